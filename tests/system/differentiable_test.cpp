// The Jacobians by dual numbers, by hand and by differences agree.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <bench/problems/brusselator_line.hpp>
#include <bench/problems/hires.hpp>
#include <bench/problems/robertson.hpp>
#include <bench/problems/van_der_pol.hpp>
#include <gtest/gtest.h>

#include <continuo/system/differentiable.hpp>
#include <continuo/system/jacobian.hpp>

namespace continuo::differentiable_test {
namespace {

/// A state near x, without special values in its components.
template <class X>
X moved(X x) {
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = x[i] * 1.25 + 0.01 * static_cast<double>(i + 1);
  return x;
}

template <class X>
std::vector<Scalar<X>> by_differences(auto f, const X& x) {
  X fx = x, scratch = x, slope = x;
  evaluate(f, 0.5, x, fx);
  std::vector<Scalar<X>> rows(x.size() * x.size());
  evaluate_jacobian(f, 0.5, x, fx, scratch, slope, [](std::size_t) { return 1e-9; }, std::span(rows));
  return rows;
}

/// Dual numbers agree with the Jacobian written by hand to some tens of roundings of the greatest entry of a row.
/// Differences: the increment is 1.5e-8 of a component, and so is the error of a quadratic f relative to its greatest
/// entry; the bound of 1e-5 allows for a component that is small in its row.
template <class Problem>
void expect_agreement(const Problem& problem) {
  const auto x = moved(problem.start());
  using X = std::remove_const_t<decltype(x)>;
  const std::size_t n = x.size();
  auto f = differentiable(problem);
  static_assert(HasJacobian<decltype(f), X>);
  std::vector<double> hand(n * n), dual(n * n);
  problem.jacobian(0.5, x, std::span(hand));
  f.jacobian(0.5, x, std::span(dual));
  const auto only_f = [&problem](double t, const X& at, X& dxdt) { problem(t, at, dxdt); };
  const auto differences = by_differences(only_f, x);
  for (std::size_t i = 0; i < n; ++i) {
    double greatest = 0;
    for (std::size_t j = 0; j < n; ++j) greatest = std::max(greatest, std::abs(hand[i * n + j]));
    for (std::size_t j = 0; j < n; ++j) {
      EXPECT_NEAR(dual[i * n + j], hand[i * n + j], 1e-14 * greatest) << Problem::name << ' ' << i << ' ' << j;
      EXPECT_NEAR(differences[i * n + j], hand[i * n + j], 1e-5 * greatest) << Problem::name << ' ' << i << ' ' << j;
    }
  }
}

TEST(Differentiable, JacobiansByDualsByHandAndByDifferencesAgree) {
  expect_agreement(bench::Robertson<>{});
  expect_agreement(bench::VanDerPol<>{});
  expect_agreement(bench::Hires<>{});
  expect_agreement(bench::BrusselatorLine<>{.points = 7});   // 14 columns: a full chunk and a part of one
  expect_agreement(bench::BrusselatorLine<>{.points = 12});  // three full ones
}

TEST(Differentiable, WritesTheEntriesOfAPatternByGroupsOfColumns) {
  struct WithPattern : bench::BrusselatorLine<> {
    SparsePattern pattern;
    const SparsePattern& jacobian_pattern() const { return pattern; }
  };
  WithPattern problem{bench::BrusselatorLine<>{.points = 20}, {}};
  const auto x = moved(problem.start());
  std::vector<MatrixPlace> places;
  problem.jacobian_entries(x, [&](std::size_t i, std::size_t j, double) {
    places.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)});
  });
  problem.pattern = SparsePattern(x.size(), places);
  auto f = differentiable(problem);
  static_assert(HasSparseJacobian<decltype(f), std::vector<double>>);
  std::vector<double> values(problem.pattern.entries());
  f.jacobian_values(0.0, x, std::span(values));
  problem.jacobian_entries(x, [&](std::size_t i, std::size_t j, double value) {
    EXPECT_NEAR(values[problem.pattern.find(i, j)], value, 1e-14 * 900) << i << ' ' << j;  // diffusion is 8.8
  });
}

// d/dx and d/dt of x1 exp(t), t x0^2 - sin(x1) by hand.
TEST(Differentiable, TakesLambdasThatReturnOrWriteOfAnyScalar) {
  auto returns =
      differentiable([](auto t, const auto& x) { return std::array{x[1] * exp(t), t * x[0] * x[0] - sin(x[1])}; });
  auto writes = differentiable<long double>([](auto t, const auto& x, auto& dxdt) {
    dxdt[0] = x[1] * exp(t);
    dxdt[1] = t * x[0] * x[0] - sin(x[1]);
  });
  const auto check = [](auto& f, const auto& x) {
    using X = std::remove_cvref_t<decltype(x)>;
    using Real = Scalar<X>;
    static_assert(HasJacobian<decltype(f), X> && HasTimeDerivative<decltype(f), X>);
    const Real t = Real(3) / 4;
    std::vector<Real> rows(4);
    X dfdt = x;
    f.jacobian(t, x, std::span(rows));
    f.time_derivative(t, x, dfdt);
    const std::array<Real, 6> expected{0, std::exp(t), 2 * t * x[0], -std::cos(x[1]), x[1] * std::exp(t), x[0] * x[0]};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(static_cast<double>(rows[i] - expected[i]), 0, 1e-15) << i;
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(static_cast<double>(dfdt[i] - expected[4 + i]), 0, 1e-15) << i;
  };
  check(returns, std::array{0.5, 0.25});
  check(returns, std::array{0.5L, 0.25L});
  check(writes, std::vector{0.5L, 0.25L});
}

struct Pendulum {
  template <class X>
  void operator()(double, const X& x, X& dxdt) const {  // a plain t: no df/dt by duals, but a Jacobian
    dxdt[0] = x[1];
    dxdt[1] = -sin(x[0]);
  }
  std::string_view component_name(std::size_t i) const { return i == 0 ? "angle" : "rate"; }
  double mass(std::size_t i) const { return i == 0 ? 1 : 2; }
};

TEST(Differentiable, KeepsWhatTheSystemSaysOfItself) {
  using X = std::array<double, 2>;
  auto f = differentiable(Pendulum{});
  static_assert(Named<decltype(f)> && HasMassDiagonal<decltype(f), X> && HasJacobian<decltype(f), X>);
  static_assert(!HasTimeDerivative<decltype(f), X> && RightHandSide<decltype(f), X>);
  std::array<double, 4> rows{};
  f.jacobian(0.0, X{0, 3}, std::span<double>(rows));
  EXPECT_EQ(rows, (std::array{0.0, 1.0, -1.0, 0.0}));  // cos 0 = 1
}

}  // namespace
}  // namespace continuo::differentiable_test
