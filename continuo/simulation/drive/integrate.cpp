// Runs the integration of a model by a method chosen by its name, watched by a recorder.
#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <continuo/simulation/drive/integrate.hpp>
#include <continuo/simulation/drive/model_method.hpp>
#include <continuo/simulation/motion_watcher.hpp>
#include <continuo/simulation/program/event_names.hpp>
#include <continuo/solve/integrator.hpp>
#include <continuo/solve/with_method.hpp>

namespace continuo {

template class Steps<model::ModelSystem, model::ModelSystem::X>;
template void Steps<model::ModelSystem, model::ModelSystem::X>::transfer_base(model::StateWriter&);
template void Steps<model::ModelSystem, model::ModelSystem::X>::transfer_base(model::StateReader&);
template Consistency make_consistent(model::ModelSystem&, const double&, model::ModelSystem::X&,
                                     const Tolerance<double>&, SolvedTo);
template std::string problem_of_result(model::ModelSystem&, const double&, const model::ModelSystem::X&);

}  // namespace continuo

namespace continuo::model {

namespace {

class Recording final : public StepWatcher {
 public:
  Recording(RunRecorder& recorder, MotionWatcher* watcher) : recorder_(recorder), watcher_(watcher) {}

  void on_segment(Stepping& run, double to) override {
    recorder_.on_segment(to,
                         At{&run, [](void* of, double t, ModelSystem::X& x) { static_cast<Stepping*>(of)->at(t, x); }});
    if (watcher_) watcher_->on_piece(to, [&run](double t, ModelSystem::X& x) { run.at(t, x); });
  }

  [[nodiscard]] double quiet_until() const override {
    return watcher_ ? StepWatcher::quiet_until() : recorder_.quiet_until();
  }

  void on_event(Stepping& run, const EventOccurrence<ModelSystem::X>& now) override {
    recorder_.on_event(now.t, names_.of(run.events(), now.events, true), now.before, now.after);
    if (watcher_) watcher_->on_jump(now.t, now.before, now.after);
  }

  [[nodiscard]] std::size_t marks_seen() const { return names_.marks_seen(); }
  void see_marks(std::size_t count) { names_.see(count); }

 private:
  RunRecorder& recorder_;
  MotionWatcher* watcher_;  // may be null
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
    [[nodiscard]] double quiet_until(Driving&) const { return watcher.quiet_until(); }
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
  with_method<AllMethods>(method, [&](auto chosen) {
    run = std::make_unique<SteppingByName>(model_method<decltype(chosen)>(), std::move(integration), interval);
  });
  return run;
}

namespace {

constexpr std::chrono::seconds checkpoint_of_clock{10};  // a long run that is killed loses no more than this
// Rows wait for the next checkpoint in memory. They are more than what a checkpoint has besides.
constexpr std::size_t bytes_of_rows = std::size_t{4} << 20, rows_to_state = 8;

/// A run on its way to its end.
class Progression {
 public:
  Progression(std::string_view method, Integration integration, RunRecorder& recorder, Run& run,
              const Followers& followers)
      : options_(integration.options),
        recorder_(recorder),
        watcher_(followers.watcher),
        recording_(recorder, watcher_),
        run_(run),
        log_(followers.log),
        steps_(begin_integration(method, std::move(integration), {run.plan.from, run.plan.to})) {
    if (log_) recorder_.collect_parts();
    if (log_ && log_->checkpoints() > 0)
      every_ = (run.plan.to - run.plan.from) / static_cast<double>(log_->checkpoints());
  }

  void begin() {
    recorder_.begin(run_.plan.from, steps_->x());  // where unknowns of algebraic equations have been found
    if (watcher_) watcher_->begin(run_.plan, steps_->x());
    next_ = run_.plan.from;
  }

  [[nodiscard]] bool begin_from(const IntegrationCheckpoint& checkpoint) {
    ByteReader reader(checkpoint.state);
    steps_->restore(reader);
    reader.expect_end();
    if (!reader.ok() || steps_->t() != checkpoint.t || checkpoint.marks_seen > steps_->events().marks().size())
      return false;
    recording_.see_marks(checkpoint.marks_seen);
    next_ = checkpoint.t + every_;
    return true;
  }

  void go() {
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t count = 1;; ++count) {
      if (log_) note();
      if (recorder_.is_refused() || !steps_->advance(recording_)) break;
      if (count % 1024 == 0 && options_.progress) options_.progress(steps_->t());
    }
    recorder_.finish(steps_->t(), steps_->x());
    run_.outcome = steps_->outcome();
    if (recorder_.is_refused()) run_.outcome = {.ending = Ending::stopped_by_callback, .t = steps_->t()};
    run_.statistics = steps_->statistics();
    run_.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    run_.stop_text = steps_->events().stop_text();
  }

 private:
  /// Writes a checkpoint where one is due by the time of the run or by the clock, and where the run is about to be
  /// broken off.
  void note() {
    if (!(every_ > 0)) return;
    const double t = steps_->t();
    const auto now = std::chrono::steady_clock::now();
    const Statistics cost = steps_->statistics();
    const bool is_broken_off = (options_.interrupt && options_.interrupt->load(std::memory_order_relaxed)) ||
                               cost.steps + cost.rejected >= options_.max_steps;
    const bool has_many_rows = recorder_.bytes_of_part() >= std::max(bytes_of_rows, rows_to_state * bytes_of_state_);
    if (t < next_ && now - noted_ < checkpoint_of_clock && !is_broken_off && !has_many_rows) return;
    noted_ = now;
    next_ = t + every_;
    IntegrationCheckpoint checkpoint{.t = t, .part = recorder_.part(), .marks_seen = recording_.marks_seen()};
    ByteWriter writer;
    steps_->save(writer);
    checkpoint.state = writer.take();
    bytes_of_state_ = checkpoint.state.size();
    log_->add(checkpoint);
  }

  Options<ModelSystem::X> options_;
  RunRecorder& recorder_;
  MotionWatcher* watcher_;  // may be null
  Recording recording_;
  Run& run_;
  IntegrationLog* log_;
  std::unique_ptr<Stepping> steps_;
  double every_ = 0, next_ = 0;
  std::size_t bytes_of_state_ = 0;  // of the last checkpoint
  std::chrono::steady_clock::time_point noted_ = std::chrono::steady_clock::now();
};

}  // namespace

void integrate(std::string_view method, Integration integration, RunRecorder& recorder, Run& run,
               const Followers& followers) {
  Progression progression(method, std::move(integration), recorder, run, followers);
  progression.begin();
  progression.go();
}

bool integrate_from(const IntegrationCheckpoint& checkpoint, Integration integration, RunRecorder& recorder, Run& run,
                    IntegrationLog* log) {
  Progression progression(run.plan.method, std::move(integration), recorder, run, {.log = log});
  if (!progression.begin_from(checkpoint)) return false;
  progression.go();
  return true;
}

}  // namespace continuo::model
