// A run of a model whose steps somebody else takes: its events, by the driver that every run has, and who sees them.
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <continuo/simulation/program/model_events.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/simulation/stepping.hpp>
#include <continuo/solve/driver/driver.hpp>

namespace continuo::model {

/// Who lets runs begin, and sees their motions.
class SeenRuns {
 public:
  using X = ModelSystem::X;

  virtual ~SeenRuns() = default;
  /// How this run begins.
  [[nodiscard]] virtual Integration integration(std::size_t run) = 0;
  /// Whether the piece of its motion that ends at `to` is to be shown.
  [[nodiscard]] virtual bool wants(std::size_t run, double to) = 0;
  /// Shows it: `at(t, x)` gives the state at a time of the piece, its ends included.
  virtual void on_piece(std::size_t run, double to, const std::function<void(double t, X& x)>& at) = 0;
  /// Events have fired.
  virtual void on_event(std::size_t run, const ModelEvents& events, const EventOccurrence<X>& now) = 0;
};

class SeenRun : private Driver<ModelSystem, ModelSystem::X, ModelEvents> {
  using Base = Driver<ModelSystem, ModelSystem::X, ModelEvents>;

 public:
  using X = ModelSystem::X;

  /// Begins in the state x0. The steps have the system, and are told which step has been taken.
  SeenRun(std::unique_ptr<Steps<ModelSystem, X>> steps, X x0, Interval<double> interval, Options<X> options,
          ModelEvents events);

  /// What happens at the beginning of the run, or in the step that has been taken. Returns when the run has ended, or
  /// waits for its next step.
  void pass(SeenRuns& seen, std::size_t run);
  /// It has taken steps without anything in them up to the beginning of the present one, t, in the state x.
  void move_on(double t, X x);
  /// It waits for a step: it can be passed again.
  void go_on() { extend_to(interval().to); }

  using Base::events, Base::outcome, Base::system, Base::t, Base::x;

  /// Whether a guard is at zero since an event, and has to be looked at in any case.
  [[nodiscard]] bool is_at_zero() const { return is_at_zero_; }
  /// A component that an event has changed and no equation reads: the steps go on with what it was before.
  struct Constant {
    std::size_t component;
    double value;
  };
  [[nodiscard]] std::span<const Constant> constants() const { return constants_; }
  /// The time of the next event of the schedule.
  [[nodiscard]] double next_scheduled() const { return next_scheduled_; }

 private:
  void look();

  bool is_at_zero_ = true;
  std::vector<Constant> constants_;
  double next_scheduled_ = 0;
};

}  // namespace continuo::model
