// continuo/live/session/session_drag.cpp
// The mouse: things and bodies in a hand, and how they leave it.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <continuo/live/session.hpp>
#include <continuo/live/session/messages.hpp>

namespace continuo::live {

namespace {

constexpr double hand_looks_back = 0.1;  // second: over which the speed of a hand is measured
constexpr double hand_rests = 0.08;      // that has not moved for so long

/// From above zero to zero counts: a run that began at zero would have to leave it first, and nothing would turn it
/// back.
bool is_crossed(double before, double after) {
  return before > 0 ? after <= 0 : before == 0 && after < 0;
}

}  // namespace

void Session::drag(std::size_t item, std::span<const double> to) {
  if (item >= shown_->drawing.size() || !shown_->drawing[item].drag_target) return say_note("this cannot be dragged");
  const std::size_t number = *shown_->drawing[item].drag_target;
  const DragTarget& drag_target = shown_->drag_targets[number];
  if (to.size() != drag_target.dimension || !std::ranges::all_of(to, [](double v) { return std::isfinite(v); }))
    return say_note(fmt::format("a drag needs {} coordinates", drag_target.dimension));
  leave_look();
  if (held_.empty() || held_drag_target_ != number) in_hand_.clear();
  held_ = drag_target.held();
  held_drag_target_ = number;
  use_variables(variables_);
  Instant instant = main_->instant_at(cursor_);
  std::vector<double> x = pull(drag_target, drag_targets_[number], cursor_, instant.x, to);
  stop_at_guards(drag_target, instant.x, x);
  const bool moved = std::ranges::any_of(drag_target.positions, [&](std::size_t i) { return x[i] != instant.x[i]; });
  if (moved) instant.mode = shown_->model().start_mode;
  instant.moved = true;
  instant.x = std::move(x);
  touch(std::move(instant), held_);
}

void Session::hold_body(std::optional<HeldBody> held) {
  held_body_ = held;
  main_->hold(held);
  if (ghost_) ghost_->hold(held);
  if (!playing_) rewind_to(cursor_);
  emit(main_->instant_at(cursor_));
}

void Session::drag_body(std::size_t body, std::span<const double> to) {
  const worlds::WorldRun* world = main_->world();
  if (!world || body >= world->bodies().size()) return say_note("there is no such body");
  const bool finite = std::ranges::all_of(to, [](double v) { return std::isfinite(v); });
  if (to.size() != static_cast<std::size_t>(world->dimension()) || !finite)
    return say_note(fmt::format("a drag needs {} coordinates", world->dimension()));
  leave_look();
  if (!held_body_ || held_body_->body != body) in_hand_.clear();
  HeldBody held{body, {}};
  std::ranges::copy(to, held.to.begin());
  hold_body(held);
}

void Session::pick(std::size_t body) {
  const worlds::WorldRun* world = main_->world();
  if (!world || body >= world->bodies().size()) return say_note("there is no such body");
  audience_.hear(Topic::message, picked_json(*world, body));
}

/// Where what is held has come to, and when.
void Session::watch_hand(double wall) {
  if (held_.empty() && !held_body_) return;
  InHand now{wall, cursor_, {}};
  if (held_body_) {
    const worlds::Point place = main_->world()->position(held_body_->body);
    now.x.assign(place.begin(), place.end());
  } else {
    const Track::X x = main_->instant_at(cursor_, false).x;
    for (const std::size_t i : shown_->drag_targets[held_drag_target_].positions) now.x.push_back(x[i]);
  }
  if (!in_hand_.empty() && in_hand_.back().x == now.x) return;
  in_hand_.push_back(std::move(now));
  while (in_hand_.size() > 2 && in_hand_[1].wall <= wall - hand_looks_back) in_hand_.pop_front();
}

/// In the time of the model: what is shown ten times as slow flies on as it was seen to move. 0 in a pause.
std::vector<double> Session::speed_of_hand() const {
  if (in_hand_.empty()) return {};
  const InHand &first = in_hand_.front(), &last = in_hand_.back();
  std::vector<double> speed(last.x.size(), 0.0);
  if (!playing_ || !(last.t > first.t) || now_() - last.wall > hand_rests) return speed;
  for (std::size_t i = 0; i < speed.size(); ++i) speed[i] = (last.x[i] - first.x[i]) / (last.t - first.t);
  return speed;
}

void Session::release(bool still) {
  const std::vector<double> speed = still ? std::vector<double>() : speed_of_hand();
  in_hand_.clear();
  if (held_body_) {
    const std::size_t body = held_body_->body;
    worlds::Point velocity{};
    std::ranges::copy(speed, velocity.begin());
    main_->let_go(body, velocity);
    if (ghost_) ghost_->let_go(body, velocity);
    hold_body(std::nullopt);
  }
  if (held_.empty()) return;
  const std::vector<std::size_t> were_held = std::exchange(held_, {});
  if (std::ranges::all_of(speed, [](double v) { return v == 0; })) return touch();
  Instant instant = main_->instant_at(cursor_);
  const std::vector<std::size_t>& positions = shown_->drag_targets[held_drag_target_].positions;
  for (std::size_t k = 0; k < speed.size(); ++k) {
    const auto pair = std::ranges::find(shown_->model().pairs, positions[k], &PositionVelocity::position);
    if (pair != shown_->model().pairs.end()) instant.x[pair->velocity] = speed[k];
  }
  instant.moved = true;
  touch(std::move(instant), were_held);
}

/// A hand does not push through what an event would have turned back: where a guard whose event changes something would
/// have fired, the way ends just before.
void Session::stop_at_guards(const DragTarget& drag_target, const std::vector<double>& from, std::vector<double>& to) {
  constexpr int halvings = 50;
  if (!main_->equations()) return;
  model::ModelSystem system = main_->equations()->system();
  system.go(shown_->model().start_mode);
  model::ModelEvents guards = main_->equations()->events();
  std::vector<double> before(guards.size()), after(guards.size());
  guards.guards(system, cursor_, from, before);
  const auto fires = [&](const std::vector<double>& x) {
    guards.guards(system, cursor_, x, after);
    for (std::size_t i = 0; i < guards.size(); ++i) {
      if (!guards.is_guard(i) || !(guards.can_assign(i) || guards.can_restart(i)) || !guards.active(system, i))
        continue;
      const Direction direction = guards.direction(i);
      if (direction != Direction::rises && is_crossed(before[i], after[i])) return true;
      if (direction != Direction::falls && is_crossed(-before[i], -after[i])) return true;
    }
    return false;
  };
  if (!fires(to)) return;
  std::vector<double> tried = to;
  double good = 0, bad = 1;
  const auto at = [&](double part) {
    for (const std::size_t i : drag_target.positions) tried[i] = from[i] + part * (to[i] - from[i]);
    return tried;
  };
  for (int k = 0; k < halvings; ++k) {
    const double middle = (good + bad) / 2;
    (fires(at(middle)) ? bad : good) = middle;
  }
  to = at(good);
}

}  // namespace continuo::live
