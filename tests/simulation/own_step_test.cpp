// Steps of explicit Runge-Kutta methods in machine code: every number as of the step that calls f, and whole runs.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tests/symbolic/native_referee.hpp>

#include <continuo/language/load.hpp>
#include <continuo/methods/explicit_rk/bogacki_shampine3.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/dormand_prince5.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/explicit_rk/verner7.hpp>
#include <continuo/methods/explicit_rk/verner9.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/symbolic/native/native_compiler.hpp>

namespace continuo::model::own_step_test {
namespace {

namespace fs = std::filesystem;
using X = ModelSystem::X;
/// Those of few stages come first: they are compiled in the shortest time.
using Methods = std::tuple<BogackiShampine3, Rk4, Tsitouras5, DormandPrince5, Dop853, Verner7, Verner9>;
constexpr std::size_t few_stages = 4;

/// The same system without steps of its own.
struct Plain {
  ModelSystem& system;
  void operator()(double t, const X& x, X& dxdt) { system(t, x, dxdt); }
};

void expect_the_same(const X& actual, const X& expected, const std::string& what) {
  ASSERT_EQ(actual.size(), expected.size()) << what;
  for (std::size_t i = 0; i < expected.size(); ++i)
    ASSERT_EQ(bits(actual[i]), bits(expected[i]))
        << what << ", component " << i << ": " << actual[i] << ", not " << expected[i];
}

/// A step from the same place by both, of everything that the next one, the controller and the dense output read.
template <class M>
class Pair {
 public:
  Pair(ModelSystem& own, ModelSystem& plain, const X& x)
      : own_(own), plain_{plain}, own_work_(M::workspace(x)), plain_work_(M::workspace(x)), own_end_(x), end_(x) {}

  void expect_the_same_step(double t, const X& x, double h, bool discontinuity, const Tolerance<double>& tolerance,
                            const std::string& what) {
    M::set_tolerance(own_work_, tolerance);
    const int expected = M::step(plain_, t, x, h, discontinuity, plain_work_, end_);
    EXPECT_EQ(M::step(own_, t, x, h, discontinuity, own_work_, own_end_), expected) << what;
    expect_the_same(own_end_, end_, what + ", end");
    for (std::size_t j = 0; j < M::tableau.stages; ++j)
      expect_the_same(own_work_.k[j], plain_work_.k[j], fmt::format("{}, stage {}", what, j));
    EXPECT_EQ(own_work_.start_fresh, plain_work_.start_fresh);
    EXPECT_EQ(own_work_.end_fresh, plain_work_.end_fresh);
    if constexpr (M::error_order > 0) {
      EXPECT_EQ(bits(own_work_.own.square), bits(M::error_square(plain_work_, h, x, end_, tolerance))) << what;
      EXPECT_EQ(own_work_.own.has_square, true) << what;
    }
    M::accept(own_work_);
    M::accept(plain_work_);
  }
  [[nodiscard]] const X& end() const { return end_; }

 private:
  ModelSystem& own_;
  Plain plain_;
  typename M::template Workspace<X> own_work_, plain_work_;
  X own_end_, end_;
};

/// Three steps, each from the end of the last where that is finite, and one after a jump of the state.
template <class M>
void expect_the_same_steps(const ModelProgram& compiled, ModelSystem& own, ModelSystem& plain, const X& start,
                           std::mt19937& random, const std::string& what) {
  ASSERT_NE(compiled.step_code(own.mode(), step_formula_of<M>)->code(), nullptr) << what;
  std::normal_distribution<double> normal;
  const auto near = [&](X x) {
    for (double& value : x) value += 0.1 * normal(random) * (1 + std::abs(value));
    return x;
  };
  Pair<M> pair(own, plain, start);
  const X rtol_each(start.size(), 1e-5), atol_each(start.size(), 1e-3);
  X x = near(start);
  double t = normal(random);
  for (int i = 0; i < 4; ++i) {
    const bool jump = i == 3;
    if (jump) x = near(start);
    const double h = 0.01 * normal(random);
    const Tolerance<double> one{.rtol = 1e-6, .atol = 1e-9}, each{0, 0, rtol_each.data(), atol_each.data()};
    pair.expect_the_same_step(t, x, h, jump || i == 0, i % 2 == 0 ? one : each,
                              fmt::format("{} by {}, step {}", what, M::name, i));
    x = pair.end();
    t += h;
  }
}

/// By method number `number` of them all.
void expect_the_same_steps(std::size_t number, const Model& model, const std::shared_ptr<NativeCompiler>& native,
                           std::mt19937& random, const std::string& what) {
  Model with_compiler = model;
  with_compiler.native = native;
  const auto compiled = compile(with_compiler), interpreted = compile(model);
  const std::vector<double> variables = start_values(model);
  const auto begin = variables.begin() + model.layout.states;
  const X start(begin, begin + static_cast<std::ptrdiff_t>(model.states.size()));
  ModelSystem own(compiled, variables), plain(interpreted, variables);
  for (std::size_t mode = 0; mode < model.modes.size(); ++mode) {
    own.go(mode);
    plain.go(mode);
    [&]<std::size_t... m>(std::index_sequence<m...>) {
      ((m == number % sizeof...(m)
            ? expect_the_same_steps<std::tuple_element_t<m, Methods>>(*compiled, own, plain, start, random, what)
            : void()),
       ...);
    }(std::make_index_sequence<std::tuple_size_v<Methods>>());
  }
}

TEST(OwnStep, HasTheBitsOfTheStepThatCallsF) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  std::mt19937 random(11);
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(CONTINUO_SOURCE_DIR) / "models"))
    if (entry.path().extension() == ".sim") files.push_back(entry.path());
  std::ranges::sort(files);
  std::size_t models = 0;
  for (const fs::path& file : files) {
    const Loaded loaded = load(file.string());
    ASSERT_TRUE(loaded) << file;
    const Model& model = *loaded.model;
    if (model.has_world() || model.needs_dae_solver() || model.states.empty() || model.states.size() > 6) continue;
    expect_the_same_steps(models++ % few_stages, model, native, random, file.string());
  }
  EXPECT_GT(models, 15U);
  EXPECT_EQ(native->report().trouble, "");
}

