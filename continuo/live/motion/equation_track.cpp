// continuo/live/motion/equation_track.cpp
// Integrates a model's equations as a Track.
#include <atomic>
#include <chrono>
#include <future>
#include <limits>
#include <optional>
#include <utility>

#include <continuo/live/motion/track.hpp>
#include <continuo/live/motion/world_track.hpp>
#include <continuo/runs/kind.hpp>

namespace continuo::live {

namespace {

constexpr double lengths_ahead = 1e6;
constexpr std::size_t most_marks = 100'000;
constexpr std::size_t states_of_brief_steps = 64;  // their steps take no time to speak of
constexpr double brief_step = 1e-3;                // seconds: to start a thread takes a twentieth of it

/// A run with the events of its last step: all that a thread needs which computes a step.
class WatchedRun final : model::StepWatcher {
 public:
  WatchedRun(const std::shared_ptr<const model::ModelProgram>& program, const model::Plan& plan, double length)
      : run_(model::begin_integration(plan.method, integration(program, plan, length),
                                      {plan.from, plan.from + lengths_ahead * length})) {}

  bool advance() {
    passed_.clear();
    return run_->advance(*this);
  }
  void go_on(const Instant& instant, std::span<const double> variables, std::span<const std::size_t> held) {
    give_up_ = false;
    passed_.clear();
    names_.restart();
    run_->go_on(instant, variables, held);
  }
  /// From any thread: the step that is being made ends as soon as it can.
  void give_up() { give_up_ = true; }

  model::Stepping& stepping() { return *run_; }
  const model::Stepping& stepping() const { return *run_; }
  const std::vector<Passed>& passed() const { return passed_; }
  bool has_many_marks() const { return names_.marks_seen() > most_marks; }

 private:
  model::Integration integration(const std::shared_ptr<const model::ModelProgram>& program, const model::Plan& plan,
                                 double longest_step) {
    model::Experiment experiment;
    experiment.max_step = longest_step;
    experiment.max_steps = std::numeric_limits<std::size_t>::max() / 256;
    experiment.interrupt = &give_up_;
    return model::integration_of(program, plan, experiment);
  }
  void on_segment(model::Stepping&, double) override {}
  void on_event(model::Stepping& run, const EventOccurrence<Track::X>& now) override {
    const model::ModelEvents& events = run.events();
    const auto stops = events.stops();
    passed_.push_back({now.t,
                       names_.of(events, now.events),
                       now.before,
                       now.after,
                       run.system().mode(),
                       {stops.begin(), stops.end()}});
  }

  std::atomic<bool> give_up_{false};
  std::unique_ptr<model::Stepping> run_;
  std::vector<Passed> passed_;
  model::EventNames names_;
};

class EquationTrack final : public Track {
 public:
  EquationTrack(const std::shared_ptr<const model::ModelProgram>& program, const model::Plan& plan,
                StepInterrupt* interrupt)
      : Track(plan),
        interrupt_(interrupt),
        run_(std::make_shared<WatchedRun>(program, plan, length())),
        variables_(plan.variables) {
    remember();
  }
  ~EquationTrack() override {
    if (step_.valid()) interrupt_->leave(std::move(step_));
  }

  double t() const override { return waits_ ? begin_.t : run_->stepping().t(); }

  bool advance(double) override {
    passed_.clear();
    if (waits_ && !restart()) return false;
    remember();
    if (run_->has_many_marks()) run_->go_on(begin_, variables_, held_);  // which forgets them
    const std::optional<bool> more = compute();
    if (!more) return false;
    statistics_ = run_->stepping().statistics();
    passed_ = run_->passed();
    if (*more) return true;
    if (outcome().ending != Ending::reached_end) return false;
    run_->stepping().extend_to(t() + lengths_ahead * length());
    return true;
  }
  bool was_interrupted() const override { return waits_; }

  void at(double t, X& x) override {
    if (waits_) {
      x = begin_.x;
    } else {
      run_->stepping().at(t, x);
    }
  }

  Instant instant_at(double t, bool) override {
    Instant instant = begin_;
    if (waits_) return instant;
    instant.t = t;
    at(t, instant.x);
    for (const Passed& passed : passed_) {
      if (passed.t > t) break;
      instant.mode = passed.mode;
      instant.stops = passed.stops;
    }
    return instant;
  }

  Status go_on(const Instant& instant, std::span<const double> variables, std::span<const std::size_t> held) override {
    variables_.assign(variables.begin(), variables.end());
    held_.assign(held.begin(), held.end());
    passed_.clear();
    begin_ = instant;
    if (step_.valid()) {  // the run is not free yet
      waits_ = true;
    } else {
      waits_ = false;
      run_->go_on(instant, variables_, held_);
      remember();
    }
    return {};
  }

  const Outcome<double>& outcome() const override { return run_->stepping().outcome(); }
  const std::string& stop_text() const override { return run_->stepping().events().stop_text(); }
  Statistics statistics() const override { return statistics_; }
  const model::Stepping* equations() const override { return waits_ ? nullptr : &run_->stepping(); }

 private:
  /// One step; nothing where it was interrupted. What may take long is computed in a thread, and not waited for then.
  std::optional<bool> compute() {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    const bool is_brief = begin_.x.size() < states_of_brief_steps || (knows_cost_ && cost_ < brief_step);
    std::optional<bool> more;
    if (!interrupt_ || is_brief) {
      more = run_->advance();
    } else {
      step_ = std::async(std::launch::async, [run = run_] { return run->advance(); });
      if (interrupt_->wait_for(step_)) {
        more = step_.get();
      } else {
        run_->give_up();
        waits_ = true;
      }
    }
    cost_ = std::chrono::duration<double>(Clock::now() - begin).count();
    knows_cost_ = true;
    return more;
  }

  /// After a step that was given up: from where it began. False: it is still being computed, and somebody else is
  /// interrupting.
  bool restart() {
    if (step_.valid()) {
      if (!interrupt_->wait_for(step_)) return false;
      static_cast<void>(step_.get());
    }
    waits_ = false;
    run_->go_on(begin_, variables_, held_);
    return true;
  }

  void remember() {
    const model::Stepping& run = run_->stepping();
    const auto stops = run.events().stops();
    begin_.t = run.t();
    begin_.x = run.x();
    begin_.mode = run.system().mode();
    begin_.stops.assign(stops.begin(), stops.end());
  }

  StepInterrupt* interrupt_;
  std::shared_ptr<WatchedRun> run_;
  std::future<bool> step_;  // valid while a step that was given up is being computed
  Instant begin_;           // where the last step began
  bool waits_ = false;      // the motion stands there, and the run is to be taken back to it
  bool knows_cost_ = false;
  double cost_ = 0;  // of the last step, in seconds
  Statistics statistics_;
  std::vector<std::size_t> held_;
  std::vector<double> variables_;
};

}  // namespace

Result<std::unique_ptr<Track>> make_track(const std::shared_ptr<const model::ModelProgram>& program,
                                          const model::Plan& plan, StepInterrupt* interrupt) {
  if (runs::kind_of(program->model).solver == runs::Solver::world) return make_world_track(program, plan);
  return std::unique_ptr<Track>(std::make_unique<EquationTrack>(program, plan, interrupt));
}

}  // namespace continuo::live
