// bench/choice/residual.hpp
// How far unknowns are off their equations where a run is read between its steps.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <bench/choice/problems.hpp>
#include <fmt/format.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::bench {

inline constexpr std::size_t instants = 1000;

/// The methods that solve algebraic equations, with control of their error.
inline std::vector<MethodInfo> algebraic_methods() {
  std::vector<MethodInfo> methods;
  for (const MethodInfo& method : method_catalogue())
    if (method.implicit && !method.automatic && !method.second_order && method.error_order > 0)
      methods.push_back(method);
  return methods;
}

/// The problem with the right sides of its equations `0 = ...` as outputs.
inline model::Loaded load_with_residuals(const ChoiceProblem& problem) {
  constexpr std::string_view algebraic = "0 = ";
  std::string text;
  std::size_t equations = 0;
  for (std::size_t begin = 0; begin < problem.text.size();) {
    const std::size_t end = std::min(problem.text.find('\n', begin), problem.text.size());
    const std::string_view line = problem.text.substr(begin, end - begin);
    text += fmt::format("{}\n", line);
    if (line.starts_with(algebraic))
      text += fmt::format("output residual{} = {}\n", ++equations, line.substr(algebraic.size()));
    begin = end + 1;
  }
  return model::load(model::Source("problem.sim", fmt::format("{}run 0..{} [s]\n", text, problem.duration)));
}

/// The largest residual of an algebraic equation over the rows of a run; nothing where it does not reach its end.
inline std::optional<double> largest_residual(const model::Model& model, model::Experiment experiment) {
  experiment.max_steps = 1'000'000;
  const model::Simulated simulated = model::simulate(model, experiment);
  if (!simulated.run || simulated.run->outcome.ending != Ending::reached_end) return {};
  const model::Motion& motion = simulated.run->motion;
  double largest = 0;
  for (std::size_t column = 0; column < motion.columns.size(); ++column) {
    if (!motion.columns[column].name.starts_with("residual")) continue;
    for (std::size_t i = 0; i < motion.rows(); ++i) largest = std::max(largest, std::abs(motion.row(i)[column]));
  }
  return largest;
}

/// The same over `instants` instants, in units of rtol = atol.
inline std::optional<double> largest_residual(const model::Model& model, double duration, std::string_view method,
                                              double tolerance) {
  const std::optional<double> largest = largest_residual(model, {.method = std::string(method),
                                                                 .rtol = tolerance,
                                                                 .atol = {tolerance},
                                                                 .output = duration / static_cast<double>(instants)});
  return largest ? std::optional(*largest / tolerance) : std::nullopt;
}

}  // namespace continuo::bench
