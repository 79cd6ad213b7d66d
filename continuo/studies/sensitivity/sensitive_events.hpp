// The events of a model and the jumps of its equations, and their effect on the sensitivities. Internal
// to sensitivity.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/simulation/program/model_events.hpp>
#include <continuo/status/status.hpp>
#include <continuo/studies/sensitivity/sensitive_system.hpp>

namespace continuo::studies::detail {

/// An event at the instant at which it occurs.
struct SensitiveEventOccurrence {
  std::size_t event;  // of the model, in the order of the text
  double t;
  std::vector<double> time_moves{};  // dt/dp
};

class SensitiveEvents {
 public:
  using X = SensitiveSystem::X;

  SensitiveEvents(const SensitiveProgram& program, std::span<const double> variables, double from, double length);

  [[nodiscard]] std::size_t size() const { return plain_.size(); }
  [[nodiscard]] std::string_view name(std::size_t i) const { return plain_.name(i); }
  [[nodiscard]] Direction direction(std::size_t i) const { return plain_.direction(i); }
  [[nodiscard]] bool is_guard(std::size_t i) const { return plain_.is_guard(i); }
  [[nodiscard]] bool can_assign(std::size_t i) const { return plain_.can_assign(i); }
  [[nodiscard]] bool is_condition(std::size_t i) const { return plain_.is_condition(i); }
  [[nodiscard]] bool renews_guard(std::size_t i) const { return plain_.renews_guard(i); }
  [[nodiscard]] bool active(const SensitiveSystem& system, std::size_t i) const {
    return plain_.active(system.plain(), i);
  }
  [[nodiscard]] double next_time(std::size_t i, double t, bool inclusive) const {
    return plain_.next_time(i, t, inclusive);
  }
  void guards(SensitiveSystem& system, double t, const X& x, std::span<double> values);
  [[nodiscard]] std::optional<Carried> carried(const SensitiveSystem& system, std::size_t i, double t, const X& x,
                                               double forward);
  // The guards over a step, enclosed as in a run of the model alone.
  void take_step(const SensitiveSystem& system, double begin, double size, std::span<const X> coefficients);
  [[nodiscard]] bool is_enclosed(std::size_t i) const { return plain_.is_enclosed(i); }
  void enclose_all(double from, double to) { plain_.enclose_all(from, to); }
  [[nodiscard]] const Enclosure<double>& whole(std::size_t i) const { return plain_.whole(i); }
  [[nodiscard]] EnclosureWithSlope<double> enclosure(std::size_t i, double from, double to) {
    return plain_.enclosure(i, from, to);
  }
  [[nodiscard]] Enclosure<double> value_enclosure(std::size_t i, double at) { return plain_.value_enclosure(i, at); }

  [[nodiscard]] EventResponse fire(SensitiveSystem& system, std::size_t fired, double t, const X& before, X& x);
  /// The run goes on from t: what was scheduled for that very instant has fired.
  void resume(double t, std::span<const std::size_t> stops) { plain_.resume(t, stops); }

  [[nodiscard]] std::span<const SensitiveEventOccurrence> occurrences() const { return occurrences_; }
  [[nodiscard]] bool is_declared(std::size_t i) const { return plain_.is_declared(i); }
  /// A failure where the motion has no derivative.
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  struct Jump;
  /// A surface of the equations as it was before it was crossed, and whether the motion slid along it.
  struct Surface {
    const Variation* variation;
    std::vector<double> values;
    bool slid;
  };
  /// What an event has done, and how its time moves.
  struct Change {
    X before, after;
    std::vector<double> moves;
  };
  /// What is known of an event before its actions: what its tape gives, x', and which event set it off, if any.
  struct Acting {
    const Change* set_off_by;
    std::vector<double> values;
    X rates;
  };
  [[nodiscard]] const Change* set_off_by(SensitiveSystem& system, std::size_t fired, double t);
  [[nodiscard]] std::vector<double> time_moves(std::size_t event, std::span<const double> values, double t,
                                               std::span<const double> rates);
  [[nodiscard]] std::vector<double> crossing_moves(std::string_view name, const Variation& guard,
                                                   std::span<const double> values, std::span<const double> rates);
  void cross_surface(std::size_t fired, const Surface& surface, SensitiveSystem& system, double t, const X& rates,
                     X& now);
  void act(std::size_t fired, SensitiveSystem& system, double t, const Acting& acting, X& now);
  void perform(const std::vector<SensitiveAction>& actions, std::span<const double> values,
               std::span<const double> rates, std::span<const double> moves, Jump& jump) const;

  double length_;  // of the run
  model::ModelEvents plain_;
  std::size_t undeclared_ = 0;           // steps of inputs, then surfaces of jumps, come before the text's events
  std::vector<std::size_t> first_jump_;  // by mode
  std::size_t n_, count_;
  struct Schedule {
    double first = 0, period = 0;
    std::vector<double> first_moves{}, period_moves{};
  };
  std::vector<std::optional<Schedule>> schedules_;  // by event of the model
  const SensitiveProgram* program_;
  X x_;  // of the model alone
  std::vector<X> coefficients_;
  std::vector<SensitiveEventOccurrence> occurrences_;
  double instant_t_;  // of what follows
  std::vector<Change> instant_{};
  std::vector<double> moves_{};  // of the event that is firing
  Status status_;
};

static_assert(EventSource<SensitiveEvents, SensitiveSystem, SensitiveSystem::X>);

}  // namespace continuo::studies::detail
