// The discrete adjoint is the derivative of the numerical solution, through events too, and costs a few runs.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <ceres/jet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tests/sensitivities/bouncing_ball.hpp>

#include <continuo/methods/dirk/kvaerno5.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/sensitivities/adjoint.hpp>

namespace continuo::adjoint_test {
namespace {

using std::cos, std::sin, testing::HasSubstr;

/// A smooth system with random coefficients, by three components and four parameters.
struct RandomSystem {
  std::array<double, 18> w;

  explicit RandomSystem(std::mt19937& random) {
    for (double& one : w) one = std::uniform_real_distribution<double>(-1, 1)(random);
  }
  template <class T, class S, class Q>
  void operator()(const T& t, const S& x, const Q& p, S& dxdt) const {
    using std::exp;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto &next = x[(i + 1) % 3], &last = x[(i + 2) % 3];
      dxdt[i] = w[i] * sin(p[0] * next + w[3 + i] * t) - 0.3 * p[1] * x[i] * x[i] * x[i] +
                w[6 + i] * p[2] * last / (1.0 + x[i] * x[i]) + w[9 + i] * exp(-p[3] * p[3] * t) * cos(w[12 + i] * t) +
                w[15 + i] * p[1] * x[0];
    }
  }
};
using X = std::array<double, 3>;
using P = std::array<double, 4>;
constexpr X x0{0.4, -0.7, 0.2};
constexpr P p{1.3, 0.8, -0.6, 0.5};
constexpr auto objective = [](const auto&, const auto& x, const auto& q) { return x[0] * x[1] + sin(x[2]) * q[0]; };

/// The derivatives by x0, then by p.
template <class G>
std::vector<double> all_of(const G& gradient) {
  std::vector<double> all(gradient.by_initial_values.begin(), gradient.by_initial_values.end());
  all.insert(all.end(), gradient.by_parameters.begin(), gradient.by_parameters.end());
  return all;
}
void expect_near(const std::vector<double>& found, const std::vector<double>& expected, double relative) {
  double greatest = 0;
  for (const double one : expected) greatest = std::max(greatest, std::abs(one));
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], relative * greatest) << k;
}

/// The same steps with dual numbers as the state: forward differentiation of the method itself.
template <class M>
std::vector<double> by_dual_steps(const RandomSystem& system, double h, std::size_t steps) {
  using Dual = ceres::Jet<double, 7>;
  std::array<Dual, 3> x, x_new;
  std::array<Dual, 4> q;
  for (std::size_t i = 0; i < 3; ++i) x[i] = Dual(x0[i], static_cast<int>(i));
  for (std::size_t k = 0; k < 4; ++k) q[k] = Dual(p[k], static_cast<int>(3 + k));
  const auto f = [&](const Dual& t, const std::array<Dual, 3>& at, std::array<Dual, 3>& dxdt) {
    system(t, at, q, dxdt);
  };
  auto work = M::workspace(x);
  for (std::size_t s = 0; s < steps; ++s) {
    M::step(f, Dual(static_cast<double>(s) * h), x, Dual(h), s == 0, work, x_new);
    M::accept(work);
    x = x_new;
  }
  const Dual value = objective(Dual(), x, q);
  return {value.v.data(), value.v.data() + 7};
}

// Both are exact derivatives of the same sums: they differ by rounding, some hundred of them in ten steps.
template <class M>
void expect_derivative_of_steps() {
  std::mt19937 random(7);
  for (int round = 0; round < 3; ++round) {
    const RandomSystem system(random);
    const auto run = solve_for_adjoint(system, x0, p, {0, 2}, M{}, {.step = 0.25});
    const auto gradient = run.gradient(AtEnd{objective});
    ASSERT_TRUE(gradient.status) << describe(gradient.status);
    expect_near(all_of(gradient), by_dual_steps<M>(system, 0.25, 8), 1e-13);
  }
}
TEST(Adjoint, IsTheDerivativeOfExplicitStepsToRounding) {
  expect_derivative_of_steps<Rk4>();
  expect_derivative_of_steps<Dop853>();
}

