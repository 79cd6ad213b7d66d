// --ds, --ds-min, --ds-max: how long the steps along a branch are, of equilibria or orbits.
#pragma once
#include <optional>

#include <apps/continuo/options/command_line.hpp>

namespace continuo::app {

/// In parts of the parameter's range and of the size of the states.
struct BranchSteps {
  std::optional<double> first, least, largest;

  /// Into the options of a continuation, which have the same three.
  template <class Options>
  void set(Options& options) const {
    if (first) options.first_step = *first;
    if (least) options.least_step = *least;
    if (largest) options.largest_step = *largest;
    // Who names one of them means the others to go with it.
    if (!largest && options.first_step > options.largest_step) options.largest_step = options.first_step;
    if (!first && options.first_step > options.largest_step) options.first_step = options.largest_step;
    if (!least && options.least_step > options.first_step) options.least_step = options.first_step / 1000;
  }
};

/// `along`: the option that they need.
void add_branch_steps(CLI::App& verb, BranchSteps& steps, CLI::Option* along);
/// Says what is wrong.
bool are_in_order(const BranchSteps& steps);

}  // namespace continuo::app
