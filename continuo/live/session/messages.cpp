// continuo/live/session/messages.cpp
// Writes the messages of a session as JSON.
#include <array>
#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include <continuo/live/session/messages.hpp>
#include <continuo/runs/methods.hpp>

namespace continuo::live {

namespace {

using nlohmann::json;

/// Texts of models may be any bytes; what is no UTF-8 is replaced.
std::string text_of(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

json number(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

std::string_view word_of(ColumnKind kind) {
  static constexpr std::array<std::string_view, 7> words = {"state", "let",   "output",  "energy",
                                                            "drift", "curve", "distance"};
  return words[static_cast<std::size_t>(kind)];
}

std::string_view word_of(model::Shape shape) {
  static constexpr std::array<std::string_view, 9> words = {"floor", "ball",  "spring", "rod", "rope",
                                                            "arrow", "trail", "box",    "text"};
  return words[static_cast<std::size_t>(shape)];
}

std::string_view word_of(model::Severity severity) {
  static constexpr std::array<std::string_view, 3> words = {"error", "warning", "note"};
  return words[static_cast<std::size_t>(severity)];
}

json columns_of(const LiveModel& shown) {
  json columns = json::array();
  for (const LiveColumn& column : shown.columns)
    columns.push_back({{"name", column.name}, {"unit", column.unit}, {"kind", word_of(column.kind)}});
  return columns;
}

json curve_of(const LiveCurve& curve) {
  return {{"label", curve.label}, {"column", curve.column}, {"unit", curve.unit}};
}

json plots_of(const LiveModel& shown) {
  json plots = json::array();
  for (const LivePlot& plot : shown.plots) {
    json curves = json::array();
    for (const LiveCurve& curve : plot.curves) curves.push_back(curve_of(curve));
    plots.push_back({{"curves", curves}, {"against", plot.against ? curve_of(*plot.against) : json("t")}});
  }
  return plots;
}

json drawing_of(const LiveModel& shown) {
  json drawing = json::array();
  for (const SceneItem& item : shown.drawing) {
    json numbers = json::object();
    for (const SceneNumbers& part : item.numbers)
      numbers[part.name] = part.is_point ? json(part.places) : json(part.places.front());
    json made = {{"shape", word_of(item.shape)}, {"numbers", numbers}, {"drag", item.drag_target.has_value()}};
    if (!item.label.empty()) made["label"] = item.label;
    if (!item.color.empty()) made["color"] = item.color;
    if (!item.text.empty()) made["text"] = item.text;
    if (!item.path.empty()) made["path"] = item.path;
    drawing.push_back(std::move(made));
  }
  return drawing;
}

/// Name, value (now, and as the text has it), unit, range and comment: of parameters and inputs.
template <class Quantity>
json control_of(const Quantity& quantity, std::span<const double> variables, std::span<const double> file) {
  return {{"name", quantity.name},
          {"value", number(variables[quantity.variable])},
          {"file", number(file[quantity.variable])},
          {"unit", quantity.unit},
          {"min", quantity.range ? json(quantity.range->low) : json(nullptr)},
          {"max", quantity.range ? json(quantity.range->high) : json(nullptr)},
          {"comment", quantity.comment}};
}

json parameters_of(const ModelWords& words, std::span<const double> file) {
  json parameters = json::array();
  for (const model::Parameter& parameter : words.shown.model().parameters) {
    json made = control_of(parameter, words.variables, file);
    made["structural"] = parameter.structural;
    made["independent"] = parameter.independent;
    parameters.push_back(std::move(made));
  }
  return parameters;
}

json inputs_of(const ModelWords& words, std::span<const double> file) {
  json inputs = json::array();
  for (const model::Input& input : words.shown.model().inputs) {
    json made = control_of(input, words.variables, file);
    made["key"] = input.key;
    made["from_file"] = input.points.has_value();
    inputs.push_back(std::move(made));
  }
  return inputs;
}

json point_of(const worlds::Point& point, int dimension) {
  json made = json::array({point[0], point[1]});
  if (dimension == 3) made.push_back(point[2]);
  return made;
}

json bodies_of(const worlds::WorldRun* world) {
  if (!world) return nullptr;
  constexpr std::size_t few = 1000;
  json radius = json::array(), walls = json::array(), names = json::array();
  for (const worlds::BodyShape& body : world->bodies()) {
    radius.push_back(body.radius);
    if (world->bodies().size() <= few) names.push_back(body.name);
  }
  for (const worlds::WallShape& wall : world->walls())
    walls.push_back(
        {{"normal", point_of(wall.normal, world->dimension())}, {"offset", wall.offset}, {"thin", wall.thin}});
  json meshes = json::array();
  for (const worlds::StaticMeshShape& mesh : world->meshes()) {
    json corners = json::array(), facets = json::array();
    for (const worlds::Point& corner : mesh.corners) corners.push_back(point_of(corner, world->dimension()));
    for (const auto& [a, b, c] : mesh.facets)
      facets.push_back(world->dimension() == 2 ? json::array({a, b}) : json::array({a, b, c}));
    meshes.push_back({{"name", mesh.name}, {"corners", corners}, {"facets", facets}, {"thin", mesh.thin}});
  }
  json springs = json::array();
  for (const worlds::SpringShape& spring : world->springs()) {
    const bool to_body = spring.b != model::no_body;
    springs.push_back({{"a", spring.a},
                       {"b", to_body ? json(spring.b) : json(nullptr)},
                       {"point", to_body ? json(nullptr) : point_of(spring.point, world->dimension())}});
  }
  json forms = json::array(), form = json::array(), joints = json::array();
  for (const worlds::BodyForm& one : world->forms()) {
    json corners = json::array();
    for (const worlds::Point& corner : one.corners) corners.push_back(point_of(corner, world->dimension()));
    forms.push_back({{"corners", corners}, {"faces", one.faces}});
  }
  for (const worlds::BodyShape& body : world->bodies())
    if (!forms.empty()) form.push_back(body.form == worlds::no_form ? json(nullptr) : json(body.form));
  for (const worlds::JointShape& joint : world->joints())
    joints.push_back({{"name", joint.name},
                      {"kind", joint.kind},
                      {"first", joint.first},
                      {"second", joint.second == model::no_body ? json(nullptr) : json(joint.second)},
                      {"on_first", point_of(joint.on_first, world->dimension())},
                      {"on_second", point_of(joint.on_second, world->dimension())},
                      {"axis", point_of(joint.axis, world->dimension())},
                      {"apart", number(joint.apart)}});
  return {{"count", world->bodies().size()},
          {"dimension", world->dimension()},
          {"radius", radius},
          {"names", names},
          {"walls", walls},
          {"meshes", meshes},
          {"containers", json::array()},
          {"springs", springs},
          {"forms", forms},
          {"form", form},
          {"joints", joints}};
}

json methods_of(const model::Model& model) {
  json methods = json::array();
  for (const runs::Method& method : runs::methods_for(model))
    methods.push_back({{"name", method.name},
                       {"title", method.title},
                       {"order", method.order},
                       {"implicit", method.implicit},
                       {"fixed", !method.chooses_steps}});
  return methods;
}

json accuracy_of(const model::Plan& plan) {
  return {{"method", plan.method},
          {"step", plan.step > 0 ? json(plan.step) : json(nullptr)},
          {"rtol", plan.step > 0 ? json(nullptr) : json(plan.rtol)}};
}

json diagnostic_of(const model::Diagnostic& problem, const model::Source& source) {
  const model::Place place = source.place(problem.span.begin), end = source.place(problem.span.end);
  const int length = end.line == place.line ? end.column - place.column : 1;
  return {{"severity", word_of(problem.severity)},
          {"code", problem.code},
          {"text", problem.message},
          {"hint", problem.help},
          {"label", problem.label},
          {"line", place.line},
          {"column", place.column},
          {"length", std::max(length, 1)}};
}

}  // namespace

std::string model_json(const ModelWords& words) {
  const model::Model& model = words.shown.model();
  const std::vector<double> file = start_values(model);
  json gallery = json::array();
  for (const GalleryModel& other : words.gallery)
    gallery.push_back({{"name", other.name}, {"title", other.title}, {"subject", other.subject}});
  const model::Source source(words.path, words.text);
  json mistakes = json::array();
  for (const model::Diagnostic& mistake : words.mistakes) mistakes.push_back(diagnostic_of(mistake, source));
  json experiment = accuracy_of(words.plan);
  experiment["from"] = words.plan.from;
  experiment["to"] = words.plan.to;
  return text_of({{"say", "model"},
                  {"run", words.run},
                  {"name", model.name},
                  {"heading", model.heading},
                  {"path", words.path},
                  {"text", words.text},
                  {"saveable", words.saveable},
                  {"welcome", words.welcome},
                  {"mistakes", mistakes},
                  {"time_unit", model.time_unit},
                  {"dimension", words.shown.dimension},
                  {"scene_count", words.shown.scene.size()},
                  {"path_count", words.shown.paths.size()},
                  {"columns", columns_of(words.shown)},
                  {"plots", plots_of(words.shown)},
                  {"drawing", drawing_of(words.shown)},
                  {"bodies", bodies_of(words.world)},
                  {"parameters", parameters_of(words, file)},
                  {"inputs", inputs_of(words, file)},
                  {"methods", methods_of(model)},
                  {"experiment", experiment},
                  {"gallery", gallery},
                  {"undo", words.undo}});
}

std::string state_json(const StateWords& words) {
  const model::Model& model = words.shown.model();
  json parameters = json::object(), inputs = json::object();
  for (const model::Parameter& parameter : model.parameters)
    parameters[parameter.name] = number(words.variables[parameter.variable]);
  for (const model::Input& input : model.inputs) inputs[input.name] = number(words.variables[input.variable]);
  json state = accuracy_of(words.plan);
  state.update({{"say", "state"},
                {"playing", words.playing},
                {"t", words.t},
                {"target", words.target},
                {"reached", words.reached},
                {"slow", words.slow},
                {"history", {words.first, words.last}},
                {"ghost", words.ghost ? accuracy_of(*words.ghost) : json(nullptr)},
                {"parameters", parameters},
                {"inputs", inputs},
                {"undo", words.undo},
                {"mode", words.mode},
                {"steps", words.statistics.steps},
                {"rejected", words.statistics.rejected},
                {"ended", words.ended.empty() ? json(nullptr) : json(words.ended)}});
  return text_of(state);
}

std::string picked_json(const worlds::WorldRun& world, std::size_t body) {
  const worlds::BodyShape& shape = world.bodies()[body];
  json values = {{"radius", shape.radius}, {"mass", shape.mass}};
  const worlds::Point x = world.position(body), v = world.velocity(body), spin = world.spin(body);
  static constexpr std::array<const char*, 3> axes = {"x", "y", "z"};
  for (std::size_t k = 0; k < static_cast<std::size_t>(world.dimension()); ++k) {
    values[axes[k]] = number(x[k]);
    values[std::string(axes[k]) + "'"] = number(v[k]);
  }
  if (world.dimension() == 2) {
    values["spin"] = number(spin[2]);
  } else {
    for (std::size_t k = 0; k < 3; ++k) values[std::string("spin_") + axes[k]] = number(spin[k]);
  }
  return text_of({{"say", "values"}, {"t", world.time()}, {"body", body}, {"name", shape.name}, {"values", values}});
}

std::string event_json(const LiveEvent& event) {
  return text_of({{"say", "event"}, {"t", event.t}, {"name", event.name}, {"mark", event.mark}});
}

std::string message_json(const model::Diagnostic& problem, const model::Source& source) {
  json message = diagnostic_of(problem, source);
  message["say"] = "message";
  if (problem.span.empty()) message["line"] = message["column"] = nullptr;
  return text_of(message);
}

std::string note_json(std::string_view severity, std::string_view text, std::string_view hint) {
  return text_of({{"say", "message"},
                  {"severity", severity},
                  {"code", ""},
                  {"text", text},
                  {"hint", hint},
                  {"line", nullptr},
                  {"column", nullptr}});
}

std::string checked_json(double id, std::span<const model::Diagnostic> problems, const model::Source& source) {
  json found = json::array();
  for (const model::Diagnostic& problem : problems) found.push_back(diagnostic_of(problem, source));
  return text_of({{"say", "checked"}, {"id", id}, {"diagnostics", found}});
}

std::string saved_json(std::string_view path) {
  return text_of({{"say", "saved"}, {"path", path}});
}

std::string pong_json(double id) {
  return text_of({{"say", "pong"}, {"id", id}});
}

std::string role_json(const RoleWords& words) {
  return text_of({{"say", "role"},
                  {"role", words.role},
                  {"may", words.may},
                  {"own_sessions", words.own_sessions},
                  {"viewers_address", words.viewers_address.empty() ? json(nullptr) : json(words.viewers_address)}});
}

std::string room_json(std::size_t viewers) {
  return text_of({{"say", "room"}, {"viewers", viewers}});
}

std::string busy_json(std::string_view with, double seconds) {
  return text_of({{"say", "busy"}, {"with", with.empty() ? json(nullptr) : json(with)}, {"seconds", seconds}});
}

}  // namespace continuo::live
