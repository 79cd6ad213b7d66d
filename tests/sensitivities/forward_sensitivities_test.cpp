// Forward sensitivities of C++ systems: closed forms, every source of derivatives, and what is refused.
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tests/sensitivities/bouncing_ball.hpp>

#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/sensitivities/forward_sensitivities.hpp>

namespace continuo::forward_sensitivities_test {
namespace {

using testing::HasSubstr;

// x = x0 exp(-p t): dx/dp = -t x, dx/dx0 = x / x0. The tolerance of the run holds for S.
TEST(ForwardSensitivities, DecayAsInClosedForm) {
  const auto decay = [](const auto&, const auto& x, const auto& p) { return std::array{-p[0] * x[0]}; };
  const SensitivityOptions<std::array<double, 1>> options{
      .run = {.rtol = 1e-10, .atol = 1e-12, .save = save_at({0.5, 2.0})}, .by_initial_values = true};
  const auto run = forward_sensitivities(decay, std::array{3.0}, std::array{0.7}, {0, 2}, Rodas5P{}, options);
  ASSERT_TRUE(run.status) << describe(run.status);
  ASSERT_EQ(run.rows(), 2U);
  for (std::size_t r = 0; r < 2; ++r) {
    const double x = 3 * std::exp(-0.7 * run.time(r));
    EXPECT_NEAR(run.value(r, 0), x, 1e-9);
    EXPECT_NEAR(run.sensitivity(r, 0, 0), -run.time(r) * x, 1e-9);
    EXPECT_NEAR(run.sensitivity(r, 0, 1), x / 3, 1e-9);
  }
}

// Between impacts the motion is a parabola, which the method follows exactly: what remains is rounding and the location
// of the impacts, some 1e-15 of the time.
TEST(ForwardSensitivities, BouncingBallAsInClosedForm) {
  const auto exact = bouncing_ball::after_two_impacts(9.81, 0.8, 1, 1.5);
  const auto run =
      forward_sensitivities(bouncing_ball::fall, std::array{1.0, 0.0}, std::array{9.81, 0.8}, {0, 1.5}, Dop853{},
                            {.run = {.rtol = 1e-10}, .by_initial_values = true}, bouncing_ball::floor());
  ASSERT_TRUE(run.status) << describe(run.status);
  EXPECT_NEAR(run.final_value(0), exact.x, 1e-12);
  EXPECT_NEAR(run.final_sensitivity(0, 0), exact.by_g, 1e-12);
  EXPECT_NEAR(run.final_sensitivity(0, 1), exact.by_e, 1e-12);
  EXPECT_NEAR(run.final_sensitivity(0, 2), exact.by_h, 1e-12);
  // t2 = t1 (1 + 2 e)
  ASSERT_EQ(run.events.size(), 2U);
  EXPECT_NEAR(run.events[0].moves[1], 0, 1e-14);
  EXPECT_NEAR(run.events[1].moves[1], 2 * std::sqrt(2 / 9.81), 1e-13);
}

using X = std::array<double, 2>;
using P = std::array<double, 3>;
/// Michaelis and Menten's rate with a forcing, with p as its parameters.
struct Traceable {
  template <class T, class S, class Q>
  void operator()(const T& t, const S& x, const Q& p, S& dxdt) const {
    using std::sin;
    dxdt[0] = -p[0] * x[0] / (p[1] + x[0]) + p[2] * sin(t);
    dxdt[1] = p[0] * x[0] / (p[1] + x[0]) - x[1];
  }
};
struct Plain {
  void operator()(double t, const X& x, const P& p, X& dxdt) const { Traceable{}(t, x, p, dxdt); }
};
struct WithMembers : Plain {
  void jacobian(double, const X& x, const P& p, std::span<double> rows) const {
    const double slope = p[0] * p[1] / ((p[1] + x[0]) * (p[1] + x[0]));
    rows[0] = -slope, rows[2] = slope, rows[3] = -1;
  }
  void parameter_jacobian(double t, const X& x, const P& p, std::span<double> rows) const {
    const double below = p[1] + x[0];
    rows[0] = -x[0] / below, rows[1] = p[0] * x[0] / (below * below), rows[2] = std::sin(t);
    rows[3] = -rows[0], rows[4] = -rows[1];
  }
};
struct WithProducts : Plain {
  void vector_jacobian(double, const X& x, const P& p, const X& lambda, X& product) const {
    const double slope = p[0] * p[1] / ((p[1] + x[0]) * (p[1] + x[0]));
    product = {slope * (lambda[1] - lambda[0]), -lambda[1]};
  }
  void vector_parameter_jacobian(double t, const X& x, const P& p, const X& lambda, P& product) const {
    const double below = p[1] + x[0], all = lambda[1] - lambda[0];
    product = {all * x[0] / below, -all * p[0] * x[0] / (below * below), lambda[0] * std::sin(t)};
  }
};

template <class F>
std::vector<double> final_sensitivities() {
  const auto run = forward_sensitivities(F{}, X{1.5, 0.2}, P{1.1, 0.6, 0.3}, {0, 4}, Dop853{},
                                         {.run = {.rtol = 1e-11, .atol = 1e-13}, .by_initial_values = true});
  EXPECT_TRUE(run.status) << describe(run.status);
  return run.run.final_state();
}

// All describe the same S' exactly but for the differences, whose error of some 3e-13 of f the motion does not magnify.
TEST(ForwardSensitivities, AllSourcesOfDerivativesAgree) {
  const std::vector<double> traced = final_sensitivities<Traceable>();
  for (const auto& other :
       {final_sensitivities<Plain>(), final_sensitivities<WithMembers>(), final_sensitivities<WithProducts>()}) {
    ASSERT_EQ(other.size(), traced.size());
    for (std::size_t i = 0; i < traced.size(); ++i) EXPECT_NEAR(other[i], traced[i], 1e-10) << i;
  }
}

// A sign instead of a distance: the event is located, but how its time moves is not known.
TEST(ForwardSensitivities, AnEventWhoseGuardJumpsHasNoDerivative) {
  const auto still = [](const auto&, const auto& x, const auto& p, auto& dxdt) { dxdt[0] = 0.0 * p[0] * x[0]; };
  const auto jump = rises(
      "jump",
      [](const auto& t, const auto&, const auto& p) {
        const auto late = t - 0.25 * p[0];
        return late < 0 ? late * 0.0 - 1.0 : late * 0.0 + 1.0;
      },
      [](auto& now) { now.x[0] = 1.0 + now.before[0]; });
  const auto run = forward_sensitivities(still, std::array{1.0}, std::array{2.0}, {0, 1}, Dop853{}, {}, jump);
  EXPECT_EQ(run.status.ending, Ending::cannot_continue);
  EXPECT_THAT(run.status.message, HasSubstr("`jump` jumps across its threshold"));
}

TEST(ForwardSensitivities, InputThatCannotBeMeantIsRefused) {
  const auto decay = [](const auto&, const auto& x, const auto& p, auto& dxdt) { dxdt[0] = -p[0] * x[0]; };
  using Y = std::array<double, 1>;
  const auto refusal = [&](const SensitivityOptions<Y>& options) {
    const auto run = forward_sensitivities(decay, Y{1.0}, Y{2.0}, {0, 1}, Dop853{}, options);
    EXPECT_EQ(run.status.ending, Ending::invalid_input);
    return run.status.message;
  };
  EXPECT_THAT(refusal({.run = {.events = {falls<Y>("a", [](double, const Y& x) { return x[0]; })}}}),
              HasSubstr("follow its options as arguments"));
  EXPECT_THAT(refusal({.run = {.save = Save<Y>::every_step([](double, const Y&) {})}}), HasSubstr("callback"));
  EXPECT_THAT(refusal({.run = {.rtol = -1}}), HasSubstr("rtol"));
  EXPECT_THAT(refusal({.run = {.projection = [](double, Y&) {}}}), HasSubstr("neither a projection nor signs"));
  EXPECT_THAT(refusal({.run = {.signs = {Sign::positive}}}), HasSubstr("neither a projection nor signs"));
  EXPECT_THAT(refusal({.initial_by_parameters = {1, 2}}), HasSubstr("initial_by_parameters has 2 numbers"));
  EXPECT_THAT(refusal({.parameter_sizes = {0}}), HasSubstr("size of a parameter"));
  EXPECT_THAT(refusal({.parameter_sizes = {1, 1}}), HasSubstr("parameter_sizes has 2 numbers"));
}

}  // namespace
}  // namespace continuo::forward_sensitivities_test
