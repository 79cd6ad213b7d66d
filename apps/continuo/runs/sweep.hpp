// Several runs of one model, over values of parameters and of initial values: --set k=1,2,5 and --set k=1..5/9.
//
//   const std::vector<SweepText> texts = take_sweep(options);   // what is left in `options` holds for all members
//   const Prepared base = prepare(options);
//   if (const auto sweep = read_sweep(texts, base)) members = run_sweep(*sweep, base, nullptr, table, watch);
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <apps/continuo/options/experiment_options.hpp>

#include <continuo/results/motion_curves.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::app {

class SweepTable;  // runs/sweep_table.hpp

/// What is varied, and its values in the unit of the model.
struct SweepAxis {
  std::string name;         // of a parameter, or of a state or a family of states
  bool is_initial = false;  //
  std::vector<double> values;

  /// The heading of its column: "k", "x(0)".
  std::string column() const { return is_initial ? name + "(0)" : name; }
};

struct Sweep {
  std::vector<SweepAxis> axes;

  /// How many runs: the product of the axes.
  std::size_t size() const;
  /// The value of an axis in a member. The last axis varies first.
  double value(std::size_t member, std::size_t axis) const;
  /// All of them, one for each axis.
  std::vector<double> values(std::size_t member) const;
  /// The headings of their columns.
  std::vector<std::string> columns() const;
  /// "k = 2, x(0) = 3".
  std::string label(std::size_t member) const;
};

/// A setting that gives more than one value: "k=1,2,5", "k=1..5/9".
struct SweepText {
  std::string text;
  bool is_initial = false;
};
/// Takes them out of the options.
std::vector<SweepText> take_sweep(ExperimentOptions& options);
/// Nothing, after saying why, where one of them cannot be used.
std::optional<Sweep> read_sweep(const std::vector<SweepText>& texts, const Prepared& base);

/// A run of the sweep, and what it was run with; without a run where the member was not begun or cannot be run.
struct SweepMember {
  bool begun = false;
  std::shared_ptr<const model::ModelProgram> program{};
  model::Simulated simulated{};
  std::unique_ptr<results::MotionCurves> curves{};  // of its picture, where one is wanted
};
/// Runs all members, as many at a time as there are cores; each is the run that its settings alone would give. After
/// Ctrl-C those that have ended are there. `curves`: what is to be drawn of each, or null. `watch` gets the part that
/// is done. The table gets the rows as they come; when it wants no more, no more runs are begun.
std::vector<SweepMember> run_sweep(const Sweep& sweep, const Prepared& base, const results::MotionCurves* curves,
                                   SweepTable& table, const std::function<void(double)>& watch);

}  // namespace continuo::app
