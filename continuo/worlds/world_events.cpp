// Searches for the guards of a model between looks at its bodies, and fires events and schedules.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <continuo/solve/events/event_location.hpp>
#include <continuo/worlds/world_events.hpp>

namespace continuo::worlds {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

constexpr std::size_t most_rounds = 10'000;  // of an instant

/// Whether a guard is on its other side, or at zero on the way there.
bool has_passed(Direction direction, int side, double now) {
  return side != 0 && !(side * now > 0) && watches(direction, -side);
}

/// The side of a guard that comes from `side`: zero belongs to the side to which it leads.
int side_after(int side, double now) {
  return now == 0 ? -side : sign_of(now);
}

}  // namespace

double slack_of(const WorldRun& world) {
  return 1e-9 * world.step();
}

WorldEvents::WorldEvents(const std::shared_ptr<const model::ModelProgram>& program, std::span<const double> variables,
                         double from, double look)
    : program_(program),
      system_(program, variables),
      events_(*program, variables, from),
      values_(events_.size()),
      before_(events_.size()),
      sides_(events_.size()),
      scheduled_after_(from),
      look_(look) {
  for (std::size_t i = 0; i < events_.size(); ++i) any_guard_ = any_guard_ || events_.is_guard(i);
  find_watched();
}

Status WorldEvents::begin(WorldRun& world, const Sink& sink) {
  place_guards(world);
  Status status = fire_rounds(world, take_due(world.time() + slack_of(world), true), sink);
  if (any_guard_) read_guards(world, before_);
  return status;
}

/// Gives guards the sides of their present values, without a past.
void WorldEvents::place_guards(WorldRun& world) {
  if (!any_guard_) return;
  read_guards(world, before_);
  std::ranges::transform(before_, sides_.begin(), [](double g) { return sign_of(g); });
}

double WorldEvents::next_scheduled() const {
  double next = never;
  for (std::size_t i = 0; i < events_.size(); ++i)
    if (!events_.is_guard(i)) next = std::min(next, events_.next_time(i, scheduled_after_, false));
  return next;
}

double WorldEvents::next(const WorldRun& world) const {
  const double step = world.step(), look = world.time() + (step > 0 ? step : look_);
  return any_guard_ ? std::min(next_scheduled(), look) : next_scheduled();
}

Status WorldEvents::advance(WorldRun& world, double to) {
  if (!any_guard_ || world.step() > 0) {
    Status status = world.advance_to(to);
    if (status && any_guard_) read_guards(world, values_);
    return status;
  }
  const Snapshot saved = world.snapshot();
  const X state = world.state();
  Status status = world.advance_to(to);
  if (status) status = look_at_first_contact(world, saved);
  if (!status) return status;
  read_guards(world, values_);
  if (!any_passed()) status = look_where_guards_turn(world, saved, state);
  return status && any_passed() ? go_back_to_event(world, saved) : status;
}

void WorldEvents::read_guards(WorldRun& world, std::vector<double>& values) {
  events_.guards(system_, world.time(), world.state(), values);
}
bool WorldEvents::passed(std::size_t i) const {
  return events_.is_guard(i) && events_.active(system_, i) && has_passed(events_.direction(i), sides_[i], values_[i]);
}
bool WorldEvents::any_passed() const {
  for (std::size_t i = 0; i < events_.size(); ++i)
    if (passed(i)) return true;
  return false;
}

/// Moves the world to the first instant at which a guard has changed its side, on the far side.
Status WorldEvents::go_back_to_event(WorldRun& world, const Snapshot& saved) {
  double low = saved.time, high = world.time();
  const auto move_to = [&](double t) {
    Status status = world.restore(saved);
    if (status) status = world.advance_to(t);
    if (status) read_guards(world, values_);
    return status;
  };
  const double least = 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(low), std::abs(high));
  while (high - low > least) {
    const double middle = low + (high - low) / 2;
    if (Status status = move_to(middle); !status) return status;
    (any_passed() ? high : low) = middle;
  }
  return move_to(high);
}

Status WorldEvents::fire_due(WorldRun& world, const Sink& sink) {
  const double until = world.time() + slack_of(world);
  std::vector<std::size_t> fired = take_passed();
  do {
    const std::vector<std::size_t> due = take_due(until, false);
    fired.insert(fired.end(), due.begin(), due.end());
    std::ranges::sort(fired);
    if (Status status = fire_rounds(world, std::move(fired), sink); !status) return status;
    fired.clear();
  } while (!stopped_ && next_scheduled() <= until);
  if (any_guard_) read_guards(world, before_);
  return {};
}

