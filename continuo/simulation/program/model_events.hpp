// continuo/simulation/program/model_events.hpp
// A model's `when`, `at`, `every` and `initially`, and the steps of its inputs, as the source of events that solve/
// asks for. The actions of an event read the state from before it and take effect together, a change of mode too.
#pragma once
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/simulation/program/guard_enclosures.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/simulation/program/motion_series.hpp>
#include <continuo/solve/event.hpp>
#include <continuo/solve/events/guard_motion.hpp>

namespace continuo::model {

/// A `mark "text"` that was reached, or the text of the `stop` that ended the run.
struct Marked {
  double t;
  std::string text;
  std::size_t event;  // which of the source's events

  /// For checkpoints.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(t, text);
  }
};

class ModelEvents {
 public:
  using X = ModelSystem::X;

  /// Times are those of a run that begins at `from` with these variables. With `jumps`, for a system that holds its
  /// switches, the surfaces of these are events as well.
  ModelEvents(const ModelProgram& program, std::span<const double> variables, double from, bool jumps = false);

  [[nodiscard]] std::size_t size() const { return events_.size(); }
  [[nodiscard]] std::string_view name(std::size_t i) const { return events_[i].name; }
  [[nodiscard]] Direction direction(std::size_t i) const { return events_[i].direction; }
  [[nodiscard]] bool is_guard(std::size_t i) const {
    return events_[i].kind == Kind::guard || events_[i].kind == Kind::jump;
  }
  [[nodiscard]] bool can_restart(std::size_t i) const { return events_[i].can_restart; }
  [[nodiscard]] bool can_assign(std::size_t i) const { return events_[i].can_assign; }
  [[nodiscard]] bool is_condition(std::size_t i) const { return events_[i].is_condition; }
  [[nodiscard]] bool active(const ModelSystem& system, std::size_t i) const {
    return !events_[i].in_one_mode || events_[i].mode == system.mode();
  }
  [[nodiscard]] double next_time(std::size_t i, double t, bool inclusive) const;
  void guards(ModelSystem& system, double t, const X& x, std::span<double> values);
  /// Whether steps that the system takes itself have no root of a guard in them.
  [[nodiscard]] bool watched_by(const ModelSystem& system) const { return system.watches_guards(); }
  /// Where the motion carries guard i from zero, by its exact derivatives; empty for surfaces of jumps, and while the
  /// motion slides.
  [[nodiscard]] std::optional<Carried> carried(const ModelSystem& system, std::size_t i, double t, const X& x,
                                               double forward);

  // The guards over a step, enclosed (solve/events/event_location.hpp).
  void take_step(const ModelSystem& system, double begin, double size, std::span<const X> coefficients) {
    enclosures_.take(system, {begin, size, coefficients});
  }
  [[nodiscard]] bool is_enclosed(std::size_t i) const { return enclosures_.has(i); }
  void enclose_all(double from, double to) { enclosures_.enclose_all(from, to); }
  [[nodiscard]] const Enclosure<double>& whole(std::size_t i) const { return enclosures_.whole(i); }
  [[nodiscard]] EnclosureWithSlope<double> enclosure(std::size_t i, double from, double to) {
    return enclosures_.over(i, from, to);
  }
  [[nodiscard]] Enclosure<double> value_enclosure(std::size_t i, double at) { return enclosures_.value(i, at); }

  [[nodiscard]] EventResponse fire(ModelSystem& system, std::size_t i, double t, const X& before, X& x);
  [[nodiscard]] bool has_limit_action(std::size_t i) const { return events_[i].has_limit; }
  [[nodiscard]] EventResponse at_limit(ModelSystem& system, std::size_t i, double t, const X& before, X& x);

  /// When the run began.
  [[nodiscard]] double begin() const { return begin_; }
  /// How often each `stop` of the model has been reached.
  [[nodiscard]] std::span<const std::size_t> stops() const { return stop_counts_; }
  /// The run goes on from t: what was scheduled for that very instant has fired.
  void resume(double t, std::span<const std::size_t> stops) {
    resumed_ = t;
    stop_counts_.assign(stops.begin(), stops.end());
  }

  /// For checkpoints. What is evaluated from the system's variables is made anew from those.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(resumed_, stop_counts_);
    archive.list(marks_);
    archive(stop_text_);
    for (Marked& mark : marks_) archive.index(mark.event, size() - 1);
  }

  /// The author knows of it; steps of inputs and jumps of equations are nobody's event.
  [[nodiscard]] bool is_declared(std::size_t i) const {
    return events_[i].kind != Kind::input && events_[i].kind != Kind::jump;
  }
  /// A surface along which the motion may slide: marks of it say where it begins to and where it leaves.
  [[nodiscard]] bool is_jump(std::size_t i) const { return events_[i].kind == Kind::jump; }
  [[nodiscard]] bool renews_guard(std::size_t i) const { return is_jump(i); }
  [[nodiscard]] std::span<const Marked> marks() const { return marks_; }
  [[nodiscard]] const std::string& stop_text() const { return stop_text_; }

 private:
  enum class Kind { guard, scheduled, input, jump };
  struct Entry {
    Kind kind;
    std::size_t index;  // into Model::events, Model::schedule, the step inputs, or the switches of the mode
    std::string name;
    Direction direction = Direction::crosses;
    bool can_restart = true;  // its actions can change what the equations read, or stop the run
    bool can_assign = true;   // or a state
    bool is_condition = false;
    bool has_limit = false;
    bool in_one_mode = false;
    std::size_t mode = 0;
    std::vector<double> times{};   // of scheduled ones, ascending
    DecimalTicks<double> ticks{};  // of `every`
  };
  struct Effect {
    std::size_t event = 0;
    bool stop = false;
    std::size_t mode;
  };

  [[nodiscard]] Entry entry_of(const When& when, std::size_t index) const;
  [[nodiscard]] Entry entry_of(const ModelProgram& program, const Scheduled& scheduled, std::size_t index,
                               std::span<const double> variables, double from) const;
  void add_jumps(const ModelProgram& program);
  [[nodiscard]] EventResponse act(ModelSystem& system, const ProgramBlock& block, std::span<const double> values,
                                  std::size_t i, double t, const X& before, X& x);
  [[nodiscard]] EventResponse pass(ModelSystem& system, std::size_t i, double t, const X& x);
  void perform(const std::vector<ProgramAction>& actions, std::span<const double> values, double t, X& x,
               Effect& effect);

  double begin_, resumed_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<Entry> events_;
  GuardEnclosures enclosures_;
  std::optional<MotionSeries> series_;
  std::vector<GuardMotion> motions_;      // by Model::events
  std::vector<double> guard_values_;      // by Model::events
  std::vector<double> switch_values_;     // by switch of the mode
  std::vector<std::size_t> guard_place_;  // where in events_ each of Model::events stands
  std::vector<std::size_t> stop_counts_;
  std::vector<Marked> marks_;
  std::string stop_text_;
};

static_assert(EventSource<ModelEvents, ModelSystem, ModelSystem::X>);

}  // namespace continuo::model
