#include <cmath>
#include <set>
#include <span>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/studies/sweep/morris.hpp>

namespace continuo::studies::morris_test {
namespace {

using testing::HasSubstr;

template <class F>
std::vector<double> outcomes_of(const MorrisDesign& design, F f) {
  std::vector<double> outcomes, u(design.factors);
  for (std::uint64_t run = 0; run < design.runs(); ++run) {
    for (std::size_t i = 0; i < design.factors; ++i) u[i] = coordinate(design, run, i);
    outcomes.push_back(f(std::span<const double>(u)));
  }
  return outcomes;
}

TEST(Morris, ChangesOneFactorAfterAnotherByHalfOfItsRange) {
  const MorrisDesign design{.factors = 6, .trajectories = 50, .seed = 1, .levels = 8};
  std::set<std::size_t> first_changes;
  for (std::uint64_t trajectory = 0; trajectory < 50; ++trajectory) {
    std::set<std::size_t> changed;
    for (std::uint64_t k = 0; k < 6; ++k) {
      const std::uint64_t run = trajectory * 7 + k;
      for (std::size_t i = 0; i < 6; ++i) {
        const double before = coordinate(design, run, i), after = coordinate(design, run + 1, i);
        EXPECT_EQ(std::fmod(before * 8, 1), 0.5);
        if (before == after) continue;
        EXPECT_EQ(std::abs(after - before), 0.5);
        changed.insert(i);
        if (k == 0) first_changes.insert(i);
      }
      EXPECT_EQ(changed.size(), k + 1);
    }
  }
  EXPECT_EQ(first_changes.size(), 6u);  // each comes first at times
}

TEST(Morris, EffectsOfALinearFunctionAreItsCoefficients) {
  const MorrisDesign design{.factors = 3, .trajectories = 10, .seed = 2};
  const auto effects =
      morris_screening(design, outcomes_of(design, [](auto u) { return 4 * u[0] - 2 * u[1] + 100; })).effects;
  const double expected[] = {4, -2, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(effects[i].mean, expected[i], 1e-12);
    EXPECT_NEAR(effects[i].mean_absolute.value, std::abs(expected[i]), 1e-12);
    EXPECT_NEAR(effects[i].mean_absolute.low, std::abs(expected[i]), 1e-12);
    EXPECT_NEAR(effects[i].deviation, 0, 1e-12);
    EXPECT_EQ(effects[i].count, 10u);
  }
}

TEST(Morris, EffectsOfAProductSpreadAsTheOtherFactor) {
  // d(u v)/du is v, even over 1/8, 3/8, 5/8, 7/8: mean 1/2, variance 5/64.
  const MorrisDesign design{.factors = 2, .trajectories = 20000, .seed = 3};
  const auto effects = morris_screening(design, outcomes_of(design, [](auto u) { return u[0] * u[1]; })).effects;
  const double deviation = std::sqrt(5.0 / 64);
  for (const ElementaryEffects& e : effects) {
    EXPECT_NEAR(e.mean, 0.5, 4 * deviation / std::sqrt(20000));
    EXPECT_NEAR(e.deviation, deviation, 4 * deviation / std::sqrt(20000));
  }
}

TEST(Morris, EffectsOfOppositeSignsDoNotCancelInTheMeanOfTheirSizes) {
  // (u - 1/2)(v - 1/2): the effect of u is v - 1/2, even over -3/8, -1/8, 1/8, 3/8.
  const MorrisDesign design{.factors = 2, .trajectories = 5000, .seed = 4};
  const auto effects =
      morris_screening(design, outcomes_of(design, [](auto u) { return (u[0] - 0.5) * (u[1] - 0.5); })).effects;
  for (const ElementaryEffects& e : effects) {
    EXPECT_NEAR(e.mean_absolute.value, 0.25, 4 * 0.125 / std::sqrt(5000));
    EXPECT_NEAR(e.mean, 0, 4 * std::sqrt(5.0 / 64 / 5000));
  }
}

TEST(Morris, IntervalsHaveTheMeanAsOftenAsPromised) {
  int held = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const MorrisDesign design{.factors = 2, .trajectories = 20, .seed = seed};
    const auto e = morris_screening(design, outcomes_of(design, [](auto u) { return u[0] * u[1]; })).effects[0];
    held += e.mean_absolute.low <= 0.5 && 0.5 <= e.mean_absolute.high ? 1 : 0;
  }
  EXPECT_NEAR(held, 950, 4 * std::sqrt(1000 * 0.95 * 0.05));
}

TEST(Morris, CountsStepsWithFailedRunsApart) {
  const MorrisDesign design{.factors = 2, .trajectories = 10, .seed = 5};
  auto outcomes = outcomes_of(design, [](auto u) { return u[0] + u[1]; });
  outcomes[1] = std::nan("");  // in the middle of the first trajectory: both of its steps
  for (const ElementaryEffects& e : morris_screening(design, outcomes).effects) {
    EXPECT_EQ(e.count, 9u);
    EXPECT_EQ(e.missing, 1u);
    EXPECT_NEAR(e.mean, 1, 1e-12);
  }
  outcomes.resize(15);  // after an interruption
  for (const ElementaryEffects& e : morris_screening(design, outcomes).effects) EXPECT_EQ(e.count, 4u);
  EXPECT_TRUE(std::isnan(morris_screening(design, {}).effects[0].mean));
}

TEST(Morris, FaultsSayHowToMendThem) {
  EXPECT_THAT(check(MorrisDesign{.factors = 0}).message, HasSubstr("nothing is varied"));
  EXPECT_THAT(check(MorrisDesign{.trajectories = 1}).message, HasSubstr("10 to 50 are usual"));
  EXPECT_THAT(check(MorrisDesign{.levels = 5}).message, HasSubstr("an even number of levels"));
  EXPECT_TRUE(check(MorrisDesign{.factors = 3}));
}

}  // namespace
}  // namespace continuo::studies::morris_test
