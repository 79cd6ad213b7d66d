// What it costs to type a model instead of compiling it: the same equations on the tape, as machine code made of the
// tape, and written by hand in C++ with states of run-time and of fixed size, through the same solver.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <bench/problems/kepler.hpp>
#include <bench/problems/lorenz.hpp>
#include <bench/problems/outer_planets.hpp>
#include <bench/problems/pleiades.hpp>
#include <bench/problems/pollution.hpp>
#include <bench/processor_time.hpp>
#include <bench/stiff/brusselator_sparse.hpp>

#include <continuo/language/load.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/simulation/native.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::bench {
namespace {

using X = std::vector<double>;
constexpr double tolerance = 1e-9;

/// A problem for states of run-time size, as a model has them.
template <class Problem>
struct OfRunTimeSize {
  Problem problem{};
  std::array<double, Problem::size> x{}, derivative{};

  void operator()(double t, const X& from, X& dxdt) {
    std::copy_n(from.data(), x.size(), x.data());
    problem(t, x, derivative);
    std::copy_n(derivative.data(), x.size(), dxdt.data());
  }
};
template <>
struct OfRunTimeSize<Pollution<>> : Pollution<> {};  // it is one for states of any kind

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A model, and where its states stand for one who orders them otherwise.
struct Typed {
  std::optional<model::ModelSystem> tape, native;
  X start;
};

/// `columns`: the states of the model in the order of `start`.
Typed typed_system(const model::Source& source, const std::vector<std::string>& columns, const X& start) {
  model::Loaded loaded = model::load(source);
  if (!loaded.model) {
    std::fputs(loaded.text().c_str(), stderr);
    return {};
  }
  model::Model& model = *loaded.model;
  Typed typed;
  for (const auto& state : model.states) {
    const auto place = std::ranges::find(columns, state.column) - columns.begin();
    typed.start.push_back(start.at(static_cast<std::size_t>(place)));
  }
  typed.tape.emplace(model::compile(model), model::start_values(model));
  model.native = std::make_shared<model::NativeCompiler>(model::NativeOptions{.use = model::NativeUse::always});
  typed.native.emplace(model::compile(model), model::start_values(model));
  // Here they differentiate and compile, which a long run does not notice.
  for (auto* system : {&typed.tape, &typed.native}) {
    (void)(*system)->jacobian_pattern();
    std::vector<double> values((*system)->jacobian_pattern().entries());
    (*system)->jacobian_values(0, typed.start, values);
  }
  return typed;
}

struct Case {
  const char* title;
  std::string file;
  std::vector<std::string> columns;
  double duration;
};

template <class Method, class System, class State>
double seconds_of(const System& system, const State& start, double duration) {
  const Options<State> options{.rtol = tolerance, .atol = tolerance, .save = Save<State>::only_end()};
  const double begin = processor_seconds();
  const auto solution = solve(system, start, {0, duration}, Method{}, options);
  const double seconds = processor_seconds() - begin;
  return solution.outcome ? seconds : std::numeric_limits<double>::infinity();
}

/// The least times of the four, taken in turn so that all suffer the same of other work on the machine.
template <class Method, class Problem, class System>
void race(const Case& one, const Typed& typed, const System& dynamic, const X& dynamic_start) {
  if (!typed.tape) return;
  double tape = std::numeric_limits<double>::infinity(), native = tape, by_hand = tape, fixed = tape;
  const double end = processor_seconds() + 2;
  for (int repeat = 0; repeat < 3 || processor_seconds() < end; ++repeat) {
    tape = std::min(tape, seconds_of<Method>(*typed.tape, typed.start, one.duration));
    native = std::min(native, seconds_of<Method>(*typed.native, typed.start, one.duration));
    by_hand = std::min(by_hand, seconds_of<Method>(dynamic, dynamic_start, one.duration));
    if constexpr (requires { Problem::size; })
      fixed = std::min(fixed, seconds_of<Method>(Problem{}, Problem::start(), one.duration));
  }
  std::printf("| %s | %zu | %s | %.2f | %.2f | %.2f | ", one.title, typed.start.size(), Method::name.data(), 1e3 * tape,
              1e3 * native, 1e3 * by_hand);
  std::printf(std::isfinite(fixed) ? "%.2f" : "", 1e3 * fixed);
  std::printf(" | **%.2f** | ", native / by_hand);
  std::printf(std::isfinite(fixed) ? "%.2f |\n" : "|\n", native / fixed);
}

template <class Method, class Problem>
void compare(const Case& one) {
  const auto start = Problem::start();
  const X dynamic_start(start.begin(), start.end());
  race<Method, Problem>(one, typed_system(model::Source(one.file, text_of(one.file)), one.columns, dynamic_start),
                        OfRunTimeSize<Problem>{}, dynamic_start);
}

/// The Brusselator has a sparse Jacobian on both sides.
template <class Method>
void compare_brusselator(Case one, std::size_t points) {
  const SparseBrusselator system(points);
  std::string text = text_of(one.file);
  const std::string written = "N = 20";
  text.replace(text.find(written), written.size(), "N = " + std::to_string(points));
  for (std::size_t i = 1; i <= points; ++i)
    for (const char* name : {"u", "v"}) one.columns.push_back(std::string(name) + "[" + std::to_string(i) + "]");
  race<Method, SparseBrusselator>(one, typed_system(model::Source(one.file, text), one.columns, system.start()), system,
                                  system.start());
}

std::vector<std::string> bodies(int count, const std::string& axes) {
  std::vector<std::string> columns;
  for (const char* primes : {"", "'"})
    for (const char axis : axes)
      for (int i = 1; i <= count; ++i) columns.push_back(std::string(1, axis) + "[" + std::to_string(i) + "]" + primes);
  return columns;
}

/// In the order of the paper and of the problem.
std::vector<std::string> substances() {
  return {"NO2",  "NO",  "O3P", "O3",   "HO2",  "OH",  "HCHO", "CO",  "ALD", "MEO2",
          "C2O3", "CO2", "PAN", "CH3O", "HNO3", "O1D", "SO2",  "SO4", "NO3", "N2O5"};
}

}  // namespace
}  // namespace continuo::bench

