// continuo/live/motion/clock.cpp
// The time that a model should have reached, and the speed that it reaches.
#include <continuo/live/motion/clock.hpp>

namespace continuo::live {

void PacedClock::set_speed(double wall, double t, double speed) {
  speed_ = speed;
  start(wall, t);
}

void PacedClock::start(double wall, double t) {
  wall_ = wall;
  t_ = t;
  marks_.clear();
}

void PacedClock::forgive(double wall, double t) {
  if (speed_ <= 0 || target(wall) - t <= largest_debt * speed_) return;
  wall_ = wall - largest_debt;
  t_ = t;
}

void PacedClock::reached(double wall, double t) {
  forgive(wall, t);
  marks_.push_back({wall, t});
  while (marks_.size() > 2 && wall - marks_[1].wall >= window) marks_.pop_front();
}

double PacedClock::reached_speed() const {
  if (marks_.size() < 2 || marks_.back().wall <= marks_.front().wall) return 0;
  return (marks_.back().t - marks_.front().t) / (marks_.back().wall - marks_.front().wall);
}

bool PacedClock::slow() const {
  const bool measured = marks_.size() >= 2 && marks_.back().wall - marks_.front().wall >= window / 2;
  return speed_ > 0 && measured && reached_speed() < 0.95 * speed_;
}

}  // namespace continuo::live
