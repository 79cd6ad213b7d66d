// continuo/simulation/drive/integrate.hpp
// Runs an integration to its end for simulate. Internal to it.
#pragma once
#include <string_view>

#include <continuo/simulation/drive/run_recorder.hpp>
#include <continuo/simulation/integration_recording.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/simulation/stepping.hpp>

namespace continuo::model {

/// Runs from run.plan.from to run.plan.to; leaves outcome, statistics, marks and the text of a stop in the run.
/// The method's name must be one of the catalogue.
void integrate(std::string_view method, Integration integration, RunRecorder& recorder, Run& run,
               const Followers& followers = {});

/// The same from a checkpoint; the recorder has its parts already. False where it does not fit, and then nothing has
/// been done.
[[nodiscard]] bool integrate_from(const IntegrationCheckpoint& checkpoint, Integration integration,
                                  RunRecorder& recorder, Run& run, IntegrationLog* log = nullptr);

}  // namespace continuo::model
