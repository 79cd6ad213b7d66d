// Difference schemes applied to an expression of x in several precisions.
#include <cmath>
#include <memory>
#include <utility>

#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/studies/converge_text.hpp>
#include <apps/continuo/studies/differences.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/symbolic/graph/derivative.hpp>

namespace continuo::app {
namespace {

/// An expression of the state x as a function of numbers of any length.
template <class Real>
std::function<Real(Real)> function_of(const model::ModelProgram& program, model::NodeId node) {
  const std::vector<model::NodeId> nodes{node};
  const auto tape = program.tape_of(nodes);
  std::vector<Real> registers(tape->register_count());
  tape->prepare<Real>(registers);
  return [tape, registers, place = program.model.layout.states](Real x) mutable {
    Real value{};
    registers[place] = x;
    tape->evaluate<Real>(registers, {&value, 1});
    return value;
  };
}

}  // namespace

std::optional<std::vector<studies::DifferenceErrors>> study_differences(const std::string& expression, double at) {
  // x as the state of a model, the function as its output: the language's own parser, checks and derivatives.
  const model::Loaded loaded = model::load(
      model::Source("--derivative", fmt::format("x' = 0\nx(0) = 0\noutput f = {}\nrun 0..1\n", expression)));
  if (!loaded) {
    show(loaded.diagnostics, loaded.source);
    return std::nullopt;
  }
  model::ModelProgram program(*loaded.model);
  const model::NodeId f = program.model.outputs.front().node;
  const auto x = program.model.layout.states;
  const model::NodeId first = model::differentiate(program.model.graph, f, x);
  const model::NodeId second = model::differentiate(program.model.graph, first, x);
  const double slope = function_of<double>(program, first)(at), bend = function_of<double>(program, second)(at);
  if (!std::isfinite(function_of<double>(program, f)(at)) || !std::isfinite(slope) || !std::isfinite(bend)) {
    say(fmt::format("{} has no derivatives at x = {}: one of them is not a number", expression, at));
    return std::nullopt;
  }
  return studies::converge_differences(function_of<double>(program, f), function_of<float>(program, f), at, slope,
                                       bend);
}

std::string differences_text(const std::vector<studies::DifferenceErrors>& study, bool in_float) {
  const auto measured = [](const studies::ErrorCurve& curve) {
    return fmt::format("{:.1e} at {:.1e}", curve.least_error, curve.best_step);
  };
  // Nothing balances where f = 0 is rounded by nothing.
  const auto predicted = [](const studies::Balance& balance) {
    if (!(balance.step > 0)) return std::string("-");
    return fmt::format("{:.1e} at {:.1e}", balance.error, balance.step);
  };
  std::string text = fmt::format("{:<14} {:>5} {:>8}  {:<20}  {:<18}", "difference", "order", "observed",
                                 "least error at h", "predicted");
  text += in_float ? fmt::format("  {:<20}  predicted", "in float") : "";
  end_line(text);
  for (const studies::DifferenceErrors& errors : study) {
    const auto& curve = errors.of_double;
    text += fmt::format("{:<14} {:>5} {:>8}  {:<20}  {:<18}", errors.scheme.name, errors.scheme.order,
                        curve.found ? fmt::format("{:.2f}", curve.order) : "-", measured(curve),
                        curve.found ? predicted(errors.predicted) : "-");
    if (in_float)
      text += fmt::format("  {:<20}  {}", measured(errors.of_float),
                          curve.found ? predicted(errors.predicted_in_float) : "-");
    end_line(text);
  }
  return text;
}

results::Figure differences_figure(const std::vector<studies::DifferenceErrors>& study, bool in_float,
                                   const std::string& title) {
  results::Panel panel{
      .x_label = "h", .y_label = "relative error", .curves = {}, .logarithmic_x = true, .logarithmic_y = true};
  panel.tall = true;
  const auto add = [&](const studies::DifferenceErrors& errors, const std::vector<double>& values, std::string label) {
    results::Curve curve{.label = std::move(label), .x = {}, .y = {}};
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!(values[i] > 0) || values[i] > 10) continue;  // beyond that it is no approximation
      curve.x.push_back(errors.steps[i]);
      curve.y.push_back(values[i]);
    }
    panel.curves.push_back(std::move(curve));
  };
  for (const auto& errors : study) add(errors, errors.in_double, std::string(errors.scheme.name));
  if (in_float)
    for (const auto& errors : study) add(errors, errors.in_float, std::string(errors.scheme.name) + ", float");
  return {.title = title, .panels = {std::move(panel)}};
}

}  // namespace continuo::app
