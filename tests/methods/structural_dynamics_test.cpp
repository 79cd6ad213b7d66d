// Newmark's and the generalized-alpha method on structures whose discrete motion is known in closed form.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "any_motion.hpp"
#include <continuo/methods/structural/generalized_alpha.hpp>
#include <continuo/methods/structural/newmark.hpp>
#include <continuo/solve/solve.hpp>
#include <continuo/system/second_order.hpp>

namespace continuo::structural_dynamics_test {
namespace {

using testing::AnyMotion;
using X = std::array<double, 2>;
using One = std::array<double, 1>;

/// Masses on a line between two walls, with springs of stiffness 1; positions, then velocities.
struct Chain {
  static constexpr std::uint32_t masses = 30;
  SparsePattern pattern = [] {
    std::vector<MatrixPlace> places;
    for (std::uint32_t i = 0; i < masses; ++i) {
      places.push_back({i, i + masses});
      for (std::uint32_t j = i > 0 ? i - 1 : 0; j <= std::min<std::uint32_t>(i + 1, masses - 1); ++j)
        places.push_back({i + masses, j});
    }
    return SparsePattern(2 * masses, places);
  }();

  void operator()(double, const std::vector<double>& x, std::vector<double>& dxdt) const {
    for (std::size_t i = 0; i < masses; ++i) {
      const double left = i > 0 ? x[i - 1] : 0, right = i + 1 < masses ? x[i + 1] : 0;
      dxdt[i] = x[masses + i];
      dxdt[masses + i] = left - 2 * x[i] + right;
    }
  }
  std::size_t pair_count(std::size_t size) const { return size / 2; }
  PositionVelocity pair(std::size_t i, std::size_t size) const { return {i, i + size / 2}; }
  const SparsePattern& jacobian_pattern() const { return pattern; }
};

// A mode of frequency w moves as cos(W t) with tan(W h / 2) = w h / 2, exactly: average acceleration maps the circle
// (w q, v) onto itself. Here 200 steps, each solved to 1e-9 of the tolerance's scale.
TEST(Newmark, ModesOfAChainMoveAtTheFrequencyOfTheClosedForm) {
  for (const std::size_t mode : {std::size_t{1}, std::size_t{10}, std::size_t{30}}) {
    const double angle = std::numbers::pi * static_cast<double>(mode) / (Chain::masses + 1);
    const double w = 2 * std::sin(angle / 2), h = 0.5, end = 100;
    std::vector<double> x(2 * Chain::masses, 0.0);
    for (std::size_t i = 0; i < Chain::masses; ++i) x[i] = std::sin(angle * static_cast<double>(i + 1));
    const auto solution = solve(Chain{}, x, {0.0, end}, Newmark{}, {.rtol = 1e-10, .atol = 1e-12, .step = h});
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    const double discrete = 2 / h * std::atan(w * h / 2);
    for (std::size_t i = 0; i < Chain::masses; ++i)
      EXPECT_NEAR(solution.final_state()[i], x[i] * std::cos(discrete * end), 1e-9) << "mode " << mode;
    EXPECT_EQ(solution.statistics.jacobians, 1U);
    EXPECT_EQ(solution.statistics.factorizations, 1U);
    // The system is linear: the second iteration of a step corrects the errors of the Jacobian by differences.
    EXPECT_LE(solution.statistics.linear_solves, 400U);
  }
}

auto oscillator_of(double w) {
  return second_order([w](double, const One& q) { return One{-w * w * q[0]}; });
}
/// Of n steps of an oscillator of frequency w, from (w q, v) = (0.6, 0.8).
template <class M>
std::vector<double> amplitudes(double w, double h, int n) {
  auto oscillator = oscillator_of(w);
  X x{0.6 / w, 0.8}, x_new{};
  auto work = M::workspace(x);
  M::set_tolerance(work, Tolerance<double>{.rtol = 1e-14, .atol = 1e-280});
  std::vector<double> result;
  for (int i = 0; i < n; ++i) {
    M::step(oscillator, 0.0, x, h, i == 0, work, x_new);
    M::accept(work);
    x = x_new;
    result.push_back(std::hypot(w * x[0], x[1]));
  }
  return result;
}

TEST(Newmark, DampsNoFrequency) {
  for (const double w : {0.1, 1.0, 30.0}) {
    for (const double amplitude : amplitudes<Newmark>(w, 1, 1000)) ASSERT_NEAR(amplitude, 1, 1e-9);
  }
}

// For h w -> infinity three eigenvalues of the step coincide at -Rho: powers grow by a polynomial of degree 2 besides
// Rho^n, so from step 500 to 1000 the mean factor is off by at most 4^(1/500) = 1.003.
template <double Rho>
void expect_damping_at_infinity() {
  const auto amplitude = amplitudes<GeneralizedAlphaWith<Rho>>(1e5, 1, 1000);
  EXPECT_NEAR(std::pow(amplitude[999] / amplitude[499], 1.0 / 500), Rho, 0.003);
}
TEST(GeneralizedAlpha, DampsTheHighestFrequenciesByItsSpectralRadius) {
  expect_damping_at_infinity<0.8>();
  expect_damping_at_infinity<0.6>();
  expect_damping_at_infinity<1.0>();
}
TEST(GeneralizedAlpha, WipesOutTheHighestFrequenciesAtZeroRadius) {
  const auto amplitude = amplitudes<GeneralizedAlphaWith<0.0>>(1e6, 1, 10);
  EXPECT_LT(amplitude[9], 1e-6);
}
TEST(GeneralizedAlpha, KeepsTheLowFrequencies) {
  // Damping begins with the third power of h w: for Rho = 0.8 less than 1e-6 a step at h w = 0.1.
  EXPECT_GT(amplitudes<GeneralizedAlpha>(0.1, 1, 100).back(), 1 - 1e-4);
}

/// Duffing's oscillator with damping, stiffening by a cube: forces that are not linear, in q and in v.
AnyMotion<double> duffing() {
  return {[](double t, double q, double v) { return -q - q * q * q - 0.2 * v * (1 + v * v) + std::cos(t); }};
}
template <class M>
X after_duffing(double h) {
  const auto solution = solve(duffing(), X{1, 0.5}, {0.0, 3.0}, M{}, {.rtol = 1e-12, .atol = 1e-13, .step = h});
  EXPECT_TRUE(solution.outcome) << describe(solution.outcome);
  return solution.final_state();
}

template <class M>
class Structural : public ::testing::Test {};
using StructuralMethods = ::testing::Types<Newmark, GeneralizedAlpha>;
TYPED_TEST_SUITE(Structural, StructuralMethods);

TYPED_TEST(Structural, HasOrderTwoWhereForcesAreNotLinear) {
  // Three halvings: the differences fall by 2^order without an exact solution.
  const X a = after_duffing<TypeParam>(0.02), b = after_duffing<TypeParam>(0.01), c = after_duffing<TypeParam>(0.005);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(std::log2((a[i] - b[i]) / (b[i] - c[i])), 2, 0.1);
}

TYPED_TEST(Structural, TheInterpolantHasTheStatedOrderInsideAStep) {
  // One step from an exact state of q'' = -q: the error of the velocity between the ends falls with h^3.
  auto oscillator = oscillator_of(1);
  const auto error = [&](double h) {
    const X x{std::cos(0.3), -std::sin(0.3)};
    X x_new = x, between = x;
    auto work = TypeParam::workspace(x);
    TypeParam::set_tolerance(work, Tolerance<double>{.rtol = 1e-14, .atol = 1e-14});
    TypeParam::step(oscillator, 0.0, x, h, true, work, x_new);
    Interpolant<X, TypeParam::dense_degree> interpolant(x);
    TypeParam::interpolate(oscillator, 0.0, x, h, x_new, work, interpolant);
    double worst = 0;
    for (double theta = 0; theta <= 1; theta += 0.125) {
      interpolant(theta, between);
      worst = std::max(
          {worst, std::abs(between[0] - std::cos(0.3 + theta * h)), std::abs(between[1] + std::sin(0.3 + theta * h))});
    }
    return worst;
  };
  EXPECT_NEAR(std::log2(error(0.02) / error(0.01)), TypeParam::dense_order + 1, 0.2);
}

/// Two masses with M = {{2, 1}, {1, 3}} and K = {{3, -1}, {-1, 2}}: with M as the mass matrix, or f divided by M.
struct Coupled {
  bool divided = false;

