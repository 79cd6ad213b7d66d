// What is proved of a guard up to the end of a step holds behind an event too, unless the event changes the guard.
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::model::guards_behind_events_test {
namespace {

std::vector<double> marks_of(const std::string& text, const char* method, double tolerance) {
  const Loaded loaded = load(Source("guards.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  const Simulated simulated = simulate(*loaded.model, {.method = method, .rtol = tolerance, .atol = {tolerance}});
  EXPECT_TRUE(simulated.run) << render(simulated.diagnostics, loaded.source);
  std::vector<double> times;
  for (const RecordedEvent& event : simulated.run->events)
    if (!event.mark.empty()) times.push_back(event.t);
  return times;
}

/// The changes of sign of g on from..to by values that are far closer than any two of them, halved to rounding.
std::vector<double> roots_of(const std::function<double(double)>& g, double from, double to) {
  constexpr int parts = 200'000;
  std::vector<double> roots;
  for (int k = 0; k < parts; ++k) {
    double a = from + (to - from) * k / parts, b = from + (to - from) * (k + 1) / parts;
    if ((g(a) > 0) == (g(b) > 0)) continue;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = a + (b - a) / 2;
      ((g(middle) > 0) == (g(a) > 0) ? a : b) = middle;
    }
    roots.push_back(b);
  }
  return roots;
}

void expect_near(const std::vector<double>& found, const std::vector<double>& roots, double within,
                 const std::string& text) {
  ASSERT_EQ(found.size(), roots.size()) << text;
  for (std::size_t i = 0; i < roots.size(); ++i) EXPECT_NEAR(found[i], roots[i], within) << text << i;
}

const char* const methods[] = {"dop853", "tsitouras5", "rodas5p", "taylor"};

// x = t to rounding, whatever the step: one step has many crossings, and an event changes nothing.
TEST(GuardsBehindEvents, AllCrossingsOfAStepAreMarked) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> uniform(-0.9, 0.9);
  for (int trial = 0; trial < 10; ++trial) {
    const double phase = uniform(engine), level = uniform(engine), tilt = 0.3 * uniform(engine);
    const auto number = [](double value) { return "(" + std::to_string(value) + ")"; };
    const std::string guard = "sin(7*x + " + number(phase) + ") + " + number(tilt) + "*x crosses " + number(level);
    const std::string text = "x' = 1\nx(0) = 0\nwhen " + guard + " { mark \"e\" }\nrun 0..3\n";
    const double p = std::stod(std::to_string(phase)), l = std::stod(std::to_string(level)),
                 c = std::stod(std::to_string(tilt));
    const auto roots = roots_of([=](double t) { return std::sin(7 * t + p) + c * t - l; }, 0, 3);
    ASSERT_GE(roots.size(), 3u);
    for (const char* method : methods) expect_near(marks_of(text, method, 1e-6), roots, 1e-9, method + text);
  }
}

// The first event bends the guard, which was proved to rise to the end of the step, so that it comes back.
TEST(GuardsBehindEvents, AnEventThatChangesItsGuardIsSearchedFor) {
  const char* const text = R"(
x' = 1;  a' = 0
x(0) = 0;  a(0) = 0
when x - 1 + a*0.5*sin(20*(x - 1)) crosses 0 { a := 1; mark "e" }
run 0..2
)";
  std::vector<double> roots{1};
  for (const double root : roots_of([](double t) { return t - 1 + 0.5 * std::sin(20 * (t - 1)); }, 1 + 1e-6, 2))
    roots.push_back(root);
  ASSERT_GE(roots.size(), 3u);
  for (const char* method : methods) expect_near(marks_of(text, method, 1e-6), roots, 1e-9, method);
}

// Another event changes it: no guard is crossed then, but the proof is none any more.
TEST(GuardsBehindEvents, AnEventThatChangesAnotherGuardIsHeeded) {
  const char* const text = R"(
x' = 1;  a' = 0
x(0) = 0;  a(0) = 0
when x - 1 + a*0.5*sin(20*(x - 1)) crosses 0 { mark "e" }
when x rises through 1.02 { a := 1 }
run 0..2
)";
  std::vector<double> roots{1};
  for (const double root : roots_of([](double t) { return t - 1 + 0.5 * std::sin(20 * (t - 1)); }, 1.02, 2))
    roots.push_back(root);
  ASSERT_GE(roots.size(), 3u);
  for (const char* method : methods) expect_near(marks_of(text, method, 1e-6), roots, 1e-9, method);
}

// Where the motion is one of many steps: an oscillation through a level, in closed form.
TEST(GuardsBehindEvents, AnOscillationPassesItsLevelTwiceAPeriod) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> uniform(-0.95, 0.95);
  for (int trial = 0; trial < 10; ++trial) {
    const double level = std::stod(std::to_string(uniform(engine)));
    const std::string text =
        "x'' = -x\nx(0) = 1; x'(0) = 0\nwhen x crosses (" + std::to_string(level) + ") { mark \"e\" }\nrun 0..50\n";
    std::vector<double> roots;
    for (int turn = 0; turn < 9; ++turn)
      for (const double angle : {std::acos(level), 2 * std::numbers::pi - std::acos(level)})
        if (const double root = 2 * std::numbers::pi * turn + angle; root < 50) roots.push_back(root);
    for (const char* method : methods) {
      // The error of the motion at a tolerance of 1e-9 over eight periods, divided by the speed at the level.
      const double within = 1e-6 / std::sqrt(1 - level * level);
      expect_near(marks_of(text, method, 1e-9), roots, within, method + text);
    }
  }
}

}  // namespace
}  // namespace continuo::model::guards_behind_events_test
