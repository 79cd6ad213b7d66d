// How far a run without a method is from the truth, in tolerances, for rtol = atol = 1e-3 ... 1e-10. Given the name of
// a method, of that one. A star says that the run doubts itself (model::doubt_of). Exits with 1 where an end is off by
// more than 30 tolerances and the run says nothing of it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <bench/choice/problems.hpp>
#include <fmt/format.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>

namespace {

using namespace continuo;

constexpr double most_tolerances = 30;

struct Error {
  double tolerances;     // the greatest error of a state at the end; negative where the run did not get there
  bool doubted = false;  // the run says that it is off
};

Error error_of(const bench::ChoiceProblem& problem, const model::Model& model, double tolerance,
               const std::string& method) {
  model::Experiment experiment{.rtol = tolerance, .atol = {tolerance}, .doubts = true, .keep_rows = false};
  if (!method.empty()) experiment.method = method;
  const model::Simulated simulated = model::simulate(model, experiment);
  if (!simulated.run || simulated.run->outcome.ending != Ending::reached_end) return {-1};
  double worst = 0;
  for (const auto& [name, expected] : problem.end) {
    const auto state = std::ranges::find(model.states, name, &model::State::column);
    if (state == model.states.end()) return {std::numeric_limits<double>::infinity()};
    const double value = simulated.run->final_state()[static_cast<std::size_t>(state - model.states.begin())];
    worst = std::max(worst, std::abs(value - expected) / (tolerance * (1 + std::abs(expected))));
  }
  return {worst, simulated.run->outcome.hint.find("a second run") != std::string::npos};
}

}  // namespace

int main(int argc, char** argv) {
  const std::string method = argc > 1 ? argv[1] : "";
  bool wrong = false;
  fmt::print(
      "| Problem | 1e-3 | 1e-4 | 1e-5 | 1e-6 | 1e-7 | 1e-8 | 1e-9 | 1e-10 |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& problem : bench::choice_problems()) {
    const auto loaded =
        model::load(model::Source("problem.sim", fmt::format("{}\nrun 0..{} [s]\n", problem.text, problem.duration)));
    if (!loaded) {
      fmt::print("{}: {}\n", problem.name, loaded.text());
      return 2;
    }
    fmt::print("| {} |", problem.name);
    for (int power = 3; power <= 10; ++power) {
      const Error error = error_of(problem, *loaded.model, std::pow(10.0, -power), method);
      wrong = wrong || (error.tolerances > most_tolerances && !error.doubted);
      error.tolerances < 0 ? fmt::print(" - |") : fmt::print(" {:.2g}{} |", error.tolerances, error.doubted ? "*" : "");
    }
    fmt::print("\n");
  }
  return wrong ? 1 : 0;
}