// The referee: central differences of order 4 of fixed steps in long double. With d = 1e-3 they leave d^4 / 30 = 3e-14
// times a fifth derivative of up to some thousands of the first.
TEST(Adjoint, IsTheDerivativeOfImplicitSteps) {
  using R = long double;
  std::mt19937 random(7);
  const RandomSystem system(random);
  const auto value = [&](std::size_t moved, R by) {
    std::array<R, 3> x;
    std::array<R, 4> q;
    std::copy(x0.begin(), x0.end(), x.begin());
    std::copy(p.begin(), p.end(), q.begin());
    (moved < 3 ? x[moved] : q[moved - 3]) += by;
    const auto f = [&](R t, const std::array<R, 3>& at, std::array<R, 3>& dxdt) { system(t, at, q, dxdt); };
    const auto end = solve(f, x, {0, 2}, Kvaerno5{}, {.rtol = 1e-13L, .atol = 1e-15L, .step = 0.125L});
    EXPECT_TRUE(end.outcome);
    return objective(R(2), end.final_state(), q);
  };
  std::vector<double> expected;
  for (std::size_t k = 0; k < 7; ++k) {
    const R d = 1e-3L;
    expected.push_back(
        static_cast<double>((8 * (value(k, d) - value(k, -d)) - (value(k, 2 * d) - value(k, -2 * d))) / (12 * d)));
  }
  const auto run = solve_for_adjoint(system, x0, p, {0, 2}, Kvaerno5{}, {.rtol = 1e-12, .step = 0.125});
  const auto gradient = run.gradient(AtEnd{objective});
  ASSERT_TRUE(gradient.status) << describe(gradient.status);
  expect_near(all_of(gradient), expected, 1e-9);
}

// As of ForwardSensitivities.BouncingBallAsInClosedForm. Of implicit methods the steps end at the impacts, of explicit
// ones these lie on the interpolant: the derivatives of both are those of a parabola.
template <class M>
void expect_bouncing_ball() {
  const auto exact = bouncing_ball::after_two_impacts(9.81, 0.8, 1, 1.5);
  const auto run = solve_for_adjoint(bouncing_ball::fall, std::array{1.0, 0.0}, std::array{9.81, 0.8}, {0, 1.5}, M{},
                                     {.rtol = 1e-8}, bouncing_ball::floor());
  const auto gradient = run.gradient(AtEnd{[](const auto&, const auto& x, const auto&) { return x[0]; }});
  ASSERT_TRUE(gradient.status) << describe(gradient.status);
  EXPECT_NEAR(gradient.value, exact.x, 1e-11);
  EXPECT_NEAR(gradient.by_parameters[0], exact.by_g, 1e-11);
  EXPECT_NEAR(gradient.by_parameters[1], exact.by_e, 1e-11);
  EXPECT_NEAR(gradient.by_initial_values[0], exact.by_h, 1e-11);
}
TEST(Adjoint, BouncingBallAsInClosedForm) {
  expect_bouncing_ball<Dop853>();
  expect_bouncing_ball<Kvaerno5>();
}

// A ball that falls from rest is stopped by the floor at t = sqrt(2 h / g): the end of the run moves. The integral of
// its height is 2/3 h t, by h it changes as h^(3/2).
TEST(Adjoint, TheEndOfARunMovesWithTheEventThatStopsIt) {
  auto stop = falls("floor", [](const auto&, const auto& x) { return x[0]; });
  stop.stop_after = 1;
  const double h = 1.7, g = 9.81, t = std::sqrt(2 * h / g);
  const auto run = solve_for_adjoint(bouncing_ball::fall, std::array{h, 0.0}, std::array{g, 0.0}, {0, 9}, Dop853{},
                                     {.rtol = 1e-8}, stop);
  const auto time = run.gradient(AtEnd{[](const auto& end, const auto&, const auto&) { return end; }});
  EXPECT_NEAR(time.value, t, 1e-13);
  EXPECT_NEAR(time.by_initial_values[0], t / (2 * h), 1e-12);
  EXPECT_NEAR(time.by_parameters[0], -t / (2 * g), 1e-12);
  const auto area = run.gradient(Integral{[](const auto&, const auto& x, const auto&) { return x[0]; }});
  EXPECT_NEAR(area.value, 2 * h * t / 3, 1e-12);
  EXPECT_NEAR(area.by_initial_values[0], h > 0 ? t : 0, 1e-12);
  EXPECT_NEAR(area.by_parameters[0], -h * t / (3 * g), 1e-12);
}

