// continuo/worlds/world_events.hpp
// The events of a model while its bodies move. The condition of a `when` is sampled at every step; without steps it is
// sampled at regular times, at contacts of the bodies that it depends on, and where it has a turning point in between,
// and its events are located. `at`, `every`, `initially` and the steps of inputs happen at their times.
//
//   WorldEvents events(program, plan.variables, plan.from, look);
//   events.begin(world, sink);
//   status = events.advance(world, std::min(to, events.next(world)));  ...  events.fire_due(world, sink);
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <continuo/simulation/program/event_names.hpp>
#include <continuo/simulation/program/model_events.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::worlds {

/// The number of samples of a `when` in a run of a world without steps.
inline constexpr double looks = 1000;

/// With steps, how much earlier than due the end of a step may be.
[[nodiscard]] double slack_of(const WorldRun& world);

/// Events of one instant; the world is as they left it.
struct WorldEventOccurrence {
  double t;
  const std::vector<model::EventName>& names;  // empty for the step of an input, which is no event
  const std::vector<double>& before;
};

/// Finds and fires the events of one run.
class WorldEvents {
 public:
  using X = std::vector<double>;
  /// Gets the events of each instant.
  using Sink = std::function<void(const WorldEventOccurrence&)>;

  /// `look` is the time between two samples of a `when` in a world without steps.
  WorldEvents(const std::shared_ptr<const model::ModelProgram>& program, std::span<const double> variables, double from,
              double look);

  /// Fires the events at the very beginning. Fails, like `fire_due`, where the run cannot continue.
  Status begin(WorldRun& world, const Sink& sink);
  /// The time to which the world may be advanced at once.
  [[nodiscard]] double next(const WorldRun& world) const;
  /// Advances to the first end of a step that is not before `to`, or to the first instant of an event where that is
  /// earlier.
  Status advance(WorldRun& world, double to);
  /// Fires the events that are due now, in the order of the text, each on the state that the one before has left; then,
  /// round by round, the events whose guards these actions have carried to their other side (docs/events.md).
  Status fire_due(WorldRun& world, const Sink& sink);

  /// Whether a `stop` has been reached, by which event, and its text.
  [[nodiscard]] bool stopped() const { return stopped_; }
  /// The event whose `stop` was reached.
  [[nodiscard]] const std::string& stopped_by() const { return stopped_by_; }
  /// The text of the `stop`, which may be empty.
  [[nodiscard]] const std::string& stop_text() const { return events_.stop_text(); }
  /// For each `stop after N`, how often it has been executed.
  [[nodiscard]] std::span<const std::size_t> stops() const { return events_.stops(); }

  /// Continues after the state of the world or its variables have been set. Events scheduled for this very instant
  /// count as done.
  void go_on(WorldRun& world, std::span<const double> variables, std::span<const std::size_t> stops);

 private:
  double next_scheduled() const;
  void read_guards(WorldRun& world, std::vector<double>& values);
  void place_guards(WorldRun& world);
  [[nodiscard]] bool passed(std::size_t i) const;
  [[nodiscard]] bool any_passed() const;
  Status look_at_first_contact(WorldRun& world, const Snapshot& saved);  // event_search.cpp
  Status look_where_guards_turn(WorldRun& world, const Snapshot& saved, const X& before);
  double slope(std::size_t i, double t, const X& state, double length);
  void find_watched();
  Status go_back_to_event(WorldRun& world, const Snapshot& saved);
  std::vector<std::size_t> take_passed();
  std::vector<std::size_t> take_due(double until, bool inclusive);
  Status fire_rounds(WorldRun& world, std::vector<std::size_t> fired, const Sink& sink);
  Result<std::vector<std::size_t>> fire_round(WorldRun& world, const std::vector<std::size_t>& fired, const Sink& sink);
  void carry_over(double t, const X& state, std::vector<std::size_t>& next);

  std::shared_ptr<const model::ModelProgram> program_;
  model::ModelSystem system_;  // its guards, actions and modes
  model::ModelEvents events_;
  std::vector<double> values_, before_;  // of guards: now, and at the last sample
  std::vector<int> sides_;         // of guards, at the last sample and after each action; 0: at zero since the start
  std::set<std::size_t> watched_;  // bodies that they read
  model::EventNames names_;
  double scheduled_after_, look_;
  bool any_guard_ = false, stopped_ = false;
  std::string stopped_by_;
};

}  // namespace continuo::worlds
