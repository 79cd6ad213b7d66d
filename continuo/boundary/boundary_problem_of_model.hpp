// The boundary-value problem that a model's conditions at several times pose, for whoever solves it otherwise than
// boundary_of_model.hpp does.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/boundary/boundary_value.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_program.hpp>

namespace continuo::boundary {

/// The conditions as one function of x at the times that they name.
class BoundaryConditions {
 public:
  /// The conditions of a model with the parameters of a plan. The program must outlive this object.
  BoundaryConditions(const model::ModelProgram& program, const model::Plan& plan);

  /// The times that conditions read, ascending.
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// Which of `times` this setting of a condition is.
  [[nodiscard]] std::size_t place_of(const model::Setting& setting) const;

  /// residuals = what is left of each condition, in the order of the text. x: the states at the first time, at the
  /// second, and so on.
  void operator()(Values x, std::span<double> residuals);

  /// Which entries of the Jacobian may differ from zero.
  [[nodiscard]] std::vector<MatrixPlace> places() const;

  /// The values that state `i` is given without reference to others: times and values.
  std::vector<std::pair<double, double>> known(std::size_t state);

 private:
  struct SampleAt {
    std::uint32_t variable;
    std::size_t time;  // which of times_
    model::NodeId of;
    model::Evaluation evaluation;
  };
  struct Condition {
    std::size_t column = 0;
    model::Evaluation value;
    std::vector<SampleAt> samples;
  };

  double value(std::size_t i, Values x);
  [[nodiscard]] double time_of(const model::Setting& setting) const;

  const model::Model& model_;
  std::size_t n_;
  double from_, to_;
  std::vector<double> variables_, times_;
  std::vector<Condition> conditions_;
};

/// Columns over time to begin a search from, such as an earlier run.
struct GuessTable {
  std::string name;                         // what messages call it: its file
  std::vector<std::string> columns;         // named like states, without the time's
  std::vector<double> times;                // ascending
  std::vector<std::vector<double>> values;  // by column, one per time; NaN where there is none
};

/// The plan of a model whose conditions stand at several times, or nothing where `problems` has the reason: E33x, E34x.
[[nodiscard]] std::optional<model::Plan> plan_boundary(const model::Model& model, const model::Experiment& experiment,
                                                       std::vector<model::Diagnostic>& problems);

/// Ready to be solved.
struct PosedBoundary {
  std::shared_ptr<const model::ModelProgram> program;
  model::Plan plan;
  std::shared_ptr<BoundaryConditions> conditions;
  BoundaryValueProblem problem;
  BoundaryValueOptions options;
};
/// Nothing where the model does not go together with such conditions, or with the experiment; `problems` says why.
[[nodiscard]] std::optional<PosedBoundary> pose_boundary(const std::shared_ptr<const model::ModelProgram>& program,
                                                         const model::Experiment& experiment,
                                                         std::vector<model::Diagnostic>& problems);

/// How many guesses the model has: at least one.
[[nodiscard]] std::size_t guess_count(const model::Model& model);
/// The k-th of them: what the model guesses, else straight lines between the values of the conditions. It refers to
/// `posed`.
[[nodiscard]] BoundaryValueGuess guess_of(const PosedBoundary& posed, std::size_t k);
/// From the columns of a table; states that it does not have as in the first guess, derivatives as slopes. E349 where
/// it has none of them, or is outside of the run.
[[nodiscard]] std::optional<BoundaryValueGuess> guess_from(const PosedBoundary& posed, const GuessTable& table,
                                                           std::vector<model::Diagnostic>& problems);
/// The solution that it leads to.
[[nodiscard]] BoundaryValueSolution solve_from_guess(const PosedBoundary& posed, std::size_t k);
/// Why there is none: E307, E322.
[[nodiscard]] model::Diagnostic boundary_failure(const model::Model& model, const BoundaryValueSolution& solution);

}  // namespace continuo::boundary
