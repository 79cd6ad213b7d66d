// continuo/live/live_model.hpp
// What is shown of a model: the values that are plotted, the numbers of its drawing, the points that can be dragged.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <continuo/live/motion/drag_target.hpp>
#include <continuo/live/settings.hpp>
#include <continuo/simulation/program/model_program.hpp>

namespace continuo::live {

/// The kinds of plotted values.
enum class ColumnKind { state, let, output, energy, drift, curve, distance };

/// A plotted value: the states (of many bodies only those of equations and
/// measures), then `quantities`, then the drift of the energy (where there is
/// one) and the ghost's distance.
struct LiveColumn {
  std::string name, unit;
  ColumnKind kind;
};

/// A curve of a plot, by its column.
struct LiveCurve {
  std::string label;
  std::size_t column;
  std::string unit;
};
/// A plot: curves over a column, or over t.
struct LivePlot {
  std::vector<LiveCurve> curves;
  std::optional<LiveCurve> against;  // nothing: t
};

/// Numbers of a drawn thing by the name of what they say: where they stand in the scene.
struct SceneNumbers {
  std::string name;
  std::vector<std::size_t> places;
  bool is_point;
};
/// A shape of the drawing.
struct SceneItem {
  model::Shape shape;
  std::string label, color, text;
  std::vector<SceneNumbers> numbers;
  std::optional<std::size_t> drag_target;  // of LiveModel::drag_targets, where the mouse may move it
  std::vector<std::size_t> path{};         // of a trail: where its point stands in the paths
};

/// A model with all that is shown of it.
struct LiveModel {
  std::shared_ptr<const model::ModelProgram> program;
  std::vector<LiveColumn> columns;
  std::vector<std::size_t> plotted;  // the states that are columns, the first of them
  std::vector<LivePlot> plots;
  std::vector<SceneItem> drawing;
  std::vector<model::NodeId> quantities, scene, paths;  // paths: the points of trails, for each row
  std::vector<DragTarget> drag_targets;
  std::vector<std::size_t> apart;            // the states in which a ghost's distance is measured
  std::optional<std::size_t> energy, drift;  // columns
  int dimension = 2;

  /// The model itself.
  [[nodiscard]] const model::Model& model() const { return program->model; }
  /// The column of the ghost's distance, the last one.
  [[nodiscard]] std::size_t distance() const { return columns.size() - 1; }
};

/// The values of the model's variables as they are at some instant: parameters and inputs. Shared by all that was
/// computed with them.
using Variables = std::shared_ptr<const std::vector<double>>;

/// Inputs that somebody moves (those with a key that may be pressed, and `taken`) do not follow their files.
using Taken = std::set<std::string, std::less<>>;
/// Prepares a model to be shown. Compiles its equations.
[[nodiscard]] LiveModel prepare(model::Model model, Keys keys, const Taken& taken = {});

}  // namespace continuo::live
