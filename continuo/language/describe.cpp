// continuo/language/describe.cpp
// Writes the description of a checked model: states, equations, units, events, experiment.
#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <continuo/language/describe.hpp>
#include <continuo/language/sweep.hpp>
#include <continuo/language/world.hpp>

namespace continuo::model {

namespace {

class Writer {
 public:
  Writer(const Model& model, const DescribeOptions& options) : model_(model), options_(options) {}

  std::string text() && {
    title();
    if (model_.has_world()) world(*model_.world);
    if (!std::ranges::all_of(model_.states, &State::in_world)) equations();
    states();
    parameters();
    inputs();
    quantities("Lets", model_.lets);
    quantities("Outputs", model_.outputs);
    quantities("Energies", model_.energies);
    events();
    experiment();
    sweep();
    remarks();
    return std::move(text_);
  }

 private:
  using Row = std::vector<std::string>;

  template <class... Arguments>
  void line(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
    text_ += '\n';
  }

  /// Columns side by side, each as wide as its widest entry.
  void table(const std::vector<Row>& rows, std::size_t more = 0) {
    std::vector<std::size_t> width;
    for (const Row& row : rows) {
      width.resize(std::max(width.size(), row.size()));
      for (std::size_t i = 0; i + 1 < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
    }
    for (const Row& row : rows) {
      std::string text = " ";
      for (std::size_t i = 0; i < row.size(); ++i) text += fmt::format(" {:<{}}", row[i], width[i]);
      text.erase(text.find_last_not_of(' ') + 1);
      line("{}", text);
    }
    if (more > 0) line("  ... and {} more", more);
  }

  /// Under a heading, a row for each of the first items.
  template <class List, class MakeRow>
  void section(std::string_view heading, const List& list, MakeRow&& make_row) {
    if (list.empty()) return;
    line("\n{}", heading);
    const std::size_t shown = std::min(list.size(), options_.most_listed);
    std::vector<Row> rows;
    for (std::size_t i = 0; i < shown; ++i) rows.push_back(make_row(list[i]));
    table(rows, list.size() - shown);
  }

  std::string expression(NodeId node) const {
    if (!node.valid()) return "?";
    return to_text(
        model_.graph, node, [&](std::uint32_t v) { return variable_name(model_, v); }, options_.longest_expression);
  }
  static std::string in_brackets(const std::string& unit) { return unit.empty() ? "" : "[" + unit + "]"; }
  static std::string range(const std::optional<Range>& range) {
    return range ? fmt::format("in {:g}..{:g}", range->low, range->high) : "";
  }
  static std::string beside(const std::string& comment) { return comment.empty() ? "" : "# " + comment; }
  /// `2*pi*sqrt(m/k) = 6.28`, and a plain number once.
  std::string with_value(NodeId node, double value) const {
    const std::string number = fmt::format("{:.6g}", value);
    return model_.graph.value(node) ? number : expression(node) + " = " + number;
  }

  void title() {
    line("{}", model_.name);
    const std::string first = model_.heading.substr(0, model_.heading.find('\n'));
    if (!first.empty()) line("{}", first);
  }

  std::string number(NodeId node, std::span<const double> variables) const {
    return fmt::format("{:.6g}", evaluate(model_, node, variables));
  }
  std::string point(const std::vector<NodeId>& nodes, std::span<const double> variables) const {
    std::vector<std::string> numbers;
    for (const NodeId node : nodes) numbers.push_back(number(node, variables));
    return fmt::format("({})", fmt::join(numbers, ", "));
  }

  std::string shape(const ShapeDescription& shape, int dimension, std::span<const double> variables) const {
    switch (shape.kind) {
      case ShapeDescription::Kind::capsule:
        return "capsule " + number(shape.length, variables) + " radius " + number(shape.radius, variables);
      case ShapeDescription::Kind::box:
        return "box " + point({shape.size.begin(), shape.size.begin() + dimension}, variables);
      case ShapeDescription::Kind::hull:
        return fmt::format("hull of {} points", shape.corners.size());
      case ShapeDescription::Kind::compound:
        return fmt::format("compound of {} part{}", shape.parts.size(), shape.parts.size() == 1 ? "" : "s");
      case ShapeDescription::Kind::ball:
        break;
    }
    return "radius " + number(shape.radius, variables);
  }

  void world(const WorldDescription& world) {
    const std::vector<double> start = start_values(model_);
    const auto axes = static_cast<std::ptrdiff_t>(world.dimension);
    const auto of = [&](const NodePoint& p) { return point({p.begin(), p.begin() + axes}, start); };
    line("\nWorld of {} dimensions, {}", world.dimension,
         world.mode.fast ? "moved fast, by " + world.mode.integrator : "moved exactly");
    line("  gravity {}", of(world.gravity));
    if (world.attraction.valid()) line("  attraction {}", number(world.attraction, start));
    if (world.drag_linear.valid())
      line("  drag linear {} quadratic {}", number(world.drag_linear, start), number(world.drag_quadratic, start));
    if (world.combine_rule != CombineRuleDescription{})
      line("  surfaces combine: restitution {}, friction {}, rolling {}", world.combine_rule.restitution,
           world.combine_rule.friction, world.combine_rule.rolling);
    if (!world.springs.empty()) line("  {} springs", world.springs.size());
    section(fmt::format("Bodies ({})", world.bodies.size()), world.bodies, [&](const BodyDescription& body) -> Row {
      std::vector<NodeId> at;
      for (int axis = 0; axis < world.dimension; ++axis)
        at.push_back(model_.states[body.first_state + 2 * static_cast<std::size_t>(axis)].initial);
      return {body.name, "at " + point(at, start), shape(body.shape, world.dimension, start),
              body.character ? "character"
              : body.driven  ? "driven"
              : body.fixed   ? "fixed"
                             : "mass " + number(body.mass, start)};
    });
    section("Joints", world.joints, [&](const JointDescription& joint) -> Row {
      return {joint.is_named ? joint.name : "", joint.kind,
              world.bodies[joint.first].name + " to " +
                  (joint.second == no_body ? "the world" : world.bodies[joint.second].name)};
    });
    section("Walls", world.walls, [&](const WallDescription& wall) -> Row {
      return {wall.name, of(wall.normal), "at " + number(wall.offset, start), wall.thin ? "thin" : ""};
    });
    section("Meshes", world.meshes, [&](const MeshDescription& mesh) -> Row {
      return {mesh.name,
              world.dimension == 2
                  ? fmt::format("chain of {} points", std::max(mesh.points.size(), mesh.corners.size()))
                  : fmt::format("mesh of {} triangles", mesh.triangles.size()),
              "at " + of(mesh.position), mesh.is_closed ? "closed" : "", mesh.thin ? "thin" : ""};
    });
    const auto row_of = [&](const ForceDescription& load) -> Row {
      Row row{"on " + world.bodies[load.body].name};
      for (const NodeId component : load.components)
        if (component.valid()) row.push_back(expression(component));
      return row;
    };
    section("Forces", world.forces, row_of);
    section("Torques", world.torques, row_of);
  }

  void equations() {
    line("\nEquations, of first order");
    std::vector<std::size_t> of_equations;
    for (std::size_t i = 0; i + model_.unknowns.size() < model_.states.size(); ++i) {
      if (!model_.states[i].in_world) of_equations.push_back(i);
    }
    const std::size_t count = of_equations.size(), shown = std::min(count, options_.most_listed);
    for (std::size_t m = 0; m < model_.modes.size(); ++m) {
      const Mode& mode = model_.modes[m];
      const bool starts = m == model_.start_mode;
      if (model_.modes.size() > 1) line("  mode {}{}", mode.name, starts ? ", where the run starts" : "");
      std::vector<Row> rows;
      for (std::size_t k = 0; k < shown; ++k) {
        const std::size_t i = of_equations[k];
        rows.push_back({"(" + model_.states[i].column + ")'", "= " + expression(mode.derivatives[i])});
      }
      table(rows, count - shown);
    }
    for (const AlgebraicEquation& equation : model_.algebraic) line("  0 = {}", expression(equation.residual));
  }

  void states() {
    const std::vector<double> start = start_values(model_);
    std::vector<State> differential;
    for (std::size_t i = 0; i + model_.unknowns.size() < model_.states.size(); ++i) {
      if (!model_.states[i].in_world) differential.push_back(model_.states[i]);
    }
    section(fmt::format("States ({})", differential.size()), differential, [&](const State& s) -> Row {
      return {s.column, in_brackets(s.unit), "starts at " + with_value(s.initial, start[s.variable])};
    });
  }

  void parameters() {
    section("Parameters", model_.parameters, [&](const Parameter& p) -> Row {
      return {p.name,         "= " + with_value(p.expression, p.value), in_brackets(p.unit),
              range(p.range), p.structural ? "decides the size" : "",   beside(p.comment)};
    });
  }

  void inputs() {
    section("Inputs", model_.inputs, [&](const Input& i) -> Row {
      return {i.name,           fmt::format("= {:g}", i.value),      in_brackets(i.unit),
              range(i.range),   i.key.empty() ? "" : "key " + i.key, i.file.empty() ? "" : "from " + i.file,
              beside(i.comment)};
    });
    section("Unknowns", model_.unknowns,
            [&](const Unknown& u) -> Row { return {u.name, in_brackets(u.unit), "guess " + expression(u.guess)}; });
  }

  void quantities(std::string_view heading, const std::vector<Quantity>& list) {
    section(heading, list,
            [&](const Quantity& q) -> Row { return {q.name, in_brackets(q.unit), "= " + expression(q.node)}; });
  }

  std::string actions(const Block& block) const {
    std::string text;
    for (const Action& action : block)
      text += (text.empty() ? "" : "; ") + std::visit([&](const auto& what) { return one_action(what); }, action.what);
    return text;
  }
  std::string one_action(const Assign& assign) const {
    return model_.states[assign.state].column + " := " + expression(assign.value);
  }
  std::string one_action(const If& choice) const {
    std::string text = "if " + expression(choice.condition) + " { " + actions(choice.then) + " }";
    if (!choice.otherwise.empty()) text += " else { " + actions(choice.otherwise) + " }";
    return text;
  }
  std::string one_action(const Go& go) const { return "go " + model_.modes[go.mode].name; }
  std::string one_action(const Mark& mark) const { return "mark \"" + mark.text + "\""; }
  std::string one_action(const Stop& stop) const {
    std::string text = stop.text.empty() ? "stop" : "stop \"" + stop.text + "\"";
    return stop.after > 1 ? text + fmt::format(" after {}", stop.after) : text;
  }

  void events() {
    section("Events", model_.event_order, [&](const EventOrder& order) -> Row {
      if (order.scheduled) {
        const Scheduled& event = model_.schedule[order.index];
        return {event.name, "{ " + actions(event.actions) + " }"};
      }
      const When& event = model_.events[order.index];
      const std::string then = event.has_limit ? " then { " + actions(event.limit_actions) + " }" : "";
      return {"when " + event.name, "{ " + actions(event.actions) + " }" + then};
    });
  }

  void experiment() {
    const RunSettings& run = model_.run;
    if (!run.from || !run.to) return;
    const std::string unit = model_.time_unit.empty() ? "" : " " + model_.time_unit;
    std::string text = fmt::format("  t = {:g}..{:g}{}", run.from->value, run.to->value, unit);
    if (run.output && run.output->interval)
      text += fmt::format(", output every {:g}{}", run.output->interval->value, unit);
    if (!run.output || run.output->kind == OutputPlan::Kind::steps) text += ", output at every step";
    if (run.output && run.output->first) {
      text +=
          fmt::format(", {} outputs per decade from {:g}{}", run.output->per_decade, run.output->first->value, unit);
    }
    if (run.method) text += ", method " + *run.method;
    if (run.step) text += fmt::format(", step {:g}{}", run.step->value, unit);
    if (run.rtol) text += fmt::format(", tol {:g}", *run.rtol);
    if (!run.atol.empty()) text += fmt::format(", abs {:g}", fmt::join(run.atol, ", "));
    if (run.max_step) text += fmt::format(", max step {:g}{}", run.max_step->value, unit);
    if (run.max_steps) text += fmt::format(", max steps {}", *run.max_steps);
    if (run.realtime) text += ", in real time";
    line("\nRun\n{}", text);
    if (!model_.checks.empty()) {
      line("  {} {} the result", model_.checks.size(), model_.checks.size() == 1 ? "check judges" : "checks judge");
    }
  }

  void sweep() {
    if (!model_.sweep) return;
    const SweepPlan& plan = *model_.sweep;
    section(fmt::format("Sweep ({} runs)", plan.runs), plan.axes, [&](const SweepAxis& axis) -> Row {
      if (const auto* drawn = std::get_if<SweepDistribution>(&axis.values))
        return {axis.column(), in_brackets(axis.unit),
                fmt::format("{}({:g})", to_string(drawn->kind), fmt::join(drawn->numbers, ", "))};
      const std::vector<double>& values = std::get<SweepPoints>(axis.values).values;
      return {axis.column(), in_brackets(axis.unit),
              values.size() == 1 ? fmt::format("{:g}", values.front())
                                 : fmt::format("{} values from {:g} to {:g}", values.size(), std::ranges::min(values),
                                               std::ranges::max(values))};
    });
  }

  void remarks() {
    std::vector<std::string> remarks;
    if (model_.needs_boundary_solver()) remarks.emplace_back("conditions at several times: a boundary-value problem");
    if (model_.needs_dae_solver()) remarks.emplace_back("algebraic equations: a DAE of index 1");
    if (model_.all_paired && !model_.accelerations_depend_on_velocities) {
      remarks.emplace_back("x'' = a(t, x): velocity_verlet and central_difference fit, too");
    }
    if (!model_.has_units) remarks.emplace_back("no units");
    if (remarks.empty()) return;
    line("\nRemarks");
    for (const std::string& remark : remarks) line("  {}", remark);
  }

  const Model& model_;
  const DescribeOptions& options_;
  std::string text_;
};

}  // namespace

std::string describe(const Model& model, const DescribeOptions& options) {
  return Writer(model, options).text();
}

}  // namespace continuo::model
