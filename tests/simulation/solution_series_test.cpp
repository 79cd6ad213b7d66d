// The Taylor series of models' solutions: of random models against the tape on another kind of series in long double;
// runs by the method `taylor` against closed forms.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tests/language/check_helpers.hpp>
#include <tests/symbolic/native_referee.hpp>

#include <continuo/simulation/program/model_system.hpp>
#include <continuo/simulation/program/solution_series.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/symbolic/native/native_compiler.hpp>
#include <continuo/symbolic/tape/tape_run.hpp>

namespace continuo::model::solution_series_test {
namespace {

constexpr std::size_t order = 8;
using Referee = Taylor<long double, order>;

/// The series of the solution from x on: order^2 evaluations of the tape, each of which gives one coefficient more.
std::vector<Referee> slow_series(const ModelProgram& program, double t, const std::vector<double>& x) {
  const Tape& tape = *program.derivatives[0];
  std::vector<Referee> registers(tape.register_count()), rates(x.size()), states(x.begin(), x.end());
  const std::vector<double> variables = start_values(program.model);
  for (std::size_t i = 0; i < variables.size(); ++i) registers[i] = Referee(variables[i]);
  tape.prepare<Referee>(registers);
  for (std::size_t k = 0; k < order; ++k) {
    registers[Layout::time] = Referee(t, 1.0);
    std::ranges::copy(states, registers.begin() + program.model.layout.states);
    tape.evaluate<Referee>(std::span<Referee>(registers), std::span<Referee>(rates));
    for (std::size_t i = 0; i < x.size(); ++i) states[i].c[k + 1] = rates[i].c[k] / static_cast<long double>(k + 1);
  }
  return states;
}

std::vector<std::vector<double>> series_of(SolutionSeries& series, double t, const std::vector<double>& x,
                                           std::span<const std::size_t> held = {}) {
  std::vector<double> c((order + 1) * x.size());
  std::ranges::copy(x, c.begin());
  series.expand(t, 1, c, held);
  std::vector<std::vector<double>> rows;
  for (auto row = c.begin(); row != c.end(); row += static_cast<std::ptrdiff_t>(x.size()))
    rows.emplace_back(row, row + static_cast<std::ptrdiff_t>(x.size()));
  return rows;
}

/// Rounding counts as a part of the greatest coefficient: terms of that size cancel in others.
void expect_same(const ModelProgram& program, const std::string& text, double t, const std::vector<double>& x) {
  SolutionSeries series(program, program.model.modes[0].derivatives, start_values(program.model));
  const std::vector<std::vector<double>> found = series_of(series, t, x);
  const std::vector<Referee> expected = slow_series(program, t, x);
  long double greatest = 1;
  for (const Referee& one : expected)
    for (const long double c : one.c) greatest = std::max(greatest, std::abs(c));
  ASSERT_TRUE(std::isfinite(greatest)) << text;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t k = 0; k <= order; ++k) {
      ASSERT_NEAR(found[k][i], static_cast<double>(expected[i].c[k]), 1e-11 * static_cast<double>(greatest))
          << "state " << i << ", order " << k << '\n'
          << text;
    }
  }
}

/// Formulas of x, y, z and t of moderate size.
class RandomFormula {
 public:
  explicit RandomFormula(std::mt19937& engine) : engine_(engine) {}

