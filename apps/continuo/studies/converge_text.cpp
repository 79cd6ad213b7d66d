// A study of convergence as a table with remarks, and as a figure.
#include <algorithm>
#include <cmath>

#include <apps/continuo/studies/converge_text.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/results/method_colors.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/runs/methods.hpp>
#include <continuo/solve/catalogue.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::app {
namespace {

using studies::Convergence;
using studies::ErrorCurve;
using studies::MethodConvergence;
using studies::StepErrors;

std::string order_text(const ErrorCurve& curve) {
  return curve.found ? fmt::format("{:.2f}", curve.order) : "-";
}

std::string error_text(double error) {
  return std::isnan(error) ? "-" : fmt::format("{:.1e}", error);
}

std::string best_text(const ErrorCurve& curve, bool by_tolerance = false) {
  if (!(curve.best_step > 0)) return "-";
  return fmt::format("{:.1e} at {:.1e}{}", curve.least_error, curve.best_step,
                     curve.floor_reached || by_tolerance ? "" : " *");
}

std::string predicted_text(const std::optional<studies::FloorPrediction>& floor) {
  if (!floor) return "-";
  return fmt::format("{:.0e} .. {:.0e} at {:.0e} .. {:.0e}", floor->at_random.error, floor->at_worst.error,
                     floor->at_random.step, floor->at_worst.step);
}

std::string points_text(const MethodConvergence& method, bool by_tolerance, bool in_float, bool in_long_double) {
  std::string text = fmt::format("\n{}\n{:>12} {:>10} {:>10} {:>10}", method.method,
                                 by_tolerance ? "tolerance" : "step", "global", "local", "energy");
  text += fmt::format("{} {:>12} {:>10}\n",
                      std::string(in_float ? "      float" : "") + (in_long_double ? "       long" : ""), "evaluations",
                      "time");
  for (const StepErrors& point : method.points) {
    text += fmt::format("{:>12.3e} {:>10} {:>10} {:>10}", point.step, error_text(point.global), error_text(point.local),
                        error_text(point.energy));
    if (in_float) text += fmt::format(" {:>10}", error_text(point.in_float));
    if (in_long_double) text += fmt::format(" {:>10}", error_text(point.in_long_double));
    text += fmt::format(" {:>12} {:>10}\n", point.evaluations, results::duration(point.seconds));
  }
  return text;
}

std::string heading(bool by_tolerance) {
  if (by_tolerance) return fmt::format("{:<24} {:>7} {:>7}  {}", "method", "slope", "energy", "least error at tol");
  return fmt::format("{:<24} {:>5} {:>7} {:>7} {:>7}  {:<20}  {:<34}", "method", "order", "global", "local", "energy",
                     "least error at h", "where rounding should balance it");
}

std::string row_of(const MethodConvergence& method, bool by_tolerance) {
  if (by_tolerance)
    return fmt::format("{:<24} {:>7} {:>7}  {}", method.method, order_text(method.global), order_text(method.energy),
                       best_text(method.global, by_tolerance));
  return fmt::format("{:<24} {:>5} {:>7} {:>7} {:>7}  {:<20}  {:<34}", method.method, method.nominal,
                     order_text(method.global), order_text(method.local), order_text(method.energy),
                     best_text(method.global), predicted_text(method.floor));
}

/// A line on methods that choose more than the size of a step: what was measured of them.
std::string what_keeps_its_order(const std::string& name) {
  const MethodInfo* info = find_method(name);
  if (info == nullptr) return "";
  if (info->automatic)
    return fmt::format("{}: measured is its explicit method, unless equations are stiff or algebraic\n", name);
  if (info->order == info->order_of_fixed_steps) return "";
  return fmt::format("{}: steps of a fixed size keep order {}; of those it chooses by tolerance (up to {}): --tol\n",
                     name, info->order_of_fixed_steps, info->order);
}

std::string often(std::size_t times) {
  return times == 1 ? "once" : fmt::format("{} times, first", times);
}

std::string spoiled_text(const studies::SpoiledOrder& spoiled, const model::Model& model) {
  std::string text = "less than its order is left of a method where steps lead across\n";
  for (const studies::Kink& kink : spoiled.kinks) {
    const model::State& state = model.states[kink.state];
    text += fmt::format("  a {} of the equation of `{}`, by `{}`: {} at t = {}\n", kink.jumps ? "jump" : "bend",
                        state.algebraic ? state.column : state.column + "'", kink.text, often(kink.times),
                        results::short_number(kink.first));
  }
  if (spoiled.events > 0)
    text += fmt::format("  an event, or begin anew at one: {} at t = {}\n", often(spoiled.events),
                        results::short_number(spoiled.first_event));
  return text;
}

}  // namespace

