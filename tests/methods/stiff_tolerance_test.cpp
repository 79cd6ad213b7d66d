// The error at the end of a run by a stiff method is within 30 tolerances, for rtol = 1e-3 ... 1e-11 and the problems
// of bench/stiff: Robertson to 1e11, HIRES, Oregonator, van der Pol in both forms, pollution, and the Brusselator on a
// line. bench/stiff prints the whole table (docs/benchmarks_stiff.md); the tests include the part of it that runs in
// seconds.
#include <algorithm>
#include <cmath>
#include <concepts>
#include <string>
#include <vector>

#include <bench/stiff/brusselator_sparse.hpp>
#include <bench/stiff/measure.hpp>
#include <bench/stiff/page.hpp>
#include <gtest/gtest.h>

#include "solved_by_name.hpp"
#include <continuo/methods/automatic.hpp>
#include <continuo/methods/collocation/radau.hpp>
#include <continuo/methods/dirk/implicit_euler.hpp>
#include <continuo/methods/dirk/kencarp4.hpp>
#include <continuo/methods/dirk/kvaerno5.hpp>
#include <continuo/methods/dirk/tr_bdf2.hpp>
#include <continuo/methods/extrapolation/seulex.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/rosenbrock/rodas4.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/methods/rosenbrock/rosenbrock23.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::promises {
namespace {

/// run(rtol, atol) is the solution of Problem by some method.
template <class Problem, class Run>
void expect_tolerance_kept_by(int loosest_power, int strictest_power, const Run& run) {
  for (const int power : bench::tolerances_asked) {
    if (power < loosest_power) continue;
    if (power > strictest_power) return;
    const double rtol = std::pow(10, -power);
    const auto solution = run(rtol, rtol * bench::absolute_part<Problem>);
    ASSERT_TRUE(solution.outcome) << Problem::name << ' ' << rtol << ' ' << describe(solution.outcome);
    const auto answer = bench::judged<Problem>(solution.final_state(), rtol, solution.statistics.evaluations);
    EXPECT_LE(answer.tolerances, bench::most_tolerances) << Problem::name << ' ' << rtol;
  }
}

/// The default method uses this pair only for tolerances below 1e-6; at 1e-4 its error in the phase of a relaxation
/// oscillation is 38 tolerances.
template <class M>
constexpr int loosest_power = std::same_as<M, Dop853Radau> ? 5 : 0;

/// With the methods selected by name, as in studies, compiled once for all systems.
template <class M, class Problem>
void expect_tolerance_kept(int strictest_power) {
  expect_tolerance_kept_by<Problem>(loosest_power<M>, strictest_power, solved_by_name<M, Problem>);
}

/// With the sparse Jacobian.
template <class M>
void expect_tolerance_kept_on_a_line(int strictest_power) {
  expect_tolerance_kept_by<bench::BrusselatorLine<>>(loosest_power<M>, strictest_power, [](double rtol, double atol) {
    bench::SparseBrusselator system;
    auto start = system.start();
    using X = decltype(start);
    return solve(system, start, {0.0, bench::BrusselatorLine<>::duration}, M{},
                 {.rtol = rtol, .atol = atol, .save = Save<X>::only_end()});
  });
}

/// A method of order p needs steps ~ tolerance^(1/p): of order 2, tens of millions at 1e-11. Extrapolation needs one
/// matrix I/H - J for all rows of its table, but each row rounds its own: relative to 1/H by |J| H epsilon, which at
/// the end of Robertson's problem is some percent. The rows then differ by more than the tolerance of 1e-11 unless
/// steps are short, as many as the noise leaves, and their errors add up.
template <class M>
constexpr int strictest_in_seconds() {
  return M::order == 1 ? 4 : M::order == 2 ? 8 : std::same_as<M, Seulex> ? 10 : 11;
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

// With a Jacobian evaluated in the jump and kept while steps grew again, the iteration seemed to converge: the solution
// continued along a line, thousands of tolerances away.
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
  expect_tolerance_kept_on_a_line<TypeParam>(TypeParam::order == 1 ? 3 : strictest);
}

REGISTER_TYPED_TEST_SUITE_P(StiffTolerance, IsKeptOnAnOrbitWithJumps, IsKeptToTheLimitsOfDouble);

using Pairs = ::testing::Types<Tsitouras5Rodas5P, Dop853Radau, Tsitouras5Bdf>;
INSTANTIATE_TYPED_TEST_SUITE_P(Automatic, StiffTolerance, Pairs, NameOfStiffMethod);
using CollocationMethods = ::testing::Types<Radau5, Radau>;
INSTANTIATE_TYPED_TEST_SUITE_P(Collocation, StiffTolerance, CollocationMethods, NameOfStiffMethod);
using DiagonalMethods = ::testing::Types<ImplicitEuler, TrBdf2, KenCarp4, Kvaerno5>;
INSTANTIATE_TYPED_TEST_SUITE_P(DiagonallyImplicit, StiffTolerance, DiagonalMethods, NameOfStiffMethod);
using MultistepMethods = ::testing::Types<Bdf>;
INSTANTIATE_TYPED_TEST_SUITE_P(Multistep, StiffTolerance, MultistepMethods, NameOfStiffMethod);
using ExtrapolationMethods = ::testing::Types<Seulex>;
INSTANTIATE_TYPED_TEST_SUITE_P(Extrapolation, StiffTolerance, ExtrapolationMethods, NameOfStiffMethod);
using RosenbrockMethods = ::testing::Types<Rosenbrock23, Rodas4, Rodas5P>;
INSTANTIATE_TYPED_TEST_SUITE_P(Rosenbrock, StiffTolerance, RosenbrockMethods, NameOfStiffMethod);

}  // namespace
}  // namespace continuo::promises
