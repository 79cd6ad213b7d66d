// `combine` in a world: its rule applies to the motion, in every mode.
#include <string>
#include <vector>

#include <tests/worlds/scene.hpp>

#include <continuo/language/describe.hpp>

namespace continuo::worlds::materials_test {
namespace {

/// A ball of e = 0.8 falls by 5 on a floor of e = 0.2; a disc of mu = 0.4 slips on it, of mu = 0.1.
std::string scene(const std::string& combine, const std::string& checks) {
  return R"(
world {
  gravity (0, -10)
  wall floor (0, 1) at 0 restitution 0.2 friction 0.1 rolling 0.02
  body ball at (0, 5.5) restitution 0.8 friction 0
  body disc at (10, 0.5) velocity (-20, 0) restitution 0 friction 0.4
  body wheel at (40, 0.5) velocity (3, 0) spin -6 restitution 0 friction 1 rolling 0.08
)" + combine +
         R"(
}
output rebound = (1/2*ball.y'^2 + 10*(ball.y - 0.5))/10
run 0..1.1
)" + checks;
}

struct Mode {
  std::string line;
  double height, speed, rolling;  // tolerances
};
/// Exact to rounding; of the fast motion's contacts see tests/bodies/materials_test.cpp: it makes impacts at their
/// instant, and lets contacts yield in their first step.
const std::vector<Mode> modes = {{"", 1e-12, 1e-12, 1e-12}, {"mode fast step 1/240", 1e-3, 0.01, 0.01}};

TEST(Materials, CombineAsTheWorldSays) {
  struct Case {
    std::string text;
    double restitution, friction, rolling;
  };
  for (const Case& each :
       {Case{"", 0.8, 0.2, 0.08},  // the greater, the geometric mean, the greater
        Case{"combine restitution minimum friction maximum rolling average", 0.2, 0.4, 0.05},
        Case{"combine restitution average friction average rolling minimum", 0.5, 0.25, 0.02},
        Case{"combine restitution product friction product rolling geometric_mean", 0.16, 0.04, 0.04},
        Case{"combine restitution geometric_mean", 0.4, 0.2, 0.08},
        Case{"combine friction minimum rolling product", 0.8, 0.1, 0.0016}}) {
    for (const Mode& mode : modes) {
      const model::Run run = run_of(scene(each.text + "\n" + mode.line, ""));
      // e^2 of the height. The disc slips until 2/3 of its speed is left: for 1.67 s at 0.4. A wheel
      // of inertia m r^2/2 is slowed by c g/(1 + 1/2).
      EXPECT_NEAR(last(run, "rebound"), each.restitution * each.restitution * 5, mode.height) << each.text;
      EXPECT_NEAR(last(run, "disc.x'"), -20 + each.friction * 10 * 1.1, mode.speed) << each.text;
      EXPECT_NEAR(last(run, "wheel.x'"), 3 - each.rolling * 10 / 1.5 * 1.1, mode.rolling) << each.text;
    }
  }
}

TEST(Materials, AreTakenFromSnapshotsToo) {
  const std::string text = scene("combine restitution minimum", "");
  const auto run = started(text), again = started(text);
  ASSERT_TRUE(run->advance_to(0.5));
  ASSERT_TRUE(again->restore(run->snapshot()));
  ASSERT_TRUE(run->advance_to(1.1));
  ASSERT_TRUE(again->advance_to(1.1));
  EXPECT_EQ(run->state(), again->state());
}

TEST(Materials, AreToldByTheDescription) {
  const auto told = [](const std::string& combine) { return describe(program_of(scene(combine, ""))->model); };
  EXPECT_NE(
      told("combine friction minimum").find("surfaces combine: restitution maximum, friction minimum, rolling maximum"),
      std::string::npos);
  EXPECT_EQ(told("").find("surfaces combine"), std::string::npos);
}

}  // namespace
}  // namespace continuo::worlds::materials_test
