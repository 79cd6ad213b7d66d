// continuo/live/track.hpp
// One integration that the view draws on: asked for a step where its last one has been shown to the end, and put back
// to any instant of that step where a hand changes something there.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <continuo/model/stepping.hpp>

namespace continuo::live {

/// Events of one instant as they happened.
struct Passed {
  struct Name {
    std::string event, mark;
  };
  double t;
  std::vector<Name> names;  // empty: the step of an input, which is nobody's event
  std::vector<double> before, after;
  std::size_t mode;  // afterwards, like
  std::vector<std::size_t> stops;
};

class Track final : model::StepWatcher {
 public:
  using X = model::ModelSystem::X;

  /// `plan` as `plan_run` gives it.
  Track(const std::shared_ptr<const model::ModelProgram>& program, const model::Plan& plan);

  double t() const { return run_->t(); }
  /// One step, or less where an event changes the state. False: it is over, and `outcome` says why.
  bool advance();
  /// The events of the last step, in order.
  const std::vector<Passed>& passed() const { return passed_; }
  /// x at a time of the last step.
  void at(double t, X& x) { run_->at(t, x); }
  /// What it takes to go on from a time of the last step.
  model::Instant instant_at(double t);
  void go_on(const model::Instant& instant, std::span<const double> variables, std::span<const std::size_t> held);

  const model::ModelSystem& system() const { return run_->system(); }
  const model::ModelEvents& events() const { return run_->events(); }
  const Outcome<double>& outcome() const { return run_->outcome(); }
  const std::string& stop_text() const { return run_->events().stop_text(); }
  Statistics statistics() const { return run_->statistics(); }
  const model::Plan& plan() const { return plan_; }

 private:
  void stretch(model::Stepping&, double) override {}
  void happening(model::Stepping& run, const Happening<X>& now) override;
  void remember();

  static constexpr std::size_t most_marks = 100'000;

  model::Plan plan_;
  double reach_;  // the length of the run in the text: no step is longer
  std::unique_ptr<model::Stepping> run_;
  std::size_t mode_ = 0;            // before the last step, like
  std::vector<std::size_t> stops_;  //
  std::vector<Passed> passed_;
  std::size_t marks_seen_ = 0;
  std::vector<std::size_t> held_;
  std::vector<double> variables_;
};

}  // namespace continuo::live
