// The Runge-Kutta-Nystrom pairs against the conditions of E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary
// Differential Equations I", II.14, and against motions known in closed form.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "dense_order.hpp"
#include "nystrom_trees.hpp"
#include <continuo/methods/nystrom/dormand_prince_nystrom12.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom6.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom8.hpp>
#include <continuo/system/second_order.hpp>

namespace continuo::runge_kutta_nystrom_test {
namespace {

using Quad = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;

template <class M>
class Nystrom : public ::testing::Test {};
using Pairs = ::testing::Types<DormandPrinceNystrom6, DormandPrinceNystrom8, DormandPrinceNystrom12>;
TYPED_TEST_SUITE(Nystrom, Pairs);

template <std::size_t Stages>
std::vector<Quad> numbers(const Coefficient (&row)[Stages]) {
  std::vector<Quad> result(Stages);
  for (std::size_t i = 0; i < Stages; ++i) result[i] = row[i].template as<Quad>();
  return result;
}
template <std::size_t Stages>
NystromNumbers<Quad> numbers(const NystromTableau<Stages>& tableau) {
  NystromNumbers<Quad> result{numbers(tableau.c), {}, numbers(tableau.b), numbers(tableau.bv)};
  for (const auto& row : tableau.a) result.a.push_back(numbers(row));
  return result;
}

// The coefficients are known to 45 digits after the point and calculated with in 34; the greatest of them is 50, and 17
// stages make up to five factors.
const Quad rounding(1e-30);

TYPED_TEST(Nystrom, StagesLieOnAParabola) {
  const auto method = numbers(TypeParam::tableau);
  for (std::size_t i = 0; i < method.c.size(); ++i) {
    Quad sum = -method.c[i] * method.c[i] / 2;
    for (const Quad& entry : method.a[i]) sum += entry;
    EXPECT_LT(abs(sum), rounding) << "stage " << i;
  }
}

TYPED_TEST(Nystrom, MeetsAllOrderConditionsAndNotTheNext) {
  const auto method = numbers(TypeParam::tableau);
  const auto order = static_cast<std::size_t>(TypeParam::order);
  const auto trees = nystrom_trees(method, order);
  EXPECT_LT(position_defect(trees, method.b, order), rounding);
  EXPECT_LT(velocity_defect(trees, method.bv, order), rounding);
  EXPECT_GT(velocity_defect(trees, method.bv, order + 1), Quad(1e-9));
  const auto lower = static_cast<std::size_t>(TypeParam::error_order);
  EXPECT_LT(position_defect(trees, numbers(TypeParam::tableau.embedded), lower), rounding);
  EXPECT_LT(velocity_defect(trees, numbers(TypeParam::tableau.embedded_v), lower), rounding);
  EXPECT_GT(velocity_defect(trees, numbers(TypeParam::tableau.embedded_v), lower + 1), Quad(1e-9));
}

TEST(DormandPrinceNystrom6, DenseOutputMeetsItsOrderConditionsAllAlongTheStep) {
  using M = DormandPrinceNystrom6;
  const auto trees = nystrom_trees(numbers(M::tableau), 6);
  for (const double part : {0.1, 0.5, 0.75, 1.0}) {
    const Quad theta(part);
    std::vector<Quad> position(6, Quad(0)), velocity(6, Quad(0));
    for (std::size_t i = 0; i < 6; ++i) {
      Quad power = theta;
      for (std::size_t j = 0; j < 5; ++j, power *= theta) {
        const Quad r = M::dense.r[i][j].as<Quad>();
        position[i] += r * power * theta;
        velocity[i] += Quad(j + 2) * r * power;
      }
    }
    EXPECT_LT(position_defect(trees, position, 6, theta), rounding);
    EXPECT_LT(velocity_defect(trees, velocity, 5, theta), rounding);
  }
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
  const int steps = TypeParam::order == 12 ? 12 : TypeParam::order == 8 ? 48 : 200;
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

TYPED_TEST(Nystrom, TheInterpolantHasTheStatedOrder) {
  expect_dense_order_on_oscillator<TypeParam>(0.25);
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
}  // namespace continuo::runge_kutta_nystrom_test
