// Finds what is varied among parameters, inputs and initial values, and reads its values in its unit.
#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include <fmt/format.h>

#include <continuo/language/check/declarations/files.hpp>
#include <continuo/language/check/views/sweep_axes.hpp>

namespace continuo::model::detail {

namespace {

constexpr std::size_t most_values = 1'000'000;  // of one axis

struct DistributionRule {
  std::string_view name;
  SweepDistribution::Kind kind;
  std::size_t numbers;
  std::string_view written;
};
constexpr std::array<DistributionRule, 4> distributions = {{
    {"uniform", SweepDistribution::Kind::uniform, 2, "uniform(low, high)"},
    {"normal", SweepDistribution::Kind::normal, 2, "normal(mean, deviation)"},
    {"lognormal", SweepDistribution::Kind::lognormal, 2, "lognormal(median, deviation of the logarithm)"},
    {"triangular", SweepDistribution::Kind::triangular, 3, "triangular(low, mode, high)"},
}};

/// The variable that the expression is; nothing where it is anything else.
std::optional<std::uint32_t> variable_of(Graph& graph, NodeId node) {
  const std::vector<std::uint32_t> read = variables_of(graph, node);
  return read.size() == 1 && graph.variable(read.front()) == node ? std::optional(read.front()) : std::nullopt;
}

/// Of both ends, by the unit behind the last one.
std::optional<double> factor_of(const ast::Unit& text, const Measured& wanted, Report& report) {
  const auto unit = unit_of(text, report);
  if (!unit) return std::nullopt;
  const auto factor = factor_between(Measured::known(*unit), wanted);
  if (!factor)
    report.fail("E201", text.span, "units do not match",
                fmt::format("what is varied is {}, its values are {}", unit_text(wanted), to_text(*unit)));
  return factor;
}

}  // namespace

std::optional<Measured> SweepAxes::cannot_be_varied(Span span, std::string help) {
  report_.fail("E283", span, fmt::format("{} cannot be varied", report_.quote(span)), {}, std::move(help));
  return std::nullopt;
}

std::optional<double> SweepAxes::number(const ast::Expression& text, const Measured& wanted, std::string_view what) {
  Scope scope;
  const auto found = expressions_.values.setting(text, scope, wanted, what);
  return found ? std::optional(found->value) : std::nullopt;
}

/// Bodies begin where they are put; measures of the world and its joints follow from them.
bool SweepAxes::is_state_with_start(std::size_t state, Span span) {
  const State& found = model_.states[state];
  if (model_.needs_boundary_solver()) {
    (void)cannot_be_varied(span, "the model has conditions at several times: vary a parameter that they read");
    return false;
  }
  const bool is_measure = expressions_.workspace.declared.base_of_state(state).is_measure;
  if (!found.algebraic && !is_measure) return true;
  (void)cannot_be_varied(span, "it follows from other quantities");
  return false;
}

/// `x(0)`, `ball.x'(0)`: at the start of the run.
std::optional<Measured> SweepAxes::subject_at_start(const ast::Call& call, Span span, SweepAxis& axis) {
  Scope scope;
  const std::size_t before = report_.errors();
  const Value state = expressions_.lookup.lookup(call.callee, scope);
  if (state.bad || report_.errors() > before) return std::nullopt;
  const auto variable = variable_of(expressions_.workspace.graph, state.node);
  const std::uint32_t first = model_.layout.states;
  if (!variable || *variable < first || *variable - first >= model_.states.size())
    return cannot_be_varied(span, "x(0) is varied where x is a state; a parameter is varied by its name alone");
  const std::size_t i = *variable - first;
  if (call.arguments.size() != 1) return cannot_be_varied(span, "an initial value has one time, as in x(0)");
  const auto time = expressions_.values.time_setting(call.arguments.front(), scope, "the time of an initial value");
  if (!time) return std::nullopt;
  const double start = model_.run.from ? model_.run.from->value : 0;
  if (time->value != start)
    return cannot_be_varied(span, fmt::format("states begin at the start of the run, which is {:g}", start));
  if (!is_state_with_start(i, span)) return std::nullopt;
  axis.kind = SweepAxis::Kind::initial;
  axis.name = model_.states[i].column;
  axis.unit = model_.states[i].unit;
  return state.measured;
}

std::optional<Measured> SweepAxes::find_subject(const ast::Expression& subject, SweepAxis& axis) {
  if (const auto* call = std::get_if<ast::Call>(&subject.node)) return subject_at_start(*call, subject.span, axis);
  const auto* name = std::get_if<ast::Name>(&subject.node);
  if (!name) return cannot_be_varied(subject.span, "a parameter, an input or an initial value x(0) can");
  Scope scope;
  const std::size_t before = report_.errors();
  const Value found = expressions_.lookup.lookup(*name, scope);
  if (found.bad || report_.errors() > before) return std::nullopt;
  const auto variable = variable_of(expressions_.workspace.graph, found.node);
  const Layout& layout = model_.layout;
  if (variable && *variable >= layout.parameters && *variable - layout.parameters < model_.parameters.size()) {
    const Parameter& parameter = model_.parameters[*variable - layout.parameters];
    axis.kind = SweepAxis::Kind::parameter;
    axis.name = parameter.name;
    axis.unit = parameter.unit;
    return found.measured;
  }
  if (variable && *variable >= layout.inputs && *variable - layout.inputs < model_.inputs.size()) {
    const Input& input = model_.inputs[*variable - layout.inputs];
    if (input.points)
      return cannot_be_varied(subject.span, "this input follows its file: multiply it by a parameter, and vary that");
    axis.kind = SweepAxis::Kind::input;
    axis.name = input.name;
    axis.unit = input.unit;
    return found.measured;
  }
  const bool is_state = variable && *variable >= layout.states && *variable - layout.states < model_.states.size();
  const std::string_view written = report_.slice(subject.span);
  return cannot_be_varied(subject.span, is_state ? fmt::format("where it begins can: write {}(0)", written)
                                                 : "a parameter, an input or an initial value x(0) can");
}

std::optional<SweepPoints> SweepAxes::grid(const ast::SweepGrid& text, const Measured& wanted) {
  double factor = 1;
  Measured ends = wanted;
  if (text.range.unit) {
    const auto found = factor_of(*text.range.unit, wanted, report_);
    if (!found) return std::nullopt;
    factor = *found;
    ends = Measured::unknown();
  }
  const auto first = number(*text.range.first, ends, "the first value"),
             last = number(*text.range.last, ends, "the last value"),
             count = number(text.count, Measured::known(Unit()), "the number of values");
  if (!first || !last || !count) return std::nullopt;
  const double from = *first * factor, to = *last * factor;
  if (!(*count >= 1 && *count <= static_cast<double>(most_values)) || *count != std::floor(*count)) {
    report_.fail("E284", text.count.span, fmt::format("a grid has 1 to {} values", most_values),
                 fmt::format("this is {:g}", *count));
    return std::nullopt;
  }
  if (*count > 1 && from == to) {
    report_.fail("E284", text.range.span, "the grid is empty", fmt::format("it goes from {:g} to {:g}", from, to),
                 "write another last value, or a list: in (1, 2, 5)");
    return std::nullopt;
  }
  if (text.is_logarithmic && !(from > 0 && to > 0) && !(from < 0 && to < 0)) {
    report_.fail("E284", text.range.span, "equal ratios do not lead through 0",
                 fmt::format("it goes from {:g} to {:g}", from, to), "leave out `log`, or begin elsewhere");
    return std::nullopt;
  }
  SweepPoints points;
  const auto n = static_cast<std::size_t>(*count);
  for (std::size_t i = 0; i < n; ++i) {
    const double part = n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) : 0;
    points.values.push_back(text.is_logarithmic ? from * std::pow(to / from, part) : from + (to - from) * part);
  }
  if (n > 1) points.values.back() = to;
  return points;
}

