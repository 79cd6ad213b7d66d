// sensitivity_attack COUNT SEED: tests any number of derivatives of random hybrid models, up to the first on which
// library and referee differ.
#include <cstdint>
#include <cstdlib>

#include <fmt/format.h>
#include <tests/hybrid/sensitivities.hpp>

int main(int count, char** words) {
  using namespace continuo::hybrid;
  if (count < 3) {
    fmt::print("sensitivity_attack COUNT SEED [FAILURES_TO_TELL]\n");
    return 1;
  }
  const SensitivityAttack result =
      attack_sensitivities(std::strtoull(words[1], nullptr, 10), std::strtoull(words[2], nullptr, 10),
                           count > 3 ? std::strtoull(words[3], nullptr, 10) : 5);
  for (const std::string& failure : result.failures) fmt::print("----\n{}\n", failure);
  fmt::print("{} of {} derivatives are wrong; {} go through events, {} through sliding, {} are not zero\n",
             result.failed, result.asked, result.through_events, result.through_slides, result.not_zero);
  fmt::print("  refused:\n");
  for (const auto& [reason, times] : result.refused) fmt::print("  {:6} {}\n", times, reason);
  fmt::print("  left out:\n");
  for (const auto& [reason, times] : result.left_out) fmt::print("  {:6} {}\n", times, reason);
  return result.failed == 0 ? 0 : 4;
}
