// continuo/simulation/drive/command_line_values.cpp
// Parameters and tolerances given by name on the command line. The value is read by the language itself, so everything
// that may stand behind `param k =` may stand here.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/solve/catalogue.hpp>
#include <continuo/symbolic/names/suggest.hpp>
#include <continuo/symbolic/units/units.hpp>

namespace continuo::model {

namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
  return begin == std::string_view::npos ? std::string_view() : text.substr(begin, end - begin + 1);
}

/// The value and unit of `param value = TEXT` in a model of its own.
std::optional<Parameter> read_value(std::string_view text, std::string& problem) {
  if (text.empty() || text.find_first_of("\n;#,") != std::string_view::npos) {
    problem = "one value is expected";
    return std::nullopt;
  }
  // The state is there because a model without one is none.
  Loaded loaded = load(Source("--set", fmt::format("param value = {}\nx' = 0\nx(0) = 0\n", text)));
  if (loaded.model && !loaded.model->parameters.empty()) return loaded.model->parameters.front();
  problem = "it cannot be read";
  for (const Diagnostic& diagnostic : loaded.diagnostics) {
    if (diagnostic.severity != Severity::error) continue;
    problem = diagnostic.message;
    break;
  }
  return std::nullopt;
}

std::optional<double> in_unit(const std::string& unit, const Parameter& given, std::string& problem) {
  if (given.unit.empty() || given.unit == unit) return given.value;
  const Result<Unit> from = parse_unit(given.unit), to = parse_unit(unit.empty() ? "1" : unit);
  const auto factor = from && to ? conversion_factor(*from, *to) : std::nullopt;
  if (factor) return given.value * *factor;
  problem = fmt::format("[{}] is no [{}]", given.unit, unit.empty() ? "1" : unit);
  return std::nullopt;
}

/// The place of a part within the whole setting.
Span place(std::string_view whole, std::string_view part) {
  const auto begin = static_cast<std::uint32_t>(part.data() - whole.data());
  return {begin, begin + static_cast<std::uint32_t>(part.size())};
}

/// The name that may have been meant, else all of them if they are few.
std::string known_names(std::span<const std::string> names, std::string_view name, std::string_view what) {
  std::string help = did_you_mean(name, names);
  if (!help.empty() || names.size() > 20) return help;
  return names.empty() ? "it has none" : fmt::format("its {} are {}", what, fmt::join(names, ", "));
}

}  // namespace

Diagnostic no_parameter(const Model& model, std::string_view name, Span span) {
  std::vector<std::string> names;
  for (const Parameter& parameter : model.parameters) names.push_back(parameter.name);
  return error("E340", span, fmt::format("the model has no parameter `{}`", name), {},
               known_names(names, name, "parameters"));
}

Diagnostic no_method(std::string_view name, Span span) {
  std::vector<std::string_view> names;
  for (const MethodInfo& info : method_catalogue()) names.push_back(info.name);
  const std::string near = did_you_mean(name, names);
  return error("E330", span, fmt::format("there is no method `{}`", name), {},
               near.empty() ? "`continuo methods` lists them" : near);
}

Diagnostic no_state(const Model& model, std::string_view name, Span span) {
  std::vector<std::string> names;
  for (const State& state : model.states) names.push_back(state.column);
  return error("E344", span, fmt::format("the model has no state `{}`", name), {}, known_names(names, name, "states"));
}

std::optional<ParameterSetting> parse_setting(const Model& model, std::string_view text,
                                              std::vector<Diagnostic>& problems) {
  const std::size_t equals = text.find('=');
  const std::string_view name = trimmed(text.substr(0, equals));
  if (equals == std::string_view::npos || name.empty()) {
    problems.push_back(
        error("E341", place(text, text), fmt::format("`{}` sets nothing", text), {}, "write NAME=VALUE, such as k=5"));
    return std::nullopt;
  }
  const std::size_t index = find_parameter(model, name);
  if (index == npos) {
    problems.push_back(no_parameter(model, name, place(text, name)));
    return std::nullopt;
  }
  const Parameter& parameter = model.parameters[index];
  const std::string_view given_text = trimmed(text.substr(equals + 1));
  const Span span = given_text.empty() ? place(text, text) : place(text, given_text);
  std::string problem;
  const auto given = read_value(given_text, problem);
  const auto value = given ? in_unit(parameter.unit, *given, problem) : std::nullopt;
  if (!value) {
    problems.push_back(error("E341", span, fmt::format("`{}` cannot be set to `{}`", name, given_text), problem));
    return std::nullopt;
  }
  if (parameter.range && (*value < parameter.range->low || *value > parameter.range->high)) {
    problems.push_back(warning("E342", span,
                               fmt::format("{} = {} is outside the range {}..{} that the model declares", name, *value,
                                           parameter.range->low, parameter.range->high)));
  }
  return ParameterSetting{std::string(name), *value};
}

std::optional<InitialSetting> parse_initial(const Model& model, std::string_view text,
                                            std::vector<Diagnostic>& problems) {
  const std::size_t equals = text.find('=');
  const std::string_view name = trimmed(text.substr(0, equals));
  if (equals == std::string_view::npos || name.empty()) {
    problems.push_back(
        error("E346", place(text, text), fmt::format("`{}` sets nothing", text), {}, "write NAME=VALUE, such as x=3"));
    return std::nullopt;
  }
  const std::vector<std::size_t> meant = states_named(model, name);
  if (meant.empty()) {
    problems.push_back(no_state(model, name, place(text, name)));
    return std::nullopt;
  }
  const std::string_view given_text = trimmed(text.substr(equals + 1));
  std::string problem;
  const auto given = read_value(given_text, problem);
  const auto value = given ? in_unit(model.states[meant.front()].unit, *given, problem) : std::nullopt;
  if (value) return InitialSetting{std::string(name), *value};
  problems.push_back(error("E346", given_text.empty() ? place(text, text) : place(text, given_text),
                           fmt::format("`{}` cannot begin at `{}`", name, given_text), problem));
  return std::nullopt;
}

std::optional<ToleranceSetting> parse_tolerance(const Model& model, ToleranceKind kind, std::string_view text,
                                                std::vector<Diagnostic>& problems) {
  const std::size_t equals = text.find('=');
  const std::string_view name = equals == std::string_view::npos ? std::string_view() : trimmed(text.substr(0, equals));
  const std::string_view given_text = trimmed(equals == std::string_view::npos ? text : text.substr(equals + 1));
  std::string unit;
  if (equals != std::string_view::npos) {
    const std::vector<std::size_t> meant = states_named(model, name);
    if (meant.empty()) {
      problems.push_back(no_state(model, name, name.empty() ? place(text, text) : place(text, name)));
      return std::nullopt;
    }
    if (kind == ToleranceKind::absolute) unit = model.states[meant.front()].unit;
  }
  std::string problem;
  const auto given = read_value(given_text, problem);
  const auto value = given ? in_unit(unit, *given, problem) : std::nullopt;
  const bool too_large = kind == ToleranceKind::relative && value && !(*value < 1);
  if (value && *value > 0 && !too_large) return ToleranceSetting{std::string(name), *value};
  if (value) problem = "a tolerance is greater than zero";
  if (too_large) problem = "a relative tolerance is a part of the state's size, less than 1";
  const Span span = given_text.empty() ? place(text, text) : place(text, given_text);
  problems.push_back(error("E345", span, fmt::format("`{}` is no tolerance", given_text), {}, problem));
  return std::nullopt;
}

}  // namespace continuo::model
