// An integration of a model step by step, whatever the method: what `simulate` runs to its end and the live view
// drives.
//
//   const std::unique_ptr<Stepping> run = begin_integration("dop853", std::move(integration), {0, 10});
//   while (run->advance(watcher)) use(run->t(), run->x());
#pragma once
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_events.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/solve/observer.hpp>
#include <continuo/solve/options.hpp>
#include <continuo/solve/outcome.hpp>

namespace continuo {
class ByteReader;
class ByteWriter;
}  // namespace continuo

namespace continuo::model {

/// What an integrator is made of, besides the method.
struct Integration {
  ModelSystem system;
  ModelSystem::X x0;
  Options<ModelSystem::X> options;
  ModelEvents events;
};

/// A run as planned: of simulate, or step by step.
[[nodiscard]] Integration integration_of(const std::shared_ptr<const ModelProgram>& program, const Plan& plan,
                                         const Experiment& experiment);

/// All that a run has to know to go on from some instant, besides the values of parameters and inputs.
struct Instant {
  double t = 0;
  std::vector<double> x;
  std::size_t mode = 0;
  std::vector<std::size_t> stops;  // how often each `stop` has been reached
};

class Stepping;

/// Who watches: pieces of trajectory that stand, and events, as solve/observer.hpp has them.
class StepWatcher {
 public:
  virtual ~StepWatcher() = default;
  /// The motion is final up to `to`; run.at(t, x) gives x there.
  virtual void on_segment(Stepping& run, double to) = 0;
  /// Pieces that end before this time need not be shown.
  [[nodiscard]] virtual double quiet_until() const { return -std::numeric_limits<double>::infinity(); }
  /// Events have fired.
  virtual void on_event(Stepping& run, const EventOccurrence<ModelSystem::X>& now) = 0;
};

/// A run that is advanced step by step. One object serves one thread at a time.
class Stepping {
 public:
  using X = ModelSystem::X;
  virtual ~Stepping() = default;

  /// One step, cut short at an event that changes the state. True while there is more.
  [[nodiscard]] virtual bool advance(StepWatcher& watcher) = 0;
  /// The time reached.
  [[nodiscard]] virtual double t() const = 0;
  /// The state at that time.
  [[nodiscard]] virtual const X& x() const = 0;
  /// x at a time of the last stretch, on the dense output.
  virtual void at(double t, X& x) = 0;
  /// The equations with their mode and parameters.
  [[nodiscard]] virtual const ModelSystem& system() const = 0;
  /// The events with their guards and counts.
  [[nodiscard]] virtual const ModelEvents& events() const = 0;
  /// How the run ended, once `advance` has returned false.
  [[nodiscard]] virtual const Outcome<double>& outcome() const = 0;
  /// The cost so far.
  [[nodiscard]] virtual Statistics statistics() const = 0;
  /// Moves the end of the run to a later time.
  virtual void extend_to(double to) = 0;

  /// A checkpoint between two steps: what the run from here on depends on, but for the dense output of the last step.
  virtual void save(ByteWriter& bytes) = 0;
  /// Reads a checkpoint of the same model, by the same plan but for its end, into a run that has not made a step: it
  /// goes on to the same bits. Bytes that cannot be such a checkpoint make the reader fail, and the run is of no use.
  virtual void restore(ByteReader& bytes) = 0;

  /// Goes on from another instant with these parameters and inputs, as after an event; events scheduled for that very
  /// instant are over. States that are `held` stand still from here on.
  virtual void go_on(const Instant& instant, std::span<const double> variables, std::span<const std::size_t> held) = 0;
};

/// What both cost together.
[[nodiscard]] Statistics sum(const Statistics& a, const Statistics& b);

/// The method's name must be one of the catalogue.
[[nodiscard]] std::unique_ptr<Stepping> begin_integration(std::string_view method, Integration integration,
                                                          Interval<double> interval);

}  // namespace continuo::model
