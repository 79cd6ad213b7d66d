// Norms and step size controllers of one's own: what they change, and that what is none is not accepted in silence.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/with_controller.hpp>
#include <continuo/methods/with_norm.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::with_norm_test {
namespace {

using V = std::vector<double>;
constexpr std::size_t size = 1000;

// One oscillator of two components among components at rest.
struct Oscillator {
  void operator()(double, const V& x, V& dxdt) const {
    std::ranges::fill(dxdt, 0.0);
    dxdt[0] = x[1];
    dxdt[1] = -x[0];
  }
};
V start() {
  V x(size, 0);
  x[0] = 1;
  return x;
}
double error_of(const Solution<V>& solution) {
  return std::hypot(solution.final_state()[0] - std::cos(10), solution.final_state()[1] + std::sin(10));
}

// The root of the sum of squares is sqrt(n) times the root mean square: a run with it has the steps of one with
// tolerances that are sqrt(n) times as strict.
struct EuclideanNorm {
  double operator()(std::span<const double> errors) const {
    double sum = 0;
    for (const double error : errors) sum += error * error;
    return std::sqrt(sum);
  }
};
TEST(WithNorm, TheSumOfSquaresIsTheMeanAtAToleranceStricterByTheRootOfN) {
  const double strict = 1e-6 / std::sqrt(static_cast<double>(size));
  const auto plain =
      solve(Oscillator{}, start(), {0, 10}, Tsitouras5{}, {.rtol = 0, .atol = strict, .first_step = 1e-2});
  const auto normed = solve(Oscillator{}, start(), {0, 10}, with_norm(Tsitouras5{}, EuclideanNorm{}),
                            {.rtol = 0, .atol = 1e-6, .first_step = 1e-2});
  EXPECT_EQ(normed.statistics.evaluations, plain.statistics.evaluations);
  EXPECT_NEAR(normed.final_state()[0], plain.final_state()[0], 1e-12);
}

TEST(WithNorm, OneActiveComponentAmongManyIsHeldToItsTolerance) {
  const Options<V> options{.rtol = 0, .atol = 1e-6};
  const auto check = [&](auto method) {
    const auto plain = solve(Oscillator{}, start(), {0, 10}, method, options);
    const auto normed = solve(Oscillator{}, start(), {0, 10}, with_norm(method, MaximumNorm{}), options);
    ASSERT_TRUE(normed.outcome) << describe(normed.outcome);
    EXPECT_LT(error_of(normed), 1e-4);
    EXPECT_GT(error_of(plain), 6 * error_of(normed));
  };
  check(Tsitouras5{});
}

// Of an array of two components, so that Newton's matrix is small: the greatest is at most sqrt(2) times the mean.
using X = std::array<double, 2>;
struct Small {
  void operator()(double, const X& x, X& dxdt) const { dxdt = {x[1], -x[0]}; }
};
TEST(WithNorm, AMethodOfVariableOrderFollows) {
  const Options<X> options{.rtol = 1e-7, .atol_each = {1e-8, 1e-8}};
  const auto plain = solve(Small{}, X{1, 0}, {0, 10}, Bdf{}, options);
  const auto normed = solve(Small{}, X{1, 0}, {0, 10}, with_norm(Bdf{}, MaximumNorm{}), options);
  ASSERT_TRUE(normed.outcome) << describe(normed.outcome);
  EXPECT_NEAR(normed.final_state()[0], std::cos(10), 1e-5);
  EXPECT_GE(normed.statistics.steps + 5, plain.statistics.steps);
  EXPECT_LT(normed.statistics.steps, 2 * plain.statistics.steps);
}

// Of the second component alone: x' = 1 costs nothing, whatever happens to the first.
struct SecondAlone {
  double operator()(std::span<const double> errors) const { return std::abs(errors[1]); }
};
TEST(WithNorm, ComponentsMayBeLeftOut) {
  struct Pair {
    void operator()(double t, const X&, X& dxdt) const { dxdt = {50 * std::cos(50 * t), 1}; }
  };
  const Options<X> options{.rtol = 1e-8, .first_step = 1};
  const auto all = solve(Pair{}, X{0, 0}, {0, 10}, with_norm(Tsitouras5{}, MaximumNorm{}), options);
  const auto second = solve(Pair{}, X{0, 0}, {0, 10}, with_norm(Tsitouras5{}, SecondAlone{}), options);
  EXPECT_GT(all.statistics.steps, 500U);
  EXPECT_LT(second.statistics.steps, 5U);
  EXPECT_NEAR(second.final_state()[1], 10, 1e-13);
}

template <int which>
struct NoNorm {
  double operator()(std::span<const double>) const {
    return which == 0   ? -1
           : which == 1 ? std::numeric_limits<double>::quiet_NaN()
                        : std::numeric_limits<double>::infinity();
  }
};
TEST(WithNorm, WhatIsNoNormIsNotAcceptedInSilence) {
  const auto refused = [](const auto& solution) {
    EXPECT_EQ(solution.outcome.ending, Ending::invalid_input);
    EXPECT_NE(solution.outcome.hint.find("it is no norm"), std::string::npos) << solution.outcome.hint;
  };
  refused(solve(Small{}, X{1, 0}, {0, 10}, with_norm(Tsitouras5{}, NoNorm<0>{}), {}));
  refused(solve(Small{}, X{1, 0}, {0, 10}, with_norm(Tsitouras5{}, NoNorm<1>{}), {}));
  refused(solve(Small{}, X{1, 0}, {0, 10}, with_norm(Tsitouras5{}, NoNorm<2>{}), {}));
  const auto fixed = solve(Small{}, X{1, 0}, {0, 10}, with_norm(Tsitouras5{}, MaximumNorm{}), {.step = 0.1});
  EXPECT_EQ(fixed.outcome.ending, Ending::invalid_input);
}

// B. van der Pol's oscillator changes its pace by a factor of a thousand, twice in each turn.
struct VanDerPol {
  void operator()(double, const X& x, X& dxdt) const { dxdt = {x[1], 20 * (1 - x[0] * x[0]) * x[1] - x[0]}; }
};
TEST(WithController, AFilterRejectsFewerSteps) {
  const Options<X> options{.rtol = 1e-7, .atol = 1e-7};
  const auto deadbeat = solve(VanDerPol{}, X{2, 0}, {0, 100}, with_controller(Tsitouras5{}, Deadbeat{}), options);
  const auto filter = solve(VanDerPol{}, X{2, 0}, {0, 100}, with_controller(Tsitouras5{}, H211b{}), options);
  const auto again = solve(VanDerPol{}, X{2, 0}, {0, 100}, with_controller(Tsitouras5{}, H211b{}), options);
  ASSERT_TRUE(deadbeat.outcome && filter.outcome);
  EXPECT_LT(2 * filter.statistics.rejected, deadbeat.statistics.rejected);
  EXPECT_NEAR(filter.final_state()[0], deadbeat.final_state()[0], 1e-3);
  EXPECT_EQ(filter.x, again.x);
  EXPECT_EQ(filter.statistics.evaluations, again.statistics.evaluations);
}

// The factor decides: on x' = 0 every step is the given multiple of the one before.
struct Half {
  double operator()(const StepError<double>&) const { return 0.5; }
};
TEST(WithController, StepsFollowTheFactor) {
  struct Rest {
    void operator()(double, const X&, X& dxdt) const { dxdt = {0, 0}; }
  };
  const auto solution =
      solve(Rest{}, X{1, 0}, {0, 1}, with_controller(Tsitouras5{}, Half{}), {.first_step = 0.25, .max_steps = 10});
  ASSERT_EQ(solution.t.size(), 11U);
  for (std::size_t k = 1; k < solution.t.size(); ++k)
    EXPECT_EQ(solution.t[k], 0.5 - std::ldexp(1.0, -static_cast<int>(k) - 1));
}

template <int which>
struct NoController {
  double operator()(const StepError<double>&) const {
    return which == 0 ? 0 : which == 1 ? std::numeric_limits<double>::quiet_NaN() : 1e9;
  }
};
TEST(WithController, WhatCannotControlIsNotAcceptedInSilence) {
  const auto refused = [](const auto& solution) {
    EXPECT_EQ(solution.outcome.ending, Ending::invalid_input);
    EXPECT_NE(solution.outcome.hint.find("the step controller has returned"), std::string::npos);
  };
  refused(solve(Small{}, X{1, 0}, {0, 10}, with_controller(Tsitouras5{}, NoController<0>{}), {}));
  refused(solve(Small{}, X{1, 0}, {0, 10}, with_controller(Tsitouras5{}, NoController<1>{}), {}));
  refused(solve(Small{}, X{1, 0}, {0, 10}, with_controller(Tsitouras5{}, NoController<2>{}), {}));
}

}  // namespace
}  // namespace continuo::with_norm_test