  std::string operator()(int depth) {
    if (depth == 0) {
      constexpr std::array leaves{"x", "y", "z", "t", "a", "0.75", "1.5"};
      return leaves[static_cast<std::size_t>(pick(7))];
    }
    constexpr std::array patterns{"({0} + {1})",
                                  "({0} - {1})",
                                  "{0}*{1}",
                                  "{0}*{0}",
                                  "{0}/(2 + sin({1}))",
                                  "sin({0})",
                                  "cos({0})",
                                  "sin({0})*cos({0})",
                                  "atan({0})",
                                  "sqrt(1 + ({0})^2)",
                                  "exp(tanh({0}))",
                                  "log(2 + cos({0}))",
                                  "log10(3 + {0}^2)",
                                  "(1 + {0}^2)^a",
                                  "(2 + sin({0}))^cos({1})",
                                  "asin(0.8*sin({0}))",
                                  "acos(sin({0})/2)",
                                  "tan(sin({0}))",
                                  "sinh(sin({0}))",
                                  "cosh(sin({0}))",
                                  "hypot({0}, 1 + {1})",
                                  "{0}/hypot({1}, 1.5)^3",
                                  "(2 + {0})*(1.5 - {1})",
                                  "atan2({0}, 2)",
                                  "({0})^3",
                                  "1/(1 + ({0})^2)^2",
                                  "({0})^n",
                                  "abs({0})",
                                  "max({0}, {1})",
                                  "min({0}, {1})",
                                  "-({0})",
                                  "(if {0} < {1} then {0} else {1}*a)"};
    const auto pattern = patterns[static_cast<std::size_t>(pick(static_cast<int>(patterns.size())))];
    return fmt::format(fmt::runtime(pattern), (*this)(depth - 1), (*this)(depth - 1));
  }

 private:
  int pick(int n) { return std::uniform_int_distribution(0, n - 1)(engine_); }
  std::mt19937& engine_;
};

TEST(SolutionSeries, OfRandomModelsIsThatOfTheTape) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int compared = 0;
  for (int trial = 0; trial < 300; ++trial) {
    RandomFormula formula(random);
    const int depth = 1 + trial % 3;
    const std::string text =
        fmt::format("param a = 1.25, n = 3\nx' = {}\ny' = {}\nz' = {}\nx(0) = 0.3; y(0) = -0.2; z(0) = 0.5\nrun 0..1\n",
                    formula(depth), formula(depth), formula(depth));
    const auto program = compile(good(text));
    const std::vector<double> x{uniform(random), uniform(random), uniform(random)};
    const std::vector<Referee> expected = slow_series(*program, 0.4, x);
    const bool is_moderate = std::ranges::all_of(expected, [](const Referee& one) {
      return std::ranges::all_of(one.c, [](long double c) { return std::abs(c) < 1e6L; });
    });
    if (!is_moderate) continue;
    ++compared;
    ASSERT_NO_FATAL_FAILURE(expect_same(*program, text, 0.4, x));
  }
  EXPECT_GT(compared, 200);
}

// What a graph writes as products and roots of a sum is a power of it again.
TEST(SolutionSeries, OfPowersWithFractionsIsThatOfTheTape) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const char* rate :
       {"-x/hypot(x, y)^3", "x/hypot(x, hypot(y, z))^5 - y", "(x^2 + y^2)^1.5", "y/(1 + x^2)^2.5",
        "hypot(x, y)*(x^2 + y^2)", "sqrt(1 + x*y)*(1 + x*y)", "(2 + z)^1.5/(2 + z)^0.5",
        "z/sqrt(2 + x)^3 + sqrt(2 + x)", "hypot(x, y)^7*(x - y)", "1/hypot(y - x, z)^3 - 1/hypot(x - y, z)^3",
        "(1 + x^2)^1.5*(1 + x^2)^1.5", "(x^2 + 1)^2*hypot(x, 1)", "x/hypot(a, 2)^3", "hypot(x, y)/hypot(x, y)^3",
        "-(2 + x)^(-1.5)", "x^2*sqrt(x^2)*y"}) {
    const std::string text = fmt::format(
        "param a = 1.25\nx' = {}\ny' = x*z\nz' = {} + t\nx(0) = 1; y(0) = 1; z(0) = 1\nrun 0..1\n", rate, rate);
    const auto program = compile(good(text));
    const std::vector<double> x{1.2 + 0.2 * uniform(random), 0.9 * uniform(random) + 0.1, uniform(random)};
    ASSERT_NO_FATAL_FAILURE(expect_same(*program, text, 0.4, x));
  }
}

