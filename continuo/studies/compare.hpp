// continuo/studies/compare.hpp
// Several methods and steps on one model, each judged by a tight reference run.
//
//   const Comparison comparison = compare(program, {.methods = {"euler", "rk4"}, .steps = {0.1, 0.05}});
//   for (const Contender& c : comparison.contenders) fmt::print("{} {}: {}\n", c.method, c.step, c.largest_error);
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <continuo/simulation/simulate.hpp>

namespace continuo::studies {

/// Every method with every step; without steps with every tolerance; without either as the model says.
struct CompareRequest {
  std::vector<std::string> methods;
  std::vector<double> steps{}, tolerances{};
  model::Experiment experiment{};  // what holds for all: parameters, end, output, interrupt
};

/// One method with one step or tolerance. Errors are those of the worst state, each measured by the largest value the
/// reference takes, over the rows at output times.
struct Contender {
  std::string method;
  std::optional<double> step, tolerance;
  model::Simulated simulated;
  double final_error, largest_error;  // NaN without a run
  std::vector<double> times, errors;  // at each output time that was reached

  /// The method with its step or tolerance, as in the legend of a plot.
  [[nodiscard]] std::string label() const;  // "rk4, h = 0.1"
};

/// A reference run, and the methods that are compared with it.
struct Comparison {
  model::Simulated reference;
  std::vector<Contender> contenders;
};

/// The relative tolerance of the reference, close to round-off. Its method is Verner's 9(8) pair, or a stiff one where
/// the model has algebraic equations or an implicit method is compared: a pair could take hours there. Bodies that only
/// the fast motion moves are compared with it in steps of a sixteenth.
inline constexpr double reference_rtol = 1e-13;

/// Without a good reference run there are no contenders; its diagnostics say why.
[[nodiscard]] Comparison compare(const std::shared_ptr<const model::ModelProgram>& program,
                                 const CompareRequest& request);

}  // namespace continuo::studies
