// Derivatives through events, jumps of the equations and sliding, of random hybrid systems, against differences of the
// referee's closed forms. `sensitivity_attack` tests any number.
#include <numeric>

#include <gtest/gtest.h>
#include <tests/hybrid/sensitivities.hpp>

namespace continuo::hybrid {
namespace {

TEST(HybridSensitivities, AreTheDifferencesOfClosedForms) {
  const SensitivityAttack result = attack_sensitivities(300, 1, 3);
  EXPECT_EQ(result.failed, 0u) << "of " << result.asked;
  for (const std::string& failure : result.failures) ADD_FAILURE() << failure;
  EXPECT_GE(result.through_events, result.asked / 2);
  EXPECT_GE(result.through_slides, result.asked / 10);
  EXPECT_GE(result.not_zero, result.asked / 2);
  std::size_t refused = 0;
  for (const auto& [reason, times] : result.refused) refused += times;
  EXPECT_LT(refused, result.asked / 4);
}

}  // namespace
}  // namespace continuo::hybrid
