// continuo/worlds/world_along.hpp
// The states of a world at wanted instants, for studies that compare runs: without rows, checks or a recording.
//
//   const WorldAlong along = world_along(program, {.experiment = experiment, .times = {0.1, 0.2, 0.35}});
//   if (along.diagnostics.empty()) ... along.states[2]
//
// Without steps they are the states at these instants. With steps they are interpolated between the ends of a step: of
// bodies without a contact in it by the cubic through positions and velocities, of other bodies by the parabola before
// the impact and the one after it, with the change where these are nearest to each other, and of equations linearly.
#pragma once
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <continuo/language/text/diagnostic.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/solve/outcome.hpp>

namespace continuo::worlds {

/// Which run, and at which times its states are wanted.
struct AlongRequest {
  model::Experiment experiment{};
  std::vector<double> times{};                            // ascending; empty: as the model's `run` says
  std::vector<std::pair<std::size_t, double>> initial{};  // values of states in place of the model's
};

/// The states at the wanted times.
struct WorldAlong {
  std::vector<double> times;                // as far as the run advanced
  std::vector<std::vector<double>> states;  // Model::states at each of them
  std::vector<double> variables;            // the register file at the start
  Outcome<double> outcome;
  std::vector<model::Diagnostic> diagnostics;
};

/// Runs the world of a program. A run that ends early has the states up to there, and its outcome; where it cannot
/// begin, `diagnostics` has the reason.
[[nodiscard]] WorldAlong world_along(const std::shared_ptr<const model::ModelProgram>& program,
                                     const AlongRequest& request);

}  // namespace continuo::worlds