// Guards and actions that depend on t, x and p, at given times too; strict runs of both, which differ by their errors
// of some 1e-12, magnified by the sensitivities.
TEST(Adjoint, AgreesWithForwardSensitivitiesThroughRandomEvents) {
  std::mt19937 random(100);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int round = 0; round < 4; ++round) {
    const RandomSystem system(random);
    std::array<double, 6> w;
    for (double& one : w) one = any(random);
    const auto wall = crosses(
        "wall",
        [w](const auto& t, const auto& x, const auto& q) { return x[0] - 0.3 * w[0] * q[0] - 0.2 * sin(w[1] * t); },
        [w](auto& now) {
          now.x[0] = now.before[0] + 0.5 * w[0] * now.p[2];
          now.x[1] = -now.p[1] * w[2] * now.before[1] + 0.3 * w[3] * now.t;
          now.x[2] = now.before[2] + now.p[3] * now.before[0] * now.before[0];
        });
    const auto kick = at("kick", {0.77, 1.9}, [w](auto& now) { now.x[0] = now.before[0] * now.p[1] + w[5]; });
    const auto note = falls("note", [](const auto&, const auto& x) { return x[2]; });
    const auto forward =
        forward_sensitivities(system, x0, p, {0, 2.5}, Dop853{},
                              {.run = {.rtol = 1e-12, .atol = 1e-13}, .by_initial_values = true}, wall, kick, note);
    ASSERT_TRUE(forward.status) << describe(forward.status);
    ASSERT_LT(forward.events.size(), 20U) << "a round that chatters says nothing";
    std::vector<double> expected(7);
    const double slopes[3] = {forward.final_value(1), forward.final_value(0), p[0] * std::cos(forward.final_value(2))};
    for (std::size_t k = 0; k < 7; ++k)
      for (std::size_t i = 0; i < 3; ++i)
        expected[k] += slopes[i] * forward.final_sensitivity(i, k < 3 ? 4 + k : k - 3);
    expected[3] += std::sin(forward.final_value(2));
    const auto run =
        solve_for_adjoint(system, x0, p, {0, 2.5}, Dop853{}, {.rtol = 1e-12, .atol = 1e-13}, wall, kick, note);
    const auto gradient = run.gradient(AtEnd{objective});
    ASSERT_TRUE(gradient.status) << describe(gradient.status);
    expect_near(all_of(gradient), expected, 1e-9);
  }
}

// An action that carries other guards across, whose events move as it does; and a guard that is crossed at the same
// instant as another, by the motion, which moves by itself.
TEST(Adjoint, EventsOfOneInstantMoveWithWhatSetsThemOff) {
  const auto f = [](const auto& t, const auto& x, const auto& q, auto& dxdt) {
    dxdt[0] = q[0] + 0.1 * x[1];
    dxdt[1] = -x[1] * q[1] + 0.2 * t;
  };
  const auto first = rises(
      "first", [](const auto&, const auto& x, const auto& q) { return x[0] - q[2]; },
      [](auto& now) { now.x[1] = now.before[1] + 3.0 * now.p[1] + now.t; });
  const auto twin = rises(
      "twin", [](const auto&, const auto& x, const auto& q) { return 2.0 * (x[0] - q[2]); },
      [](auto& now) { now.x[1] = 0.5 * now.before[1] * now.p[0] + now.t; });
  const auto set_off = rises(
      "set off", [](const auto&, const auto& x) { return x[1] - 2.0; },
      [](auto& now) {
        now.x[0] = now.before[0] - 4.0 * now.p[0] * now.t;
        now.x[1] = 0.3 * now.before[1] * now.p[2];
      });
  const std::array start{0.0, 1.0};
  const std::array q{1.0, 0.7, 0.8};
  const auto compare = [&](const auto&... events) {
    const auto forward = forward_sensitivities(
        f, start, q, {0, 2}, Dop853{}, {.run = {.rtol = 1e-11, .atol = 1e-12}, .by_initial_values = true}, events...);
    ASSERT_TRUE(forward.status) << describe(forward.status);
    ASSERT_EQ(forward.events.size(), 2U);
    EXPECT_EQ(forward.events[0].t, forward.events[1].t);
    const auto run = solve_for_adjoint(f, start, q, {0, 2}, Dop853{}, {.rtol = 1e-11, .atol = 1e-12}, events...);
    const auto gradient = run.gradient(AtEnd{[](const auto&, const auto& x, const auto&) { return x[0]; }});
    ASSERT_TRUE(gradient.status) << describe(gradient.status);
    std::vector<double> expected;
    for (std::size_t k = 0; k < 5; ++k) expected.push_back(forward.final_sensitivity(0, k < 2 ? 3 + k : k - 2));
    expect_near(all_of(gradient), expected, 1e-9);
  };
  compare(first, set_off);
  compare(first, twin);
}