/// An expression of the states, the parameter and the time; some of them are not finite at some places.
std::string random_expression(std::size_t states, int depth, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  if (depth == 0) {
    const std::size_t which = below(states + 3);
    if (which == states) return "t";
    if (which == states + 1) return "p";
    if (which == states + 2) return fmt::format("{:.3f}", 0.1 * static_cast<double>(1 + below(30)));
    return fmt::format("x{}", which + 1);
  }
  const auto part = [&] { return random_expression(states, depth - 1, random); };
  constexpr std::array forms{"({} + {})",     "({} - {})",     "{}*{}",      "({})/(2 + ({})^2)",
                             "min({}, {})",   "hypot({}, {})", "sin({})*{}", "exp(-abs({}))*({})",
                             "sqrt({}) - {}", "log({}) + {}"};
  return fmt::format(fmt::runtime(forms[below(forms.size())]), part(), part());
}

TEST(OwnStep, OfRandomModelsHasTheBitsOfTheStepThatCallsF) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  std::mt19937 random(5);
  for (std::size_t number = 0; number < std::tuple_size_v<Methods>; ++number) {
    const std::size_t states = 12 - number;  // more than eight are loops
    std::string text = "model Any\nparam p = 0.7\n";
    for (std::size_t i = 1; i <= states; ++i)
      text += fmt::format("x{0}' = {1}\nx{0}(0) = {2}\n", i, random_expression(states, states > 8 ? 2 : 3, random),
                          0.3 + 0.1 * static_cast<double>(i));
    const Loaded loaded = load(Source("any.sim", text + "run 0..1\n"));
    ASSERT_TRUE(loaded) << text << loaded.text();
    expect_the_same_steps(number, *loaded.model, native, random, text);
  }
  EXPECT_EQ(native->report().trouble, "");
}

/// Everything that a run says, with and without machine code.
void expect_the_same_run(const std::string& text, const std::string& method,
                         const std::shared_ptr<NativeCompiler>& native) {
  Loaded loaded = load(Source("any.sim", text));
  ASSERT_TRUE(loaded) << loaded.text();
  const Experiment experiment{.method = method};
  const Simulated plain = simulate(*loaded.model, experiment);
  loaded.model->native = native;
  const Simulated own = simulate(*loaded.model, experiment);
  ASSERT_TRUE(plain.run && own.run) << text;
  expect_the_same(own.run->motion.values, plain.run->motion.values, text);
  EXPECT_EQ(own.run->outcome.ending, plain.run->outcome.ending);
  EXPECT_EQ(own.run->outcome.hint, plain.run->outcome.hint);
  EXPECT_EQ(own.run->outcome.component, plain.run->outcome.component);
  ASSERT_EQ(own.run->events.size(), plain.run->events.size());
  for (std::size_t i = 0; i < plain.run->events.size(); ++i)
    EXPECT_EQ(bits(own.run->events[i].t), bits(plain.run->events[i].t)) << text;
  EXPECT_EQ(own.run->statistics.evaluations, plain.run->statistics.evaluations) << text;
  EXPECT_EQ(own.run->statistics.steps, plain.run->statistics.steps);
  EXPECT_EQ(own.run->statistics.rejected, plain.run->statistics.rejected);
}

