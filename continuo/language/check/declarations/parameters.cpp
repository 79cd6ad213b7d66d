// continuo/language/check/declarations/parameters.cpp
// Values, ranges and comments of parameters and inputs.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <continuo/language/check/declarations/files.hpp>
#include <continuo/language/check/declarations/parameters.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r#");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1));
}

/// The comment at the end of the line on which the definition ends.
std::string comment_beside(const Source& source, Span span) {
  const int number = source.place(span.end).line;
  const std::string_view line = source.line(number);
  bool in_text = false;
  for (std::size_t i = span.end - source.line_start(number); i < line.size(); ++i) {
    if (line[i] == '"') in_text = !in_text;
    if (line[i] == '#' && !in_text) return trimmed(line.substr(i));
  }
  return {};
}

std::optional<Range> slider(Expressions& expressions, const Definition& definition, const Measured& measured,
                            double value) {
  if (!definition.text->range) return std::nullopt;
  const ast::Range& range = *definition.text->range;
  Scope scope = definition.scope;
  Measured wanted = measured;
  double factor = 1;
  if (range.unit) {
    const auto unit = unit_of(*range.unit, expressions.report);
    if (!unit) return std::nullopt;
    const auto converted = factor_between(Measured::known(*unit), wanted);
    if (!converted) {
      expressions.report.fail(
          "E201", range.unit->span, "units do not match",
          fmt::format("`{}` is {}, its range {}", definition.name, unit_text(wanted), to_text(*unit)));
      return std::nullopt;
    }
    factor = *converted;
    wanted = Measured::unknown();
  }
  const auto low = expressions.values.constant(*range.first, scope, wanted, "the end of a range");
  const auto high = expressions.values.constant(*range.last, scope, wanted, "the end of a range");
  if (!low || !high) return std::nullopt;
  const Range result{*low * factor, *high * factor};
  if (!(result.low < result.high)) {
    expressions.report.fail("E221", range.span, "the range is empty",
                            fmt::format("{:g} is not below {:g}", result.low, result.high));
  } else if (value < result.low || value > result.high) {
    expressions.report.warn("E290", range.span, fmt::format("`{}` lies outside its range", definition.name),
                            fmt::format("its value is {:g}", value));
  }
  return result;
}

}  // namespace

Parameters make_parameters(Expressions& expressions) {
  Workspace& workspace = expressions.workspace;
  const Declarations& declared = workspace.declared;
  Parameters made;
  for (const std::size_t i : declared.parameters)
    workspace.definitions.value(i, declared.definitions[i].text->name, {});
  for (const std::size_t i : workspace.definitions.evaluation_order()) {
    const Definition& definition = declared.definitions[i];
    const Value& written = workspace.definitions.written(i);
    made.order.push_back(definition.variable - workspace.layout.parameters);
    double& value = workspace.registers[definition.variable];
    value = evaluate(workspace.graph, written.node, workspace.registers);
    if (!written.bad && !std::isfinite(value)) {
      expressions.report.fail("E222", definition.value->span, "a parameter must be a finite number", not_finite(value));
    }
  }
  for (const std::size_t i : declared.parameters) {
    const Definition& d = declared.definitions[i];
    const Value written = workspace.definitions.written(i);
    const double value = workspace.registers[d.variable];
    made.all.push_back({d.name, d.variable, written.node, value, unit_or_nothing(written.measured),
                        slider(expressions, d, written.measured, value),
                        comment_beside(expressions.report.source(), d.text->span),
                        variables_of(workspace.graph, written.node).empty(), workspace.definitions.is_structural(i),
                        d.text->name.span});
  }
  return made;
}

void mark_structural(std::vector<Parameter>& parameters, Workspace& workspace) {
  for (const std::size_t i : workspace.declared.parameters) {
    const std::uint32_t place = workspace.declared.definitions[i].variable - workspace.layout.parameters;
    parameters[place].structural = workspace.definitions.is_structural(i);
  }
}

void check_overrides(const std::vector<Parameter>& parameters, Expressions& expressions) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) names.push_back(parameter.name);
  for (const auto& [name, value] : expressions.workspace.overrides) {
    if (std::ranges::find(names, name) != names.end()) continue;
    const std::string near = did_you_mean(name, names);
    const std::string all = names.empty() ? "the model has none" : "the parameters are " + listed(names);
    expressions.report.fail("E210", {}, fmt::format("there is no parameter `{}` to set", name), {},
                            near.empty() ? all : near);
  }
}

std::vector<Input> make_inputs(Expressions& expressions) {
  Workspace& workspace = expressions.workspace;
  std::vector<Input> made;
  for (std::size_t i = 0; i < workspace.declared.definitions.size(); ++i) {
    const Definition& d = workspace.declared.definitions[i];
    if (d.kind != Definition::Kind::input) continue;
    workspace.definitions.value(i, d.text->name, {});
    const Value written = workspace.definitions.written(i);
    double& value = workspace.registers[d.variable];
    value = evaluate(workspace.graph, written.node, workspace.registers);
    const auto between =
        d.input->interpolation == ast::Interpolation::step ? Table::Between::step : Table::Between::linear;
    const std::string file =
        d.input->file ? file_of(*d.input->file, d.input->file_span, expressions.report) : std::string();
    auto points =
        file.empty() ? std::nullopt : points_of(file, d.input->file_span, between, d.name, expressions.report);
    made.push_back({d.name, d.variable, value, unit_or_nothing(written.measured),
                    slider(expressions, d, written.measured, value), d.input->key.value_or(""), file, std::move(points),
                    comment_beside(expressions.report.source(), d.text->span), d.text->name.span});
  }
  return made;
}

}  // namespace continuo::model::detail
