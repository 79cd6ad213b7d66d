// tests/hybrid/attack/hybrid.cpp
// hybrid_attack COUNT SEED [METHOD]: tests any number of random hybrid models, by one method or by each, up to the
// first on which library and referee differ.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <tests/hybrid/comparison.hpp>

int main(int count, char** words) {
  using namespace continuo::hybrid;
  if (count < 3) {
    fmt::print("hybrid_attack COUNT SEED [default|rk4|dop853|radau|bdf [FAILURES_TO_TELL]]\n");
    return 1;
  }
  const std::size_t models = std::strtoull(words[1], nullptr, 10);
  const std::uint64_t seed = std::strtoull(words[2], nullptr, 10);
  const std::string_view only = count > 3 ? words[3] : "";
  const std::size_t told = count > 4 ? std::strtoull(words[4], nullptr, 10) : 5;
  std::size_t failed = 0;
  for (const Asked& asked : asked_methods()) {
    const std::string_view name = asked.method.empty() ? "default" : asked.method;
    if (!only.empty() && only != name) continue;
    const Attack result = attack(asked, models, seed, told);
    failed += result.failed;
    for (const std::string& failure : result.failures) fmt::print("---- {}\n{}\n", name, failure);
    fmt::print("{}: {} of {} models fail; {} events; {} models slide, {} cascade, {} have several at one instant\n",
               name, result.failed, result.asked, result.events, result.with_slides, result.with_cascades,
               result.with_simultaneous);
    fmt::print("  {} left out:\n", result.rejected);
    for (const auto& [reason, times] : result.reasons) fmt::print("  {:6} {}\n", times, reason);
  }
  return failed == 0 ? 0 : 4;
}
