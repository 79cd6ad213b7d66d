// States that change their size during a run: cells that divide, particles that leave. The references are closed forms.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "any_derivative.hpp"
#include <continuo/methods/multistep/adams.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::resize_test {
namespace {

using solve_test::V, solve_test::AnyDerivative;

constexpr double rate = 0.3, part = 0.4;
constexpr AnyDerivative growth{[](double, const V& x, V& dxdt) {
  for (std::size_t i = 0; i < x.size(); ++i) dxdt[i] = rate * x[i];
}};
double fullest(double, const V& x) {
  return std::ranges::max(x) - 1;
}
// Every cell that is full leaves a part of its content to a new one.
void divide(EventAction<V>& now) {
  for (std::size_t i = 0, n = now.x.size(); i < n; ++i) {
    if (now.x[i] < 1 - 1e-9) continue;
    now.x.push_back((1 - part) * now.x[i]);
    now.x[i] *= part;
  }
  now.resize = true;
}
const Event<V> division{.name = "division", .guard = fullest, .direction = Direction::rises, .action = divide};

// The times of all divisions up to t: a cell with content c at a time divides log(1 / c) / rate later.
void divisions(double now, double content, double end, std::vector<double>& times) {
  const double t = now - std::log(content) / rate;
  if (t > end) return;
  times.push_back(t);
  divisions(t, part, end, times);
  divisions(t, 1 - part, end, times);
}
double sum(const V& x) {
  return std::accumulate(x.begin(), x.end(), 0.0);
}

template <class M>
class Resized : public testing::Test {};
using Methods = testing::Types<Adams, Bdf>;
TYPED_TEST_SUITE(Resized, Methods);

TYPED_TEST(Resized, CellsDivideAtTheirTimesAndGrowOn) {
  const auto solution =
      solve(growth, V{0.2}, {0, 20}, TypeParam{}, {.rtol = 1e-9, .atol = 1e-12, .events = {division}});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  std::vector<double> times;
  divisions(0, 0.2, 20, times);
  std::ranges::sort(times);
  ASSERT_GT(times.size(), 50U);
  // Cells with the same ancestors' parts, in whatever order, divide together.
  std::size_t divided = 0;
  for (const EventRecord<V>& event : solution.events) {
    EXPECT_NEAR(event.t, times[divided], 1e-5);
    EXPECT_EQ(event.before.size(), divided + 1);
    while (divided < times.size() && times[divided] < event.t + 1e-4) ++divided;
    EXPECT_EQ(event.after.size(), divided + 1);
  }
  EXPECT_EQ(divided, times.size());
  for (std::size_t row = 0; row < solution.t.size(); ++row)
    EXPECT_NEAR(sum(solution.x[row]), 0.2 * std::exp(rate * solution.t[row]), 1e-4);
  EXPECT_EQ(solution.final_state().size(), times.size() + 1);
}

TYPED_TEST(Resized, RowsAtTimesAndPolynomialsKnowTheirSize) {
  Options<V> options{.rtol = 1e-9, .atol = 1e-12, .events = {division}, .save = save_every(0.5)};
  const auto rows = solve(growth, V{0.2}, {0, 12}, TypeParam{}, options);
  options.save = save_dense();
  const auto dense = solve(growth, V{0.2}, {0, 12}, TypeParam{}, options);
  std::vector<double> times;
  divisions(0, 0.2, 12, times);
  ASSERT_EQ(rows.t.size(), 25U);
  for (std::size_t row = 0; row < rows.t.size(); ++row) {
    const double t = rows.t[row];
    const auto cells =
        1 + static_cast<std::size_t>(std::ranges::count_if(times, [t](double when) { return when < t; }));
    EXPECT_EQ(rows.x[row].size(), cells);
    EXPECT_EQ(dense(t).size(), cells);
    EXPECT_NEAR(sum(rows.x[row]), 0.2 * std::exp(rate * t), 1e-6);
    EXPECT_NEAR(sum(dense(t)), 0.2 * std::exp(rate * t), 1e-6);
  }
}

// One particle less after each step; each decays by itself.
TYPED_TEST(Resized, StepByStep) {
  const AnyDerivative decay{[](double, const V& x, V& dxdt) {
    for (std::size_t i = 0; i < x.size(); ++i) dxdt[i] = -x[i];
  }};
  Integrator integrator(decay, V{1, 2, 3, 4}, {0, 2}, TypeParam{}, {.rtol = 1e-9, .atol = 1e-12, .max_step = 0.1});
  std::size_t steps = 0, evaluations = 0;
  while (integrator.advance()) {
    ++steps;
    EXPECT_GT(integrator.statistics().evaluations, evaluations);
    evaluations = integrator.statistics().evaluations;
    if (integrator.x().size() == 1 || integrator.t() < 1) continue;
    V x = integrator.x();
    x.erase(x.begin());
    integrator.resize(x);
    EXPECT_EQ(integrator.x(), x);
  }
  ASSERT_TRUE(integrator.outcome()) << describe(integrator.outcome());
  EXPECT_EQ(integrator.statistics().steps, steps + 1);
  ASSERT_EQ(integrator.x().size(), 1U);
  EXPECT_NEAR(integrator.x()[0], 4 * std::exp(-2.0), 1e-6);
  EXPECT_TRUE(TypeParam::name != "bdf" || integrator.statistics().jacobians > 3);
}

TEST(Resize, WhatDoesNotFitIsRefused) {
  const auto outcome = [](Options<V> options) {
    const auto solution = solve(growth, V{0.2}, {0, 20}, Adams{}, std::move(options));
    EXPECT_EQ(solution.outcome.ending, Ending::invalid_input);
    EXPECT_EQ(solution.final_state().size(), 1U);
    return solution.outcome.hint;
  };
  EXPECT_NE(outcome({.atol_each = {1e-9}, .events = {division}}).find("a tolerance per component"), std::string::npos);
  EXPECT_NE(outcome({.events = {division}, .signs = {Sign::positive}}).find("one for each component"),
            std::string::npos);
  Event<V> silent = division;
  silent.action = [](EventAction<V>& now) { now.x.push_back(0); };
  EXPECT_NE(outcome({.events = {silent}}).find("sets `resize`"), std::string::npos);
  Event<V> empty = division;
  empty.action = [](EventAction<V>& now) { now.x.clear(), now.resize = true; };
  EXPECT_NE(outcome({.events = {empty}}).find("empty"), std::string::npos);
  Integrator integrator(growth, V{0.2}, {0, 1}, Adams{}, {.atol_each = {1e-9}});
  integrator.advance();
  integrator.resize({1, 1});
  EXPECT_EQ(integrator.outcome().ending, Ending::invalid_input);
  EXPECT_EQ(integrator.x().size(), 1U);
}

}  // namespace
}  // namespace continuo::resize_test
