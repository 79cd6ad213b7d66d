// Runs the integration of a model by a method chosen by its name, watched by a recorder.
#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include <continuo/simulation/drive/integrate.hpp>
#include <continuo/simulation/drive/model_method.hpp>
#include <continuo/simulation/program/event_names.hpp>
#include <continuo/solve/integrator.hpp>
#include <continuo/solve/with_method.hpp>

namespace continuo::model {

namespace {

class Recording final : public StepWatcher {
 public:
  explicit Recording(RunRecorder& recorder) : recorder_(recorder) {}

  void on_segment(Stepping& run, double to) override {
    recorder_.on_segment(to,
                         At{&run, [](void* of, double t, ModelSystem::X& x) { static_cast<Stepping*>(of)->at(t, x); }});
  }

  void on_event(Stepping& run, const EventOccurrence<ModelSystem::X>& now) override {
    recorder_.on_event(now.t, names_.of(run.events(), now.events, true), now.before, now.after);
  }

 private:
  RunRecorder& recorder_;
  EventNames names_;
};

class SteppingByName final : public Stepping {
 public:
  SteppingByName(ModelMethod method, Integration integration, Interval<double> interval) : method_(method) {
    begin(std::move(integration.system), std::move(integration.x0), interval, std::move(integration.options),
          std::move(integration.events));
  }

  bool advance(StepWatcher& watcher) override {
    Forward forward{*this, watcher};
    return integrator_->advance(forward);
  }
  double t() const override { return integrator_->t(); }
  const X& x() const override { return integrator_->x(); }
  void at(double t, X& x) override { integrator_->at(t, x); }
  const ModelSystem& system() const override { return integrator_->system(); }
  const ModelEvents& events() const override { return integrator_->events(); }
  const Outcome<double>& outcome() const override { return integrator_->outcome(); }
  Statistics statistics() const override { return sum(past_, integrator_->statistics()); }
  void extend_to(double to) override { integrator_->extend_to(to); }

  void save(ByteWriter& bytes) override {
    StateWriter archive(bytes);
    integrator_->transfer(archive, method_.write);
  }
  void restore(ByteReader& bytes) override {
    StateReader archive(bytes);
    integrator_->transfer(archive, method_.read);
  }

  void go_on(const Instant& instant, std::span<const double> variables, std::span<const std::size_t> held) override {
    past_ = statistics();
    ModelSystem system = integrator_->system();
    system.set_all(variables);
    system.go(instant.mode);
    system.hold({held.begin(), held.end()});
    system.settle_switches(instant.t, instant.x, nullptr);
    ModelEvents events(system.program(), variables, integrator_->events().begin(), true);
    events.resume(instant.t, instant.stops);
    Options<X> options = integrator_->options();
    const Interval<double> interval{instant.t, integrator_->interval().to};
    begin(std::move(system), instant.x, interval, std::move(options), std::move(events));
  }

 private:
  using Driving = Driver<ModelSystem, X, ModelEvents>;
  using Integrating = Integrator<ModelSystem, X, AnyMethod<ModelSystem, X>, ModelEvents>;

  struct Forward {
    SteppingByName& run;
    StepWatcher& watcher;
    void on_segment(Driving&, double, double to) { watcher.on_segment(run, to); }
    void on_event(Driving&, const EventOccurrence<X>& now) { watcher.on_event(run, now); }
  };

  void begin(ModelSystem system, X x0, Interval<double> interval, Options<X> options, ModelEvents events) {
    integrator_.emplace(std::move(system), std::move(x0), interval, method_.method, std::move(options),
                        std::move(events));
  }

  ModelMethod method_;
  Statistics past_;  // of integrators before this one
  std::optional<Integrating> integrator_;
};

}  // namespace

Statistics sum(const Statistics& a, const Statistics& b) {
  return {.steps = a.steps + b.steps,
          .rejected = a.rejected + b.rejected,
          .evaluations = a.evaluations + b.evaluations,
          .jacobians = a.jacobians + b.jacobians,
          .factorizations = a.factorizations + b.factorizations,
          .linear_solves = a.linear_solves + b.linear_solves,
          .events = a.events + b.events,
          .seconds = a.seconds + b.seconds};
}

std::unique_ptr<Stepping> begin_integration(std::string_view method, Integration integration,
                                            Interval<double> interval) {
  std::unique_ptr<Stepping> run;
  with_method(method, [&](auto chosen) {
    run = std::make_unique<SteppingByName>(model_method<decltype(chosen)>(), std::move(integration), interval);
  });
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
