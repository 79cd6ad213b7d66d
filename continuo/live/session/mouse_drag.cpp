// The mouse: things and bodies in a hand, and how they leave it.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <continuo/live/session/mouse_drag.hpp>

namespace continuo::live {

namespace {

constexpr double hand_looks_back = 0.1;  // second: over which the speed of a hand is measured
constexpr double hand_rests = 0.08;      // that has not moved for so long

/// From above zero to zero counts: a run that began at zero would have to leave it first, and nothing would turn it
/// back.
bool is_crossed(double before, double after) {
  return before > 0 ? after <= 0 : before == 0 && after < 0;
}

bool all_finite(std::span<const double> to) {
  return std::ranges::all_of(to, [](double v) { return std::isfinite(v); });
}

}  // namespace

void MouseDrag::begin() {
  body_.reset();
  in_hand_.clear();
  show();
}

void MouseDrag::show() {
  const LiveModel& shown = *playback_.shown();
  targets_.clear();
  for (const DragTarget& target : shown.drag_targets) targets_.emplace_back(shown, target.nodes, playback_.variables());
}

void MouseDrag::move(std::size_t item, std::span<const double> to) {
  const LiveModel& shown = *playback_.shown();
  if (item >= shown.drawing.size() || !shown.drawing[item].drag_target) return notices_.note("this cannot be dragged");
  const std::size_t number = *shown.drawing[item].drag_target;
  const DragTarget& target = shown.drag_targets[number];
  if (to.size() != target.dimension || !all_finite(to))
    return notices_.note(fmt::format("a drag needs {} coordinates", target.dimension));
  playback_.leave_look();
  if (playback_.held_states().empty() || target_ != number) in_hand_.clear();
  const std::vector<std::size_t> held = target.held();
  playback_.hold_states(held);
  target_ = number;
  targets_[number].use(playback_.variables());
  Instant instant = playback_.instant();
  std::vector<double> x = pull(target, targets_[number].evaluation(), playback_.t(), instant.x, to);
  stop_at_guards(target, instant.x, x);
  const bool moved = std::ranges::any_of(target.positions, [&](std::size_t i) { return x[i] != instant.x[i]; });
  if (moved) instant.mode = shown.model().start_mode;
  instant.moved = true;
  instant.x = std::move(x);
  playback_.go_on_from(instant, held);
}

void MouseDrag::hold_body(std::optional<HeldBody> held) {
  body_ = held;
  playback_.hold_body(held);
}

void MouseDrag::move_body(std::size_t body, std::span<const double> to) {
  const worlds::WorldRun* world = playback_.main().world();
  if (!world || body >= world->bodies().size()) return notices_.note("there is no such body");
  if (to.size() != static_cast<std::size_t>(world->dimension()) || !all_finite(to))
    return notices_.note(fmt::format("a drag needs {} coordinates", world->dimension()));
  playback_.leave_look();
  if (!body_ || body_->body != body) in_hand_.clear();
  HeldBody held{body, {}};
  std::ranges::copy(to, held.to.begin());
  hold_body(held);
}

void MouseDrag::watch(double wall) {
  if (playback_.held_states().empty() && !body_) return;
  InHand now{wall, playback_.t(), {}};
  if (body_) {
    const worlds::Point place = playback_.main().world()->position(body_->body);
    now.x.assign(place.begin(), place.end());
  } else {
    const Track::X x = playback_.instant(false).x;
    for (const std::size_t i : held_target().positions) now.x.push_back(x[i]);
  }
  if (!in_hand_.empty() && in_hand_.back().x == now.x) return;
  in_hand_.push_back(std::move(now));
  while (in_hand_.size() > 2 && in_hand_[1].wall <= wall - hand_looks_back) in_hand_.pop_front();
}

/// In the time of the model: what is shown ten times as slow flies on as it was seen to move. 0 in a pause.
std::vector<double> MouseDrag::speed_of_hand() const {
  if (in_hand_.empty()) return {};
  const InHand &first = in_hand_.front(), &last = in_hand_.back();
  std::vector<double> speed(last.x.size(), 0.0);
  if (!playback_.playing() || !(last.t > first.t) || now_() - last.wall > hand_rests) return speed;
  for (std::size_t i = 0; i < speed.size(); ++i) speed[i] = (last.x[i] - first.x[i]) / (last.t - first.t);
  return speed;
}

void MouseDrag::release(bool still) {
  const std::vector<double> speed = still ? std::vector<double>() : speed_of_hand();
  in_hand_.clear();
  if (body_) {
    worlds::Point velocity{};
    std::ranges::copy(speed, velocity.begin());
    playback_.let_go(body_->body, velocity);
    hold_body(std::nullopt);
  }
  const std::vector<std::size_t> were_held(playback_.held_states().begin(), playback_.held_states().end());
  if (were_held.empty()) return;
  playback_.hold_states({});
  if (std::ranges::all_of(speed, [](double v) { return v == 0; })) return playback_.go_on();
  Instant instant = playback_.instant();
  const std::vector<std::size_t>& positions = held_target().positions;
  const auto& pairs = playback_.shown()->model().pairs;
  for (std::size_t k = 0; k < speed.size(); ++k) {
    const auto pair = std::ranges::find(pairs, positions[k], &PositionVelocity::position);
    if (pair != pairs.end()) instant.x[pair->velocity] = speed[k];
  }
  instant.moved = true;
  playback_.go_on_from(instant, were_held);
}

/// A hand does not push through what an event would have turned back: where a guard whose event changes something would
/// have fired, the way ends just before.
void MouseDrag::stop_at_guards(const DragTarget& target, const std::vector<double>& from,
                               std::vector<double>& to) const {
  constexpr int halvings = 50;
  const model::Stepping* equations = playback_.main().equations();
  if (!equations) return;
  const double t = playback_.t();
  model::ModelSystem system = equations->system();
  system.go(playback_.shown()->model().start_mode);
  model::ModelEvents guards = equations->events();
  std::vector<double> before(guards.size()), after(guards.size());
  guards.guards(system, t, from, before);
  const auto fires = [&](const std::vector<double>& x) {
    guards.guards(system, t, x, after);
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
    for (const std::size_t i : target.positions) tried[i] = from[i] + part * (to[i] - from[i]);
    return tried;
  };
  for (int k = 0; k < halvings; ++k) {
    const double middle = (good + bad) / 2;
    (fires(at(middle)) ? bad : good) = middle;
  }
  to = at(good);
}

}  // namespace continuo::live
