// Many steps of the method `taylor` in one call of machine code: every number of a run as of the steps one by one, also
// where guards are watched.
#include <array>
#include <cstddef>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tests/symbolic/native_referee.hpp>

#include <continuo/language/load.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/symbolic/native/native_compiler.hpp>

namespace continuo::model::series_steps_test {
namespace {

class Both {
 public:
  /// A run with machine code says the same as one by the program of series, in which every step goes by the driver.
  void expect_the_same_run(const std::string& text, const Experiment& experiment = {.method = "taylor"}) {
    Loaded loaded = load(Source("any.sim", text));
    ASSERT_TRUE(loaded) << text << loaded.text();
    const Simulated plain = simulate(*loaded.model, experiment);
    loaded.model->native = native;
    const Simulated own = simulate(*loaded.model, experiment);
    ASSERT_TRUE(plain.run && own.run) << text;
    ASSERT_EQ(own.run->motion.values.size(), plain.run->motion.values.size()) << text;
    for (std::size_t i = 0; i < plain.run->motion.values.size(); ++i)
      ASSERT_EQ(bits(own.run->motion.values[i]), bits(plain.run->motion.values[i])) << text << i;
    EXPECT_EQ(own.run->outcome.ending, plain.run->outcome.ending) << text;
    EXPECT_EQ(own.run->outcome.hint, plain.run->outcome.hint) << text;
    ASSERT_EQ(own.run->events.size(), plain.run->events.size()) << text;
    for (std::size_t i = 0; i < plain.run->events.size(); ++i) {
      EXPECT_EQ(bits(own.run->events[i].t), bits(plain.run->events[i].t)) << text;
      EXPECT_EQ(own.run->events[i].name, plain.run->events[i].name) << text;
      EXPECT_EQ(own.run->events[i].after, plain.run->events[i].after) << text;
    }
    EXPECT_EQ(own.run->statistics.steps, plain.run->statistics.steps) << text;
    EXPECT_EQ(own.run->statistics.rejected, plain.run->statistics.rejected) << text;
    EXPECT_EQ(own.run->statistics.evaluations, plain.run->statistics.evaluations) << text;
    events += plain.run->events.size();
  }

