// continuo/worlds/world_events.hpp
// The events of a model's text while its bodies move. A `when` is looked for at every step; without steps every so
// often, at contacts of the bodies that it reads, and where it turns in between; and then located; `at`, `every`,
// `initially` and the steps of inputs happen when their time has come.
//
//   WorldEvents events(program, plan.variables, plan.from, look);
//   events.begin(world, sink);
//   status = events.advance(world, std::min(to, events.next(world)));  ...  events.happen(world, sink);
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

/// At what a `when` asks, in a run of a world without steps.
inline constexpr double looks = 1000;

/// With steps, how much earlier than due the end of a step may be.
[[nodiscard]] double slack_of(const WorldRun& world);

/// Events of one instant; the world is as they left it.
struct WorldHappening {
  double t;
  const std::vector<model::EventName>& names;  // empty: the step of an input, which is nobody's event
  const std::vector<double>& before;
};

class WorldEvents {
 public:
  using X = std::vector<double>;
  using Sink = std::function<void(const WorldHappening&)>;

  /// `look`: between two looks at what a `when` asks, of a world without steps.
  WorldEvents(const std::shared_ptr<const model::ModelProgram>& program, std::span<const double> variables, double from,
              double look);

  /// What happens at the very beginning. Empty, or why the run cannot go on; so with `happen`.
  Status begin(WorldRun& world, const Sink& sink);
  /// How far it may be advanced at once.
  [[nodiscard]] double next(const WorldRun& world) const;
  /// To the first end of a step that is not before `to`; to the first instant of an event where one comes before.
  Status advance(WorldRun& world, double to);
  /// What is due now, in the order of the text, each on what the one before has left; then, round by round, what these
  /// actions carry to its other side (docs/events.md).
  Status happen(WorldRun& world, const Sink& sink);

  /// A `stop` has been reached: by which event, and what it says.
  [[nodiscard]] bool stopped() const { return stopped_; }
  [[nodiscard]] const std::string& stopped_by() const { return stopped_by_; }
  [[nodiscard]] const std::string& stop_text() const { return events_.stop_text(); }
  [[nodiscard]] std::span<const std::size_t> stops() const { return events_.stops(); }

  /// The world has been put elsewhere, or its variables changed: what was scheduled for this very instant is over.
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
  Status happen_rounds(WorldRun& world, std::vector<std::size_t> fired, const Sink& sink);
  Result<std::vector<std::size_t>> happen_round(WorldRun& world, const std::vector<std::size_t>& fired,
                                                const Sink& sink);
  void carry_over(double t, const X& state, std::vector<std::size_t>& next);

  std::shared_ptr<const model::ModelProgram> program_;
  model::ModelSystem system_;  // its guards, actions and modes
  model::ModelEvents events_;
  std::vector<double> values_, before_;  // of guards: now, and at the last look
  std::vector<int> sides_;         // of guards, at the last look and after each action; 0: at zero since the start
  std::set<std::size_t> watched_;  // bodies that they read
  model::EventNames names_;
  double scheduled_after_, look_;
  bool any_guard_ = false, stopped_ = false;
  std::string stopped_by_;
};

}  // namespace continuo::worlds
