// Writes the parts of a checked model as JSON.
#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <apps/continuo/verbs/model_json.hpp>
#include <nlohmann/json.hpp>

#include <continuo/language/world.hpp>
#include <continuo/runs/kind.hpp>

namespace continuo::app {
namespace {

using Json = nlohmann::ordered_json;

class ModelWriter {
 public:
  explicit ModelWriter(const model::Model& model) : model_(model), start_(model::start_values(model)) {}

  Json write() const {
    return {{"name", model_.name},
            {"heading", model_.heading},
            {"solver", runs::name_of(runs::kind_of(model_).solver)},
            {"time_unit", model_.time_unit},
            {"states", list(model_.states, &ModelWriter::state)},
            {"modes", list(model_.modes, &ModelWriter::mode)},
            {"algebraic", list(model_.algebraic, &ModelWriter::algebraic)},
            {"parameters", list(model_.parameters, &ModelWriter::parameter)},
            {"inputs", list(model_.inputs, &ModelWriter::input)},
            {"unknowns", list(model_.unknowns, &ModelWriter::unknown)},
            {"lets", list(model_.lets, &ModelWriter::quantity)},
            {"outputs", list(model_.outputs, &ModelWriter::quantity)},
            {"energies", list(model_.energies, &ModelWriter::quantity)},
            {"events", list(model_.event_order, &ModelWriter::event)},
            {"checks", list(model_.checks, &ModelWriter::check)},
            {"bodies", model_.has_world() ? list(model_.world->bodies, &ModelWriter::body) : Json::array()},
            {"joints", model_.has_world() ? list(model_.world->joints, &ModelWriter::joint) : Json::array()},
            {"walls", model_.has_world() ? list(model_.world->walls, &ModelWriter::wall) : Json::array()},
            {"meshes", model_.has_world() ? list(model_.world->meshes, &ModelWriter::mesh) : Json::array()},
            {"run", run()}};
  }

 private:
  template <class Item>
  Json list(const std::vector<Item>& items, Json (ModelWriter::*json_of_item)(const Item&) const) const {
    Json array = Json::array();
    for (const Item& item : items) array.push_back((this->*json_of_item)(item));
    return array;
  }

  Json text(model::NodeId node) const {
    if (!node.valid()) return nullptr;
    return to_text(model_.graph, node, [this](std::uint32_t variable) { return variable_name(model_, variable); });
  }
  static Json low(const std::optional<model::Range>& range) { return range ? Json(range->low) : Json(); }
  static Json high(const std::optional<model::Range>& range) { return range ? Json(range->high) : Json(); }
  static Json value_of(const std::optional<model::Setting>& setting) { return setting ? Json(setting->value) : Json(); }

