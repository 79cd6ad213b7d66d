// Writes the C file of a model: its sizes, names and values, and a function for each of its tapes.
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <continuo/simulation/c_export.hpp>
#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/symbolic/graph/derivative.hpp>
#include <continuo/symbolic/native/c_lists.hpp>
#include <continuo/symbolic/native/c_source.hpp>

namespace continuo::model {

namespace {

// Of a grid of a million points no name would be read, and numbers are computed by loops.
constexpr std::size_t most_names = 1000, most_numbers = 10'000;

std::string identifier(std::string_view name) {
  std::string text;
  for (const char c : name) text += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (text.empty() || std::isdigit(static_cast<unsigned char>(text.front())) != 0) text.insert(0, "model_");
  return text;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// Within a comment of C.
std::string commented(std::string_view text) {
  std::string safe(text);
  for (std::size_t at = 0; (at = safe.find("*/", at)) != std::string::npos;) safe.replace(at, 2, "* /");
  for (std::size_t at = 0; (at = safe.find("/*", at)) != std::string::npos;) safe.replace(at, 2, "/ *");
  return safe;
}

std::string literal(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

class CText {
 public:
  explicit CText(const ModelProgram& program)
      : program_(program), model_(program.model), name_(identifier(model_.name)), NAME_(upper(name_)) {
    const Layout& layout = model_.layout;
    arrays_ = {{"x", layout.states, layout.states + static_cast<std::uint32_t>(model_.states.size())},
               {"p", layout.parameters, layout.inputs},
               {"u", layout.inputs, layout.samples}};
  }

  std::string text() {
    write_start();
    write_modes();
    write_jacobians();
    write_outputs();
    const std::string helpers = c_helpers(functions_, program_.tables);
    return heading() + "#include <math.h>\n\n" + sizes() + names() + values() + helpers + functions_;
  }

 private:
  /// Everything is computed from the arguments: nothing is prepared.
  Tape tape_of(const Graph& graph, std::span<const NodeId> nodes) const {
    TapeVariables variables = program_.tape_variables();
    variables.steady_begin = variables.steady_end = 0;
    Graph own = graph;
    std::vector<NodeId> replaced;
    for (const NodeId node : nodes) replaced.push_back(program_.with_inputs(own, node));
    return Tape(own, replaced, variables, program_.tables);
  }

  void write_function(const Graph& graph, std::span<const NodeId> nodes, const std::string& what,
                      const std::function<std::string(std::size_t)>& comment) {
    if (nodes.empty()) return;
    const Tape tape = tape_of(graph, nodes);
    const std::string signature = fmt::format(
        "void {}_{}(double t, const double *restrict x, const double *restrict p, const double *restrict u,\n"
        "    double *restrict r, double *restrict y)",
        name_, what);
    const bool few = nodes.size() <= most_names;
    const CFunction function = c_function(tape, {.signature = signature,
                                                 .arrays = arrays_,
                                                 .time = "t",
                                                 .prepared = false,
                                                 .output_comment = few ? comment : nullptr});
    functions_ += "\n" + function.text;
    work_ = std::max(work_, function.registers);
  }

  std::string of_mode(std::size_t mode) const {
    return model_.modes.size() > 1 ? "_" + identifier(model_.modes[mode].name) : "";
  }

  void write_modes() {
    for (std::size_t mode = 0; mode < model_.modes.size(); ++mode) {
      write_function(model_.graph, model_.modes[mode].derivatives, "rates" + of_mode(mode), [&](std::size_t k) {
        return model_.states[k].algebraic ? "0 = ..." : commented(fmt::format("({})'", model_.states[k].column));
      });
      std::vector<NodeId> guards;
      std::vector<std::string> events;
      for (const When& event : model_.events) {
        if (event.mode.value_or(mode) != mode) continue;
        guards.push_back(event.guard);
        events.push_back(commented(event.name));
      }
      write_function(model_.graph, guards, "guards" + of_mode(mode), [&](std::size_t k) { return events[k]; });
    }
  }

  void write_jacobians() {
    std::vector<std::uint32_t> columns(model_.states.size());
    std::iota(columns.begin(), columns.end(), model_.layout.states);
    for (std::size_t mode = 0; mode < model_.modes.size(); ++mode) {
      Graph graph = model_.graph;
      const std::vector<JacobianEntry> entries = jacobian(graph, model_.modes[mode].derivatives, columns);
      std::vector<NodeId> nodes;
      std::vector<std::uint32_t> rows, places;
      for (const JacobianEntry& entry : entries) {
        nodes.push_back(entry.value);
        rows.push_back(entry.row);
        places.push_back(entry.column);
      }
      if (nodes.empty()) continue;
      write_pattern(of_mode(mode), rows, places);
      write_function(graph, nodes, "jacobian" + of_mode(mode), [&](std::size_t k) {
        return commented(fmt::format("d ({})' / d {}", model_.states[rows[k]].column, model_.states[places[k]].column));
      });
    }
  }

  void write_pattern(const std::string& mode, const std::vector<std::uint32_t>& rows,
                     const std::vector<std::uint32_t>& columns) {
    functions_ += fmt::format(
        "\n/* Where {0}_jacobian{1} has its entries; all others are zero. */\n#define {2}_JACOBIAN{3} {4}\n", name_,
        mode, NAME_, upper(mode), rows.size());
    const CList lists[] = {{"rows", rows}, {"columns", columns}};
    const auto loops = rows.size() > most_numbers ? c_loops(lists) : std::nullopt;
    if (loops) {
      functions_ += fmt::format("void {}_jacobian{}_places(int *restrict rows, int *restrict columns) {{\n{}}}\n",
                                name_, mode, *loops);
    } else {
      functions_ += array("int", fmt::format("jacobian{}_rows", mode), rows);
      functions_ += array("int", fmt::format("jacobian{}_columns", mode), columns);
    }
  }

  /// Of a grid a function: its numbers are many, and follow a few rules.
  void write_start() {
    if (!has_start_function()) return;
    std::vector<NodeId> nodes;
    for (const State& state : model_.states) nodes.push_back(state.initial);
    write_function(model_.graph, nodes, "start", nullptr);
  }
  bool has_start_function() const {
    if (model_.states.size() <= most_numbers) return false;
    std::vector<NodeId> nodes;
    for (const State& state : model_.states) nodes.push_back(state.initial);
    if (!std::ranges::all_of(nodes, &NodeId::valid)) return false;
    return std::ranges::all_of(variables_of(model_.graph, nodes), [&](std::uint32_t variable) {
      return variable == Layout::time || (variable >= model_.layout.parameters && variable < model_.layout.samples);
    });
  }

  /// What the model calls an output, then what it names by `let`.
  std::vector<Quantity> outputs() const {
    std::vector<Quantity> all = model_.outputs;
    for (const Quantity& let : model_.lets)
      if (std::ranges::none_of(all, [&](const Quantity& other) { return other.name == let.name; })) all.push_back(let);
    return all;
  }

  void write_outputs() {
    const std::vector<Quantity> quantities = outputs();
    std::vector<NodeId> nodes;
    for (const Quantity& quantity : quantities) nodes.push_back(quantity.node);
    output_count_ = nodes.size();
    write_function(model_.graph, nodes, "outputs", [&](std::size_t k) {
      return commented(quantities[k].unit.empty() ? quantities[k].name
                                                  : fmt::format("{} [{}]", quantities[k].name, quantities[k].unit));
    });
  }

  template <class Number>
  std::string array(std::string_view type, std::string_view what, const std::vector<Number>& numbers) const {
    if (numbers.empty()) return "";
    return fmt::format("const {} {}_{}[{}] = {{{}}};\n", type, name_, what, numbers.size(), fmt::join(numbers, ", "));
  }
  std::string array_of_names(std::string_view what, const std::vector<std::string>& names) const {
    if (names.empty() || names.size() > most_names) return "";
    std::vector<std::string> quoted;
    for (const std::string& name : names) quoted.push_back(literal(name));
    return fmt::format("const char *const {}_{}_names[{}] = {{{}}};\n", name_, what, names.size(),
                       fmt::join(quoted, ", "));
  }

  std::string sizes() const {
    std::string text;
    const auto define = [&](std::string_view what, std::size_t value) {
      text += fmt::format("#define {}_{} {}\n", NAME_, what, value);
    };
    define("STATES", model_.states.size());
    define("PARAMETERS", model_.parameters.size());
    define("INPUTS", model_.inputs.size());
    define("OUTPUTS", output_count_);
    define("WORK", work_);
    return text + "\n";
  }

  std::string names() const {
    std::vector<std::string> states, parameters, inputs;
    for (const State& state : model_.states) states.push_back(state.column);
    for (const Parameter& parameter : model_.parameters) parameters.push_back(parameter.name);
    for (const Input& input : model_.inputs) inputs.push_back(input.name);
    return array_of_names("state", states) + array_of_names("parameter", parameters) + array_of_names("input", inputs);
  }

  /// The numbers of the text: where the run begins, its parameters and inputs.
  std::string values() const {
    const std::vector<double> all = start_values(model_);
    const auto part = [&](std::uint32_t begin, std::size_t count) {
      return std::vector<double>(all.begin() + begin, all.begin() + begin + static_cast<std::ptrdiff_t>(count));
    };
    const std::string start =
        has_start_function() ? "" : array("double", "start", part(model_.layout.states, model_.states.size()));
    std::string text = start + array("double", "parameters", part(model_.layout.parameters, model_.parameters.size())) +
                       array("double", "inputs", part(model_.layout.inputs, model_.inputs.size()));
    return text;
  }

  std::string heading() const {
    std::string text = fmt::format("/* {} as C, written by Continuo.\n", commented(model_.name));
    text += " *\n * Compile with -ffp-contract=off for the same bits as the simulation.\n *\n";
    text += fmt::format(
        " *   double r[{0}_WORK], dxdt[{0}_STATES];                     r: one for each thread\n"
        " *   {1}_rates{2}(t, x, p, u, r, dxdt);\n"
        " *\n"
        " * t is the time{3}, x the states, p the parameters, u the inputs, in the order of the names below;{4}\n"
        " * {1}_parameters and {1}_inputs are their values in the model. An array that has no elements may be null.\n",
        NAME_, name_, of_mode(model_.start_mode),
        model_.time_unit.empty() ? "" : fmt::format(" in {}", commented(model_.time_unit)),
        has_start_function() ? "" : fmt::format(" {}_start,", name_));
    if (has_start_function())
      text += fmt::format(
          " * {0}_start(t, 0, p, u, r, x) computes the states at the start; there are too many to list.\n", name_);
    if (model_.modes.size() > 1) {
      text += " * In each mode the model has other equations, and functions of its own:";
      for (const Mode& mode : model_.modes) text += " " + commented(mode.name);
      text += ".\n";
    }
    if (model_.needs_dae_solver())
      text += " * States whose line says `0 = ...` have no derivative: their value solves that equation.\n";
    if (!model_.events.empty())
      text += fmt::format(" * {}_guards: an event is where its guard passes zero; what it does stands in the model.\n",
                          name_);
    return text + " */\n";
  }

  const ModelProgram& program_;
  const Model& model_;
  std::string name_, NAME_;
  std::vector<CArray> arrays_;
  std::size_t work_ = 1, output_count_ = 0;
  std::string functions_;
};

}  // namespace

Result<std::string> c_text(const ModelProgram& program) {
  if (program.model.has_world()) {
    return invalid_input(
        "a world of bodies moves by collisions and contacts, not by equations alone, which is all that C "
        "functions could say; `continuo run` simulates it");
  }
  return CText(program).text();
}

}  // namespace continuo::model