// A difference is written with its terms in the order of their first use, and negated for the other one.
constexpr std::array negated_differences{"x*(28 - z) - y",   "-(x - y)",         "(y - x)*(x - y) + z",
                                         "-(z - x*y) - 2*z", "(x - 2)*(2 - x)",  "-(a - x)*z - (y - 1)*x",
                                         "-(x - a)*(y - x)", "z - t + (t - z)*x"};

TEST(SolutionSeries, OfNegatedDifferencesIsThatOfTheTape) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const char* first : negated_differences) {
    for (const char* second : negated_differences) {
      const std::string text = fmt::format(
          "param a = 1.25\nz' = {}\ny' = {}\nx' = y - x\nx(0) = 1; y(0) = 1; z(0) = 1\nrun 0..1\n", first, second);
      const auto program = compile(good(text));
      const std::vector<double> x{uniform(random), uniform(random), uniform(random)};
      ASSERT_NO_FATAL_FAILURE(expect_same(*program, text, 0.4, x));
    }
  }
}

// The equations are written once for all runs, which have exponents of their own.
TEST(SolutionSeries, OfOneProgramHaveTheirOwnNumbers) {
  const std::string text = "param k = 2, n = 3\nx' = k*x^n\nx(0) = 1\nrun 0..1\n";
  const auto program = compile(good(text));
  const std::vector<double> start = start_values(program->model);
  const auto variable_of = [&](std::size_t i) {
    return program->model.layout.parameters + static_cast<std::uint32_t>(i);
  };
  SolutionSeries one(*program, program->model.modes[0].derivatives, start), other = one;
  other.set(variable_of(0), 0.5);
  other.set(variable_of(1), 2);
  for (int turn = 0; turn < 2; ++turn) {
    EXPECT_DOUBLE_EQ(series_of(one, 0, {2})[2][0], 2 * 3 * 4 * 2 * 8 / 2.0);  // k n x^(n - 1) x' / 2
    EXPECT_DOUBLE_EQ(series_of(other, 0, {2})[2][0], 0.5 * 2 * 2 * 0.5 * 4 / 2.0);
  }
}

// Members of families are computed together.
TEST(SolutionSeries, OfFamiliesIsThatOfTheTape) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0.2, 1);
  for (const char* rate :
       {"u[i]*v[i] - sin(u[i])", "(u[i-1] - 2*u[i] + u[i+1])*exp(-v[i])", "u[i]^1.5/(1 + v[i+1]^2)",
        "i/4*cos(u[i])*sin(u[i]) + sqrt(v[i])", "max(u[i], v[i])*u[N+1-i]", "hypot(u[i], v[N+1-i])"}) {
    const std::string text = fmt::format(
        "param N = 20\nfor i in 1..N {{ u[i](0) = 1; v[i](0) = 1; v[i]' = u[i]*v[i] "
        "}}\n"
        "for i in 2..N-1 {{ u[i]' = {} }}\nu[1]' = 1 + u[2]; u[N]' = u[1]*u[N]\nrun 0..1\n",
        rate);
    const auto program = compile(good(text));
    std::vector<double> x(program->model.states.size());
    for (double& each : x) each = uniform(random);
    ASSERT_NO_FATAL_FAILURE(expect_same(*program, text, 0, x));
  }
}

