// continuo/simulation/drive/integrate.hpp
// Runs an integration to its end for simulate. Internal to it.
#pragma once
#include <string_view>

#include <continuo/simulation/drive/run_recorder.hpp>
#include <continuo/simulation/stepping.hpp>

namespace continuo::model {

/// Runs from run.plan.from to run.plan.to; leaves outcome, statistics, marks and the text of a stop in the run.
/// The method's name must be one of the catalogue.
void integrate(std::string_view method, Integration integration, RunRecorder& recorder, Run& run);

}  // namespace continuo::model