// Lotka's and Volterra's equations: an objective of all kinds of terms, against the forward sensitivities of the same
// terms, of which the integral is a component of the state; and the cost in evaluations and products.
TEST(Adjoint, SumsAndIntegralsAgreeWithForwardSensitivitiesAndCostFewRuns) {
  const auto prey = [](const auto&, const auto& x, const auto& q, auto& dxdt) {
    dxdt[0] = q[0] * x[0] - q[1] * x[0] * x[1];
    dxdt[1] = -q[2] * x[1] + q[3] * x[0] * x[1];
    if (x.size() == 3) dxdt[2] = q[0] * x[1] * x[1];
  };
  const P q{1.5, 1.0, 3.0, 1.0};
  const std::vector<double> times{1.0, 2.5, 7.0}, start{1.0, 1.0};
  auto saved = times;
  saved.push_back(8.0);
  const auto forward =
      forward_sensitivities(prey, std::vector<double>{1.0, 1.0, 0.0}, q, {0, 8}, Dop853{},
                            {.run = {.rtol = 1e-12, .atol = 1e-13, .save = save_at(saved)}, .by_initial_values = true});
  const auto run =
      solve_for_adjoint(prey, start, q, {0, 8}, Tsitouras5{}, {.rtol = 1e-12, .atol = 1e-13, .save = save_at(times)});
  ASSERT_EQ(run.solution.t, times);
  const auto gradient = run.gradient(
      AtTimes{[](std::size_t j, const auto&, const auto& x, const auto&) { return (x[0] - 1.0) * (1.0 + double(j)); }},
      Integral{[](const auto&, const auto& x, const auto& r) { return r[0] * x[1] * x[1]; }},
      AtEnd{[](const auto&, const auto& x, const auto&) { return x[1]; }});
  ASSERT_TRUE(gradient.status) << describe(gradient.status);
  std::vector<double> expected(6);
  for (std::size_t k = 0; k < 6; ++k) {
    const std::size_t column = k < 2 ? 4 + k : k - 2;
    expected[k] = forward.sensitivity(3, 2, column) + forward.sensitivity(3, 1, column);
    for (std::size_t j = 0; j < 3; ++j) expected[k] += forward.sensitivity(j, 0, column) * double(1 + j);
  }
  expect_near(all_of(gradient), expected, 1e-9);
  EXPECT_LT(std::abs(gradient.error_of_integral), 1e-6 * gradient.value);
  EXPECT_LE(run.costs.evaluations + gradient.costs.evaluations + gradient.costs.vector_jacobian_products,
            5 * run.costs.evaluations);
}

// A hundred parameters cost no more: the gradient is that of a hundred columns of S.
TEST(Adjoint, AHundredParametersCostAsMuchAsOne) {
  using Q = std::vector<double>;
  const auto series = [](const auto& t, const auto& x, const auto& q, auto& dxdt) {
    dxdt[0] = x[1] + 0.0 * t;
    dxdt[1] = 0.0 * x[0];
    for (std::size_t k = 0; k < 100; ++k) dxdt[1] += q[k] * cos(double(k) * 0.05 * x[0]);
  };
  Q q(100);
  for (std::size_t k = 0; k < 100; ++k) q[k] = (k % 2 == 0 ? 0.2 : -0.2) / double(1 + k);
  const std::array start{0.3, 0.1};
  const auto run = solve_for_adjoint(series, start, q, {0, 2}, Dop853{}, {.rtol = 1e-11, .atol = 1e-13});
  const auto gradient = run.gradient(AtEnd{[](const auto&, const auto& x, const auto&) { return x[0]; }});
  const auto forward =
      forward_sensitivities(series, start, q, {0, 2}, Dop853{}, {.run = {.rtol = 1e-11, .atol = 1e-13}});
  std::vector<double> expected;
  for (std::size_t k = 0; k < 100; ++k) expected.push_back(forward.final_sensitivity(0, k));
  expect_near(gradient.by_parameters, expected, 1e-9);
  EXPECT_LE(run.costs.evaluations + gradient.costs.evaluations + gradient.costs.vector_jacobian_products,
            5 * run.costs.evaluations);
}

TEST(Adjoint, WhatCannotBeMeantIsRefused) {
  const auto decay = [](const auto&, const auto& x, const auto& q, auto& dxdt) { dxdt[0] = -q[0] * x[0]; };
  using Y = std::array<double, 1>;
  const auto refusal = [&](const Options<Y>& options) {
    return solve_for_adjoint(decay, Y{1.0}, Y{2.0}, {0, 1}, Rk4{}, options).status.message;
  };
  EXPECT_THAT(refusal({}), HasSubstr("give it a step"));
  EXPECT_THAT(refusal({.step = 0.1, .save = save_dense()}), HasSubstr("keeps its steps"));
  EXPECT_THAT(refusal({.step = 0.1, .projection = [](double, Y&) {}}), HasSubstr("neither a projection nor signs"));
  EXPECT_THAT(refusal({.step = 0.1, .save = save_at({3.0})}), HasSubstr("lies outside of the run"));
  const auto run = solve_for_adjoint(decay, Y{1.0}, Y{2.0}, {0, 1}, Rk4{}, {.step = 0.1});
  const auto gradient =
      run.gradient(AtTimes{[](std::size_t, const auto&, const auto& x, const auto&) { return x[0]; }});
  EXPECT_THAT(gradient.status.message, HasSubstr("the run saves none"));
}

}  // namespace
}  // namespace continuo::adjoint_test