// x' = k*x^n: the whole program changes with n.
TEST(SolutionSeries, FollowsParametersAndHeldStates) {
  const auto program = compile(good("param k = 2, n = 2\nx' = k*x^n\ny' = x\nx(0) = 1; y(0) = 0\nrun 0..1\n"));
  SolutionSeries series(*program, program->model.modes[0].derivatives, start_values(program->model));
  EXPECT_EQ(series_of(series, 0, {1, 0})[2][0], 4);  // 1/(1 - 2 s) = 1 + 2 s + 4 s^2
  series.set(program->model.layout.parameters, 3);
  EXPECT_EQ(series_of(series, 0, {1, 0})[2][0], 9);
  SolutionSeries copy = series;
  series.set(program->model.layout.parameters + 1, -1);
  EXPECT_EQ(series_of(series, 0, {1, 0})[2][0], -4.5);  // sqrt(1 + 6 s) = 1 + 3 s - 4.5 s^2
  series.set(program->model.layout.parameters + 1, 0.5);
  EXPECT_EQ(series_of(series, 0, {1, 0})[2][0], 2.25);  // (1 + 3/2 s)^2
  EXPECT_EQ(series_of(copy, 0, {1, 0})[2][0], 9);
  const std::vector<std::size_t> held{0};
  const auto still = series_of(series, 0, {1, 0}, held);
  EXPECT_EQ(still[1][0], 0);
  EXPECT_EQ(still[1][1], 1);
  EXPECT_EQ(still[2][1], 0);
}

// The series that the system gives is that of the held branch of a switch, on either side.
TEST(SolutionSeries, FollowsSwitches) {
  const auto program = compile(good("x' = v\nv' = -sign(x)\nx(0) = 1; v(0) = 0\nrun 0..1\n"));
  ModelSystem system(program, start_values(program->model));
  for (const double x : {1.0, -1.0}) {
    system.hold_switches(0, {x, 0});
    std::vector<double> c{x, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(system.taylor_coefficients(0, 1, c), "");
    EXPECT_EQ(c[3], -x);
    EXPECT_EQ(c[4], -x / 2);
    EXPECT_FALSE(system.has_corners());
  }
}

// ---- machine code -------------------------------------------------------------------------------------------------

/// The coefficients by machine code against those by the program, to the bit, at the start and elsewhere. Whether there
/// was machine code.
void expect_same_bits(const Model& model, const std::shared_ptr<NativeCompiler>& native, std::size_t highest,
                      std::mt19937& random) {
  std::normal_distribution<double> normal;
  Model with_native = model;
  with_native.native = native;
  const auto interpreted = compile(model), compiled = compile(std::move(with_native));
  const std::vector<double> start = start_values(interpreted->model);
  SolutionSeries expected(*interpreted, interpreted->model.modes[0].derivatives, start);
  SolutionSeries found(*compiled, compiled->model.modes[0].derivatives, start);
  std::vector<double> x(interpreted->model.states.size());
  std::copy_n(start.begin() + interpreted->model.layout.states, x.size(), x.begin());
  const std::size_t functions = native->report().compiled;
  for (int place = 0; place < 3; ++place) {
    std::vector<double> a((highest + 1) * x.size()), b = a;
    std::ranges::copy(x, a.begin());
    std::ranges::copy(x, b.begin());
    expected.expand(0.3 * place, 0.1, a);
    found.expand(0.3 * place, 0.1, b);
    for (std::size_t n = 0; n < a.size(); ++n) {
      if (std::isnan(a[n]) && std::isnan(b[n])) continue;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(b[n]), std::bit_cast<std::uint64_t>(a[n]))
          << b[n] << ", not " << a[n] << ", of " << model.states[n % x.size()].column << ", order " << n / x.size()
          << " of " << highest;
    }
    for (double& value : x) value += 0.1 * normal(random) * (1 + std::abs(value));
  }
  EXPECT_EQ(native->report().compiled, functions + 1) << native->report().trouble;
}

TEST(NativeSeries, OfRandomModelsHasTheBitsOfTheProgram) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  std::mt19937 random(8);
  for (const std::size_t highest : {1U, 4U, 20U}) {
    RandomFormula formula(random);
    std::string text = "param a = 1.25, n = 3\nrun 0..1\n";
    std::vector<std::string> names{"x", "y", "z"};
    for (int i = 0; i < 5; ++i) names.push_back(fmt::format("w{}", i));
    for (std::size_t i = 0; i < names.size(); ++i) {
      text += fmt::format("{}' = {}\n{}(0) = {}\n", names[i], formula(1 + static_cast<int>(i) % 3), names[i],
                          0.3 + 0.1 * static_cast<double>(i % 4));
    }
    SCOPED_TRACE(text);
    ASSERT_NO_FATAL_FAILURE(expect_same_bits(good(text), native, highest, random));
  }
}

