// What it costs to type a model instead of compiling it: the same right-hand side on the tape and as a C++ lambda,
// through the same solver with states of run-time size.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <bench/problems/kepler.hpp>
#include <bench/problems/lorenz.hpp>
#include <bench/problems/pleiades.hpp>

#include <continuo/methods/tsitouras5.hpp>
#include <continuo/model/load.hpp>
#include <continuo/model/model_system.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::bench {
namespace {

using X = std::vector<double>;

/// The problem as a system for states of run-time size, in the model's order of states.
template <class Problem>
struct Compiled {
  std::vector<std::size_t> place;  // of the problem's component i in the model's state
  void operator()(double t, const X& x, X& dxdt) const {
    std::array<double, Problem::size> from{}, to{};
    for (std::size_t i = 0; i < Problem::size; ++i) from[i] = x[place[i]];
    Problem{}(t, from, to);
    for (std::size_t i = 0; i < Problem::size; ++i) dxdt[place[i]] = to[i];
  }
};

/// Columns of the model in the order of the problem's components.
template <class Problem>
void compare(const std::string& file, const std::vector<std::string>& columns, double duration) {
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
  X start(Problem::size);
  for (std::size_t i = 0; i < Problem::size; ++i) start[place.at(i)] = Problem::start()[i];

  const model::ModelSystem typed(model::compile(model), model::start_values(model));
  const Options<X> options{.rtol = 1e-9, .atol = 1e-9, .save = Save<X>::only_end()};
  double tape = std::numeric_limits<double>::infinity(), native = tape;
  std::size_t steps_of_tape = 0, steps_of_native = 0;
  for (int repeat = 0; repeat < 200; ++repeat) {
    const auto by_tape = solve(typed, start, {0, duration}, Tsitouras5{}, options);
    const auto by_lambda = solve(Compiled<Problem>{place}, start, {0, duration}, Tsitouras5{}, options);
    tape = std::min(tape, by_tape.statistics.seconds);
    native = std::min(native, by_lambda.statistics.seconds);
    steps_of_tape = by_tape.statistics.steps;
    steps_of_native = by_lambda.statistics.steps;
  }
  std::printf("| %s | %zu, %zu | **%.2f** |\n", std::string(Problem::title).c_str(), steps_of_tape, steps_of_native,
              tape / native);
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
  std::puts("| Model | Steps on the tape, as a lambda | Time, tape : lambda |");
  std::puts("|---|---|---|");
  compare<Lorenz>(folder + "/lorenz.sim", {"x", "y", "z"}, 10);
  compare<Kepler>(folder + "/kepler.sim", {"x", "y", "x'", "y'"}, 100);
  compare<Pleiades>(folder + "/pleiades.sim", stars("", "'"), 3);
}