  const TestFolder folder;
  const std::shared_ptr<NativeCompiler> native =
      std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  std::size_t events = 0;
};

std::size_t below(std::size_t n, std::mt19937& random) {
  return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
}

/// A smooth expression of x1, x2, ...
std::string random_expression(std::size_t states, int depth, std::mt19937& random) {
  if (depth == 0) {
    const std::size_t which = below(states + 2, random);
    return which == states       ? "p"
           : which == states + 1 ? fmt::format("{:.2f}", 0.1 * static_cast<double>(1 + below(15, random)))
                                 : fmt::format("x{}", which + 1);
  }
  constexpr std::array forms{"({} + {})",  "({} - {})",     "{}*{}",      "({})/(2 + ({})^2)",
                             "sin({})*{}", "exp(-({}))*{}", "({})^2 - {}"};
  return fmt::format(fmt::runtime(forms[below(forms.size(), random)]), random_expression(states, depth - 1, random),
                     random_expression(states, depth - 1, random));
}

/// Oscillators that random terms couple: they stay bounded for the time of these runs, or are ended by what the run
/// says.
std::string random_model(std::size_t states, std::mt19937& random) {
  std::string text = "model Any\nparam p = 0.7\n";
  for (std::size_t i = 1; i <= states; ++i) {
    text += fmt::format("x{0}' = {1}x{2} - 0.1*x{0} + 0.2*sin({3})\nx{0}(0) = {4}\n", i, i % 2 == 0 ? "-" : "",
                        i % 2 == 0 ? i - 1 : std::min(i + 1, states), random_expression(states, 2, random),
                        0.3 + 0.1 * static_cast<double>(i));
  }
  return text;
}

// Loose tolerances have a low order, whose machine code is compiled in less time; runs of equal order share it.
TEST(SeriesSteps, AreTheSameRun) {
  Both both;
  std::mt19937 random(17);
  for (const std::size_t states : {1U, 3U})
    both.expect_the_same_run(random_model(states, random) + "run 0..30 output 7 tol 1e-4 max steps 300\n");
  both.expect_the_same_run(
      "model Line\nfor i in 1..13 { u[i](0) = sin(i) }\nfor i in 2..12 { u[i]' = u[i-1] - 2*u[i] + u[i+1] }\n"
      "u[1]' = -u[1]\nu[13]' = u[12]\nrun 0..20 output 6 tol 1e-4\n");
  const std::string circle = "model Circle\nx' = y; y' = -x\nx(0) = 1\ny(0) = 0\n", tolerance = " tol 1e-5 ";
  both.expect_the_same_run("model Pole\nx' = 1 + x^2\nx(0) = 0\nrun 0..3 output 0.9" + tolerance + "\n");
  both.expect_the_same_run(circle + "run 0..30 output 7" + tolerance + "max step 0.2\n");
  both.expect_the_same_run(circle + "run 0..1000 output 100" + tolerance + "max steps 300\n");
  both.expect_the_same_run(circle + "at 3.3 { mark \"seen\" }\nat 7.1 { y := y + 0.5 }\nrun 0..40 output 9" +
                           tolerance + "\n");
  both.expect_the_same_run(circle + "run 0..40\n",
                           {.method = "taylor", .rtol = 1e-5, .atol = {1e-6, 1e-8}, .keep_rows = false});
  EXPECT_EQ(both.native->report().trouble, "");
}

TEST(SeriesSteps, WatchGuards) {
  Both both;
  std::mt19937 random(23);
  const std::string circle = "model Circle\nparam r = 0.99\nx' = y; y' = -x\nx(0) = 1\ny(0) = 0\n",
                    run = "run 0..25 tol 1e-5 max steps 300\n";
  // Roots that touch zero or nearly do, two of them close together, one at the start, and one of conditions.
  both.expect_the_same_run(
      circle +
      "when x rises through r { mark \"near\" }\nwhen x falls through 1 { mark \"touch\" }\n"
      "when (x - 0.5)^2 falls through 1e-9 { mark \"twice\" }\nwhen y crosses 0 { mark \"start\" }\n"
      "when hypot(x - 1, y) < 0.1 or atan(x/3) > r/3 { mark \"either\" }\n"
      "when sqrt(x + 1.1) - exp(y/2) + t/20 crosses 0.3 { mark \"bent\" }\n" +
      run);
  // One changes the motion, and one is of an operation that is not watched.
  both.expect_the_same_run(circle + "when x falls through -0.5 { y := 0.9*y }\n" + run);
  both.expect_the_same_run(circle + "when floor(3*x) crosses 0.5 { mark \"jump\" }\n" + run);
  for (int i = 0; i < 2; ++i) {
    std::string text = random_model(2, random);
    for (int guard = 0; guard < 3; ++guard)
      text += fmt::format("when {} crosses {} {{ mark \"any\" }}\n", random_expression(2, 2, random), 0.2 * guard);
    both.expect_the_same_run(text + run);
  }
  EXPECT_GT(both.events, 20U);
  EXPECT_EQ(both.native->report().trouble, "");
}

/// That the tests above have something to see: most steps of such a run are taken by the machine code.
TEST(SeriesSteps, AreTakenWhereNoGuardIsNear) {
  Both both;
  Loaded loaded = load(Source("any.sim",
                              "model Any\nparam level = 5\nx' = y; y' = -x\nx(0) = 1; y(0) = 0\n"
                              "when x*y + x crosses level { mark \"never\" }\nrun 0..1\n"));
  ASSERT_TRUE(loaded);
  loaded.model->native = both.native;
  const auto program = compile(*loaded.model);
  ModelSystem system(program, start_values(*loaded.model));
  constexpr std::size_t order = 12, most = 7;
  std::vector<double> now(2 * (order + 1) + 3), next = now, x{1, 0}, rest{0, 0}, times(most);
  now[0] = 1;
  const auto take = [&] {
    SeriesSteps<double> steps{.x = x.data(),
                              .rest = rest.data(),
                              .now = now.data(),
                              .next = next.data(),
                              .t = 0,
                              .scale = 1,
                              .size = 0.1,
                              .carried = 0,
                              .limit = 100,
                              .longest = 100,
                              .until = 100,
                              .forward = 1,
                              .components = 2,
                              .order = order,
                              .most = most,
                              .tolerance = {1e-6, 1e-6},
                              .terms = {7, 54},
                              .greatest_factor = 2,
                              .safety = 0.9,
                              .times = times.data(),
                              .has_guards = true};
    return system.take_series_steps(steps);
  };
  EXPECT_EQ(system.taylor_coefficients(0, 1, std::span(now).first(2 * (order + 1))), "");
  EXPECT_TRUE(system.watches_guards());
  EXPECT_EQ(take(), most);
  const std::uint32_t level = loaded.model->layout.parameters;
  for (const auto& [value, taken] : {std::pair(0.9, std::size_t{0}), std::pair(-5.0, most)}) {
    x = {1, 0}, rest = {0, 0}, now.assign(now.size(), 0), now[0] = 1;
    system.set(level, value);
    EXPECT_EQ(system.taylor_coefficients(0, 1, std::span(now).first(2 * (order + 1))), "");
    EXPECT_EQ(take(), taken) << value;
  }
}

}  // namespace
}  // namespace continuo::model::series_steps_test
