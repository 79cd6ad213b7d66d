// Periods, multipliers and extents of orbits as text, and the exit code of a failed search.
#include <cmath>
#include <numbers>

#include <apps/continuo/studies/orbit_text.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <continuo/results/csv_writer.hpp>
#include <continuo/results/summary.hpp>

namespace continuo::app {

std::string with_time_unit(double t, const model::Model& model) {
  const std::string number = fmt::format("{:.10g}", t);
  return model.time_unit.empty() ? number : number + " " + model.time_unit;
}

namespace {

std::string complex_text(const std::complex<double>& value) {
  if (std::abs(value.imag()) <= 1e-12 * std::abs(value)) return results::short_number(value.real());
  return fmt::format("{} {} {} i", results::short_number(value.real()), value.imag() < 0 ? "-" : "+",
                     results::short_number(std::abs(value.imag())));
}

}  // namespace

std::string multipliers_text(const std::vector<std::complex<double>>& multipliers) {
  std::string text = "multipliers";
  for (std::size_t i = 0; i < multipliers.size(); ++i) text += (i == 0 ? " " : ", ") + complex_text(multipliers[i]);
  return text + "\n";
}

std::string advance_text(const model::Model& model, const std::vector<double>& advance) {
  std::vector<std::string> angles;
  for (std::size_t i = 0; i < advance.size(); ++i) {
    if (advance[i] == 0) continue;
    const auto turns = std::lround(advance[i] / (2 * std::numbers::pi));
    angles.push_back(
        fmt::format("{} advances by {} turn{}", model.states[i].column, turns, std::abs(turns) == 1 ? "" : "s"));
  }
  return angles.empty() ? "" : fmt::format(" in which {}", fmt::join(angles, " and "));
}
std::string extents_text(const model::Model& model, const std::vector<double>& low, const std::vector<double>& high) {
  std::string text;
  for (std::size_t i = 0; i < model.states.size(); ++i) {
    // What rounding leaves of a zero.
    const double nothing = 1e-13 * (high[i] - low[i]);
    const auto number = [&](double value) { return results::short_number(std::abs(value) <= nothing ? 0 : value); };
    text += fmt::format("  {} from {} to {}\n", model.states[i].column, number(low[i]), number(high[i]));
  }
  return text;
}

std::string orbit_columns(const model::Model& model, std::size_t multipliers) {
  std::string csv;
  for (const model::State& state : model.states)
    for (const char* end : {" min", " max"}) {
      csv += ',';
      results::append_field(csv, state.column + end);
    }
  for (std::size_t k = 1; k <= multipliers; ++k) csv += fmt::format(",multiplier {0} re,multiplier {0} im", k);
  return csv + "\n";
}

ExitCode failed_exit(const Outcome<double>& outcome) {
  if (outcome.ending == Ending::interrupted) return interrupted;
  say(outcome.hint.empty() ? describe(outcome) : outcome.hint);
  return numerical_failure;
}

}  // namespace continuo::app