int main(int argc, char** argv) {
  using namespace continuo;
  using namespace continuo::bench;
  const std::string folder = argc > 1 ? argv[1] : "models";
  std::puts("Milliseconds of one run at the tolerance 1e-9; native: machine code of the tape.\n");
  std::puts(
      "| Model | States | Method | Tape | Native | C++ | C++ of fixed size | Native : C++ | Native : fixed size |");
  std::puts("|---|---|---|---|---|---|---|---|---|");
  compare<Dop853, Lorenz>({"lorenz to t = 1000", folder + "/lorenz.sim", {"x", "y", "z"}, 1000});
  compare<Tsitouras5, Kepler>(
      {"kepler, e = 0.5, to t = 10,000", folder + "/kepler.sim", {"x", "y", "x'", "y'"}, 10'000});
  // Beyond, the motion is chaotic: rounding decides how close the next encounter is.
  compare<Dop853, Pleiades>({"pleiades to t = 3", folder + "/pleiades.sim", bodies(7, "xy"), 3});
  compare<Dop853, OuterPlanets>(
      {"outer_planets, 2,000,000 days", folder + "/outer_planets.sim", bodies(6, "xyz"), 10 * OuterPlanets::duration});
  compare<Rodas5P, Pollution<>>(
      {"pollution to t = 60", folder + "/pollution.sim", substances(), Pollution<>::duration});
  compare_brusselator<Bdf>({"brusselator_line to t = 10", folder + "/brusselator_line.sim", {}, 10}, 20);
  compare_brusselator<Bdf>({"brusselator_line, N = 500", folder + "/brusselator_line.sim", {}, 10}, 500);
  compare_brusselator<Rodas5P>({"brusselator_line, N = 500", folder + "/brusselator_line.sim", {}, 10}, 500);
}
