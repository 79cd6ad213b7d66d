// The Runge-Kutta-Nystrom pairs against the conditions of E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary
// Differential Equations I", II.14, and against motions known in closed form.
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include <continuo/methods/dormand_prince_nystrom12.hpp>
#include <continuo/methods/dormand_prince_nystrom8.hpp>
#include <continuo/system/second_order.hpp>

namespace continuo {
namespace {

template <class M>
class Nystrom : public testing::Test {};
using Pairs = testing::Types<DormandPrinceNystrom8, DormandPrinceNystrom12>;
TYPED_TEST_SUITE(Nystrom, Pairs);

/// sum_i weight_i c_i^power.
template <std::size_t Stages>
long double moment(const Coefficient (&weight)[Stages], const Coefficient (&c)[Stages], int power) {
  long double sum = 0;
  for (std::size_t i = 0; i < Stages; ++i)
    sum += weight[i].template as<long double>() * std::pow(c[i].template as<long double>(), power);
  return sum;
}

TYPED_TEST(Nystrom, StagesLieOnAParabola) {
  const auto& tableau = TypeParam::tableau;
  for (std::size_t i = 0; i < tableau.stages; ++i) {
    long double sum = 0, size = 0;
    for (std::size_t j = 0; j < i; ++j) {
      sum += tableau.a[i][j].template as<long double>();
      size += std::abs(tableau.a[i][j].template as<long double>());
    }
    const auto c = tableau.c[i].template as<long double>();
    EXPECT_NEAR(static_cast<double>(sum - c * c / 2), 0, static_cast<double>(1e-17L * (1 + size))) << "stage " << i;
  }
}

TYPED_TEST(Nystrom, WeightsIntegratePowersOfTimeUpToTheirOrder) {
  const auto& tableau = TypeParam::tableau;
  const auto expect = [](long double got, int denominator) {
    EXPECT_NEAR(static_cast<double>(got), 1.0 / denominator, 1e-14);
  };
  for (int q = 0; q < TypeParam::order - 1; ++q) expect(moment(tableau.b, tableau.c, q), (q + 1) * (q + 2));
  for (int q = 0; q < TypeParam::order; ++q) expect(moment(tableau.bv, tableau.c, q), q + 1);
  for (int q = 0; q < TypeParam::error_order - 1; ++q)
    expect(moment(tableau.embedded, tableau.c, q), (q + 1) * (q + 2));
  for (int q = 0; q < TypeParam::error_order; ++q) expect(moment(tableau.embedded_v, tableau.c, q), q + 1);
}

/// A planet on an ellipse of eccentricity 0.2 about a fixed sun, from the nearest point; its period is 2 pi.
auto planet() {
  return second_order([]<class Real>(Real, const std::array<Real, 2>& q) {
    const Real square = q[0] * q[0] + q[1] * q[1], cube = square * std::sqrt(square);
    return std::array<Real, 2>{-q[0] / cube, -q[1] / cube};
  });
}
template <class Real>
std::array<Real, 4> planet_start() {
  return {Real(0.8L), 0, 0, std::sqrt(Real(1.5L))};
}

/// The state at `end`, by steps of equal size.
template <class M, class System, State X>
X march(System system, X x, Scalar<X> end, int steps) {
  auto work = M::workspace(x);
  X x_new = x;
  const Scalar<X> h = end / static_cast<Scalar<X>>(steps);
  for (int n = 0; n < steps; ++n) {
    if (n > 0) M::accept(work);
    M::step(system, static_cast<Scalar<X>>(n) * h, x, h, n == 0, work, x_new);
    x = x_new;
  }
  return x;
}

template <class M>
long double error_after_one_orbit(int steps) {
  const auto start = planet_start<long double>();
  const auto end = march<M>(planet(), start, 2 * std::numbers::pi_v<long double>, steps);
  long double worst = 0;
  for (std::size_t i = 0; i < 4; ++i) worst = std::max(worst, std::abs(end[i] - start[i]));
  return worst;
}

// In 80-bit numbers: order 12 falls through all digits of a double before it shows. The largest error of a component is
// along the orbit for all of these step sizes, so its logarithm is a straight line but for the next power of h.
TYPED_TEST(Nystrom, ErrorFallsWithTheOrder) {
  if (std::numeric_limits<long double>::digits < 64) GTEST_SKIP() << "long double is double here";
  const int steps = TypeParam::order == 12 ? 12 : 48;
  const long double coarse = error_after_one_orbit<TypeParam>(steps),
                    fine = error_after_one_orbit<TypeParam>(2 * steps);
  EXPECT_NEAR(static_cast<double>(std::log2(coarse / fine)), TypeParam::order, 0.5);
}

// The estimate is the error of the embedded solution: it falls with h to the power of that order plus one.
TYPED_TEST(Nystrom, EstimateFallsWithItsOrder) {
  auto system = planet();
  const auto start = planet_start<long double>();
  const auto estimate = [&](long double h) {
    auto work = TypeParam::workspace(start);
    auto x_new = start;
    TypeParam::step(system, 0, start, h, true, work, x_new);
    return TypeParam::error_norm(work, h, start, x_new, Tolerance<long double>{.rtol = 0, .atol = 1});
  };
  const long double h = 0.3L;
  EXPECT_NEAR(static_cast<double>(std::log2(estimate(h) / estimate(h / 2))), TypeParam::error_order + 1, 0.5);
}

// x'' = -x: x = cos t. A quintic that meets value, slope and curvature at both ends is off by (h/2)^6 / 6! times the
// sixth derivative, here at most 1; its derivative by less than h^5 / 1000.
TYPED_TEST(Nystrom, TheInterpolantMeetsTheMotionBetweenTheEnds) {
  using X = std::array<double, 2>;
  auto spring = second_order([](double, const std::array<double, 1>& q) { return std::array{-q[0]}; });
  const double h = 0.1;
  const X x{1, 0};
  X x_new = x, between = x;
  auto work = TypeParam::workspace(x);
  TypeParam::step(spring, 0.0, x, h, true, work, x_new);
  Interpolant<X, TypeParam::dense_degree> interpolant(x);
  TypeParam::interpolate(spring, 0.0, x, h, x_new, work, interpolant);
  for (double theta = 0; theta <= 1; theta += 0.0625) {
    interpolant(theta, between);
    EXPECT_NEAR(between[0], std::cos(theta * h), 1e-14 + std::pow(h / 2, 6) / 720);
    EXPECT_NEAR(between[1], -std::sin(theta * h), 1e-13 + std::pow(h, 5) / 1000);
  }
}

TYPED_TEST(Nystrom, AForceThatReadsTheVelocityIsRefused) {
  using X = std::array<double, 2>;
  auto damped = second_order(
      [](double, const std::array<double, 1>& q, const std::array<double, 1>& v) { return std::array{-q[0] - v[0]}; });
  const X end = march<TypeParam>(damped, X{1, 0}, 0.1, 1);
  EXPECT_TRUE(std::isnan(end[0]));
  EXPECT_TRUE(std::isnan(end[1]));
}

}  // namespace
}  // namespace continuo
