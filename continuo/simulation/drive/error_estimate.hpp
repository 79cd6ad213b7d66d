// continuo/simulation/drive/error_estimate.hpp
// How far a run is from the true motion: not the local error that the tolerance bounds, but what it has added up to,
// measured against a second run that is a hundred times as strict.
//
//   const ErrorEstimate estimate = estimate_error(program, experiment, run);
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/run.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::model {

/// How the second run is made where not by `simulate`; then what half a step changes is the estimate.
using RunAgain = std::function<Simulated(const Experiment& strict)>;

/// One more run, a hundred times as strict; by a fixed step, with half the step and Richardson's factor 2^p / (2^p -
/// 1). The method and everything else stay as they were.
[[nodiscard]] ErrorEstimate estimate_error(const std::shared_ptr<const ModelProgram>& program,
                                           const Experiment& experiment, const Run& run, const RunAgain& again = {});

/// A sentence where the final state of an adaptive run is off by more than 20 tolerances, since the motion multiplies
/// the errors of its steps (a chaotic one, many periods of an orbit), or where a stricter run ends otherwise; else
/// nothing. By a second run a hundred times as strict, or ten where rounding lets none of those end. Nothing is said of
/// runs of more than 1e7 evaluations times states, which a second one would delay by more than some tenths of a second.
[[nodiscard]] std::string doubt_of(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment,
                                   const Run& run);

}  // namespace continuo::model
