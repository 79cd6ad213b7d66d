// How a model's motion depends on its parameters and initial values: S = dx/dp along the run, exact but for the
// tolerance of the integration, which holds for S as for x; through events, whose times move too, and through modes.
// Of a world of bodies S comes from differences of runs (world_sensitivity.hpp).
//
//   const SensitivityStudy study(program, {{.index = model::find_parameter(program->model, "k")}});
//   const SensitivityRun run = study.run();
//   fmt::print("d x / d k = {} at the end\n", run.sensitivity(run.rows() - 1, 0, 0));
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/language/text/diagnostic.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/stepping.hpp>
#include <continuo/solve/outcome.hpp>
#include <continuo/status/status.hpp>
#include <continuo/studies/sensitivity/influence.hpp>

namespace continuo::studies {

namespace detail {
class SensitiveProgram;
}

/// An event of the run, and how its time depends on the influences.
struct SensitivityEvent {
  std::string name;
  double t;
  std::vector<double> time_moves;  // dt/dp
};

/// A run with the sensitivities of all states.
struct SensitivityRun {
  std::size_t states = 0, influences = 0;
  std::vector<double> times;
  std::vector<double> values;     // row after row: x, then dx/dp of each influence
  std::vector<double> variables;  // the register file at the start
  std::vector<SensitivityEvent> events;
  std::size_t mode = 0;     // at the end
  Outcome<double> outcome;  // of the integration
  Statistics statistics;
  /// A failure where the run failed, as the outcome or the first diagnostic says, and where the motion has no
  /// derivative; the rows up to there are kept.
  Status status;
  std::vector<model::Diagnostic> diagnostics;

  /// Whether the run succeeded with its sensitivities.
  [[nodiscard]] bool good() const { return diagnostics.empty() && succeeded(status.ending); }
  /// Whether the status tells why the motion has no derivative, and not how a run failed.
  [[nodiscard]] bool has_no_derivative() const {
    return !status && diagnostics.empty() && status.ending != outcome.ending;
  }
  /// The number of rows.
  [[nodiscard]] std::size_t rows() const { return times.size(); }
  /// Row r: the states, then the sensitivities to each influence.
  [[nodiscard]] std::span<const double> row(std::size_t r) const {
    const std::size_t width = states * (1 + influences);
    return {values.data() + r * width, width};
  }
  /// A state at row r, in its unit.
  [[nodiscard]] double value(std::size_t r, std::size_t state) const { return row(r)[state]; }
  /// The derivative of a state by an influence at row r.
  [[nodiscard]] double sensitivity(std::size_t r, std::size_t state, std::size_t influence) const {
    return row(r)[states * (1 + influence) + state];
  }
};

/// Which run, and at which times.
struct SensitivityRequest {
  /// Its method and its step have no part, but for a world: the method is chosen by tolerance and size; collocation
  /// where conditions stand at several times.
  model::Experiment experiment{};
  /// Rows at these times, ascending, and nowhere else; empty: as the model's `run` says, both sides of events too.
  std::vector<double> times{};
  /// Initial values in place of the model's, by state; of influences that are initial values.
  std::vector<std::pair<std::size_t, double>> initial{};
  /// The run goes on from here, as after an event, of a run that began as the experiment says; for influences that are
  /// the initial values of all states, which these then stand for, and parameters.
  std::optional<model::Instant> begin{};
  /// Of a world: how far to both sides each influence is moved; 0, or none: as little as rounding allows.
  std::vector<double> increments{};
};

/// Compiled once, for any number of runs with other values.
class SensitivityStudy {
 public:
  /// Compiles the sensitivities of a model to these influences. With `start_is_given`, the initial values come from the
  /// requests.
  SensitivityStudy(std::shared_ptr<const model::ModelProgram> program, std::vector<Influence> influences,
                   const model::Overrides& overrides = {}, bool start_is_given = false);

  /// A run with its sensitivities.
  [[nodiscard]] SensitivityRun run(const SensitivityRequest& request = {}) const;

  /// The program of the model.
  [[nodiscard]] const model::ModelProgram& program() const;
  /// The influences, in the order of the columns.
  [[nodiscard]] const std::vector<Influence>& influences() const;
  /// Quantities q of the model along a run: for each row and each quantity q, then dq/dp of each influence.
  using Along = std::function<std::vector<double>(const SensitivityRun& run)>;
  /// A function that evaluates quantities of the model, with their sensitivities, along a run.
  [[nodiscard]] Along along(std::span<const model::NodeId> quantities) const;

 private:
  [[nodiscard]] SensitivityRun integrated(const SensitivityRequest& request) const;

  std::shared_ptr<const detail::SensitiveProgram> program_;
};

/// Why there are no sensitivities of this model by these influences: E36x.
[[nodiscard]] std::optional<model::Diagnostic> no_sensitivity(const model::Model& model,
                                                              std::span<const Influence> influences);

/// "m/(N/m)": the unit of a derivative. Empty without units.
[[nodiscard]] std::string unit_of_ratio(const std::string& of, const std::string& by);

}  // namespace continuo::studies
