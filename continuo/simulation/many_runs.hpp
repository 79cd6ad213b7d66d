// Many runs of one model of which no rows are wanted, only what its checks read and what watchers see. Where the model
// allows it, several go through the processor's registers together. Each has the bits of the run that `simulate` makes,
// whatever the others are.
//
//   const ManyRuns runs(program);
//   const auto set = [&](std::size_t i, Experiment& one) { one.parameters["k"] = stiffnesses[i]; };
//   runs.make({.count = stiffnesses.size(), .set = set}, {}, [&](std::size_t i, JudgedRun run) { ...; return true; });
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <continuo/simulation/motion_watcher.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::model {

class LaneCode;  // simulation/together/lane_code.hpp

/// Experiments that differ only in the values of some parameters, inputs and initial values.
struct ManyExperiments {
  std::size_t count = 0;
  Experiment common{};  // what is the same in all of them
  /// Makes of one of these experiments, or of `common`, number `i`: gives each varied name its value.
  std::function<void(std::size_t i, Experiment& one)> set{};
};

/// A run without its rows, or why there is none: as in Simulated.
struct JudgedRun {
  std::optional<Outcome<double>> outcome{};  // none where the run could not begin
  std::vector<double> readings{};            // the values that checks have read; NaN where there is none
  std::vector<Diagnostic> diagnostics{};
};

/// Gets the run of experiment number `i`; returns whether to go on.
using OnJudged = std::function<bool(std::size_t i, JudgedRun run)>;

/// Makes runs of a model. Threads may share it, and then each makes others.
class ManyRuns {
 public:
  /// Of this model.
  explicit ManyRuns(std::shared_ptr<const ModelProgram> program);

  /// Whether runs of it can go together: some tens of ordinary differential equations at most, without jumps and
  /// without inputs that step, with checks that ask for no extremes over the run.
  [[nodiscard]] bool can_go_together() const { return can_go_together_; }

  /// Makes the runs, which are handed over in their order. `watchers`: none, or for each run one that sees it, or null.
  /// Together go those, next to each other in the list, that have an explicit Runge-Kutta method, or without events
  /// `rodas5p`, and whose ends, steps and tolerances do not depend on what is varied, or agree. A run that fails is
  /// made once more by `simulate`, which says why.
  void make(const ManyExperiments& experiments, std::span<MotionWatcher* const> watchers, const OnJudged& done) const;

 private:
  std::shared_ptr<const ModelProgram> program_;
  bool can_go_together_;
  std::shared_ptr<LaneCode> code_;
};

}  // namespace continuo::model
