// A motion of a model that is advanced to the times that a caller asks for, and changed on its way.
//
//   Motion motion(program, plan, experiment);
//   if (motion.advance(0.5)) use(motion.x());
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <continuo/simulation/program/event_names.hpp>
#include <continuo/simulation/stepping.hpp>

namespace continuo::c {

/// An event that has occurred.
struct PassedEvent {
  double t;
  std::string name;  // its mark, if it has one
};

/// A motion that is advanced step by step. What a step has found beyond the time asked for is kept, and thrown away
/// where a parameter or the state is changed before.
class Motion final : model::StepWatcher {
 public:
  Motion(const std::shared_ptr<const model::ModelProgram>& program, const model::Plan& plan,
         const model::Experiment& experiment);

  /// Moves on to t. False where the run has ended before.
  [[nodiscard]] bool advance(double t);
  [[nodiscard]] double t() const { return t_; }
  [[nodiscard]] const std::vector<double>& x() const { return x_; }
  /// Goes on from another state, or with other parameters.
  void go_on(std::vector<double> x, std::span<const double> variables);
  [[nodiscard]] const Outcome<double>& outcome() const { return run_->outcome(); }
  [[nodiscard]] const std::string& stop_text() const { return run_->events().stop_text(); }
  /// Those up to t.
  [[nodiscard]] std::vector<PassedEvent> events() const;
  [[nodiscard]] std::vector<double> variables() const { return run_->system().variables(); }

 private:
  struct Fired {
    PassedEvent event;
    std::size_t mode;
    std::vector<std::size_t> stops;
  };
  void on_segment(model::Stepping& run, double to) override;
  void on_event(model::Stepping& run, const EventOccurrence<model::ModelSystem::X>& now) override;
  [[nodiscard]] model::Instant instant() const;

  std::unique_ptr<model::Stepping> run_;
  model::EventNames names_;
  double length_;
  double t_;
  std::vector<double> x_;
  bool has_ended_ = false;
  std::vector<double> scratch_;
  model::Instant step_begin_;  // mode and stops where the last step began
  std::vector<Fired> fired_;   // in all, those of the last step possibly beyond t
};

}  // namespace continuo::c
