// continuo/live/live_model.cpp
// Prepares a model for the view: curves, drawing and handles as expressions on one tape.
#include <algorithm>
#include <map>
#include <utility>

#include <continuo/language/world.hpp>
#include <continuo/live/live_model.hpp>
#include <continuo/live/motion/point_rate.hpp>

namespace continuo::live {

namespace {

using model::NodeId;

constexpr std::size_t most_default_curves = 8;
constexpr std::size_t most_vectors = 60;  // arrows at more things would cover them

class Preparation {
 public:
  explicit Preparation(model::Model model) : model_(std::move(model)) {}

  LiveModel make() {
    add_states();
    for (const model::Quantity& let : model_.lets) add(let.name, let.unit, ColumnKind::let, let.node);
    for (const model::Quantity& output : model_.outputs) add(output.name, output.unit, ColumnKind::output, output.node);
    add_energies();
    add_plots();
    if (made_.energy) {
      made_.drift = made_.columns.size();
      made_.columns.push_back({"energy drift", "", ColumnKind::drift});
    }
    made_.columns.push_back({"distance", "", ColumnKind::distance});
    for (const model::DrawItem& item : model_.drawing) draw(item);
    measure_apart();
    made_.program = model::compile(std::move(model_));
    return std::move(made_);
  }

 private:
  void add_states() {
    constexpr std::size_t many_bodies = 20;
    const model::WorldDescription* world = model_.world.get();
    const std::size_t first = world && world->bodies.size() > many_bodies ? world->body_states() : 0;
    for (std::size_t i = first; i < model_.states.size(); ++i) {
      const model::State& state = model_.states[i];
      made_.plotted.push_back(i);
      column_of_[model_.graph.variable(state.variable)] = made_.columns.size();
      made_.columns.push_back({state.column, state.unit, ColumnKind::state});
    }
  }

  std::size_t add(const std::string& name, const std::string& unit, ColumnKind kind, NodeId node) {
    const std::size_t column = made_.columns.size();
    column_of_.emplace(node, column);
    made_.columns.push_back({name, unit, kind});
    made_.quantities.push_back(node);
    return column;
  }

  void add_energies() {
    for (const model::Quantity& energy : model_.energies)
      add(energy.name, energy.unit, ColumnKind::energy, energy.node);
    if (model_.total_energy.valid())
      made_.energy = add("energy", model_.total_energy_unit, ColumnKind::energy, model_.total_energy);
  }

  LiveCurve curve(const model::Series& series) {
    const auto known = column_of_.find(series.node);
    const std::size_t column =
        known != column_of_.end() ? known->second : add(series.label, series.unit, ColumnKind::curve, series.node);
    return {series.label, column, series.unit};
  }

  void add_plots() {
    const NodeId time = model_.graph.variable(model::Layout::time);
    for (const model::Plot& plot : model_.plots) {
      LivePlot made;
      for (const model::Series& series : plot.curves) made.curves.push_back(curve(series));
      if (plot.against.node != time) made.against = curve(plot.against);
      made_.plots.push_back(std::move(made));
    }
    if (!made_.plots.empty()) return;
    LivePlot states;
    for (std::size_t i = 0; i < std::min(most_default_curves, made_.plotted.size()); ++i)
      states.curves.push_back({made_.columns[i].name, i, made_.columns[i].unit});
    made_.plots.push_back(std::move(states));
  }

  SceneNumbers place(std::string name, const std::vector<NodeId>& nodes) {
    SceneNumbers numbers{std::move(name), {}, nodes.size() > 1};
    for (const NodeId node : nodes) {
      numbers.places.push_back(made_.scene.size());
      made_.scene.push_back(node);
    }
    return numbers;
  }

  /// The velocity of a point, and its acceleration, in each mode that has its own: `velocity`, or `velocity:MODE`.
  void add_vectors(const std::vector<NodeId>& point, SceneItem& made) {
    std::vector<std::vector<NodeId>> in_modes(model_.modes.size(), point);
    for (const char* name : {"velocity", "acceleration"}) {
      for (std::size_t mode = 0; mode < in_modes.size(); ++mode) {
        for (NodeId& node : in_modes[mode]) {
          const auto rate = rate_along_motion(model_, node, mode);
          if (!rate) return;
          node = *rate;
        }
      }
      const bool same = std::ranges::all_of(in_modes, [&](const auto& nodes) { return nodes == in_modes.front(); });
      for (std::size_t mode = 0; mode < (same ? 1 : in_modes.size()); ++mode) {
        std::string full = name;
        if (!same) full.append(":").append(model_.modes[mode].name);
        made.numbers.push_back(place(std::move(full), in_modes[mode]));
      }
    }
  }

  void draw(const model::DrawItem& item) {
    using model::Shape;
    SceneItem made{
        .shape = item.shape, .label = {}, .color = {}, .text = {}, .numbers = {}, .drag_target = {}, .path = {}};
    for (std::size_t i = 0; i < item.arguments.size(); ++i) {
      const model::DrawArgument& argument = item.arguments[i];
      if (argument.numbers.empty()) {
        made.text = argument.text;
        continue;
      }
      if (argument.numbers.size() == 3) made_.dimension = 3;
      made.numbers.push_back(place(item.shape == Shape::floor ? "height" : i == 0 ? "at" : "to", argument.numbers));
    }
    for (const model::DrawAttribute& attribute : item.attributes) {
      if (attribute.name == "color") {
        made.color = attribute.value.text;
      } else if (attribute.name == "label") {
        made.label = attribute.value.text;
      } else if (attribute.name != "drag") {
        made.numbers.push_back(place(attribute.name, attribute.value.numbers));
      }
    }
    if ((item.shape == Shape::ball || item.shape == Shape::box) && most_vectors > vectors_++)
      add_vectors(item.arguments.front().numbers, made);
    if (item.shape == Shape::trail) {
      for (const NodeId node : item.arguments.front().numbers) {
        made.path.push_back(made_.paths.size());
        made_.paths.push_back(node);
      }
    }
    if (is_dragged(item)) {
      made.drag_target = made_.drag_targets.size();
      made_.drag_targets.push_back(make_drag_target(model_, item.arguments.front().numbers));
    }
    made_.drawing.push_back(std::move(made));
  }

  /// Positions where there are any: a distance over velocities too would have no unit.
  void measure_apart() {
    if (const model::WorldDescription* world = model_.world.get()) {
      const std::size_t each = model::WorldDescription::states_of_body(world->dimension);
      made_.dimension = std::max(made_.dimension, world->dimension);
      for (std::size_t i = 0; i < world->body_states(); i += each) {
        for (int k = 0; k < world->dimension; ++k) made_.apart.push_back(i + 2 * static_cast<std::size_t>(k));
      }
      return;
    }
    for (const PositionVelocity& pair : model_.pairs) made_.apart.push_back(pair.position);
    if (!made_.apart.empty()) return;
    for (std::size_t i = 0; i < model_.states.size(); ++i) made_.apart.push_back(i);
  }

  model::Model model_;
  LiveModel made_;
  std::map<NodeId, std::size_t> column_of_;
  std::size_t vectors_ = 0;  // the drawn things that have been given vectors
};

}  // namespace

LiveModel prepare(model::Model model, Keys keys, const Taken& taken) {
  for (model::Input& input : model.inputs) {
    if ((keys == Keys::are_pressed && !input.key.empty()) || taken.contains(input.name)) input.points.reset();
  }
  return Preparation(std::move(model)).make();
}

}  // namespace continuo::live
