// What it costs to type a model instead of compiling it: the same right-hand side on the tape and as a C++ lambda,
// through the same solver with states of run-time size; and, for whoever thinks of compiling, with a state of fixed
// size.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <bench/problems/kepler.hpp>
#include <bench/problems/lorenz.hpp>
#include <bench/problems/pleiades.hpp>

#include <continuo/language/load.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::bench {
namespace {

using X = std::vector<double>;

/// The problem for states of run-time size, as the tape has them.
template <class Problem>
auto compiled() {
  return [](double t, const X& x, X& dxdt) {
    std::array<double, Problem::size> from, to;
    std::copy_n(x.data(), from.size(), from.data());
    Problem{}(t, from, to);
    std::copy_n(to.data(), to.size(), dxdt.data());
  };
}

/// Columns of the model in the order of the problem's components.
template <class Problem>
void compare(const char* title, const std::string& file, const std::vector<std::string>& columns, double duration) {
  const model::Loaded loaded = model::load(file);
  if (!loaded.model) {
    std::fputs(loaded.text().c_str(), stderr);
    return;
  }
  const model::Model& model = *loaded.model;
  std::vector<std::size_t> place;
  for (const std::string& column : columns)
    for (std::size_t i = 0; i < model.states.size(); ++i)
      if (model.states[i].column == column) place.push_back(i);
  const auto fixed_start = Problem::start();
  const X start(fixed_start.begin(), fixed_start.end());
  X typed_start(Problem::size);
  for (std::size_t i = 0; i < Problem::size; ++i) typed_start[place.at(i)] = start[i];

  const model::ModelSystem typed(model::compile(model), model::start_values(model));
  const Options<X> options{.rtol = 1e-9, .atol = 1e-9, .save = Save<X>::only_end()};
  const Options<std::array<double, Problem::size>> fixed_options{
      .rtol = 1e-9, .atol = 1e-9, .save = Save<std::array<double, Problem::size>>::only_end()};
  double tape = std::numeric_limits<double>::infinity(), native = tape, fixed = tape;
  std::size_t steps_of_tape = 0, steps_of_native = 0;
  for (int repeat = 0; repeat < 300; ++repeat) {
    const auto by_tape = solve(typed, typed_start, {0, duration}, Tsitouras5{}, options);
    const auto by_lambda = solve(compiled<Problem>(), start, {0, duration}, Tsitouras5{}, options);
    const auto by_array = solve(Problem{}, fixed_start, {0, duration}, Tsitouras5{}, fixed_options);
    tape = std::min(tape, by_tape.statistics.seconds);
    native = std::min(native, by_lambda.statistics.seconds);
    fixed = std::min(fixed, by_array.statistics.seconds);
    steps_of_tape = by_tape.statistics.steps;
    steps_of_native = by_lambda.statistics.steps;
  }
  std::printf("| %s | %zu | %zu, %zu | **%.2f** | %.2f |\n", title, Problem::size, steps_of_tape, steps_of_native,
              tape / native, tape / fixed);
}

std::vector<std::string> stars(const char* format_of_position, const char* format_of_velocity) {
  std::vector<std::string> columns;
  for (const char* primes : {format_of_position, format_of_velocity})
    for (const char axis : {'x', 'y'})
      for (int i = 1; i <= 7; ++i) columns.push_back(std::string(1, axis) + "[" + std::to_string(i) + "]" + primes);
  return columns;
}

}  // namespace
}  // namespace continuo::bench

int main(int argc, char** argv) {
  using namespace continuo::bench;
  const std::string folder = argc > 1 ? argv[1] : "models";
  std::puts("| Model | States | Steps on the tape, as a lambda | Time, tape : lambda | Time, tape : fixed size |");
  std::puts("|---|---|---|---|---|");
  compare<Lorenz>("Lorenz to t = 10", folder + "/lorenz.sim", {"x", "y", "z"}, 10);
  compare<Kepler>("Kepler, e = 0.5, to t = 100", folder + "/kepler.sim", {"x", "y", "x'", "y'"}, 100);
  compare<Pleiades>("Pleiades to t = 3", folder + "/pleiades.sim", stars("", "'"), 3);
}
