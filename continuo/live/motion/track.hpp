// continuo/live/motion/track.hpp
// One motion that the view draws on: asked for a step where its last one has been shown to the end, and put back to any
// instant of that step where a hand changes something there. Of equations, or of bodies.
#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <continuo/live/motion/step_interrupt.hpp>
#include <continuo/simulation/program/event_names.hpp>
#include <continuo/simulation/stepping.hpp>
#include <continuo/status/result.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::live {

/// All that it takes to go on from there.
struct Instant : model::Instant {
  std::shared_ptr<const worlds::Snapshot> world{};  // of bodies; null where nobody will go on from it
  bool moved = false;                               // a hand has changed x since
};

/// The events that occurred at one instant.
struct Passed {
  double t;
  std::vector<model::EventName> names;  // empty: the step of an input, which is nobody's event
  std::vector<double> before, after;
  std::size_t mode;  // afterwards, like
  std::vector<std::size_t> stops;
};

/// A body in a hand.
struct HeldBody {
  std::size_t body;
  worlds::Point to;
};

class Track {
 public:
  using X = std::vector<double>;

  explicit Track(model::Plan plan) : plan_(std::move(plan)) {}
  Track(const Track&) = delete;
  Track& operator=(const Track&) = delete;
  virtual ~Track() = default;

  virtual double t() const = 0;
  /// One step, or less where an event changes the state; `wanted` is how far somebody looks ahead. False: it is over,
  /// or the step was interrupted.
  virtual bool advance(double wanted) = 0;
  /// Whether the last step was given up: then the motion stands where it began, and the next advance begins it anew.
  virtual bool was_interrupted() const { return false; }
  /// The events of the last step, in order.
  const std::vector<Passed>& passed() const { return passed_; }
  /// x at a time of the last step.
  virtual void at(double t, X& x) = 0;
  /// What it takes to go on from a time of the last step; with `whole` false only to look at it.
  virtual Instant instant_at(double t, bool whole = true) = 0;
  /// Fails where it cannot go on with these parameters.
  virtual Status go_on(const Instant& instant, std::span<const double> variables,
                       std::span<const std::size_t> held) = 0;

  virtual const Outcome<double>& outcome() const = 0;
  virtual const std::string& stop_text() const = 0;
  virtual Statistics statistics() const = 0;
  const model::Plan& plan() const { return plan_; }

  /// Null of bodies, or while a step that was given up has not ended; null of equations.
  virtual const model::Stepping* equations() const { return nullptr; }
  virtual const worlds::WorldRun* world() const { return nullptr; }
  /// From here on the body stays where the hand is, or as near as others leave it room.
  virtual void hold(std::optional<HeldBody>) {}
  /// No longer, and it goes on with this velocity.
  virtual void let_go(std::size_t /*body*/, const worlds::Point& /*velocity*/) {}

 protected:
  /// The text says how long a run takes; a view goes on for as long as somebody looks.
  double length() const { return plan_.to > plan_.from ? plan_.to - plan_.from : 1; }

  model::Plan plan_;
  std::vector<Passed> passed_;
};

/// `plan` as `plan_run` gives it, of a world as `model::plan` does. Fails where the motion cannot begin. By the
/// interrupt a step of equations is given up, and must outlive the track; bodies end a step, which takes a moment.
Result<std::unique_ptr<Track>> make_track(const std::shared_ptr<const model::ModelProgram>& program,
                                          const model::Plan& plan, StepInterrupt* interrupt = nullptr);

}  // namespace continuo::live
