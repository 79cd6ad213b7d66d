// What a run of a stiff method ends with is within 30 tolerances of the truth, for rtol = 1e-3 ... 1e-11 and the
// problems of bench/stiff: Robertson to 1e11, HIRES, Oregonator, van der Pol in both forms, pollution, and the
// Brusselator on a line. bench/stiff prints the whole table (docs/benchmarks_stiff.md); the tests take of it what runs
// in seconds.
#pragma once
#include <cmath>
#include <string>

#include <bench/stiff/brusselator_sparse.hpp>
#include <bench/stiff/measure.hpp>
#include <bench/stiff/page.hpp>
#include <gtest/gtest.h>

#include <continuo/solve/solve.hpp>

namespace continuo::promises {

template <class M, class Problem, class System = Problem>
void expect_tolerance_kept(int strictest_power) {
  for (const int power : bench::tolerances_asked) {
    if (power > strictest_power) return;
    const double rtol = std::pow(10, -power);
    System system;
    auto start = system.start();
    using X = decltype(start);
    const auto solution =
        solve(system, start, {0.0, Problem::duration}, M{},
              {.rtol = rtol, .atol = rtol * bench::absolute_part<Problem>, .save = Save<X>::only_end()});
    ASSERT_TRUE(solution.outcome) << Problem::name << ' ' << rtol << ' ' << describe(solution.outcome);
    const auto answer = bench::judged<Problem>(solution.final_state(), rtol, solution.statistics.evaluations);
    EXPECT_LE(answer.tolerances, bench::most_tolerances) << Problem::name << ' ' << rtol;
  }
}

/// A method of order p needs steps ~ tolerance^(1/p): of order 2, tens of millions at 1e-11.
template <class M>
constexpr int strictest_in_seconds() {
  return M::order == 1 ? 4 : M::order == 2 ? 8 : 11;
}

struct NameOfStiffMethod {
  template <class M>
  static std::string GetName(int) {
    return std::string(M::name);
  }
};
template <class M>
class StiffTolerance : public ::testing::Test {};
TYPED_TEST_SUITE_P(StiffTolerance);

// A Jacobian of the jump, kept while steps grew again, made methods believe that they had solved their equations: they
// went on along a line, thousands of tolerances away.
TYPED_TEST_P(StiffTolerance, IsKeptOnAnOrbitWithJumps) {
  expect_tolerance_kept<TypeParam, bench::VanDerPol<>>(TypeParam::order == 1 ? 3 : 5);
}

TYPED_TEST_P(StiffTolerance, IsKeptToTheLimitsOfDouble) {
  constexpr int strictest = strictest_in_seconds<TypeParam>();
  expect_tolerance_kept<TypeParam, bench::Robertson<>>(strictest);
  expect_tolerance_kept<TypeParam, bench::Hires<>>(strictest);
  expect_tolerance_kept<TypeParam, bench::Oregonator<>>(strictest);
  expect_tolerance_kept<TypeParam, bench::VanDerPol<>>(strictest);
  expect_tolerance_kept<TypeParam, bench::VanDerPolScaled<>>(TypeParam::order == 1 ? 3 : strictest);
  expect_tolerance_kept<TypeParam, bench::Pollution<>>(strictest);
  using Line = bench::BrusselatorLine<>;
  expect_tolerance_kept<TypeParam, Line, bench::SparseBrusselator>(TypeParam::order == 1 ? 3 : strictest);
}

REGISTER_TYPED_TEST_SUITE_P(StiffTolerance, IsKeptOnAnOrbitWithJumps, IsKeptToTheLimitsOfDouble);

}  // namespace continuo::promises
