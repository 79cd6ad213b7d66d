// continuo/model/integrate_by.hpp
// The body of integrate_by; included only by the integrate_*.cpp.
#pragma once
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <continuo/model/integrate.hpp>
#include <continuo/solve/integrator.hpp>

namespace continuo::model {

/// Hands what the integrator reports to the recorder, which is no template.
struct RecordingObserver {
  RunRecorder& recorder;
  std::size_t marks_seen = 0;
  std::vector<RunRecorder::Name> names{};

  template <class I>
  void stretch(I& integrator, double, double to) {
    recorder.stretch(to, At{&integrator, [](void* i, double t, ModelSystem::X& x) { static_cast<I*>(i)->at(t, x); }});
  }

  template <class I>
  void happening(I& integrator, const Happening<ModelSystem::X>& now) {
    names.clear();
    const ModelEvents& events = integrator.events();
    const auto marks = events.marks().subspan(marks_seen);
    for (const std::size_t i : now.events) {
      if (!events.is_declared(i)) continue;
      const auto mark = std::ranges::find(marks, i, &Marked::event);
      names.push_back({std::string(events.name(i)), mark == marks.end() ? std::string() : mark->text});
    }
    marks_seen = events.marks().size();
    recorder.happening(now.t, names, now.before, now.after);
  }
};

template <class Method>
void integrate_by(Integration integration, RunRecorder& recorder, Run& run) {
  const auto begin = std::chrono::steady_clock::now();
  Integrator<ModelSystem, ModelSystem::X, Method, ModelEvents> integrator(
      std::move(integration.system), std::move(integration.x0), {run.plan.from, run.plan.to}, Method{},
      std::move(integration.options), std::move(integration.events));
  recorder.begin(run.plan.from, integrator.x());  // where unknowns of algebraic equations have been found
  RecordingObserver observer{recorder};
  for (std::size_t count = 1; integrator.advance(observer); ++count) {
    if (count % 1024 == 0 && integrator.options().progress) integrator.options().progress(integrator.t());
  }
  recorder.finish(integrator.t(), integrator.x());
  run.outcome = integrator.outcome();
  run.statistics = integrator.statistics();
  run.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  run.stop_text = integrator.events().stop_text();
}

}  // namespace continuo::model
