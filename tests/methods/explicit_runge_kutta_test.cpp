// What continuo/methods/explicit_runge_kutta.hpp promises of the stepper; the numbers of each tableau have tests of
// their own.
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/methods/all.hpp>

namespace continuo {
namespace {

template <class M>
class Stepper : public testing::Test {};
using Methods = testing::Types<ExplicitEuler, Midpoint, Heun, Rk4, Rk38, BogackiShampine3, DormandPrince5, Tsitouras5,
                               Dop853, Verner7, Verner9>;
TYPED_TEST_SUITE(Stepper, Methods);

struct Oscillator {
  int calls = 0;
  template <State X>
  void operator()(const Scalar<X>&, const X& x, X& dxdt) {
    ++calls;
    dxdt[0] = x[1];
    dxdt[1] = -x[0];
  }
};

TYPED_TEST(Stepper, CountsTheEvaluationsItMakes) {
  using X = std::array<double, 2>;
  Oscillator f;
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
  Oscillator f;
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
  Oscillator f;
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

}  // namespace
}  // namespace continuo
