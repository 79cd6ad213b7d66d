// Input that cannot be meant: the run does not begin, or ends, with a sentence that names the mistake.
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/methods/all.hpp>
#include <continuo/solve/solve.hpp>
#include <continuo/system/second_order.hpp>

namespace continuo::refusal_test {
namespace {

using testing::HasSubstr;
using X = std::vector<double>;
using Slope = std::function<X(double, const X&)>;
constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();

const Slope oscillator = [](double, const X& x) { return X{x[1], -x[0]}; };

/// The sentence of a run that is refused; empty where it is not.
std::string refusal(const Solution<X>& solution) {
  if (solution.outcome.ending != Ending::invalid_input) return {};
  EXPECT_EQ(solution.statistics.steps, 0U);
  return solution.outcome.hint;
}
std::string refusal(const Options<X>& options, Interval<double> interval = {0, 10}) {
  return refusal(solve(oscillator, X{1, 0}, interval, Dop853{}, options));
}
/// The same where the fault is found on the way.
template <class State>
std::string late_refusal(const Solution<State>& solution) {
  return solution.outcome.ending == Ending::invalid_input ? solution.outcome.hint : std::string();
}

TEST(Refusal, StepsThatCannotBeMeant) {
  for (const double step : {-0.1, nan, infinite}) {
    EXPECT_THAT(refusal({.step = step}), HasSubstr("the fixed step must be greater than 0")) << step;
    EXPECT_THAT(refusal({.first_step = step}), HasSubstr("first_step must be greater than 0")) << step;
  }
  for (const double longest : {0.0, -1.0, nan})
    EXPECT_THAT(refusal({.max_step = longest}), HasSubstr("max_step must be greater than 0")) << longest;
  EXPECT_THAT(refusal({.step = 0.1, .first_step = 0.01}), HasSubstr("step and first_step are both given"));
  EXPECT_THAT(refusal({.step = 0.1, .max_step = 0.01}), HasSubstr("longer than max_step"));
  EXPECT_THAT(refusal({.max_steps = 0}), HasSubstr("max_steps is 0"));
  EXPECT_THAT(refusal(solve(oscillator, X{1, 0}, {0, 1}, Rk4{}, {.step = -0.1})), HasSubstr("give it a step"));
}

TEST(Refusal, ControllersThatCannotBeMeant) {
  EXPECT_THAT(refusal({.controller = {0, 0, 0}}), HasSubstr("exponents"));
  EXPECT_THAT(refusal({.controller = {nan, 0, 0}}), HasSubstr("exponents"));
  EXPECT_THAT(refusal({.controller = {.beta1 = 1, .beta2 = 0, .beta3 = 0, .safety = 0}}), HasSubstr("safety"));
  EXPECT_THAT(refusal({.controller = {.beta1 = 1, .beta2 = 0, .beta3 = 0, .safety = 1.5}}), HasSubstr("safety"));
  EXPECT_THAT(refusal({.controller = {.beta1 = 1, .beta2 = 0, .beta3 = 0, .greatest_factor = 0.5}}),
              HasSubstr("greatest_factor"));
}

TEST(Refusal, TolerancesThatCannotBeMeant) {
  EXPECT_THAT(refusal({.rtol = -1e-6}), HasSubstr("rtol and atol must not be negative"));
  EXPECT_THAT(refusal({.rtol = nan}), HasSubstr("rtol and atol must not be negative"));
  EXPECT_THAT(refusal({.atol = -1e-6}), HasSubstr("rtol and atol must not be negative"));
  EXPECT_THAT(refusal({.rtol = 0, .atol = 0}), HasSubstr("not both zero"));
  EXPECT_THAT(refusal({.rtol = infinite}), HasSubstr("rtol must be finite"));
  EXPECT_THAT(refusal({.atol = infinite}), HasSubstr("atol is infinite"));
  EXPECT_THAT(refusal({.atol_each = {1e-6, -1e-6}}), HasSubstr("of component 1 must not be negative"));
  EXPECT_THAT(refusal({.rtol_each = {1e-6, nan}}), HasSubstr("of component 1 must not be negative"));
  EXPECT_THAT(refusal({.rtol_each = {1e-6, 0}, .atol_each = {1e-6, 0}}), HasSubstr("of component 1"));
  EXPECT_THAT(refusal({.atol_each = {1e-6}}), HasSubstr("1 are given for 2 components"));
  EXPECT_THAT(refusal({.rtol_each = {1e-6, 1e-6, 1e-6}}), HasSubstr("3 are given for 2 components"));
  EXPECT_THAT(refusal({.atol_each = {infinite, infinite}}), HasSubstr("atol is infinite"));
  EXPECT_EQ(refusal({.atol_each = {1e-6, infinite}}), "");
}

TEST(Refusal, TimesToSaveAtThatCannotBeMeant) {
  EXPECT_THAT(refusal({.save = save_at({1, 3, 2})}), HasSubstr("time 2 to save at is before the one before it"));
  EXPECT_THAT(refusal({.save = save_at({1, 2})}, {10, 0}), HasSubstr("time 1 to save at is before"));
  EXPECT_THAT(refusal({.save = save_at({1, 11})}), HasSubstr("time 1 to save at lies outside of the run"));
  EXPECT_THAT(refusal({.save = save_at({-1, 2})}), HasSubstr("time 0 to save at lies outside of the run"));
  EXPECT_THAT(refusal({.save = save_at({nan})}), HasSubstr("not finite"));
  for (const double spacing : {0.0, -0.1, nan})
    EXPECT_THAT(refusal({.save = save_every(spacing)}), HasSubstr("spacing to save at must be greater")) << spacing;
  EXPECT_THAT(refusal({.save = save_every(1e-20)}), HasSubstr("below the spacing of numbers"));
  EXPECT_THAT(refusal({.save = {.times = {1, 2}}}), HasSubstr("times to save are given"));
  EXPECT_THAT(refusal({.save = {.kind = Save<X>::Kind::dense, .spacing = 0.1}}), HasSubstr("a spacing to save at"));
}

// 0.1 added up is beyond 1 by rounding: that is the end, as a sum of ten tenths is meant.
TEST(Refusal, RoundingIsNoMistake) {
  std::vector<double> tenths{0};
  for (int k = 0; k < 30; ++k) tenths.push_back(tenths.back() + 0.1);
  ASSERT_GT(tenths.back(), 3);
  const auto solution = solve(oscillator, X{1, 0}, {0, 3}, Dop853{}, {.save = save_at(tenths)});
  EXPECT_TRUE(solution.outcome);
  ASSERT_EQ(solution.t.size(), tenths.size());
  EXPECT_EQ(solution.t.back(), 3);
}

TEST(Refusal, EventsThatCannotBeMeant) {
  const auto g = [](double, const X& x) { return x[0]; };
  const auto nothing = [](auto&) {};
  const auto with = [](Event<X> event, Interval<double> interval = {0, 1}) {
    return refusal({.events = {std::move(event)}}, interval);
  };
  EXPECT_THAT(with({.name = "none"}), HasSubstr("the event `none` has neither a guard nor times"));
  EXPECT_THAT(with({.name = "both", .guard = g, .times = {1}}), HasSubstr("has a guard and times"));
  EXPECT_THAT(with({.name = "both", .guard = g, .period = 1}), HasSubstr("has a guard and times"));
  EXPECT_THAT(with({.name = "first", .guard = g, .from = 1}), HasSubstr("has a guard and times"));
  EXPECT_THAT(with({.name = "back", .period = -1}), HasSubstr("must have a period of at least 0"));
  EXPECT_THAT(with({.name = "back", .period = nan}), HasSubstr("must have a period of at least 0"));
  EXPECT_THAT(with({.name = "from", .from = 1}), HasSubstr("has a first time and no period"));
  EXPECT_THAT(with({.name = "from", .times = {1}, .from = 1}), HasSubstr("has a first time and no period"));
  EXPECT_THAT(with({.name = "when", .times = {nan}}), HasSubstr("has a time that is not finite"));
  EXPECT_THAT(with({.name = "way", .direction = Direction::falls, .times = {1}}), HasSubstr("times and a direction"));
  EXPECT_THAT(with({.name = "limit", .times = {1}, .at_limit = nothing}), HasSubstr("action at the limit"));
  EXPECT_THAT(with(at("late", {0.5}, nothing), {1, 0}), HasSubstr("in a run that goes backwards"));
  EXPECT_THAT(with(every("late", 0.5, 0, nothing), {1, 0}), HasSubstr("in a run that goes backwards"));
  EXPECT_THAT(with(falls("root", [](double, const X& x) { return std::sqrt(-x[0]); })), HasSubstr("not a number"));
}

TEST(Refusal, StatesAndIntervalsThatCannotBeMeant) {
  EXPECT_THAT(refusal(solve(oscillator, X{}, {0, 1}, Dop853{})), HasSubstr("the state is empty"));
  EXPECT_THAT(refusal(solve(oscillator, X{1, nan}, {0, 1}, Dop853{})), HasSubstr("x[1] is not finite at the start"));
  for (const double to : {nan, infinite})
    EXPECT_THAT(refusal({}, {0, to}), HasSubstr("the interval of time is not finite"));
}

TEST(Refusal, ADerivativeOfAnotherSize) {
  for (const std::size_t size : {0U, 1U, 3U, 1000U}) {
    const Slope f = [size](double, const X&) { return X(size, 1.0); };
    const std::string expected = "f gives " + std::to_string(size) + " derivatives of 2 components";
    EXPECT_THAT(late_refusal(solve(f, X{1, 0}, {0, 1}, Dop853{})), HasSubstr(expected));
    EXPECT_THAT(late_refusal(solve(f, X{1, 0}, {0, 1}, Rk4{}, {.step = 0.1})), HasSubstr(expected));
    EXPECT_THAT(late_refusal(solve(f, X{1, 0}, {0, 1}, Radau{})), HasSubstr(expected));
    EXPECT_THAT(late_refusal(solve(f, X{1, 0}, {0, 1}, Bdf{}, {.first_step = 0.1})), HasSubstr(expected));
  }
  const auto resizes = [](double, const X&, X& dxdt) { dxdt = {1, 2, 3}; };
  EXPECT_THAT(late_refusal(solve(resizes, X{1, 0}, {0, 1}, Dop853{})), HasSubstr("f gives 3 derivatives"));
  const auto later = [](double t, const X& x) { return t < 0.5 ? X{x[1], -x[0]} : X{x[1]}; };
  const auto solution = solve(later, X{1, 0}, {0, 1}, Dop853{});
  EXPECT_FALSE(solution.outcome);
  EXPECT_NEAR(solution.outcome.t, 0.5, 1e-3);
}

TEST(Refusal, AnAccelerationOfAnotherSize) {
  const auto f = second_order([](double, std::span<const double>) { return X{1}; });
  EXPECT_FALSE(solve(f, X{1, 2, 0, 0}, {0, 1}, VelocityVerlet{}, {.step = 0.1}).outcome);
  const auto g = second_order([](double, std::span<const double> q) { return X{-q[0]}; });
  EXPECT_THAT(refusal(solve(g, X{1, 0, 0}, {0, 1}, Dop853{})),
              HasSubstr("an even number of components; this one has 3"));
}

TEST(Refusal, AStateOfAnotherSizeFromOutside) {
  Integrator integrator(oscillator, X{1, 0}, {0, 10}, Dop853{});
  ASSERT_TRUE(integrator.advance());
  integrator.set_state(X{1, 0, 0});
  EXPECT_FALSE(integrator.advance());
  EXPECT_EQ(integrator.outcome().ending, Ending::invalid_input);
  EXPECT_THAT(integrator.outcome().hint, HasSubstr("3 components for a state of 2"));
  EXPECT_EQ(integrator.x().size(), 2U);
}

TEST(Refusal, AnActionThatResizesTheState) {
  const auto solution =
      solve(oscillator, X{1, 0}, {0, 10}, Dop853{},
            {.events = {falls("grow", [](double, const X& x) { return x[0]; }, [](auto& now) { now.x = {1, 2, 3}; })}});
  EXPECT_THAT(late_refusal(solution), HasSubstr("changed the number of components from 2 to 3"));
  EXPECT_EQ(solution.outcome.event, "grow");
  EXPECT_EQ(solution.final_state().size(), 2U);
  EXPECT_TRUE(solution.events.empty());
  // At the start, where the event is tried on copies.
  const auto at_once =
      solve(oscillator, X{0, -1}, {0, 10}, Dop853{},
            {.events = {falls("shrink", [](double, const X& x) { return x[0]; }, [](auto& now) { now.x.clear(); })}});
  EXPECT_TRUE(at_once.outcome || at_once.outcome.ending == Ending::invalid_input);
}

TEST(Refusal, AnEndBeforeThePresent) {
  Integrator integrator(oscillator, X{1, 0}, {0, 10}, Dop853{});
  ASSERT_TRUE(integrator.advance());
  integrator.extend_to(integrator.t() / 2);
  EXPECT_FALSE(integrator.advance());
  EXPECT_EQ(integrator.outcome().ending, Ending::invalid_input);
  EXPECT_THAT(integrator.outcome().hint, HasSubstr("not before its present time"));
}

struct Paired {
  PositionVelocity only;
  void operator()(double, const X& x, X& dxdt) const { dxdt = {x[1], -x[0]}; }
  [[nodiscard]] std::size_t pair_count(std::size_t) const { return 1; }
  [[nodiscard]] PositionVelocity pair(std::size_t, std::size_t) const { return only; }
};

TEST(Refusal, PairsOutsideOfTheState) {
  const auto with = [](PositionVelocity pair) {
    return refusal(solve(Paired{pair}, X{1, 0}, {0, 1}, VelocityVerlet{}, {.step = 0.1}));
  };
  EXPECT_EQ(with({0, 1}), "");
  EXPECT_THAT(with({0, 2}), HasSubstr("component 2 of pair 0 is not in the state"));
  EXPECT_THAT(with({1, 1}), HasSubstr("component 1 of pair 0 is in a pair twice"));
}

struct Patterned {
  SparsePattern pattern;
  void operator()(double, const X& x, X& dxdt) const { dxdt = {x[1], -x[0]}; }
  [[nodiscard]] const SparsePattern& jacobian_pattern() const { return pattern; }
};
struct Massive {
  double last;
  void operator()(double, const X& x, X& dxdt) const { dxdt = {x[1], -x[0]}; }
  [[nodiscard]] double mass(std::size_t i) const { return i == 0 ? 1 : last; }
};

TEST(Refusal, PatternsAndMassesOfAnotherSystem) {
  const std::vector<MatrixPlace> places{{0, 1}, {1, 0}};
  EXPECT_EQ(refusal(solve(Patterned{SparsePattern(2, places)}, X{1, 0}, {0, 1}, Radau{})), "");
  EXPECT_THAT(refusal(solve(Patterned{SparsePattern(3, places)}, X{1, 0}, {0, 1}, Radau{})),
              HasSubstr("the pattern of the Jacobian is one of 3 components, and the state has 2"));
  EXPECT_THAT(refusal(solve(Massive{nan}, X{1, 0}, {0, 1}, Radau{})), HasSubstr("the mass of x[1] is not finite"));
  EXPECT_EQ(refusal(solve(Massive{2}, X{1, 0}, {0, 1}, Radau{})), "");
}

// Only the entries that are not zero are written, one of them only where x > 0.5: the others must be zeros each time.
TEST(Refusal, AJacobianBeginsAsZeros) {
  struct Jumping {
    std::vector<double>* seen;
    void operator()(double, const X& x, X& dxdt) const { dxdt = {-1000 * x[0], x[0] - x[1]}; }
    void jacobian(double, const X&, std::span<double> rows) const {
      for (const double entry : rows) seen->push_back(entry);
      rows[0] = -1000, rows[2] = 1, rows[3] = -1;
    }
  };
  std::vector<double> seen;
  EXPECT_TRUE(solve(Jumping{&seen}, X{1, 0}, {0, 10}, Rodas5P{}, {.rtol = 1e-8}).outcome);
  EXPECT_GT(seen.size(), 8U);
  for (const double entry : seen) EXPECT_EQ(entry, 0);
}

TEST(Refusal, XOfTOutsideOfTheRun) {
  const auto forward = solve(oscillator, X{1, 0}, {0, 10}, Dop853{}, {.save = save_dense()});
  const auto backward = solve(oscillator, X{1, 0}, {10, 0}, Dop853{}, {.save = save_dense()});
  for (const auto* solution : {&forward, &backward}) {
    for (const double t : {-0.01, 10.01, nan, infinite}) EXPECT_THROW((*solution)(t), std::out_of_range) << t;
    for (const double t : {0.0, 5.0, 10.0, std::nextafter(10.0, 11.0)}) EXPECT_NO_THROW((*solution)(t)) << t;
  }
  EXPECT_NEAR(forward(10)[0], std::cos(10), 1e-4);
  EXPECT_NEAR(backward(0)[0], std::cos(10), 1e-4);
  EXPECT_THROW(solve(oscillator, X{1, 0}, {0, 10}, Dop853{})(5), std::logic_error);
  const auto none = solve(oscillator, X{1, 0}, {3, 3}, Dop853{}, {.save = save_dense()});
  EXPECT_EQ(none(3), (X{1, 0}));
  EXPECT_THROW(none(4), std::out_of_range);
}

TEST(Refusal, TheFinalStateIsKnownWhateverIsSaved) {
  const auto all = solve(oscillator, X{1, 0}, {0, 10}, Dop853{});
  std::size_t rows = 0;
  const auto count = [&rows](double, const X&) { ++rows; };
  for (const Save<X>& save :
       {Save<X>(save_only_end()), Save<X>(save_at({1, 2})), Save<X>(save_every(3)), Save<X>(save_dense()),
        Save<X>(save_every_step().into(count)), Save<X>(save_at({}).into(count)), Save<X>(save_dense().into(count))})
    EXPECT_EQ(solve(oscillator, X{1, 0}, {0, 10}, Dop853{}, {.save = save}).final_state(), all.final_state());
  EXPECT_GT(rows, 10U);
  // With a callback the dense output is kept.
  EXPECT_NEAR(solve(oscillator, X{1, 0}, {0, 10}, Dop853{}, {.save = save_dense().into(count)})(5)[0], std::cos(5),
              1e-4);
  EXPECT_EQ(solve(oscillator, X{1, nan}, {0, 10}, Dop853{}).final_state()[0], 1);
  EXPECT_THROW((void)Solution<X>{}.final_state(), std::logic_error);
}

// x falls through 0 at pi/2 and is set to 2 there. The times asked for have one row each, and that at the event is the
// state after it.
TEST(Refusal, OnlyTheTimesAskedForAreKept) {
  const auto jump = falls("jump", [](double, const X& x) { return x[0]; }, [](auto& now) { now.x[0] = 2; });
  const auto tick = at("tick", {2}, [](auto& now) { now.x = {7, 0}; });
  for (const Save<X>& save : {Save<X>(save_at({0, 1, 2, 3})), Save<X>(save_every(1))}) {
    const auto solution = solve(oscillator, X{1, 0}, {0, 3.5}, Dop853{}, {.events = {jump, tick}, .save = save});
    EXPECT_EQ(solution.t, (std::vector<double>{0, 1, 2, 3}));
    ASSERT_EQ(solution.x.size(), 4U);
    EXPECT_EQ(solution.x[2], (X{7, 0}));
    EXPECT_NEAR(solution.x[3][0], 7 * std::cos(1), 1e-4);
    EXPECT_EQ(solution.events.size(), 2U);
    EXPECT_NEAR(solution.final_state()[0], 7 * std::cos(1.5), 1e-4);
  }
}

TEST(Refusal, ACallbackThatReturnsFalseEndsTheRun) {
  std::vector<double> seen;
  const auto until = [&seen](double last) {
    seen.clear();
    return [&seen, last](double t, const X&) {
      seen.push_back(t);
      return t < last;
    };
  };
  const auto solution = solve(oscillator, X{1, 0}, {0, 100}, Dop853{}, {.save = save_every(0.25).into(until(3))});
  EXPECT_EQ(solution.outcome.ending, Ending::stopped_by_callback);
  EXPECT_TRUE(solution.outcome);
  EXPECT_EQ(solution.outcome.t, 3);
  EXPECT_EQ(seen.back(), 3);
  EXPECT_EQ(seen.size(), 13U);
  EXPECT_NEAR(solution.final_state()[0], std::cos(3), 1e-4);
  const auto at_start = solve(oscillator, X{1, 0}, {0, 100}, Dop853{}, {.save = save_every_step().into(until(0))});
  EXPECT_EQ(at_start.outcome.t, 0);
  EXPECT_EQ(at_start.statistics.steps, 0U);
  EXPECT_EQ(at_start.final_state(), (X{1, 0}));
  // No event after the end of the run acts.
  int fired = 0;
  const auto later = at("later", {3.1}, [&fired](auto&) { ++fired; });
  const auto quiet = solve(oscillator, X{1, 0}, {0, 100}, Dop853{},
                           {.first_step = 10, .events = {later}, .save = save_at({3, 50}).into(until(3))});
  EXPECT_EQ(quiet.outcome.t, 3);
  EXPECT_EQ(fired, 0);
  const auto slow = solve(oscillator, X{1, 0}, {0, 1e6}, Dop853{},
                          {.save = save_only_end(), .progress = [](double t) { return t < 2000; }});
  EXPECT_EQ(slow.outcome.ending, Ending::stopped_by_callback);
  EXPECT_LT(slow.outcome.t, 1e5);
}

// The heat equation: the stages of rkc2 keep its steps stable, so that accuracy determines them.
TEST(Refusal, DiffusionIsNotStiffForAStabilisedMethod) {
  const auto heat = [](double t, const X& u, X& dudt) {
    const std::size_t n = u.size();
    for (std::size_t i = 0; i < n; ++i) {
      const double left = i == 0 ? std::sin(40 * t) : u[i - 1], right = i + 1 == n ? 0 : u[i + 1];
      dudt[i] = 100.0 * (left - 2 * u[i] + right);
    }
  };
  const auto solution = solve(heat, X(20, 0.0), {0, 20}, Rkc2{}, {.rtol = 1e-5, .save = save_only_end()});
  EXPECT_TRUE(solution.outcome);
  EXPECT_GT(solution.statistics.steps, 2000U);
  EXPECT_EQ(solution.outcome.hint, "");
}

struct Counted {
  int calls = 0;
  void operator()(double, const std::array<double, 2>& x, std::array<double, 2>& dxdt) {
    ++calls;
    dxdt = {x[1], -x[0]};
  }
  [[nodiscard]] double mass(std::size_t i) const { return i == 0 ? 1 : 4; }
};

// x' = v, 4 v' = -x: x = cos(t/2) with the mass, cos(t) without it.
TEST(Refusal, AReferenceKeepsTheMembersOfTheSystem) {
  Counted f;
  const auto solution = solve(std::ref(f), std::array{1.0, 0.0}, {0, 10}, Radau{}, {.rtol = 1e-9, .atol = 1e-12});
  EXPECT_NEAR(solution.final_state()[0], std::cos(5), 1e-7);
  EXPECT_EQ(f.calls, static_cast<int>(solution.statistics.evaluations));
  Integrator integrator(std::ref(f), std::array{1.0, 0.0}, {0, 10}, Radau{}, {.rtol = 1e-9, .atol = 1e-12});
  while (integrator.advance()) continue;
  EXPECT_NEAR(integrator.x()[0], std::cos(5), 1e-7);
}

}  // namespace
}  // namespace continuo::refusal_test