void end_line(std::string& text) {
  while (text.back() == ' ') text.pop_back();
  text += '\n';
}

bool known_methods(const std::vector<std::string>& names, const runs::Kind& kind) {
  const bool of_world = kind.solver == runs::Solver::world;
  const std::vector<std::string> known = runs::method_names(kind);
  for (const std::string& name : names) {
    if (std::ranges::find(known, name) != known.end() || (!of_world && find_method(name) != nullptr)) continue;
    const std::string near = model::did_you_mean(name, known);
    if (of_world) {
      say(fmt::format("bodies are not moved by `{}`, {}", name,
                      near.empty() ? fmt::format("but by {}", fmt::join(known, ", ")) : near));
    } else {
      say(fmt::format("there is no method `{}`{} `continuo methods` lists them", name,
                      near.empty() ? ";" : ", " + near));
    }
    return false;
  }
  return true;
}

std::string convergence_text(const Convergence& study, const model::Model& model, bool in_float, bool in_long_double,
                             bool all_points) {
  std::string text = heading(study.by_tolerance);
  text += in_float ? fmt::format("  {:<20}  there", "in float") : "";
  text += in_long_double ? "  long" : "";
  end_line(text);
  bool unreached = false;
  for (const MethodConvergence& method : study.methods) {
    if (!method.status) {
      text += fmt::format("{:<24} {}\n", method.method, method.status.message);
      continue;
    }
    unreached = unreached || (method.global.best_step > 0 && !method.global.floor_reached);
    text += row_of(method, study.by_tolerance);
    if (in_float)
      text += fmt::format("  {:<20}  {}", best_text(method.in_float), predicted_text(method.floor_in_float));
    if (in_long_double) text += "  " + order_text(method.in_long_double);
    end_line(text);
  }
  text += fmt::format("errors against {}, relative to each state's largest value\n", study.reference);
  if (study.by_tolerance) text += "slope 1: a tenth of the tolerance leaves a tenth of the error\n";
  if (unreached && !study.by_tolerance) text += "* smaller steps would still gain: --most-steps\n";
  for (const MethodConvergence& method : study.methods)
    if (method.status && !study.by_tolerance) text += what_keeps_its_order(method.method);
  if (study.spoiled) text += spoiled_text(*study.spoiled, model);
  if (all_points)
    for (const MethodConvergence& method : study.methods)
      if (method.status) text += points_text(method, study.by_tolerance, in_float, in_long_double);
  if (study.interrupted) text += "interrupted: what there was until then\n";
  return text;
}

results::Figure convergence_figure(const Convergence& study, const std::string& title) {
  const std::string x_label = study.by_tolerance ? "tolerance" : "step";
  std::vector<std::string> names;
  for (const MethodConvergence& method : study.methods) names.push_back(method.method);
  const std::vector<std::size_t> colors = results::colors_of_methods(names);
  const auto panel_of = [&](std::string label, double StepErrors::* error, std::string suffix = {}) {
    results::Panel panel{
        .x_label = x_label, .y_label = std::move(label), .curves = {}, .logarithmic_x = true, .logarithmic_y = true};
    for (std::size_t i = 0; i < study.methods.size(); ++i) {
      const MethodConvergence& method = study.methods[i];
      results::Curve curve{.label = method.method + suffix, .x = {}, .y = {}, .number = colors[i]};
      if (!suffix.empty()) curve.style = results::Curve::Style::dashed_line;
      bool some = false;
      for (const StepErrors& point : method.points) {
        const bool shown = point.*error > 0 && point.*error <= 10;  // beyond that it is no approximation
        curve.x.push_back(point.step);                              // for all panels the same
        curve.y.push_back(shown ? point.*error : std::nan(""));
        some = some || shown;
      }
      if (some) panel.curves.push_back(std::move(curve));
    }
    return panel;
  };
  results::Panel global = panel_of("error of the run", &StepErrors::global);
  for (results::Curve& curve : panel_of("", &StepErrors::in_float, ", float").curves) global.curves.push_back(curve);
  global.tall = true;
  results::Figure figure{.title = title, .panels = {std::move(global)}};
  if (auto local = panel_of("error of one step", &StepErrors::local); !local.curves.empty()) {
    local.tall = true;
    figure.panels.push_back(std::move(local));
  }
  if (auto energy = panel_of("error of the energy", &StepErrors::energy); !energy.curves.empty())
    figure.panels.push_back(std::move(energy));
  return figure;
}

}  // namespace continuo::app
