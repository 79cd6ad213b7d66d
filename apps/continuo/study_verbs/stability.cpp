// continuo stability METHOD...: how far each method's steps may go, as numbers and as a picture; with a model the
// largest stable step, predicted from its eigenvalues and confirmed by runs next to it.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/studies/converge_text.hpp>
#include <apps/continuo/studies/studied_model.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/figure.hpp>
#include <continuo/results/method_colors.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/studies/stability.hpp>

namespace continuo::app {
namespace {

using studies::Complex;
using studies::StepLimit;

struct StabilityOptions {
  ExperimentOptions experiment;  // its file: --model
  std::vector<std::string> methods;
  std::string plot;
  bool json = false;
};

std::string limit_text(double limit) {
  if (std::isnan(limit)) return "-";
  return std::isinf(limit) ? "no end" : fmt::format("{:.4f}", limit);
}

struct Region {
  std::string method;
  studies::StabilityRegion region;
};

std::string regions_text(const std::vector<Region>& regions) {
  std::string text = fmt::format("{:<24} {:>14} {:>14}\n", "method", "real axis to", "imaginary to");
  for (const auto& [method, region] : regions) {
    const std::string real = limit_text(region.real_limit);
    const bool finite = std::isfinite(region.real_limit) && region.real_limit > 0;
    text +=
        fmt::format("{:<24} {:>14} {:>14}\n", method, finite ? "-" + real : real, limit_text(region.imaginary_limit));
  }
  return text;
}

/// The states of a run of the model, at most so many of them.
struct Samples {
  std::vector<double> times;
  std::vector<std::vector<double>> states;
};
Samples samples_of(const model::Motion& motion) {
  constexpr std::size_t most = 50;
  Samples samples;
  const std::size_t stride = motion.rows() / most + 1;
  for (std::size_t row = 0; row < motion.rows(); row += stride) {
    const auto state = motion.state(row);
    samples.times.push_back(motion.time(row));
    samples.states.emplace_back(state.begin(), state.end());
  }
  return samples;
}

struct Confirmed {
  std::string method;
  StepLimit limit;
  studies::Fate below = studies::Fate::no_run, above = studies::Fate::no_run;
};

Confirmed confirm(const std::string& method, const Studied& studied, const Samples& samples,
                  const studies::Spectrum& spectrum) {
  Confirmed confirmed{.method = method, .limit = studies::largest_stable_step(method, spectrum)};
  const StepLimit& limit = confirmed.limit;
  if (!std::isfinite(limit.step) || limit.step == 0) return confirmed;
  const model::Model& model = studied.prepared.program->model;
  const studies::Pairing pairing{model.pairs, !model.accelerations_depend_on_velocities};
  std::size_t at = 0;
  while (at + 1 < samples.times.size() && samples.times[at] != limit.time) ++at;
  const auto fate = [&](double part) {
    return studies::fate_of(method, studied.system, pairing, limit.time, samples.states[at], part * limit.step,
                            limit.beyond);
  };
  confirmed.below = fate(0.99);
  confirmed.above = fate(1.01);
  return confirmed;
}

std::string confirmed_text(const std::vector<Confirmed>& all, const std::string& unit) {
  std::string text = fmt::format("\n{:<24} {:>14}  {:<26} {:>10} {:>10}\n", "method", "largest step", "set by",
                                 "at 0.99 of", "at 1.01 of");
  for (const Confirmed& c : all) {
    const StepLimit& limit = c.limit;
    const bool has_limit = std::isfinite(limit.step) && limit.step > 0;
    const std::string step = std::isnan(limit.step)   ? "unknown"
                             : std::isinf(limit.step) ? "any"
                             : has_limit              ? fmt::format("{:.6g}{}", limit.step, unit)
                                                      : "none";
    text += fmt::format("{:<24} {:>14}  {:<26} {:>10} {:>10}\n", c.method, step,
                        std::isinf(limit.step) ? "" : eigenvalue_text(limit.eigenvalue.real(), limit.eigenvalue.imag()),
                        has_limit ? studies::to_string(c.below) : "", has_limit ? studies::to_string(c.above) : "");
    while (text[text.size() - 2] == ' ') text.erase(text.size() - 2, 1);
  }
  return text;
}

/// A limit that is not known is null, one that there is none of "none".
nlohmann::json json_of(const std::vector<Region>& regions, const std::vector<Confirmed>& confirmed) {
  const auto limit = [](double value) { return std::isinf(value) ? nlohmann::json("none") : nlohmann::json(value); };
  auto methods = nlohmann::json::array();
  for (std::size_t i = 0; i < regions.size(); ++i) {
    methods.push_back({{"method", regions[i].method},
                       {"real_axis_to", limit(-regions[i].region.real_limit)},
                       {"imaginary_axis_to", limit(regions[i].region.imaginary_limit)}});
    if (i >= confirmed.size()) continue;
    const Confirmed& one = confirmed[i];
    nlohmann::json step{{"step", limit(one.limit.step)}};
    if (std::isfinite(one.limit.step) && one.limit.step > 0)
      step.update({{"eigenvalue", {one.limit.eigenvalue.real(), one.limit.eigenvalue.imag()}},
                   {"t", one.limit.time},
                   {"just_below", studies::to_string(one.below)},
                   {"just_above", studies::to_string(one.above)}});
    methods.back()["largest"] = std::move(step);
  }
  return {{"methods", methods}};
}

/// Each region lightly filled, with its crossings of the axes. Returns the number of each method's colour.
std::vector<std::size_t> add_regions(const std::vector<Region>& regions, results::Panel& panel) {
  using enum results::Curve::Style;
  std::vector<results::Curve> areas, crossings;
  std::vector<std::string> names;
  for (const auto& [method, region] : regions) names.push_back(method);
  std::vector<std::size_t> colors = results::colors_of_methods(names);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const auto& [method, region] = regions[i];
    const std::string color(results::color_of(colors[i]));
    results::Curve outline{.label = method, .x = region.x, .y = region.y, .number = colors[i]};
    const double up = std::isfinite(region.imaginary_limit) ? region.imaginary_limit : 0;
    if (region.x.empty() && up > 0) outline.x = {0, 0}, outline.y = {-up, up};
    if (outline.x.empty()) continue;
    panel.curves.push_back(std::move(outline));
    if (!region.area_x.empty())
      areas.push_back({.label = "",
                       .x = region.area_x,
                       .y = region.area_y,
                       .color = color,
                       .style = area,
                       .widens_axes = false});  // of an implicit method it has no end
    results::Curve points{.label = "", .x = {}, .y = {}, .color = color, .style = full_points};
    if (std::isfinite(region.real_limit) && region.real_limit > 0)
      points.x.push_back(-region.real_limit), points.y.push_back(0);
    for (const double y : {up, -up})
      if (up > 0) points.x.push_back(0), points.y.push_back(y);
    if (!points.x.empty()) crossings.push_back(std::move(points));
  }
  panel.curves.insert(panel.curves.end(), areas.begin(), areas.end());
  panel.curves.insert(panel.curves.end(), crossings.begin(), crossings.end());
  return colors;
}

/// The eigenvalues times each method's largest step, in its colour; those of short steps above those of long ones,
/// which reach further.
void add_eigenvalues(const std::vector<Confirmed>& confirmed, const studies::Spectrum& spectrum,
                     const std::vector<std::size_t>& colors, results::Panel& panel) {
  struct Points {
    double step;
    results::Curve curve;
  };
  std::vector<Points> all;
  for (std::size_t i = 0; i < confirmed.size(); ++i) {
    const StepLimit& limit = confirmed[i].limit;
    if (!std::isfinite(limit.step) || limit.step == 0) continue;
    results::Curve points{.label = "",
                          .x = {},
                          .y = {},
                          .color = std::string(results::color_of(colors[i])),
                          .style = results::Curve::Style::dots};
    for (std::size_t k = 0; k < spectrum.times.size(); ++k) {
      if (k > 0 && spectrum.values[k] == spectrum.values[k - 1]) continue;  // of a linear model once
      for (const Complex& value : spectrum.values[k]) {
        points.x.push_back(limit.step * value.real());
        points.y.push_back(limit.step * value.imag());
      }
    }
    all.push_back({limit.step, std::move(points)});
  }
  if (all.empty()) return;
  std::ranges::sort(all, std::ranges::greater(), &Points::step);
  all.front().curve.label = "eigenvalues times the largest step";
  for (auto& [step, points] : all) panel.curves.push_back(std::move(points));
}

results::Figure figure_of(const std::vector<Region>& regions, const std::vector<Confirmed>& confirmed,
                          const studies::Spectrum& spectrum, std::string title) {
  results::Panel panel{.x_label = "Re z", .y_label = "Im z", .curves = {}, .equal_scale = true, .zero_lines = true};
  const auto colors = add_regions(regions, panel);
  add_eigenvalues(confirmed, spectrum, colors, panel);
  return {.title = std::move(title), .panels = {std::move(panel)}};
}

ExitCode stability(const StabilityOptions& options) {
  if (!drawable(options.plot) || !known_methods(options.methods)) return usage;
  Progress progress;
  const auto watcher = progress.parts();
  const bool with_model = !options.experiment.file.empty();
  const double parts = static_cast<double>(options.methods.size()) * (with_model ? 2 : 1);
  double part = 0;
  const auto more = [&] {
    part += 1 / parts;
    if (watcher) watcher(part);
    return !interrupt_flag().load();
  };
  std::optional<Studied> studied;
  Samples samples;
  studies::Spectrum spectrum;
  if (with_model) {
    studied = study(options.experiment, "");
    if (studied->prepared.exit != done) return studied->prepared.exit;
    const auto simulated = model::simulate(studied->prepared.program, studied->prepared.experiment);
    show(simulated.diagnostics, studied->prepared.loaded.source);
    if (!simulated.run) return numerical_failure;
    samples = samples_of(simulated.run->motion);
    spectrum = studies::spectrum_along(studied->system, samples.times, samples.states);
  }
  std::vector<Region> regions;
  std::vector<Confirmed> confirmed;
  bool go_on = true;
  for (const std::string& method : options.methods) {
    if (!go_on) break;
    const std::size_t points = options.plot.empty() ? 0 : 240;
    regions.push_back({method, studies::stability_region(studies::steps_of(method), points, &interrupt_flag())});
    go_on = more();
  }
  if (with_model)
    for (const std::string& method : options.methods) {
      if (!go_on) break;
      confirmed.push_back(confirm(method, *studied, samples, spectrum));
      go_on = more();
    }
  if (options.json) {
    answer("continuo.stability/1", json_of(regions, confirmed));
  } else {
    print(regions_text(regions));
    if (!confirmed.empty()) {
      const std::string& unit = studied->prepared.program->model.time_unit;
      print(confirmed_text(confirmed, unit.empty() ? "" : " " + unit));
    }
  }
  ExitCode exit = go_on ? done : interrupted;
  if (!options.plot.empty()) {
    const std::string title = with_model ? studied->prepared.program->model.name : "Regions of absolute stability";
    if (!written(results::draw(figure_of(regions, confirmed, spectrum, title), options.plot)) && exit == done)
      exit = usage;
  }
  return exit;
}

}  // namespace

