#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include <continuo/model/integrate.hpp>
#include <continuo/solve/with_method.hpp>

namespace continuo::model {

namespace {

class Recording final : public StepWatcher {
 public:
  explicit Recording(RunRecorder& recorder) : recorder_(recorder) {}

  void stretch(Stepping& run, double to) override {
    recorder_.stretch(to,
                      At{&run, [](void* of, double t, ModelSystem::X& x) { static_cast<Stepping*>(of)->at(t, x); }});
  }

  void happening(Stepping& run, const Happening<ModelSystem::X>& now) override {
    names_.clear();
    const ModelEvents& events = run.events();
    const auto marks = events.marks().subspan(marks_seen_);
    for (const std::size_t i : now.events) {
      if (!events.is_declared(i)) continue;
      const auto mark = std::ranges::find(marks, i, &Marked::event);
      names_.push_back({std::string(events.name(i)), mark == marks.end() ? std::string() : mark->text});
    }
    marks_seen_ = events.marks().size();
    recorder_.happening(now.t, names_, now.before, now.after);
  }

 private:
  RunRecorder& recorder_;
  std::size_t marks_seen_ = 0;
  std::vector<RunRecorder::Name> names_;
};

}  // namespace

Statistics sum(const Statistics& a, const Statistics& b) {
  return {.steps = a.steps + b.steps,
          .rejected = a.rejected + b.rejected,
          .evaluations = a.evaluations + b.evaluations,
          .jacobians = a.jacobians + b.jacobians,
          .decompositions = a.decompositions + b.decompositions,
          .solutions = a.solutions + b.solutions,
          .events = a.events + b.events,
          .seconds = a.seconds + b.seconds};
}

std::unique_ptr<Stepping> begin_integration(std::string_view method, Integration integration,
                                            Interval<double> interval) {
  std::unique_ptr<Stepping> run;
  with_method(method,
              [&](auto chosen) { run = begin_integration_by<decltype(chosen)>(std::move(integration), interval); });
  return run;
}

void integrate(std::string_view method, Integration integration, RunRecorder& recorder, Run& run) {
  const auto begin = std::chrono::steady_clock::now();
  const auto progress = integration.options.progress;
  const std::unique_ptr<Stepping> steps =
      begin_integration(method, std::move(integration), {run.plan.from, run.plan.to});
  recorder.begin(run.plan.from, steps->x());  // where unknowns of algebraic equations have been found
  Recording recording(recorder);
  for (std::size_t count = 1; steps->advance(recording); ++count) {
    if (count % 1024 == 0 && progress) progress(steps->t());
  }
  recorder.finish(steps->t(), steps->x());
  run.outcome = steps->outcome();
  run.statistics = steps->statistics();
  run.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  run.stop_text = steps->events().stop_text();
}

}  // namespace continuo::model