TEST(NativeSeries, OfNegatedDifferencesHasTheBitsOfTheProgram) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  std::mt19937 random(11);
  std::string text = "param a = 1.25\ny' = x - y\nz' = x*y - z\nx(0) = 0.5; y(0) = 0.25; z(0) = 1\nrun 0..1\n";
  std::string sum;
  for (std::size_t i = 0; i < negated_differences.size(); ++i) {
    text += fmt::format("w{}' = {}\nw{}(0) = 0.1\n", i, negated_differences[i], i);
    sum += fmt::format(" - ({})*w{}", negated_differences[i], i);
  }
  text += "x' = y" + sum + "\n";
  ASSERT_NO_FATAL_FAILURE(expect_same_bits(good(text), native, 20, random)) << text;
}

TEST(NativeSeries, OfFamiliesHasTheBitsOfTheProgram) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  std::mt19937 random(9);
  std::size_t highest = 2;
  for (const char* rate :
       {"(u[i-1] - 2*u[i] + u[i+1])*exp(-v[i]) + cos(u[i])*tanh(v[i])",
        "u[i]^1.5/(1 + v[i+1]^2) + sqrt(v[i])*atan2(u[i], v[i])", "max(u[i], v[i])*u[N+1-i] + hypot(u[i], v[N+1-i])"}) {
    const std::string text = fmt::format(
        "param N = {}\nfor i in 1..N {{ u[i](0) = 0.5 + i/N; v[i](0) = 1; v[i]' = u[i]*v[i] }}\n"
        "for i in 2..N-1 {{ u[i]' = {} }}\nu[1]' = 1 + u[2]; u[N]' = u[1]*u[N]\nrun 0..1\n",
        17 + highest, rate);
    ASSERT_NO_FATAL_FAILURE(expect_same_bits(good(text), native, highest, random)) << text;
    highest += 6;
  }
}

TEST(NativeSeries, OfTheGalleryHasTheBitsOfTheProgram) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  std::mt19937 random(10);
  for (const char* name : {"kepler", "outer_planets", "brusselator_line"}) {
    const Loaded loaded = load((std::filesystem::path(CONTINUO_SOURCE_DIR) / "models" / name).string() + ".sim");
    ASSERT_TRUE(loaded) << name;
    ASSERT_NO_FATAL_FAILURE(expect_same_bits(*loaded.model, native, 9, random)) << name;
  }
}

// A run begins with the program and goes on with machine code. Equal models share it.
TEST(NativeSeries, TakesOverDuringARunAndIsShared) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::automatic, folder.path / "cache"});
  Model model = good("x' = y\ny' = -sin(x)\nx(0) = 1; y(0) = 0\nrun 0..1\n");
  model.native = native;
  const auto program = compile(std::move(model));
  const std::vector<double> start = start_values(program->model);
  SolutionSeries one(*program, program->model.modes[0].derivatives, start);
  std::vector<double> first(36), now;
  first[0] = 1;
  now = first;
  one.expand(0, 1, first);
  for (int i = 0; i < 2'000'000 && native->report().compiled == 0; ++i) one.expand(0, 1, now);
  ASSERT_EQ(native->report().compiled, 1U) << native->report().trouble;
  one.expand(0, 1, now);
  EXPECT_EQ(now, first);
  SolutionSeries other(*program, program->model.modes[0].derivatives, start);
  other.expand(0, 1, now);
  EXPECT_EQ(now, first);
  EXPECT_EQ(native->report().loaded, 0U);
}

// ---- runs ---------------------------------------------------------------------------------------------------------

Run run_of(const std::string& text, double tolerance, const std::string& method = "taylor") {
  const Loaded loaded = load_text(text);
  EXPECT_TRUE(loaded) << loaded.text();
  Experiment experiment{.method = method, .rtol = tolerance, .atol = {tolerance}};
  Simulated simulated = simulate(*loaded.model, experiment);
  EXPECT_TRUE(simulated.run) << render(simulated.diagnostics, loaded.source);
  return simulated.run ? std::move(*simulated.run) : Run{};
}

