// Guards on unknowns: enclosed as in the run, solved for between the steps, and found where they are narrow.
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/numerics/root_isolation.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/simulation/program/step_enclosure.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/solve/steps/consistent.hpp>

namespace continuo::model::unknown_guard_test {
namespace {

using X = std::vector<double>;

std::shared_ptr<const ModelProgram> program_of(const std::string& text) {
  Loaded loaded = load(Source("test.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  return compile(std::move(*loaded.model));
}

/// A step of which the dense output is given, and the first guard over it.
struct OneStep {
  std::shared_ptr<const ModelProgram> program;
  ModelSystem system;
  std::vector<X> coefficients;
  StepEnclosure enclosure;

  OneStep(const std::string& text, std::vector<X> coefficients_)
      : program(program_of(text)),
        system(program, start_values(program->model)),
        coefficients(std::move(coefficients_)),
        enclosure(enclosure_of(*program)) {}

  static StepEnclosure enclosure_of(const ModelProgram& program) {
    const NodeId guard = program.model.events[0].guard;
    const auto block = UnknownCoupling(program, program.model.modes[0].derivatives).block(guard);
    EXPECT_TRUE(block.has_value());
    return {program, std::span(&guard, 1), start_values(program.model), std::span(&*block, 1)};
  }
  Step step() const { return {0, 1, coefficients}; }

  /// The guard with the unknown solved for as in a run.
  double guard(double theta) {
    X x(coefficients[0].size());
    for (std::size_t j = coefficients.size(); j-- > 0;)
      for (std::size_t i = 0; i < x.size(); ++i) x[i] = x[i] * theta + coefficients[j][i];
    EXPECT_TRUE(make_consistent(system, theta, x, Tolerance<double>{1e-6, 1e-6}));
    std::vector<double> values(1);
    system.guards(theta, x, values);
    return values[0];
  }
};

const std::string coupled = R"(
unknown u = 0; unknown v = 0
x' = 1
x(0) = 1
0 = u + 0.3*sin(v) - x
0 = v - 0.5*cos(u*x) - 0.1*t
when u*x - v rises through 10 { mark "m" }
run 0..1
)";

/// u = x - 0.3 sin(v), v = 0.5 cos(u x) + 0.1 t: each round leaves half of the error.
long double coupled_guard(long double t, long double x) {
  long double u = x, v = 0;
  for (int round = 0; round < 200; ++round) {
    u = x - 0.3L * std::sin(v);
    v = 0.5L * std::cos(u * x) + 0.1L * t;
  }
  return u * x - v - 10;
}

TEST(UnknownGuards, TheEnclosureHoldsTheSolutionOnEveryPart) {
  // x = 0.5 + theta/2; the polynomials of u and v are off by some hundredths.
  OneStep one(coupled, {{0.5, 0.4, 0.5}, {0.5, 0.4, -0.1}});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const double width : {0.1, 1e-2, 1e-4, 1e-8, 0.0}) {
    for (int trial = 0; trial < 100; ++trial) {
      const double from = uniform(random) * (1 - width), to = from + width;
      const EnclosureWithSlope<double> curve = one.enclosure.over(one.step(), from, to)[0];
      const Enclosure<double> value = one.enclosure.values_over(one.step(), from, to)[0];
      ASSERT_TRUE(value.is_bounded() && curve.slope.is_bounded());
      long double last = 0;
      for (int k = 0; k <= 4; ++k) {
        const double theta = std::min(from + width * k / 4, to);
        const auto x = 0.5L + static_cast<long double>(theta) / 2;
        const auto exact = coupled_guard(static_cast<long double>(theta), x);
        // The constants of the text are not those of the referee, which has more digits.
        constexpr long double digits = 1e-14L;
        ASSERT_TRUE(static_cast<long double>(value.lo) - digits <= exact &&
                    exact <= static_cast<long double>(value.hi) + digits);
        ASSERT_TRUE(value.holds(one.guard(theta)) && curve.value.holds(one.guard(theta)));
        const auto slope = static_cast<double>((exact - last) / (static_cast<long double>(width) / 4));
        if (k > 0 && width > 1e-5) {
          ASSERT_TRUE(curve.slope.lo - 1e-8 <= slope && slope <= curve.slope.hi + 1e-8);
        }
        last = exact;
      }
      if (width == 0) {
        ASSERT_LT(value.hi - value.lo, 3e-13);  // some ten operations on numbers of ten
      }
    }
  }
}

// x u = x^2: u = x, except at x = 0, where u is arbitrary.
const std::string pole = R"(
unknown u = 0
x' = 1
x(0) = -1
0 = x*u - x^2
when u rises through 0.5 { mark "m" }
run 0..1
)";

TEST(UnknownGuards, NothingIsProvedWhereTheEquationsAreSingular) {
  OneStep one(pole, {{-1, -1}, {2, 2}});  // x from -1 to 1
  EXPECT_TRUE(one.enclosure.over(one.step(), 0.4, 0.6)[0].value.is_entire());
  EXPECT_TRUE(one.enclosure.values_over(one.step(), 0.5, 0.5)[0].is_entire());
  std::vector<double> found;
  std::vector<std::pair<double, double>> undecided;
  const auto end = isolate_crossings(
      0.0, 1.0, -1, [&](double a, double b) { return one.enclosure.over(one.step(), a, b)[0]; },
      [&](double a) { return one.enclosure.values_over(one.step(), a, a)[0]; },
      [&](double a, double b, int, bool) { return found.push_back((a + b) / 2), b - a > 0.1; },
      [&](double a, double b) { return undecided.emplace_back(a, b), false; });
  EXPECT_FALSE(end.proved);
  ASSERT_EQ(undecided.size(), 2u);  // next to x = 0, where the bisection of the step ends
  EXPECT_NEAR(undecided[0].first, 0.5, 0.1);
  EXPECT_NEAR(undecided[1].second, 0.5, 0.1);
  EXPECT_EQ(end.side, 1);
  ASSERT_EQ(found.size(), 1u);
}

std::vector<double> times(const std::string& text, const std::string& method) {
  Loaded loaded = load(Source("test.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  Experiment experiment{.rtol = 1e-9, .atol = {1e-9}};
  if (!method.empty()) experiment.method = method;
  const Simulated simulated = simulate(*loaded.model, experiment);
  EXPECT_TRUE(simulated.passed()) << method;
  std::vector<double> found;
  for (const RecordedEvent& event : simulated.run->events) found.push_back(event.t);
  return found;
}

std::string number(double value) {
  return fmt::format("{:.17g}", value);
}

const char* const methods[] = {"", "rodas5p", "radau", "bdf"};

/// u enters a window that begins at `low` once, at instant(width); every method must find it.
template <class Instant>
void expect_windows_found(const std::string& equations, double low, Instant&& instant, double error) {
  for (const double width : {1e-3, 1e-5, 1e-7}) {
    const std::string window = "when u > " + number(low) + " and u < " + number(low + width) + " { mark \"in\" }\n";
    for (const char* method : methods) {
      const auto found = times(equations + window, method);
      ASSERT_EQ(found.size(), 1u) << method << width;
      EXPECT_NEAR(found[0], instant(width), error) << method << width;
    }
  }
}

// d' = u = 0.204 - 2.612 d: u = u(0) exp(-2.612 t).
TEST(UnknownGuards, NarrowWindowsOfALinearOneAreFoundWhereTheyBegin) {
  const double first = 0.204 + 2.612 * 1.704;
  expect_windows_found(
      "unknown u = 0\nd' = u\nd(0) = -1.704\n0 = u - (0.204 - 2.612*d)\nrun 0..0.5\n", 1.396,
      [&](double width) { return std::log(first / (1.396 + width)) / 2.612; }, 1e-8);
}

// u + u^3 = x = t: u goes through the window of u in a..a + width from t = a + a^3 on.
TEST(UnknownGuards, NarrowWindowsOfACurvedOneAreFoundWhereTheyBegin) {
  expect_windows_found(
      "unknown u = 0\nx' = 1\nx(0) = 0\n0 = u + u^3 - x\nrun 0..3\n", 0.7, [](double) { return 0.7 + 0.343; }, 1e-14);
}

// The slopes of the guard there are 1e-9, its rounding is that of u times as much.
TEST(UnknownGuards, TwoRootsABillionthApartAreBothFound) {
  for (const char* method : methods) {
    const auto found = times(
        "unknown u = 0\nx' = 1\nx(0) = 0\n0 = u + u^3 - x\nrun 0..3\n"
        "when (u - 0.7)*(u - 0.7 - 1e-9) crosses through 0 { mark \"root\" }\n",
        method);
    ASSERT_EQ(found.size(), 2u) << method;
    EXPECT_NEAR(found[0], 1.043, 1e-14) << method;
    EXPECT_NEAR(found[1], 1.043 + (1 + 3 * 0.49) * 1e-9, 1e-14) << method;
  }
}

// Each mode has residuals of its own, and those of one mode contain a jump, which is kept on either side.
TEST(UnknownGuards, TheResidualsAreThoseOfTheModeAndOfItsSwitches) {
  const std::string text = R"(
unknown u = 0
x' = 1
x(0) = 0
mode plain { 0 = u - 3*x }
mode split { 0 = u - (if x < 2 then 5*x else 7*x) }
at 1 { go split }
when (u > 1.5 and u < 1.50001) or (u > 6 and u < 6.00001) or (u > 17.5 and u < 17.50001) { mark "in" }
run 0..3
)";
  for (const char* method : methods) {
    std::vector<double> found = times(text, method);
    std::erase_if(found, [](double t) { return std::abs(t - std::round(t)) < 1e-9; });  // the change of mode, the jump
    ASSERT_EQ(found.size(), 3u) << method;
    EXPECT_NEAR(found[0], 0.5, 1e-13) << method;
    EXPECT_NEAR(found[1], 1.2, 1e-13) << method;
    EXPECT_NEAR(found[2], 2.5, 1e-13) << method;
  }
}

TEST(UnknownGuards, BesideASingularPlaceTheyAreFoundAsElsewhere) {
  for (const char* method : methods) {
    const auto found = times(
        "unknown u = 0\nx' = 1\nx(0) = -1.03\n0 = x*u - x^2\nrun 0..2\n"
        "when u > 0.5 and u < 0.50001 { mark \"in\" }\n",
        method);
    ASSERT_EQ(found.size(), 1u) << method;
    EXPECT_NEAR(found[0], 1.53, 1e-13) << method;
  }
}

}  // namespace
}  // namespace continuo::model::unknown_guard_test