/// Updates the sides of guards. Returns those that have changed their side in the direction that their events watch.
std::vector<std::size_t> WorldEvents::take_passed() {
  std::vector<std::size_t> fired;
  for (std::size_t i = 0; any_guard_ && i < events_.size(); ++i) {
    if (!events_.is_guard(i)) continue;
    const bool is_fired = passed(i);
    if (is_fired) fired.push_back(i);
    if (is_fired || values_[i] != 0) sides_[i] = side_after(sides_[i], values_[i]);
  }
  return fired;
}

/// Returns the events of the next scheduled time up to `until`, which then counts as done.
std::vector<std::size_t> WorldEvents::take_due(double until, bool inclusive) {
  std::vector<std::size_t> due;
  double next = never;
  for (std::size_t i = 0; i < events_.size(); ++i) {
    if (events_.is_guard(i)) continue;
    const double time = events_.next_time(i, scheduled_after_, inclusive);
    if (time > until || time > next) continue;
    if (time < next) due.clear();
    next = time;
    due.push_back(i);
  }
  if (!due.empty()) scheduled_after_ = next;
  return due;
}

Status WorldEvents::fire_rounds(WorldRun& world, std::vector<std::size_t> fired, const Sink& sink) {
  for (std::size_t round = 0; !fired.empty() && !stopped_; ++round) {
    if (round == most_rounds)
      return {.ending = Ending::events_accumulate,
              .message = fmt::format("the events of t = {:.6g} set each other off without end: `{}` is among them",
                                     world.time(), events_.name(fired.front()))};
    auto next = fire_round(world, fired, sink);
    if (!next) return next.status();
    fired = *std::move(next);
  }
  return {};
}

/// Fires the events of a round. Returns the events of the next round.
Result<std::vector<std::size_t>> WorldEvents::fire_round(WorldRun& world, const std::vector<std::size_t>& fired,
                                                         const Sink& sink) {
  const X before = world.state();
  X after = before;
  const double t = world.time();
  bool stops = false;
  std::vector<std::size_t> next;
  for (const std::size_t i : fired) {  // each on the state that the one before has left
    const X left = after;
    stops = events_.fire(system_, i, t, left, after).stop || stops;
    if (any_guard_) carry_over(t, after, next);
  }
  for (const model::TableInput& input : program_->step_inputs) {
    const double value = input.table.value(t);
    if (world.variables()[input.variable] == value) continue;
    if (Status status = world.set(input.variable, value); !status) return status;
  }
  if (system_.mode() != world.mode()) world.go(system_.mode());
  if (after != before) world.set_state(after);
  const std::vector<model::EventName>& names = names_.of(events_, fired);
  if (!names.empty() || after != before) sink({t, names, before});
  if (stops) stopped_by_ = names.empty() ? std::string() : names.front().event;
  stopped_ = stopped_ || stops;
  std::ranges::sort(next);
  return next;
}

/// Adds to `next` the guards that an action, which has left this state, has carried to their other side.
void WorldEvents::carry_over(double t, const X& state, std::vector<std::size_t>& next) {
  events_.guards(system_, t, state, values_);
  for (std::size_t i = 0; i < events_.size(); ++i) {
    if (!events_.is_guard(i) || !events_.active(system_, i)) continue;
    const int side = sign_of(values_[i]), from = sides_[i];
    if (side == 0 || side == from) continue;
    sides_[i] = side;
    const Direction direction = events_.direction(i);
    const bool fires = watches(direction, side) && !(from == 0 && direction == Direction::crosses);
    if (fires && std::ranges::find(next, i) == next.end()) next.push_back(i);
  }
}

void WorldEvents::go_on(WorldRun& world, std::span<const double> variables, std::span<const std::size_t> stops) {
  const std::vector<std::size_t> counts(stops.begin(), stops.end());  // a copy, since they may belong to events_
  system_.set_all(variables);
  system_.go(world.mode());
  events_ = model::ModelEvents(*program_, variables, events_.begin());
  events_.resume(world.time(), counts);
  names_.restart();
  scheduled_after_ = world.time() + slack_of(world);  // events up to there have fired
  stopped_ = false;
  stopped_by_.clear();
  place_guards(world);
}

}  // namespace continuo::worlds
