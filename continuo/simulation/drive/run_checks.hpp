// continuo/simulation/drive/run_checks.hpp
// The checks of a model held against a run. Internal to simulate.
#pragma once
#include <span>
#include <vector>

#include <continuo/language/model.hpp>
#include <continuo/simulation/drive/run_recorder.hpp>

namespace continuo::model {

/// The times at which checks read the motion, ascending, each once. A time a rounding beyond the end is the end.
[[nodiscard]] std::vector<double> sample_times(const Model& model, const Plan& plan);

/// Every check's result; `recorder` has given its rows to the run already.
[[nodiscard]] std::vector<CheckResult> judge(const Model& model, const Run& run, const RunRecorder& recorder);
/// The same for a run whose last row is the only one that is known, with the states at the times that checks ask for,
/// and the extremes of what is to hold always.
[[nodiscard]] std::vector<CheckResult> judge(const Model& model, const Run& run, std::span<const SampledState> samples,
                                             std::span<const Extremes> extremes);
/// Only the values that the checks of such a run read; NaN where there is none. No check is of what holds always.
[[nodiscard]] std::vector<double> readings(const Model& model, const Run& run, std::span<const SampledState> samples);
/// The same of checks that have been judged.
[[nodiscard]] std::vector<double> readings_of(std::span<const CheckResult> checks);

}  // namespace continuo::model