void add_stability(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo stability euler,heun,rk4 --plot regions.svg         regions of absolute stability\n"
      "  continuo stability euler,rk4,bdf2 --model models/heat_equation.sim     the largest stable step\n"
      "  continuo stability central_difference --model models/mass_spring_damper.sim --set c=0\n";
  Verb* verb = add_verb(app, listed("stability"), examples, {wrong_model, numerical_failure, interrupted});
  verb->json_examples = {"continuo stability rk4 --model models/heat_equation.sim --json"};
  auto options = std::make_shared<StabilityOptions>();
  verb->add_option("methods", options->methods, "Methods, separated by commas")
      ->required()
      ->delimiter(',')
      ->type_name("");
  auto* model = reads_file(
      *verb,
      verb->add_option("--model", options->experiment.file, "A model whose eigenvalues are drawn into the regions"),
      files_of_model);
  verb->add_option("--set", options->experiment.settings, "Sets a parameter of the model")
      ->needs(model)
      ->type_name("NAME=VALUE");
  verb->add_flag("--json", options->json, "The limits as one JSON object");
  writes_file(*verb, verb->add_option("--plot", options->plot, "Writes a plot, .svg or .png"));
  verb->callback([&exit, options] { exit = stability(*options); });
}

}  // namespace continuo::app
