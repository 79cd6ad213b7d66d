// `continuo sense --of events|period|equilibrium`: how what a motion comes to depends on parameters.
#pragma once
#include <string>
#include <vector>

#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/terminal/exit_codes.hpp>

#include <continuo/studies/sensitivity.hpp>

namespace continuo::app {

/// Every event's time with its derivatives, a line for each.
std::string events_table(const model::Model& model, const studies::SensitivityRun& run,
                         const std::vector<studies::Influence>& influences);
/// The period of the closed orbit that the run comes to.
ExitCode sense_period(const ExperimentOptions& options, const std::vector<std::string>& parameters, bool json);
/// The equilibrium that is found from the start, of the mode the model starts in.
ExitCode sense_equilibrium(const ExperimentOptions& options, const std::vector<std::string>& parameters, bool json);

}  // namespace continuo::app
