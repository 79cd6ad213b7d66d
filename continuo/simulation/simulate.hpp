// continuo/simulation/simulate.hpp
// A model in, a trusted motion out:
//
//   Loaded loaded = load("models/bouncing_ball.sim");
//   Simulated simulated = simulate(*loaded.model, {.rtol = 1e-10, .parameters = {{"g", 1.62}}});
//   if (simulated.run) fmt::print("{} rows\n", simulated.run->motion.rows());
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/language/text/diagnostic.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/run.hpp>

namespace continuo::model {

struct ModelProgram;   // simulation/program/model_program.hpp
class MotionWatcher;   // simulation/motion_watcher.hpp
class IntegrationLog;  // simulation/integration_recording.hpp

/// A run, or why there is none. A run that failed on the way is a run: its outcome says how it ended, and
/// `diagnostics` holds the same as an error with its code. Warnings may stand beside a good run.
struct Simulated {
  std::optional<Run> run;
  std::vector<Diagnostic> diagnostics;

  /// There is a run, it ended well, and every check passed.
  [[nodiscard]] bool passed() const { return run && succeeded(run->outcome.ending) && run->checks_passed(); }
};

/// Runs a model from its start as its `run` statement says, with the changes of the experiment. Models with conditions
/// at several times or with bodies have no such run: diagnostics E321 and E323.
[[nodiscard]] Simulated simulate(const Model& model, const Experiment& experiment = {});
/// The same for a program compiled before: for many runs of one model.
[[nodiscard]] Simulated simulate(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment = {});
/// Who follows a run while it advances; it is the same without them, to the last bit.
struct Followers {
  OnRow on_row{};                    // is handed the rows
  MotionWatcher* watcher = nullptr;  // sees the motion between them; second runs, for the error, are not shown
  IntegrationLog* log = nullptr;     // records the run, so that it can be replayed and resumed
};
/// Where Experiment::keep_rows is false, the run itself has the first and the last row alone, and needs no memory for
/// the others.
[[nodiscard]] Simulated simulate(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment,
                                 const Followers& followers);

/// The plan of a run with its inputs in place, or why there can be no run.
[[nodiscard]] std::optional<Plan> plan_run(const ModelProgram& program, const Experiment& experiment,
                                           std::vector<Diagnostic>& problems);

/// What an ending that is no success says as a diagnostic: E30x, E310.
[[nodiscard]] Diagnostic failure(const Model& model, const Outcome<double>& outcome);
/// With the jump of the equations at which the run has come to stand, if there is one.
[[nodiscard]] Diagnostic failure(const ModelProgram& program, const Run& run);

/// The values of expressions of the model at every row of the run: one list per expression.
[[nodiscard]] std::vector<std::vector<double>> values_along(const ModelProgram& program, const Run& run,
                                                            std::span<const NodeId> nodes);

/// `k=5`, `k = 2*pi`, `k=30 [N/cm]`: a parameter and its value in the model's unit for it. The unit may be left out.
struct ParameterSetting {
  std::string name;
  double value;
};
/// Empty where the text cannot be used; `problems` says why (E34x), or warns of a value outside the declared range.
[[nodiscard]] std::optional<ParameterSetting> parse_setting(const Model& model, std::string_view text,
                                                            std::vector<Diagnostic>& problems);

/// `x=3`, `x' = 0.5 [m/s]`, `u[1]=2`: a state or a family of states, and where it begins, in the unit of the state.
struct InitialSetting {
  std::string name;
  double value;
};
/// Empty where the text cannot be used; `problems` says why (E344, E346).
[[nodiscard]] std::optional<InitialSetting> parse_initial(const Model& model, std::string_view text,
                                                          std::vector<Diagnostic>& problems);

/// `1e-8` for all states, `y2=1e-10`, `x' = 1 [mm/s]` for one or a family of them; absolute ones in the state's unit.
enum class ToleranceKind { relative, absolute };
/// A tolerance for one state, a family of states, or all.
struct ToleranceSetting {
  std::string name;  // empty: of all
  double value;
};
/// Empty where the text cannot be used; `problems` says why (E344, E345).
[[nodiscard]] std::optional<ToleranceSetting> parse_tolerance(const Model& model, ToleranceKind kind,
                                                              std::string_view text, std::vector<Diagnostic>& problems);

}  // namespace continuo::model
