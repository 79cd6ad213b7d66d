// A thousand random hybrid systems against the referee: every event at its time and no other. `hybrid_attack` tests any
// number.
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tests/hybrid/comparison.hpp>

namespace continuo::hybrid {
void PrintTo(const Asked& asked, std::ostream* out) {
  *out << (asked.method.empty() ? "default" : asked.method);
}

namespace {

class HybridSystems : public testing::TestWithParam<Asked> {};

TEST_P(HybridSystems, HaveEveryEventAtItsTimeAndNoOther) {
  const Attack result = attack(GetParam(), 200, 1, 3);
  EXPECT_EQ(result.failed, 0u) << "of " << result.asked;
  for (const std::string& failure : result.failures) ADD_FAILURE() << failure;
  // Fewer than half of the models are left out, and every class occurs among the others.
  EXPECT_LT(result.rejected, result.asked);
  EXPECT_GE(result.events, 5 * result.asked);
  EXPECT_GE(result.with_slides, result.asked / 20);
  EXPECT_GE(result.with_cascades, result.asked / 20);
  EXPECT_GE(result.with_simultaneous, result.asked / 20);
}

INSTANTIATE_TEST_SUITE_P(Each, HybridSystems, testing::ValuesIn(asked_methods()),
                         [](const testing::TestParamInfo<Asked>& asked) {
                           return std::string(asked.param.method.empty() ? "default" : asked.param.method);
                         });

}  // namespace
}  // namespace continuo::hybrid
