// continuo/model/integrate.hpp
// The one place where a model meets the methods: each is instantiated once, in one of the integrate_*.cpp, so that no
// translation unit has to compile them all. Internal to simulate.
#pragma once
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/model/model_events.hpp>
#include <continuo/model/model_system.hpp>
#include <continuo/model/run_recorder.hpp>
#include <continuo/solve/options.hpp>

namespace continuo::model {

/// What an integrator is made of, besides the method.
struct Integration {
  ModelSystem system;
  ModelSystem::X x0;
  Options<ModelSystem::X> options;
  ModelEvents events;
};

/// Runs from run.plan.from to run.plan.to; leaves outcome, statistics, marks and the text of a stop in the run.
/// The method's name must be one of the catalogue.
void integrate(std::string_view method, Integration integration, RunRecorder& recorder, Run& run);

template <class Method>
void integrate_by(Integration integration, RunRecorder& recorder, Run& run);

}  // namespace continuo::model
