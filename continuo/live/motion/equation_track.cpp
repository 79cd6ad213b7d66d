// continuo/live/motion/equation_track.cpp
// Integrates a model's equations as a Track.
#include <limits>
#include <utility>

#include <continuo/live/motion/track.hpp>
#include <continuo/live/motion/world_track.hpp>
#include <continuo/runs/kind.hpp>

namespace continuo::live {

namespace {

constexpr double lengths_ahead = 1e6;
constexpr std::size_t most_marks = 100'000;

class EquationTrack final : public Track, model::StepWatcher {
 public:
  EquationTrack(const std::shared_ptr<const model::ModelProgram>& program, const model::Plan& plan)
      : Track(plan),
        run_(model::begin_integration(plan.method, model::integration_of(program, plan, endless(length())),
                                      {plan.from, plan.from + lengths_ahead * length()})),
        variables_(plan.variables) {
    remember();
  }

  double t() const override { return run_->t(); }

  bool advance(double) override {
    remember();
    if (names_.marks_seen() > most_marks) restart(instant_at(t(), true));  // which forgets them
    if (run_->advance(*this)) return true;
    if (run_->outcome().ending != Ending::reached_end) return false;
    run_->extend_to(t() + lengths_ahead * length());
    return true;
  }

  void at(double t, X& x) override { run_->at(t, x); }

  Instant instant_at(double t, bool) override {
    Instant instant;
    instant.t = t;
    instant.x = run_->x();
    instant.mode = mode_;
    instant.stops = stops_;
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
    restart(instant);
    return {};
  }

  const Outcome<double>& outcome() const override { return run_->outcome(); }
  const std::string& stop_text() const override { return run_->events().stop_text(); }
  Statistics statistics() const override { return run_->statistics(); }
  const model::Stepping* equations() const override { return run_.get(); }

 private:
  void restart(const Instant& instant) {
    run_->go_on(instant, variables_, held_);
    names_.restart();
    remember();
  }
  static model::Experiment endless(double longest_step) {
    model::Experiment experiment;
    experiment.max_step = longest_step;
    experiment.max_steps = std::numeric_limits<std::size_t>::max() / 256;
    return experiment;
  }

  void remember() {
    mode_ = run_->system().mode();
    const auto stops = run_->events().stops();
    stops_.assign(stops.begin(), stops.end());
    passed_.clear();
  }

  void on_segment(model::Stepping&, double) override {}
  void on_event(model::Stepping& run, const EventOccurrence<X>& now) override {
    const model::ModelEvents& events = run.events();
    const auto stops = events.stops();
    passed_.push_back({now.t,
                       names_.of(events, now.events),
                       now.before,
                       now.after,
                       run.system().mode(),
                       {stops.begin(), stops.end()}});
  }

  std::unique_ptr<model::Stepping> run_;
  std::size_t mode_ = 0;            // before the last step, like
  std::vector<std::size_t> stops_;  //
  model::EventNames names_;
  std::vector<std::size_t> held_;
  std::vector<double> variables_;
};

}  // namespace

Result<std::unique_ptr<Track>> make_track(const std::shared_ptr<const model::ModelProgram>& program,
                                          const model::Plan& plan) {
  if (runs::kind_of(program->model).solver == runs::Solver::world) return make_world_track(program, plan);
  return std::unique_ptr<Track>(std::make_unique<EquationTrack>(program, plan));
}

}  // namespace continuo::live
