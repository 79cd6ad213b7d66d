// Lyapunov exponents: how fast neighbours part, in each direction on the average. The variational equations are
// integrated beside the motion, their columns made orthogonal again every so often (G. Benettin, L. Galgani, A.
// Giorgilli, J.-M. Strelcyn, Meccanica 15 (1980) 9-30).
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/solve/outcome.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies {

/// How long the motion is followed, in the unit of time of the system.
struct LyapunovOptions {
  double duration = 1000;  // of what is averaged
  double settle = 50;      // before that, to come to the attractor
  double interval = 0.5;   // at most, between two orthogonalisations
  double rtol = 1e-8, atol = 1e-10;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double t)> progress{};
};

/// The exponents that were found.
struct LyapunovExponents {
  Outcome<double> outcome;
  std::vector<double> exponents;  // descending, per unit of time; of what was averaged where it was interrupted
  std::vector<double> spread;     // standard error of each, from the averages of twenty parts of the run
  double averaged = 0;            // over how much time
};

/// Integrates the motion from x0 with its variational equations, n (n + 1) numbers for n components.
[[nodiscard]] LyapunovExponents lyapunov_exponents(const ParametricSystem& system, std::vector<double> x0,
                                                   const LyapunovOptions& options = {});

/// Of a model with all that happens in it: events with their jumps, modes, jumps of the equations, the time. Neighbours
/// are run beside the motion, a millionth of its size away in each direction, and put back to that distance every so
/// often; what their own events make of the distance is in it. A state that conditions read and that only events
/// change, by steps (a counter, a flag), has no neighbours and no exponent. All of them run at a tolerance of 1e-12,
/// whatever the options say; directions that shrink by more than e^-16 between two looks count as that. `experiment`
/// says where the model begins, and with which parameters.
[[nodiscard]] LyapunovExponents lyapunov_exponents(const std::shared_ptr<const model::ModelProgram>& program,
                                                   const model::Experiment& experiment,
                                                   const LyapunovOptions& options = {});

}  // namespace continuo::studies
