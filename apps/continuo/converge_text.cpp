#include <cmath>

#include <apps/continuo/converge_text.hpp>
#include <apps/continuo/terminal.hpp>
#include <fmt/format.h>

#include <continuo/model/suggest.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/solve/catalogue.hpp>

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

}  // namespace

void end_line(std::string& text) {
  while (text.back() == ' ') text.pop_back();
  text += '\n';
}

bool known_methods(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const MethodInfo& method : method_catalogue()) known.emplace_back(method.name);
  for (const std::string& name : names) {
    if (find_method(name) != nullptr) continue;
    const std::string near = model::did_you_mean(name, known);
    say(fmt::format("there is no method `{}`{} `continuo methods` lists them", name, near.empty() ? ";" : ", " + near));
    return false;
  }
  return true;
}

std::string convergence_text(const Convergence& study, bool in_float, bool in_long_double, bool all_points) {
  const std::string what = study.by_tolerance ? "tol" : "h";
  std::string text =
      fmt::format("{:<24} {:>5} {:>7} {:>7} {:>7}  {:<20}  {:<34}", "method", "order", "global", "local", "energy",
                  "least error at " + what, study.by_tolerance ? "" : "where rounding should balance it");
  text += in_float ? fmt::format("  {:<20}  there", "in float") : "";
  text += in_long_double ? "  long" : "";
  end_line(text);
  bool unreached = false;
  for (const MethodConvergence& method : study.methods) {
    if (!method.problem.empty()) {
      text += fmt::format("{:<24} {}\n", method.method, method.problem);
      continue;
    }
    unreached = unreached || (method.global.best_step > 0 && !method.global.floor_reached);
    text += fmt::format("{:<24} {:>5} {:>7} {:>7} {:>7}  {:<20}  {:<34}", method.method, method.nominal,
                        order_text(method.global), order_text(method.local), order_text(method.energy),
                        best_text(method.global, study.by_tolerance),
                        study.by_tolerance ? "" : predicted_text(method.floor));
    if (in_float)
      text += fmt::format("  {:<20}  {}", best_text(method.in_float), predicted_text(method.floor_in_float));
    if (in_long_double) text += "  " + order_text(method.in_long_double);
    end_line(text);
  }
  text += fmt::format("errors against {}, relative to each state's largest value\n", study.reference);
  if (unreached && !study.by_tolerance) text += "* smaller steps would still gain: --most-steps\n";
  if (all_points)
    for (const MethodConvergence& method : study.methods)
      if (method.problem.empty()) text += points_text(method, study.by_tolerance, in_float, in_long_double);
  if (study.interrupted) text += "interrupted: what there was until then\n";
  return text;
}

results::Figure convergence_figure(const Convergence& study, const std::string& title) {
  const std::string x_label = study.by_tolerance ? "tolerance" : "step";
  const auto panel_of = [&](std::string label, double StepErrors::* error, std::string suffix = {}) {
    results::Panel panel{
        .x_label = x_label, .y_label = std::move(label), .curves = {}, .logarithmic_x = true, .logarithmic_y = true};
    for (const MethodConvergence& method : study.methods) {
      results::Curve curve{.label = method.method + suffix, .x = {}, .y = {}};
      for (const StepErrors& point : method.points) {
        if (!(point.*error > 0) || point.*error > 10) continue;  // beyond that it is no approximation
        curve.x.push_back(point.step);
        curve.y.push_back(point.*error);
      }
      if (!curve.x.empty()) panel.curves.push_back(std::move(curve));
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
