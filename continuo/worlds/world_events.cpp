#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/worlds/world_events.hpp>

namespace continuo::worlds {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

bool has_passed(Direction direction, double before, double now) {
  const bool fell = before > 0 && !(now > 0), rose = before < 0 && !(now < 0);
  return (direction != Direction::rises && fell) || (direction != Direction::falls && rose);
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
      scheduled_after_(from),
      look_(look) {
  for (std::size_t i = 0; i < events_.size(); ++i) any_guard_ = any_guard_ || events_.is_guard(i);
  find_watched();
}

void WorldEvents::begin(WorldRun& world, const Sink& sink) {
  happen_scheduled(world, sink, true);
  if (any_guard_) read_guards(world, before_);
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

std::string WorldEvents::advance(WorldRun& world, double to) {
  if (!any_guard_ || world.step() > 0) {
    std::string error = world.advance_to(to);
    if (error.empty() && any_guard_) read_guards(world, values_);
    return error;
  }
  const Snapshot saved = world.snapshot();
  const X state = world.state();
  std::string error = world.advance_to(to);
  if (error.empty()) error = look_at_first_contact(world, saved);
  if (!error.empty()) return error;
  read_guards(world, values_);
  if (!any_passed()) error = look_where_guards_turn(world, saved, state);
  return error.empty() && any_passed() ? go_back_to_event(world, saved) : error;
}

void WorldEvents::read_guards(WorldRun& world, std::vector<double>& values) {
  events_.guards(system_, world.time(), world.state(), values);
}
bool WorldEvents::passed(std::size_t i) const {
  return events_.is_guard(i) && events_.active(system_, i) && has_passed(events_.direction(i), before_[i], values_[i]);
}
bool WorldEvents::any_passed() const {
  for (std::size_t i = 0; i < events_.size(); ++i)
    if (passed(i)) return true;
  return false;
}

/// The first instant at which a guard has passed, on its far side.
std::string WorldEvents::go_back_to_event(WorldRun& world, const Snapshot& saved) {
  double low = saved.time, high = world.time();
  const auto move_to = [&](double t) {
    std::string error = world.restore(saved);
    if (error.empty()) error = world.advance_to(t);
    if (error.empty()) read_guards(world, values_);
    return error;
  };
  const double least = 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(low), std::abs(high));
  while (high - low > least) {
    const double middle = low + (high - low) / 2;
    if (std::string error = move_to(middle); !error.empty()) return error;
    (any_passed() ? high : low) = middle;
  }
  return move_to(high);
}

void WorldEvents::happen(WorldRun& world, const Sink& sink) {
  if (any_guard_) happen_guards(world, sink);
  if (!stopped_ && next_scheduled() <= world.time() + slack_of(world)) happen_scheduled(world, sink, false);
}

void WorldEvents::happen_guards(WorldRun& world, const Sink& sink) {
  std::vector<std::size_t> fired;
  for (std::size_t i = 0; i < events_.size(); ++i)
    if (passed(i)) fired.push_back(i);
  if (!fired.empty()) happen_now(world, fired, sink);
  read_guards(world, before_);
}

void WorldEvents::happen_scheduled(WorldRun& world, const Sink& sink, bool inclusive) {
  const double until = world.time() + slack_of(world);
  while (!stopped_) {
    double next = never;
    std::vector<std::size_t> due;
    for (std::size_t i = 0; i < events_.size(); ++i) {
      if (events_.is_guard(i)) continue;
      const double time = events_.next_time(i, scheduled_after_, inclusive);
      if (time > until || time > next) continue;
      if (time < next) due.clear();
      next = time;
      due.push_back(i);
    }
    if (due.empty()) break;
    scheduled_after_ = next;
    inclusive = false;
    happen_now(world, due, sink);
  }
  if (any_guard_) read_guards(world, before_);
}

void WorldEvents::happen_now(WorldRun& world, const std::vector<std::size_t>& fired, const Sink& sink) {
  const X before = world.state();
  X after = before;
  const double t = world.time();
  bool stops = false;
  for (const std::size_t i : fired) {  // each on the state that the one before has left
    const X left = after;
    stops = events_.fire(system_, i, t, left, after).stop || stops;
  }
  for (const model::TableInput& input : program_->step_inputs) {
    const double value = input.table.value(t);
    if (world.variables()[input.variable] != value) world.set(input.variable, value);
  }
  if (system_.mode() != world.mode()) world.go(system_.mode());
  if (after != before) world.set_state(after);
  names_.clear();
  const auto marks = events_.marks().subspan(marks_seen_);
  for (const std::size_t i : fired) {
    if (!events_.is_declared(i)) continue;
    const auto mark = std::ranges::find(marks, i, &model::Marked::event);
    names_.push_back({std::string(events_.name(i)), mark == marks.end() ? std::string() : mark->text});
  }
  marks_seen_ = events_.marks().size();
  if (!names_.empty() || after != before) sink({t, names_, before});
  if (!stops) return;
  stopped_by_ = names_.empty() ? std::string() : names_.front().event;
  stopped_ = true;
}

void WorldEvents::go_on(WorldRun& world, std::span<const double> variables, std::span<const std::size_t> stops) {
  const std::vector<std::size_t> counts(stops.begin(), stops.end());  // before what they may be part of is made anew
  system_.set_all(variables);
  system_.go(world.mode());
  events_ = model::ModelEvents(*program_, variables, events_.begin());
  events_.resume(world.time(), counts);
  marks_seen_ = 0;
  scheduled_after_ = world.time() + slack_of(world);  // up to there it has happened
  stopped_ = false;
  stopped_by_.clear();
  if (any_guard_) read_guards(world, before_);
}

}  // namespace continuo::worlds