TEST(TaylorOfModels, MeetsStrictTolerances) {
  for (const double tolerance : {1e-6, 1e-9, 1e-12, 1e-14}) {
    const auto run = run_of("x'' = -x\nx(0) = 1; x'(0) = 0\nrun 0..50\n", tolerance);
    ASSERT_TRUE(run.outcome) << describe(run.outcome);
    EXPECT_NEAR(run.final_state()[0], std::cos(50), 50 * tolerance) << tolerance;
  }
}

// Landing n at t_1 + 2 v/g (e + ... + e^(n - 1)), of a ball that is dropped from h = 1 with e = 0.8.
TEST(TaylorOfModels, LocatesLandings) {
  const auto run =
      run_of("h'' = -9.81\nh(0) = 1; h'(0) = 0\nwhen h falls through 0 { h' := -0.8*h' }\nrun 0..3\n", 1e-12);
  ASSERT_TRUE(run.outcome) << describe(run.outcome);
  double t = std::sqrt(2 / 9.81), v = 9.81 * t;
  ASSERT_GE(run.events.size(), 6U);
  for (std::size_t n = 0; n < 6; ++n) {
    EXPECT_NEAR(run.events[n].t, t, 1e-11) << n;
    v *= 0.8;
    t += 2 * v / 9.81;
  }
}

// A polynomial of degree 6 in t with known roots, as a guard of a state.
TEST(TaylorOfModels, MissesNoRootOfRandomPolynomials) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(0.05, 0.95);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<double> roots(6);
    for (double& root : roots) root = uniform(random);
    std::ranges::sort(roots);
    std::string product = "1";
    for (const double root : roots) product += fmt::format("*(x - ({:.17g}))", root);
    const auto run = run_of(fmt::format("x' = 1 + 0*x\nx(0) = 0\nwhen {0} rises through 0 {{ mark \"up\" }}\n"
                                        "when {0} falls through 0 {{ mark \"down\" }}\nrun 0..1\n",
                                        product),
                            1e-12);
    ASSERT_TRUE(run.outcome) << describe(run.outcome);
    ASSERT_EQ(run.events.size(), 6U) << product;
    for (std::size_t n = 0; n < 6; ++n) EXPECT_NEAR(run.events[n].t, roots[n], 1e-9) << product;
  }
}

// Coulomb's friction, x' = -sign(x)(...): it comes to rest at t = 1 and slides along x = 0, of which there is no
// series.
TEST(TaylorOfModels, RefusesToSlide) {
  const auto run = run_of("v' = -sign(v)\nv(0) = 1\nrun 0..2\n", 1e-9);
  EXPECT_EQ(run.outcome.ending, Ending::nonlinear_solve_failed);
  EXPECT_NEAR(run.outcome.t, 1, 1e-9);
  EXPECT_NE(run.outcome.hint.find("slides along a surface"), std::string::npos) << run.outcome.hint;
}

// What is within `smooth`, and a table over time: nothing shows there beforehand.
TEST(TaylorOfModels, FindsCornersThatAreNoSwitches) {
  const auto run = run_of("x' = smooth(abs(t - 0.3))\nx(0) = 0\nrun 0..1\n", 1e-9);
  ASSERT_TRUE(run.outcome) << describe(run.outcome);
  EXPECT_NEAR(run.final_state()[0], (0.09 + 0.49) / 2, 1e-7);
  Model model = good("input u = 0\nx' = u\nx(0) = 0\nrun 0..3\n");
  model.inputs[0].points = Table({0, 1, 2}, {0, 2, -4}, Table::Between::linear);
  const Simulated simulated = simulate(compile(std::move(model)), {.method = "taylor", .rtol = 1e-10, .atol = {1e-10}});
  ASSERT_TRUE(simulated.run && simulated.run->outcome);
  EXPECT_NEAR(simulated.run->final_state()[0], 1 - 1 - 4, 1e-8);
}

