// continuo/results/plots.hpp
// From a run to its picture: the curves of the model's `plot` statements, the events marked, and the energy drift in a
// panel of its own where energies are declared.
#pragma once
#include <span>
#include <string>
#include <vector>

#include <continuo/results/figure.hpp>
#include <continuo/results/motion_curves.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/run.hpp>

namespace continuo::results {

/// One `plot` statement with its values at every row of the run.
struct PlotData {
  model::Column against;
  std::vector<double> x;
  std::vector<model::Column> curves;
  std::vector<std::vector<double>> y;  // one per curve
  bool against_time = true;
};

/// The model's `plot` statements; where it has none, its states against time, up to eight.
[[nodiscard]] std::vector<PlotData> plots_of(const model::ModelProgram& program, const model::Run& run);

/// What `run --plot` draws: the plots that the curves were asked for, or, of bodies without any, where they are at the
/// end, with the states of one or two; and the drift of the energy. Of a motion that nobody has watched, the rows.
[[nodiscard]] Figure figure_of(const model::ModelProgram& program, const model::Run& run, MotionCurves& curves);

/// Curves of one unit share a panel; curves of different units get panels of their own, one below the other.
[[nodiscard]] Figure figure_of(std::string title, const model::Run& run, std::span<const PlotData> plots);

/// "h [m/s]", "h" without a unit.
[[nodiscard]] std::string label_of(const model::Column& column);

}  // namespace continuo::results
