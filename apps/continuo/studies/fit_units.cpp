// Converts measurements and their deviations to the units of the model.
#include <optional>

#include <apps/continuo/studies/fit_units.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/symbolic/units/units.hpp>

namespace continuo::app {
namespace {

/// By what a number of one unit is multiplied to be one of the other; 1 where one of them is not said.
std::optional<double> factor_between(const results::Measurements& data, const std::string& column,
                                     const std::string& from, const std::string& to) {
  if (from.empty() || to.empty()) return 1;
  const Result<model::Unit> parsed = model::parse_unit(from), wanted = model::parse_unit(to);
  if (!parsed || !wanted) {
    const std::string suggestion = model::suggested_unit(from);
    say(fmt::format("{}:1: column `{}`: {}{}", data.file, column,
                    first_failure(parsed.status(), wanted.status()).message,
                    suggestion.empty() ? "" : fmt::format("; did you mean `{}`?", suggestion)));
    return std::nullopt;
  }
  const auto result = model::conversion_factor(*parsed, *wanted);
  if (!result) say(fmt::format("{}:1: column `{}` is in {}, but the model has it in {}", data.file, column, from, to));
  return result;
}

bool convert(results::Measurements& measured, studies::FitColumn& column, const std::string& unit) {
  const std::string& own = measured.units[column.column];
  const auto of_values = factor_between(measured, measured.columns[column.column], own, unit);
  if (!of_values) return false;
  for (double& value : measured.values[column.column]) value *= *of_values;
  if (column.deviation && column.error != studies::ErrorModel::lognormal) *column.deviation *= *of_values;
  if (!column.deviations_in) return true;
  const std::size_t place = *column.deviations_in;
  const std::string& of_deviation = measured.units[place].empty() ? own : measured.units[place];
  const auto factor = factor_between(measured, measured.columns[place], of_deviation, unit);
  if (!factor) return false;
  for (double& value : measured.values[place]) value *= *factor;
  measured.units[place] = unit;  // where two columns share it, once is enough
  return true;
}

}  // namespace

std::string unit_of_quantity(const model::Model& model, const std::string& name) {
  const std::size_t state = model::find_state(model, name);
  if (state != model::npos) return model.states[state].unit;
  for (const auto* list : {&model.outputs, &model.lets, &model.energies})
    for (const model::Quantity& quantity : *list)
      if (quantity.name == name) return quantity.unit;
  return {};
}

bool to_units_of_model(studies::FitRequest& request) {
  const model::Model& model = request.program->model;
  for (studies::FitData& data : request.data) {
    results::Measurements& measured = data.measurements;
    const auto of_time = factor_between(measured, "t", measured.time_unit, model.time_unit);
    if (!of_time) return false;
    for (double& t : measured.times) t *= *of_time;
    for (studies::FitColumn& column : data.columns)
      if (!convert(measured, column, unit_of_quantity(model, column.quantity))) return false;
  }
  return true;
}

}  // namespace continuo::app
