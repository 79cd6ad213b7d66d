// continuo/live/motion/clock.hpp
// The time that a model should have reached: k times as fast as the clock on the wall.
//
//   PacedClock clock;
//   clock.start(wall, t);
//   clock.forgive(wall, t);  advance_to(clock.target(wall));  clock.reached(wall, t);
//
// A computer that is too slow falls behind by `largest_debt` at most: any further delay is dropped, so that the motion
// slows down evenly instead of pursuing a target that it cannot reach.
#pragma once
#include <deque>
#include <functional>
#include <limits>

namespace continuo::live {

/// The time on the wall: seconds, never backwards.
using WallClock = std::function<double()>;

class PacedClock {
 public:
  static constexpr double largest_debt = 0.25;  // seconds on the wall: a stall that long is caught up with
  static constexpr double window = 1;           // seconds over which the speed is measured, so that it can be read

  /// Simulated time per second on the wall; 0: as fast as can be.
  double speed() const { return speed_; }
  void set_speed(double wall, double t, double speed);
  /// Goes on from t: after a pause, a jump, a look back.
  void start(double wall, double t);

  /// Where t should be.
  double target(double wall) const {
    return speed_ > 0 ? t_ + speed_ * (wall - wall_) : std::numeric_limits<double>::infinity();
  }
  /// Drops what is owed at t beyond the largest debt: before a target is set, and after it was missed.
  void forgive(double wall, double t);
  /// How far it came.
  void reached(double wall, double t);

  /// Over the last second; 0 before there is anything to measure.
  double reached_speed() const;
  /// Below the speed asked for by more than can be mistaken.
  bool slow() const;

 private:
  struct Mark {
    double wall, t;
  };
  double speed_ = 1, wall_ = 0, t_ = 0;
  std::deque<Mark> marks_;
};

}  // namespace continuo::live
