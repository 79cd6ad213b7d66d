// continuo/results/plots.hpp
// From a run to its picture: the curves of the model's `plot` statements, the events marked, and the energy drift in a
// panel of its own where energies are declared.
#pragma once
#include <vector>

#include <continuo/results/figure.hpp>
#include <continuo/results/record.hpp>

namespace continuo::results {

/// One `plot` statement, evaluated at every row of the motion.
struct PlotRequest {
  Column against;
  std::vector<double> x;
  std::vector<Column> curves;
  std::vector<std::vector<double>> y;  // one per curve
  bool against_time = true;
};

/// Curves of one unit share a panel; curves of different units get panels of their own below one another.
/// `energies` holds the total energy at every row, or nothing.
Figure figure_of(const Record& record, const std::vector<PlotRequest>& plots, const std::vector<double>& energies);

/// What is plotted where the model does not say: every state against time, up to eight.
std::vector<PlotRequest> default_plots(const Record& record);

/// "h [m/s]", "h" without a unit.
std::string label_of(const Column& column);

}  // namespace continuo::results