TEST(TaylorOfModels, RefusesAlgebraicEquations) {
  const Loaded loaded = load_text("x' = -z\nunknown z = 1\n0 = z - x\nx(0) = 1\nrun 0..1 method taylor\n");
  EXPECT_FALSE(loaded && simulate(*loaded.model).run);
}

// At a tolerance, the error after a thousand years is about that of other methods.
TEST(TaylorOfModels, IsAsExactAsOtherMethodsOverALongRun) {
  const Loaded loaded = load((std::filesystem::path(CONTINUO_SOURCE_DIR) / "models/outer_planets.sim").string());
  ASSERT_TRUE(loaded);
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    const auto error = [&](const char* method) {
      const Simulated simulated =
          simulate(*loaded.model, {.method = method, .rtol = tolerance, .atol = {tolerance}, .keep_rows = false});
      const auto x = simulated.run->final_state();
      return std::hypot(x[6] - 6.88878506245507991, x[8] + 2.54066260570324595, x[10] + 1.26415971758173095);
    };
    EXPECT_LT(error("taylor"), 5 * error("dop853")) << tolerance;
  }
}

// What begins as a power with a fraction has no series there. A whole power of it has.
TEST(TaylorOfModels, SaysWhereThereIsNoSeries) {
  for (const char* rate : {"1 + t^1.5", "1 + sqrt(t)", "2 - (x - 1)^0.75", "1 + abs(t*sqrt(t))"}) {
    const auto run = run_of(fmt::format("x' = {}\nx(0) = 1\nrun 0..1\n", rate), 1e-9);
    EXPECT_EQ(run.outcome.ending, Ending::nonlinear_solve_failed) << rate;
    EXPECT_NE(run.outcome.hint.find("no Taylor series"), std::string::npos) << rate << run.outcome.hint;
  }
  for (const char* rate : {"t^3", "(t^2)^1.5", "sqrt(t^2)", "(t^4)^0.75"}) {
    const auto run = run_of(fmt::format("x' = 4*{}\nx(0) = 0\nrun 0..1\n", rate), 1e-9);
    ASSERT_TRUE(run.outcome) << rate << describe(run.outcome);
    // Steps that are long against t amplify rounding.
    EXPECT_NEAR(run.final_state()[0], rate == std::string("sqrt(t^2)") ? 2 : 1, 1e-7) << rate;
  }
}

TEST(TaylorOfModels, TakesWhatIsAPolynomialAndWhatStandsStill) {
  const auto run = run_of("x' = 0\ny' = 3*t^2\nz' = 1\nx(0) = 2; y(0) = 0; z(0) = 0\nrun 0..10\n", 1e-12);
  ASSERT_TRUE(run.outcome) << describe(run.outcome);
  EXPECT_EQ(run.final_state()[0], 2);
  EXPECT_NEAR(run.final_state()[1], 1000, 1e-9);
  EXPECT_NEAR(run.final_state()[2], 10, 1e-12);
  const auto still = run_of("x' = 0\nx(0) = 2\nrun 0..1e6\n", 1e-12);
  ASSERT_TRUE(still.outcome) << describe(still.outcome);
  EXPECT_EQ(still.final_state()[0], 2);
}

// A fixed step has order 8.
TEST(TaylorOfModels, TakesStepsOfAFixedSize) {
  const auto error = [](double step) {
    const Loaded loaded = load_text("x' = x*(1 - x)\nx(0) = 0.125\nrun 0..8\n");
    const Simulated simulated = simulate(*loaded.model, {.method = "taylor", .step = step});
    return std::abs(simulated.run->final_state()[0] - 1 / (1 + 7 * std::exp(-8.0)));
  };
  EXPECT_NEAR(std::log2(error(0.5) / error(0.25)), 8, 0.7);
}

}  // namespace
}  // namespace continuo::model::solution_series_test
