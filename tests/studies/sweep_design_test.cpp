// Sweeps whose runs are those for Sobol' indices and for the screening of Morris, on a model whose outcome is known.
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/studies/sweep/sweep_run.hpp>

namespace continuo::studies::sweep_design_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// x(1) = a + 2 b + c(0), of which the last is not varied.
Result<PreparedSweep> sum_of(const std::string& runs) {
  model::Loaded loaded = model::load(model::Source("sum.sim",
                                                   "param a = 1\nparam b = 1\nx' = a + 2*b\nx(0) = 5\nrun 0..1\n"
                                                   "sweep { a uniform(0, 1); b uniform(0, 1); keep x at end; runs " +
                                                       runs + " }\n"));
  EXPECT_TRUE(loaded) << loaded.text();
  return PreparedSweep::create(*std::move(loaded.model), {});
}

std::vector<double> outcomes_of(const PreparedSweep& sweep) {
  std::vector<double> outcomes;
  for (std::uint64_t run = 0; run < sweep.runs(); ++run) outcomes.push_back(sweep.run(run).kept.front());
  return outcomes;
}

TEST(SweepDesign, IndicesAreThoseOfASum) {  // variances 1/12 and 4/12
  const auto sweep = sum_of("1000 indices seed 3");
  ASSERT_TRUE(sweep) << describe(sweep.status());
  EXPECT_EQ(sweep->runs(), 512U);  // 16 samples of 8 rows of 4
  EXPECT_THAT(sweep->design()->advice(1000), HasSubstr("of 1000 runs 512 are made"));
  const SobolIndices indices = sobol_indices(*sweep->design()->indices(), outcomes_of(*sweep));
  const double expected[] = {0.2, 0.8};
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LE(indices.first[i].low, expected[i]);
    EXPECT_GE(indices.first[i].high, expected[i]);
    EXPECT_NEAR(indices.total[i].value, expected[i], 0.1);
  }
  EXPECT_THAT(sweep->dimension_names(), ElementsAre("a", "b"));
}

TEST(SweepDesign, MorrisFindsTheSlopesOfASum) {
  const auto sweep = sum_of("31 morris");
  ASSERT_TRUE(sweep) << describe(sweep.status());
  EXPECT_EQ(sweep->runs(), 30U);
  const MorrisScreening screening = morris_screening(*sweep->design()->screening(), outcomes_of(*sweep));
  EXPECT_NEAR(screening.effects[0].mean_absolute.value, 1, 1e-6);
  EXPECT_NEAR(screening.effects[1].mean_absolute.value, 2, 1e-6);
}

TEST(SweepDesign, TooFewRunsAreRefused) {
  EXPECT_THAT(sum_of("60 indices").status().message, HasSubstr("need a multiple of 64 runs"));
  EXPECT_THAT(sum_of("5 morris").status().message, HasSubstr("2 trajectories"));
}

TEST(SweepDesign, OtherRunsAreThoseAskedFor) {
  EXPECT_EQ(sum_of("100")->runs(), 100U);
  EXPECT_THAT(sum_of("100")->design()->advice(100), HasSubstr("64 or 128"));
  EXPECT_EQ(sum_of("100 monte_carlo")->design()->advice(100), "");
}

}  // namespace
}  // namespace continuo::studies::sweep_design_test