std::optional<SweepPoints> SweepAxes::list(const ast::SweepList& text, const Measured& wanted) {
  SweepPoints points;
  const auto add = [&](const ast::Expression& value) {
    const auto read = number(value, wanted, "a value");
    if (read) points.values.push_back(*read);
    return read.has_value();
  };
  const auto* values = std::get_if<ast::List>(&text.values.node);
  if (!values) return add(text.values) ? std::optional(std::move(points)) : std::nullopt;
  for (const ast::Expression& value : values->items)
    if (!add(value)) return std::nullopt;
  return points;
}

std::optional<SweepPoints> SweepAxes::file(const ast::SweepFile& text, const SweepAxis& axis, const Measured& wanted) {
  auto column = column_of(text.file, text.span, axis.column(), report_);
  if (!column) return std::nullopt;
  SweepPoints points{.values = std::move(column->values), .file = text.file};
  if (column->unit.empty()) return points;
  const auto factor = factor_of({column->unit, text.span}, wanted, report_);
  if (!factor) return std::nullopt;
  for (double& value : points.values) value *= *factor;
  return points;
}

bool SweepAxes::is_possible(const SweepDistribution& made, Span span) {
  const std::vector<double>& n = made.numbers;
  const auto fail = [&](std::string message, std::string help) {
    report_.fail("E284", span, std::move(message), {}, std::move(help));
    return false;
  };
  switch (made.kind) {
    case SweepDistribution::Kind::uniform:
      if (n[0] < n[1]) return true;
      return fail(fmt::format("{:g} is not below {:g}", n[0], n[1]), "write uniform(low, high)");
    case SweepDistribution::Kind::normal:
      if (n[1] > 0) return true;
      return fail(fmt::format("a deviation is above 0, not {:g}", n[1]), "write normal(mean, deviation)");
    case SweepDistribution::Kind::lognormal:
      if (!(n[0] > 0)) return fail(fmt::format("a median is above 0, not {:g}", n[0]), "write lognormal(5, 0.1)");
      if (n[1] > 0) return true;
      return fail(fmt::format("a deviation is above 0, not {:g}", n[1]), "write lognormal(5, 0.1)");
    case SweepDistribution::Kind::triangular:
      if (n[0] <= n[1] && n[1] <= n[2] && n[0] < n[2]) return true;
      return fail(fmt::format("{:g}, {:g}, {:g} do not ascend", n[0], n[1], n[2]), "write triangular(low, mode, high)");
  }
  return true;
}