TEST(OwnStep, RunsWithEventsJumpsAndFailuresAreTheSame) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  const std::string bouncing =
      "model Ball\nmode flight { h'' = -9.8 }\nmode rest { h'' = 0 }\nh(0) = 10; h'(0) = 0\n"
      "when h falls through 0 in flight { h := 0\n if -0.7*h' > 0.1 { h' := -0.7*h' } else { h' := 0; go rest } }\n"
      "run 0..12 output 0.1 tol 1e-8\n";
  const std::string relay =
      "model Relay\nx'' = -x - 0.2*x' + (if x > 0.1 then -1 else 1)\nx(0) = 1; x'(0) = 0\nrun 0..20 tol 1e-8\n";
  const std::string pole = "model Pole\nx' = 1 + x^2\nx(0) = 0\nrun 0..3 tol 1e-8\n";
  const std::string root = "model Root\nx' = -sqrt(x) - 0.1\nx(0) = 1\nrun 0..3 tol 1e-8\n";
  const std::string stiff =
      "model Stiff\nx' = v; v' = 300*(1 - x^2)*v - x\nx(0) = 2; v(0) = 0\nrun 0..300 output 10 tol 1e-6\n";
  for (const std::string& text : {bouncing, relay, pole, root})
    for (const char* method : {"dop853", "tsitouras5", "dop853_radau"}) expect_the_same_run(text, method, native);
  expect_the_same_run(stiff, "tsitouras5_rodas5p", native);
  EXPECT_EQ(native->report().trouble, "");
}

/// Where rows are far apart, and no guard is watched, nobody sees most steps: one call takes many of them.
TEST(OwnStep, ManyStepsAtOnceAreTheSameRun) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  std::mt19937 random(3);
  std::string any = "model Any\nparam p = 0.7\n";
  for (int i = 1; i <= 4; ++i)
    any += fmt::format("x{0}' = -x{0} + {1}\nx{0}(0) = 0.{0}\n", i, random_expression(4, 2, random));
  const std::string forced =
      "model Forced\nx' = y; y' = -sin(x) - 0.1*y + cos(1.7*t)\nx(0) = 1; y(0) = 0\n"
      "at 3.3 { mark \"seen\" }\nat 7.1 { y := y + 0.5 }\nrun 0..40 output 9 tol 1e-8\n";
  const std::string pole = "model Pole\nx' = 1 + x^2\nx(0) = 0\nrun 0..3 output 0.9 tol 1e-8\n";
  const std::string many =
      "model Many\nx' = 40*y; y' = -40*x\nx(0) = 1; y(0) = 0\nrun 0..1000 output 100 tol 1e-7 max steps 3000\n";
  const std::string limited =
      "model Limited\nx' = y; y' = -x\nx(0) = 1; y(0) = 0\nrun 0..30 output 7 tol 1e-5 max step 0.02\n";
  const std::string stiff = "model Stiff\nx' = 50*(cos(t) - x)\nx(0) = 0\nrun 0..200 output 50 tol 1e-4\n";
  const std::string line =
      "model Line\nparam k = 3\nfor i in 1..30 { u[i](0) = sin(i) }\n"
      "for i in 2..29 { u[i]' = k*(u[i-1] - 2*u[i] + u[i+1]) + exp(-u[i]^2)*cos(t) }\n"
      "u[1]' = -u[1]\nu[30]' = sin(u[29])\nrun 0..20 output 6 tol 1e-6\n";
  for (const std::string& text : {any + "run 0..30 output 8 tol 1e-7\n", forced, pole, many, limited, stiff, line})
    for (const char* method : {"dop853", "tsitouras5"}) expect_the_same_run(text, method, native);
  EXPECT_EQ(native->report().trouble, "");
}

TEST(OwnStep, IsNotTakenWhereStatesAreHeldOrThereIsNoCompiler) {
  const TestFolder folder;
  Loaded loaded = load(Source("any.sim", "model Any\nx' = y; y' = -x\nx(0) = 1; y(0) = 0\nrun 0..1\n"));
  ASSERT_TRUE(loaded);
  auto work = Rk4::workspace(X{1, 0});
  X end(2);
  ModelSystem without(compile(*loaded.model), start_values(*loaded.model));
  EXPECT_FALSE(without.take_step<Rk4>(0, {1, 0}, 0.1, work, end));
  loaded.model->native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  ModelSystem with(compile(*loaded.model), start_values(*loaded.model));
  EXPECT_TRUE(with.take_step<Rk4>(0, {1, 0}, 0.1, work, end));
  with.hold({0});
  EXPECT_FALSE(with.take_step<Rk4>(0, {1, 0}, 0.1, work, end));
}

}  // namespace
}  // namespace continuo::model::own_step_test
