// The runs of a sweep, each by its number: the values that it has, and what it leaves. A run is the same to the last
// bit wherever and whenever it is made, and knows of no other.
//
//   const Result<PreparedSweep> sweep = PreparedSweep::create(*loaded.model, {.rtol = 1e-9});
//   for (std::uint64_t run = 0; run < sweep->runs(); ++run) table.add(run, sweep->run(run));   // by as many threads
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <continuo/language/sweep.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/many_runs.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/status/result.hpp>
#include <continuo/studies/sweep/distribution.hpp>
#include <continuo/studies/sweep/kept_values.hpp>
#include <continuo/studies/sweep/sweep_design.hpp>

namespace continuo::studies {

/// What one run has left.
struct SweepOutcome {
  Ending ending = Ending::reached_end;  // invalid_input where it could not begin
  double t = 0;                         // at its end; NaN where it could not begin
  std::vector<double> kept{};           // NaN where there is no value; of a run that failed all are
  std::string message{};                // why it failed, with the code of the message
};

/// A sweep ready to run.
class PreparedSweep {
 public:
  /// That of the model, which has one; what the experiment changes holds for all runs. The reason where it cannot be
  /// run at all.
  [[nodiscard]] static Result<PreparedSweep> create(model::Model model, model::Experiment experiment);

  /// What the text says, with as many runs as are made.
  [[nodiscard]] const model::SweepPlan& plan() const { return *plan_; }
  /// Where the runs have their points; null of a grid.
  [[nodiscard]] const SweepDesign* design() const { return design_ ? &*design_ : nullptr; }
  /// What is varied together with one coordinate of the design: "k", or "m, c" of one file.
  [[nodiscard]] std::vector<std::string> dimension_names() const;
  /// The model of all runs, whose checks are what is read of them.
  [[nodiscard]] const model::Model& model() const { return readable_.program->model; }
  /// How many runs there are.
  [[nodiscard]] std::uint64_t runs() const { return plan_->runs; }
  /// How many numbers are kept of each: one, or of a series one for each time.
  [[nodiscard]] std::size_t width() const { return width_; }

  /// The values of what is varied, in the order of the axes.
  [[nodiscard]] std::vector<double> values(std::uint64_t run) const;
  /// The experiment of one run.
  [[nodiscard]] model::Experiment experiment(std::uint64_t run) const;
  /// Whether a parameter is varied that decides how many equations there are: each run reads the model anew.
  [[nodiscard]] bool decides_size() const { return decides_size_; }
  /// Makes the run.
  [[nodiscard]] SweepOutcome run(std::uint64_t run) const;
  /// Gets the outcomes of runs in their order; returns whether to go on.
  using OnOutcome = std::function<bool(SweepOutcome outcome)>;
  /// Makes these runs to the same bits, several at once where the model can (many_runs.hpp).
  void run_each(std::span<const std::uint64_t> runs, const OnOutcome& done) const;
  /// Whether it can.
  [[nodiscard]] bool goes_together() const { return !decides_size_ && many_->can_go_together(); }

  /// A text that is the same for sweeps with the same results: model, tables, values, experiment.
  [[nodiscard]] std::string identity() const;

 private:
  /// A model whose checks are the readings of the sweep, and what it is watched for.
  struct Readable {
    std::shared_ptr<const model::ModelProgram> program;
    std::shared_ptr<const KeptNodes> nodes;
  };
  /// One dimension of the grid, or of the unit cube: an axis, or all axes of one file.
  struct Dimension {
    std::vector<std::size_t> axes{};
    std::optional<Distribution> distribution{};
    std::size_t count = 0;  // of the points
  };

  PreparedSweep() = default;
  [[nodiscard]] static Readable readable(model::Model model);
  [[nodiscard]] Status add_dimensions();
  [[nodiscard]] std::optional<Readable> read_anew(const model::Experiment& experiment, SweepOutcome& outcome) const;
  [[nodiscard]] SweepOutcome nothing() const;
  /// Gives what is varied the values of this run.
  void set_run(std::uint64_t run, model::Experiment& experiment) const;
  /// Calls `set(axis, value)` for the values of this run.
  template <class Set>
  void for_each_value(std::uint64_t run, const Set& set) const;
  void take(const Readable& readable, const Outcome<double>& end, std::vector<double> readings,
            const KeptValues* watched, SweepOutcome& outcome) const;
  [[nodiscard]] std::vector<double> kept_of(const Readable& readable, std::vector<double> readings,
                                            const KeptValues* watched) const;

  std::shared_ptr<const model::SweepPlan> plan_;
  Readable readable_;
  std::shared_ptr<const model::ManyRuns> many_;
  model::Experiment experiment_;
  std::vector<Dimension> dimensions_;
  std::optional<SweepDesign> design_;  // none of a grid
  std::size_t width_ = 0;
  bool decides_size_ = false;
};

}  // namespace continuo::studies