std::optional<SweepDistribution> SweepAxes::distribution(const ast::SweepDistribution& text, const Measured& wanted) {
  const ast::Expression* called = &text.call;
  double factor = 1;
  Measured each = wanted;
  if (const auto* quantity = std::get_if<ast::Quantity>(&called->node)) {
    const auto found = factor_of(quantity->unit, wanted, report_);
    if (!found) return std::nullopt;
    factor = *found;
    each = Measured::unknown();
    called = &*quantity->value;
  }
  const auto* call = std::get_if<ast::Call>(&called->node);
  const auto rule = std::ranges::find_if(
      distributions, [&](const DistributionRule& one) { return call && one.name == call->callee.text; });
  if (rule == distributions.end()) {
    report_.fail("E284", text.call.span, "this is no distribution", {}, "write k normal(5, 0.5) [N/m]");
    return std::nullopt;
  }
  if (call->arguments.size() != rule->numbers) {
    report_.fail("E284", text.call.span, fmt::format("`{}` needs {} numbers", rule->name, rule->numbers), {},
                 fmt::format("write {}", rule->written));
    return std::nullopt;
  }
  SweepDistribution made{.kind = rule->kind, .numbers = {}};
  for (std::size_t i = 0; i < call->arguments.size(); ++i) {
    const bool is_ratio = rule->kind == SweepDistribution::Kind::lognormal && i == 1;
    const auto read =
        number(call->arguments[i], is_ratio ? Measured::known(Unit()) : each, "a number of a distribution");
    if (!read) return std::nullopt;
    made.numbers.push_back(is_ratio ? *read : *read * factor);
  }
  return is_possible(made, text.call.span) ? std::optional(std::move(made)) : std::nullopt;
}

std::optional<SweepAxis> SweepAxes::axis(const ast::SweepAxis& text, Span span) {
  SweepAxis made{};
  made.span = span;
  const auto measured = find_subject(text.subject, made);
  if (!measured) return std::nullopt;
  const auto take = [&made](auto values) {
    if (values) made.values = *std::move(values);
    return values.has_value();
  };
  const bool fine = std::visit(
      [&](const auto& values) {
        using T = std::decay_t<decltype(values)>;
        if constexpr (std::is_same_v<T, ast::SweepGrid>) {
          return take(grid(values, *measured));
        } else if constexpr (std::is_same_v<T, ast::SweepList>) {
          return take(list(values, *measured));
        } else if constexpr (std::is_same_v<T, ast::SweepFile>) {
          return take(file(values, made, *measured));
        } else {
          return take(distribution(values, *measured));
        }
      },
      text.values);
  return fine ? std::optional(std::move(made)) : std::nullopt;
}

}  // namespace continuo::model::detail
