// Steps that begin where a slope is infinite, or nearly so: the Jacobian there lets no correction through that could be
// seen, and stages must not pass for solved.
#include <array>
#include <cmath>
#include <span>

#include <gtest/gtest.h>

#include <continuo/methods/collocation/gauss4.hpp>
#include <continuo/methods/collocation/radau.hpp>
#include <continuo/methods/dirk/kvaerno5.hpp>
#include <continuo/methods/extrapolation/seulex.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo {
namespace {

using X = std::array<double, 1>;

/// x' = inflow - sqrt(x), with its exact Jacobian.
struct Tank {
  double inflow;
  void operator()(double, const X& x, X& dxdt) const { dxdt[0] = inflow - std::sqrt(std::abs(x[0])); }
  void jacobian(double, const X& x, std::span<double> rows) const { rows[0] = -0.5 / std::sqrt(std::abs(x[0])); }
};

template <class M>
class InfiniteSlope : public testing::Test {};

using Methods = testing::Types<Radau, Gauss4, Rodas5P, Seulex, Bdf, Kvaerno5>;
TYPED_TEST_SUITE(InfiniteSlope, Methods);

// With u = sqrt(x), 2 u u' = inflow - u: t = 2 (u0 - u) + 2 inflow ln((inflow - u0)/(inflow - u)).
TYPED_TEST(InfiniteSlope, ATankFillsFromAlmostNothing) {
  for (const double inflow : {0.3, 2.0}) {
    for (const double start : {1e-12, 1e-16, 1e-20, 1e-30, 1e-60, 1e-150}) {
      const double u0 = std::sqrt(start), u = 0.7 * inflow;
      const double t = 2 * (u0 - u) + 2 * inflow * std::log((inflow - u0) / (inflow - u));
      const auto solution = solve(Tank{inflow}, X{start}, {0, t}, TypeParam{}, {.rtol = 1e-7, .atol = 1e-9});
      ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
      EXPECT_NEAR(solution.final_state()[0], u * u, 1e-5 * inflow * inflow) << "from " << start;
    }
  }
}

}  // namespace
}  // namespace continuo