  void operator()(double, const std::array<double, 4>& x, std::array<double, 4>& out) const {
    const double f0 = -3 * x[0] + x[1] - 0.1 * x[2], f1 = x[0] - 2 * x[1];
    out = {x[2], x[3], f0, f1};
    if (divided) out[2] = (3 * f0 - f1) / 5, out[3] = (2 * f1 - f0) / 5;
  }
  std::size_t pair_count(std::size_t) const { return 2; }
  PositionVelocity pair(std::size_t i, std::size_t) const { return {i, i + 2}; }
  bool has_mass() const { return !divided; }
  void mass_matrix(std::span<double> rows) const {
    std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 1, 0, 0, 1, 3};
    if (divided) m[10] = m[15] = 1, m[11] = m[14] = 0;
    std::copy(m.begin(), m.end(), rows.begin());
  }
};
TYPED_TEST(Structural, AMassMatrixIsTheSameAsDividingByIt) {
  const std::array<double, 4> x{1, -0.5, 0.2, 0};
  const Options<std::array<double, 4>> options{.rtol = 1e-12, .atol = 1e-12, .step = 0.1};
  const auto given = solve(Coupled{}, x, {0.0, 20.0}, TypeParam{}, options);
  const auto divided = solve(Coupled{true}, x, {0.0, 20.0}, TypeParam{}, options);
  ASSERT_TRUE(given.outcome) << describe(given.outcome);
  // Both iterate to 1e-6 tolerances at each of 200 steps.
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(given.final_state()[i], divided.final_state()[i], 1e-11);
}

TEST(Newmark, MeetsItsTolerance) {
  // q'' + 0.2 q' + q = sin t from (1, 0): the steady part is -5 cos t, the rest decays.
  const AnyMotion<double> driven{[](double t, double q, double v) { return -q - 0.2 * v + std::sin(t); }};
  const double end = 20, w = std::sqrt(0.99);
  const double exact =
      -5 * std::cos(end) + std::exp(-0.1 * end) * (6 * std::cos(w * end) + 0.6 / w * std::sin(w * end));
  for (const double tolerance : {1e-3, 1e-5, 1e-7}) {
    const auto solution = solve(driven, X{1, 0}, {0.0, end}, Newmark{}, {.rtol = tolerance, .atol = tolerance});
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    EXPECT_NEAR(solution.final_state()[0], exact, 30 * tolerance * (1 + std::abs(exact)));
  }
}

TYPED_TEST(Structural, ACopyGoesOnToTheSameBits) {
  Integrator original(duffing(), X{1, 0.5}, {0.0, 30.0}, TypeParam{}, {.step = 0.05});
  for (int i = 0; i < 100; ++i) original.advance();
  Integrator copy = original;
  while (original.advance()) {
  }
  while (copy.advance()) {
  }
  EXPECT_EQ(original.x(), copy.x());
}

TYPED_TEST(Structural, RefusesWhatIsNoStructureByName) {
  struct Alone {
    void operator()(double, const std::array<double, 3>& x, std::array<double, 3>& out) const {
      out = {x[1], -x[0], -x[2]};
    }
    std::size_t pair_count(std::size_t) const { return 1; }
    PositionVelocity pair(std::size_t, std::size_t) const { return {0, 1}; }
  };
  const auto solution = solve(Alone{}, std::array{1.0, 0.0, 1.0}, {0.0, 1.0}, TypeParam{}, {.step = 0.1});
  EXPECT_EQ(solution.outcome.ending, Ending::invalid_input);
  EXPECT_NE(solution.outcome.hint.find("positions and velocities"), std::string::npos) << solution.outcome.hint;
}

TYPED_TEST(Structural, AForceThatIsNotANumberEndsTheRunByName) {
  const AnyMotion<double> broken{
      [](double t, double q, double) { return t < 1 ? -q : std::numeric_limits<double>::quiet_NaN(); }};
  const auto solution = solve(broken, X{1, 0}, {0.0, 2.0}, TypeParam{}, {.step = 0.1});
  EXPECT_EQ(solution.outcome.ending, Ending::not_finite) << describe(solution.outcome);
  EXPECT_LT(solution.outcome.t, 1.1);
}

}  // namespace
}  // namespace continuo::structural_dynamics_test
