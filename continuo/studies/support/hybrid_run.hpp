// A model's motion with all that happens in it, events, modes and jumps of the equations, run from instant to instant:
// what a study needs that cannot look at x' = f(t, x, p) alone.
//
//   HybridRun run(program, plan, experiment);
//   while (run.advance_to(t)) t += 1;
#pragma once
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/stepping.hpp>

namespace continuo::studies {

/// The experiment by a method that chooses its steps and takes whatever the model has, at rtol = atol = tolerance and
/// without a limit of steps.
[[nodiscard]] model::Experiment exactly(const model::ModelProgram& program, model::Experiment experiment,
                                        double tolerance);

/// Of such an experiment; nothing where it cannot be run: `outcome` says why.
[[nodiscard]] std::optional<model::Plan> plan_of(const model::ModelProgram& program, const model::Experiment& exact,
                                                 Outcome<double>& outcome);

class HybridRun final : private model::StepWatcher {
 public:
  using X = model::ModelSystem::X;

  /// `plan` as model::plan_run makes it, of a method that chooses its steps.
  HybridRun(const std::shared_ptr<const model::ModelProgram>& program, const model::Plan& plan,
            const model::Experiment& experiment);
  HybridRun(const HybridRun&) = delete;
  HybridRun& operator=(const HybridRun&) = delete;

  /// Exactly there, events at that instant included. False where the run ends before: outcome() says how.
  [[nodiscard]] bool advance_to(double t);
  /// From another state, at this instant of another run and in its mode.
  void go_on(const model::Instant& instant);

  [[nodiscard]] double t() const { return run_->t(); }
  [[nodiscard]] const X& x() const { return run_->x(); }
  [[nodiscard]] model::Instant instant() const;
  [[nodiscard]] const Outcome<double>& outcome() const { return run_->outcome(); }
  /// How often the state or the mode has been changed, or the equations jumped, and when that was last.
  [[nodiscard]] std::size_t discontinuities() const { return discontinuities_; }
  [[nodiscard]] double last_discontinuity() const { return last_; }
  /// Whether the motion is held by a surface where the equations jump.
  [[nodiscard]] bool slides() const { return run_->system().slides(); }

  /// Called for every piece of motion between discontinuities: at(t, x) gives the state on from..to, in an x of its
  /// size.
  using At = std::function<void(double t, X& x)>;
  std::function<void(double from, double to, const At& at)> on_stretch{};
  /// Called where something changes the state at once.
  std::function<void(double t, const X& before, const X& after)> on_jump{};

 private:
  void on_segment(model::Stepping& run, double to) override;
  void on_event(model::Stepping& run, const EventOccurrence<X>& now) override;

  std::vector<double> variables_;
  std::unique_ptr<model::Stepping> run_;
  double from_, last_ = -std::numeric_limits<double>::infinity();
  std::size_t mode_, discontinuities_ = 0;
};

}  // namespace continuo::studies
