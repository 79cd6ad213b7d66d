// Any model, run, whatever it needs: equations from their start, conditions at several times, bodies.
//
//   const model::Simulated simulated = runs::run(program, {.rtol = 1e-9});
//   if (simulated.passed()) fmt::print("{} rows\n", simulated.run->motion.rows());
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include <continuo/boundary/boundary_of_model.hpp>
#include <continuo/runs/recording.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::runs {

/// What is asked beside the experiment. Each is for models of one kind, and no others heed it.
struct RunRequest {
  boundary::BoundaryRequest boundary{};  // which solution, and how it is searched for
  Log* log = nullptr;                    // in which the run is recorded as it goes
  bool from_start = false;               // conditions at several times are refused (E321)
  model::OnRow on_row{};                 // is handed the rows as they come; those of a boundary-value problem come all
                                         // at once, and stand in the run alone
};

/// A run, or why there is none.
[[nodiscard]] model::Simulated run(const std::shared_ptr<const model::ModelProgram>& program,
                                   const model::Experiment& experiment = {}, const RunRequest& request = {});

/// The plan of its run, or nothing where `problems` has the reason: E33x, E34x.
[[nodiscard]] std::optional<model::Plan> plan(const model::Model& model, const model::Experiment& experiment,
                                              std::vector<model::Diagnostic>& problems);

/// The plan of a motion from its start that somebody else makes the steps of; nothing where it has none, for which
/// `problems` has the reason.
[[nodiscard]] std::optional<model::Plan> plan_from_start(const model::ModelProgram& program,
                                                         const model::Experiment& experiment,
                                                         std::vector<model::Diagnostic>& problems);

}  // namespace continuo::runs