  Json state(const model::State& state) const {
    return {{"name", state.column},
            {"unit", state.unit},
            {"start", start_[state.variable]},
            {"kind", state.in_world    ? "body"
                     : state.algebraic ? "algebraic"
                                       : "differential"}};
  }
  /// The derivatives of the states of equations; those of bodies have none.
  Json mode(const model::Mode& mode) const {
    Json equations = Json::array();
    for (std::size_t i = 0; i < mode.derivatives.size() && i < model_.states.size(); ++i)
      if (!model_.states[i].in_world && !model_.states[i].algebraic)
        equations.push_back({{"state", model_.states[i].column}, {"derivative", text(mode.derivatives[i])}});
    return {{"name", mode.name}, {"starts", &mode == &model_.modes[model_.start_mode]}, {"equations", equations}};
  }
  Json algebraic(const model::AlgebraicEquation& equation) const {
    return {{"mode", model_.modes[equation.mode].name}, {"zero", text(equation.residual)}};
  }
  Json parameter(const model::Parameter& parameter) const {
    return {{"name", parameter.name},      {"value", parameter.value},      {"unit", parameter.unit},
            {"low", low(parameter.range)}, {"high", high(parameter.range)}, {"decides_size", parameter.structural},
            {"comment", parameter.comment}};
  }
  Json input(const model::Input& input) const {
    return {{"name", input.name},        {"value", input.value}, {"unit", input.unit}, {"low", low(input.range)},
            {"high", high(input.range)}, {"key", input.key},     {"file", input.file}, {"comment", input.comment}};
  }
  Json unknown(const model::Unknown& unknown) const {
    return {{"name", unknown.name}, {"unit", unknown.unit}, {"guess", text(unknown.guess)}};
  }
  Json quantity(const model::Quantity& quantity) const {
    return {{"name", quantity.name}, {"unit", quantity.unit}, {"expression", text(quantity.node)}};
  }
  Json event(const model::EventOrder& order) const {
    if (order.scheduled) return {{"name", model_.schedule[order.index].name}, {"scheduled", true}, {"mode", nullptr}};
    const model::When& event = model_.events[order.index];
    return {{"name", event.name},
            {"scheduled", false},
            {"mode", event.mode ? Json(model_.modes[*event.mode].name) : Json()}};
  }
  Json check(const model::Check& check) const { return check.text; }
  Json number(model::NodeId node) const { return node.valid() ? Json(evaluate(model_, node, start_)) : Json(); }
  Json body(const model::BodyDescription& body) const {
    return {{"name", body.name},
            {"fixed", body.fixed},
            {"mass", body.fixed ? Json() : number(body.mass)},
            {"radius", number(body.radius)},
            {"shape", name_of(body.shape.kind)},
            {"driven", body.driven},
            {"sensor", body.traits.sensor},
            {"character", body.character}};
  }
  static const char* name_of(model::ShapeDescription::Kind kind) {
    switch (kind) {
      case model::ShapeDescription::Kind::capsule:
        return "capsule";
      case model::ShapeDescription::Kind::box:
        return "box";
      case model::ShapeDescription::Kind::hull:
        return "hull";
      case model::ShapeDescription::Kind::compound:
        return "compound";
      case model::ShapeDescription::Kind::ball:
        break;
    }
    return "ball";
  }
  Json joint(const model::JointDescription& joint) const {
    const std::vector<model::BodyDescription>& bodies = model_.world->bodies;
    return {{"name", joint.is_named ? Json(joint.name) : Json()},
            {"kind", joint.kind},
            {"first", bodies[joint.first].name},
            {"second", joint.second == model::no_body ? Json() : Json(bodies[joint.second].name)}};
  }
  /// Free where normal . x >= offset.
  Json wall(const model::WallDescription& wall) const {
    Json normal = Json::array();
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(model_.world->dimension); ++axis)
      normal.push_back(number(wall.normal[axis]));
    return {{"name", wall.name}, {"normal", normal}, {"offset", number(wall.offset)}, {"thin", wall.thin}};
  }
  Json mesh(const model::MeshDescription& mesh) const {
    const bool is_chain = model_.world->dimension == 2;
    const std::size_t corners = std::max(mesh.points.size(), mesh.corners.size());
    const std::size_t segments = mesh.is_closed ? corners : corners - 1;
    return {{"name", mesh.name},        {"kind", is_chain ? "chain" : "triangles"},
            {"corners", corners},       {"facets", is_chain ? segments : mesh.triangles.size()},
            {"closed", mesh.is_closed}, {"thin", mesh.thin}};
  }
  Json run() const {
    const model::RunSettings& run = model_.run;
    if (!run.from || !run.to) return nullptr;
    return {{"from", run.from->value},
            {"to", run.to->value},
            {"output", run.output ? value_of(run.output->interval) : Json()},
            {"method", run.method ? Json(*run.method) : Json()},
            {"step", value_of(run.step)},
            {"rtol", run.rtol ? Json(*run.rtol) : Json()},
            {"atol", run.atol},
            {"max_step", value_of(run.max_step)},
            {"max_steps", run.max_steps ? Json(*run.max_steps) : Json()}};
  }

  const model::Model& model_;
  std::vector<double> start_;
};

}  // namespace

nlohmann::ordered_json model_json(const model::Model& model) {
  return ModelWriter(model).write();
}

}  // namespace continuo::app
