// The stepper of continuo/methods/explicit_rk/explicit_runge_kutta.hpp, by its documentation; the coefficients of each
// tableau have tests of their own.
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "equations.hpp"
#include <continuo/methods/all.hpp>

namespace continuo::explicit_runge_kutta_test {
namespace {

template <class M>
class Stepper : public ::testing::Test {};
using Methods = ::testing::Types<ExplicitEuler, Midpoint, Heun, Rk4, Rk38, BogackiShampine3, DormandPrince5, Tsitouras5,
                                 Dop853, Verner7, Verner9>;
TYPED_TEST_SUITE(Stepper, Methods);

using testing::Equations;
const Equations oscillator{[](double, auto x, auto dxdt) { dxdt[0] = x[1], dxdt[1] = -x[0]; }};

TYPED_TEST(Stepper, CountsTheEvaluationsItMakes) {
  using X = std::array<double, 2>;
  Equations f = oscillator;
  X x{1, 0}, x_new{};
  auto work = TypeParam::workspace(x);
  Interpolant<X, TypeParam::dense_degree> interpolant(x);
  int counted = 0;
  for (int i = 0; i < 4; ++i) {
    counted += TypeParam::step(f, 0.1 * i, x, 0.1, false, work, x_new);
    EXPECT_EQ(counted, f.calls);
    if (i == 2) counted += TypeParam::interpolate(f, 0.1 * i, x, 0.1, x_new, work, interpolant);
    EXPECT_EQ(counted, f.calls);
    TypeParam::accept(work);
    x = x_new;
  }
}

TYPED_TEST(Stepper, VectorsAndArraysTakeTheSameStep) {
  Equations f = oscillator;
  const std::array<double, 2> x{1, 0.5};
  const std::vector<double> y{1, 0.5};
  std::array<double, 2> x_new{};
  std::vector<double> y_new(2);
  auto work = TypeParam::workspace(x);
  auto heap = TypeParam::workspace(y);
  TypeParam::step(f, 0.0, x, 0.1, true, work, x_new);
  TypeParam::step(f, 0.0, y, 0.1, true, heap, y_new);
  EXPECT_EQ(x_new[0], y_new[0]);
  EXPECT_EQ(x_new[1], y_new[1]);
}

TYPED_TEST(Stepper, TheInterpolantMeetsBothEnds) {
  using X = std::array<double, 2>;
  Equations f = oscillator;
  const X x{1, 0.5};
  X x_new{}, value{};
  auto work = TypeParam::workspace(x);
  Interpolant<X, TypeParam::dense_degree> interpolant(x);
  TypeParam::step(f, 0.0, x, 0.3, true, work, x_new);
  TypeParam::interpolate(f, 0.0, x, 0.3, x_new, work, interpolant);
  interpolant(0.0, value);
  EXPECT_EQ(value, x);
  interpolant(1.0, value);
  // Horner's rule rounds each of its `degree` sums at the size of the state.
  EXPECT_NEAR(value[0], x_new[0], TypeParam::dense_degree * 2.3e-16);
  EXPECT_NEAR(value[1], x_new[1], TypeParam::dense_degree * 2.3e-16);
}

/// f depends on t and is not linear, so that a stage taken at the wrong place shows.
const Equations forced{[](double t, auto x, auto dxdt) { dxdt[0] = x[1] * x[1] - t, dxdt[1] = x[0] - t * x[1]; }};
using Pair = std::array<double, 2>;

TYPED_TEST(Stepper, AfterAJumpNothingOfTheLastStepIsUsed) {
  Equations f = forced;
  const Pair x{1, 0.5}, elsewhere{-2, 3};
  Pair x_new{}, expected{};
  auto used = TypeParam::workspace(x), fresh = TypeParam::workspace(x);
  TypeParam::step(f, 0.0, x, 0.1, true, used, x_new);
  TypeParam::accept(used);
  const int evaluations = TypeParam::step(f, 0.1, elsewhere, 0.2, true, used, x_new);
  EXPECT_EQ(evaluations, TypeParam::step(f, 0.1, elsewhere, 0.2, true, fresh, expected));
  EXPECT_EQ(x_new, expected);
}

TYPED_TEST(Stepper, ARejectedStepKeepsTheDerivativeAtItsStart) {
  Equations f = forced;
  const Pair x{1, 0.5};
  Pair x_new{}, expected{};
  auto work = TypeParam::workspace(x), fresh = TypeParam::workspace(x);
  const int first = TypeParam::step(f, 0.0, x, 0.5, true, work, x_new);
  EXPECT_EQ(TypeParam::step(f, 0.0, x, 0.1, false, work, x_new), first - 1);
  TypeParam::step(f, 0.0, x, 0.1, true, fresh, expected);
  EXPECT_EQ(x_new, expected);
}

TYPED_TEST(Stepper, TheDerivativeAtTheEndIsTheNextStart) {
  // Known after every step where the last stage is taken at the end, otherwise once the interpolant asked for it.
  Equations f = forced;
  const Pair x{1, 0.5};
  for (const bool interpolates : {false, true}) {
    Pair x_new{}, next{}, expected{}, slope{};
    auto work = TypeParam::workspace(x), fresh = TypeParam::workspace(x);
    Interpolant<Pair, TypeParam::dense_degree> interpolant(x);
    TypeParam::step(f, 0.0, x, 0.1, true, work, x_new);
    if (interpolates) TypeParam::interpolate(f, 0.0, x, 0.1, x_new, work, interpolant);
    TypeParam::accept(work);
    const bool known = interpolates || TypeParam::tableau.first_same_as_last();
    const int evaluations = TypeParam::step(f, 0.1, x_new, 0.1, false, work, next);
    EXPECT_EQ(evaluations, TypeParam::step(f, 0.1, x_new, 0.1, true, fresh, expected) - (known ? 1 : 0));
    EXPECT_EQ(next, expected);
    f(0.1, x_new, slope);
    EXPECT_EQ(TypeParam::derivative(work), slope);
  }
}

TYPED_TEST(Stepper, TheInterpolantMeetsTheSlopesAtBothEnds) {
  Equations f = forced;
  const Pair x{1, 0.5};
  Pair x_new{}, start{}, end{};
  auto work = TypeParam::workspace(x);
  Interpolant<Pair, TypeParam::dense_degree> p(x);
  const double h = 0.25;
  TypeParam::step(f, 0.5, x, h, true, work, x_new);
  TypeParam::interpolate(f, 0.5, x, h, x_new, work, p);
  f(0.5, x, start);
  f(0.5 + h, x_new, end);
  for (std::size_t i = 0; i < 2; ++i) {
    double slope = 0;
    for (std::size_t j = 1; j < p.c.size(); ++j) slope += static_cast<double>(j) * p.c[j][i];
    EXPECT_EQ(p.c[1][i], h * start[i]);
    EXPECT_NEAR(slope, h * end[i], 1e-13);  // the powers reach 1e2 before they cancel
  }
}

TYPED_TEST(Stepper, AnErrorThatIsNotFiniteIsNeverGood) {
  Equations blow_up{[](double, auto x, auto dxdt) { dxdt[0] = x[0] * 1e308, dxdt[1] = -x[1]; }};
  const Pair x{1e10, 0.5};
  Pair x_new{};
  auto work = TypeParam::workspace(x);
  TypeParam::step(blow_up, 0.0, x, 0.1, true, work, x_new);
  const double norm = TypeParam::error_norm(work, 0.1, x, x_new, Tolerance<double>{1e-3, 1e-3});
  EXPECT_FALSE(norm <= 1);
}

TYPED_TEST(Stepper, EveryComponentHasItsOwnTolerance) {
  if constexpr (TypeParam::error_order > 0) {
    Equations f = forced;
    const Pair x{1, 0.5}, rtol{1e-3, 1e9}, atol{1e-6, 1e9};
    const std::vector<double> y{1, 0.5};
    Pair x_new{};
    std::vector<double> y_new(2);
    auto work = TypeParam::workspace(x);
    auto heap = TypeParam::workspace(y);
    TypeParam::step(f, 0.0, x, 0.5, true, work, x_new);
    TypeParam::step(f, 0.0, y, 0.5, true, heap, y_new);
    const Tolerance<double> each{1, 1, rtol.data(), atol.data()};
    const double norm = TypeParam::error_norm(work, 0.5, x, x_new, each);
    EXPECT_NEAR(TypeParam::error_norm(heap, 0.5, y, y_new, each), norm, 1e-14 * norm);
    EXPECT_EQ(TypeParam::error_of(work, 0.5, 0), TypeParam::error_of(heap, 0.5, 0));
    // The second component counts for nothing beside its tolerance of 1e9. (DOP853 mixes two estimates.)
    const double expected = TypeParam::error_of(work, 0.5, 0) / each.scale(0, x[0], x_new[0]) / std::sqrt(2.0);
    if constexpr (!std::is_same_v<TypeParam, Dop853>) {
      EXPECT_NEAR(norm, expected, 1e-9 * expected);
    }
  }
}

/// The oscillator x_i' = x_(i+1) - x_i, indices modulo the size, by array and by vector.
template <class M, std::size_t Size>
void expect_same_as_vector() {
  Equations ring{[](double, auto x, auto dxdt) {
    for (std::size_t i = 0; i < x.size(); ++i) dxdt[i] = x[(i + 1) % x.size()] - x[i];
  }};
  std::array<double, Size> x{}, x_new{};
  for (std::size_t i = 0; i < Size; ++i) x[i] = static_cast<double>(i * i + 1);
  const std::vector<double> y(x.begin(), x.end());
  std::vector<double> y_new = y;
  auto work = M::workspace(x);
  auto heap = M::workspace(y);
  Interpolant<std::array<double, Size>, M::dense_degree> p(x);
  Interpolant<std::vector<double>, M::dense_degree> q(y);
  M::step(ring, 0.0, x, 0.1, true, work, x_new);
  M::step(ring, 0.0, y, 0.1, true, heap, y_new);
  M::interpolate(ring, 0.0, x, 0.1, x_new, work, p);
  M::interpolate(ring, 0.0, y, 0.1, y_new, heap, q);
  for (std::size_t i = 0; i < Size; ++i) {
    EXPECT_EQ(x_new[i], y_new[i]) << Size << " " << i;
    EXPECT_EQ(p.component(0.3, i), q.component(0.3, i)) << Size << " " << i;
  }
}

TYPED_TEST(Stepper, RegistersAndMemoryGiveTheSameBits) {
  // One component, in memory; three, the last register half empty; thirteen, in memory again.
  expect_same_as_vector<TypeParam, 1>();
  expect_same_as_vector<TypeParam, 3>();
  expect_same_as_vector<TypeParam, 13>();
}

}  // namespace
}  // namespace continuo::explicit_runge_kutta_test
