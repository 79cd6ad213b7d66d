// The pair of an explicit and a stiff method: it finds out by itself which one the system needs, and when.
#include <array>
#include <cmath>

#include <bench/problems/hires.hpp>
#include <bench/problems/lotka_volterra.hpp>
#include <bench/problems/oregonator.hpp>
#include <bench/problems/van_der_pol.hpp>
#include <gtest/gtest.h>

#include "stiff_promises.hpp"
#include <continuo/methods/bdf.hpp>
#include <continuo/methods/switching.hpp>
#include <continuo/methods/tsitouras5.hpp>

namespace continuo {
namespace {

struct Pair : Switching<Tsitouras5, Bdf> {
  static constexpr std::string_view name = "pair";
};

TEST(Switching, MeetsItsToleranceOnStiffProblems) {
  for (const double rtol : {1e-4, 1e-7, 1e-10}) {
    EXPECT_LT(promises::error_in_tolerances<Pair>(bench::Hires<>{}, rtol, rtol * 1e-4), 30) << rtol;
    EXPECT_LT(promises::error_in_tolerances<Pair>(bench::Oregonator<>{}, rtol, rtol * 1e-6), 30) << rtol;
    EXPECT_LT(promises::error_in_tolerances<Pair>(bench::VanDerPol<>{}, rtol, rtol), 30) << rtol;
  }
}

TEST(Switching, StaysWithTheExplicitMethodWhereNothingIsStiff) {
  const auto pair = solve(bench::LotkaVolterra<>{}, bench::LotkaVolterra<>::start(), {0.0, 100.0}, Pair{}, {});
  const auto alone = solve(bench::LotkaVolterra<>{}, bench::LotkaVolterra<>::start(), {0.0, 100.0}, Tsitouras5{}, {});
  EXPECT_EQ(pair.statistics.jacobians, 0U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(pair.final_state()[i], alone.final_state()[i]);
}

// Van der Pol with mu = 1000 is stiff on its slow branches and not on the jumps between: there and back several times.
TEST(Switching, GoesThereAndBack) {
  Integrator integrator(bench::VanDerPol<>{}, bench::VanDerPol<>::start(), {0.0, 4000.0}, Pair{}, {.rtol = 1e-6});
  std::size_t jacobians = 0, quiet = 0, stretches = 0;
  while (integrator.advance()) {
    const std::size_t now = integrator.statistics().jacobians;
    quiet = now == jacobians ? quiet + 1 : 0;
    if (quiet == 60) ++stretches;  // a stiff method renews its Jacobian at least every 50 steps
    jacobians = now;
  }
  ASSERT_TRUE(integrator.outcome());
  EXPECT_GT(jacobians, 5U);
  EXPECT_GE(stretches, 2U);
}

TEST(Switching, ACopyGoesOnToTheSameBits) {
  promises::expect_copy_goes_on_to_the_same_bits<Pair>(bench::Oregonator<>{}, bench::Oregonator<>::start(), 100);
}

TEST(Switching, DenseOutputMeetsTheToleranceAcrossTheChange) {
  const auto f = [](double t, const std::array<double, 1>& x) {
    return std::array{-1000 * (x[0] - std::cos(t)) - std::sin(t)};
  };
  for (const double tolerance : {1e-4, 1e-7})
    EXPECT_LT(promises::dense_error_in_tolerances<Pair>(f, 3, tolerance, [](double t) { return std::cos(t); }), 30);
}

TEST(Switching, SolvesAlgebraicEquationsByTheStiffMethodAlone) {
  EXPECT_LT(promises::error_of_algebraic_decay<Pair>(1e-6), 30);
}

}  // namespace
}  // namespace continuo
