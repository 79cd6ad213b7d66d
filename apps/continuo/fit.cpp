// continuo fit FILE DATA.csv --param k,c: the parameters that measurements speak for, and how surely.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <apps/continuo/command_line.hpp>
#include <apps/continuo/experiment_options.hpp>
#include <apps/continuo/influences.hpp>
#include <apps/continuo/models.hpp>
#include <apps/continuo/modules.hpp>
#include <apps/continuo/progress.hpp>
#include <apps/continuo/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>

#include <continuo/model/cells.hpp>
#include <continuo/model/simulate.hpp>
#include <continuo/results/figure.hpp>
#include <continuo/results/plots.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/studies/fit.hpp>

namespace continuo::app {
namespace {

using results::short_number;

struct FitOptions {
  ExperimentOptions experiment;
  std::vector<std::string> data, parameters, initial, columns, deviations, bounds, settings;
  std::string loss = "squares", plot;
  std::size_t starts = 1;
};

/// `NAME=REST`, or nothing after saying so.
std::optional<std::pair<std::string, std::string>> split_setting(const std::string& text, std::string_view form) {
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0 && equals + 1 < text.size())
    return std::pair(text.substr(0, equals), text.substr(equals + 1));
  say(fmt::format("`{}` is not {}", text, form));
  return std::nullopt;
}

std::optional<double> positive(const std::string& text) {
  const auto value = model::cell_number(text);
  return value && *value > 0 ? value : std::nullopt;
}

class Request {
 public:
  Request(const FitOptions& options, const Prepared& prepared) : options_(options), model_(prepared.program->model) {
    request_.program = prepared.program;
    request_.experiment = prepared.experiment;
  }

  std::optional<studies::FitRequest> make() {
    if (!read_data() || !read_settings() || !choose_columns() || !set_deviations() || !set_unknowns()) return {};
    const auto loss = std::ranges::find(studies::loss_names, options_.loss);
    if (loss == std::end(studies::loss_names)) {
      say(no_such("loss", options_.loss, {std::begin(studies::loss_names), std::end(studies::loss_names)}));
      return {};
    }
    request_.options.loss = static_cast<studies::Loss>(loss - std::begin(studies::loss_names));
    request_.options.starts = options_.starts;
    return std::move(request_);
  }

 private:
  bool read_data() {
    for (const std::string& file : options_.data) {
      auto read = studies::read_measurements(file);
      if (!read.problem.empty()) {
        say(read.problem);
        return false;
      }
      request_.data.push_back({.measurements = std::move(read.measurements), .columns = {}});
    }
    return true;
  }

  /// `a.csv:mass=2`: of one set.
  bool read_settings() {
    for (const std::string& text : options_.settings) {
      const std::size_t colon = text.rfind(':');
      const auto set = std::ranges::find(request_.data, text.substr(0, std::min(colon, text.size())),
                                         [](const studies::FitData& data) { return data.measurements.file; });
      if (colon == std::string::npos || set == request_.data.end()) {
        say(fmt::format("`{}` is not FILE:NAME=VALUE with one of the data files", text));
        return false;
      }
      std::vector<model::Diagnostic> problems;
      const auto setting = model::parse_setting(model_, text.substr(colon + 1), problems);
      show(problems, model::Source("--in", text.substr(colon + 1)));
      if (!setting) return false;
      set->parameters[setting->name] = setting->value;
    }
    return true;
  }

  bool choose_columns() {
    std::vector<std::pair<std::string, std::string>> renamed;
    for (const std::string& text : options_.columns) {
      const auto setting = split_setting(text, "COLUMN=QUANTITY");
      if (!setting) return false;
      renamed.push_back(*setting);
      const bool somewhere = std::ranges::any_of(request_.data, [&](const studies::FitData& data) {
        return std::ranges::find(data.measurements.columns, setting->first) != data.measurements.columns.end();
      });
      if (somewhere) continue;
      say(no_such("column", setting->first, request_.data.front().measurements.columns));
      return false;
    }
    const auto known = studies::quantities_of(model_);
    for (studies::FitData& data : request_.data) {
      for (std::size_t c = 0; c < data.measurements.columns.size(); ++c) {
        std::string quantity = data.measurements.columns[c];
        for (const auto& [column, meant] : renamed)
          if (column == quantity) quantity = meant;
        if (quantity == "-") continue;
        if (std::ranges::find(known, quantity) == known.end()) {
          say(fmt::format("{}:1: {} (--column {}=QUANTITY says which one is meant, --column {}=- leaves it out)",
                          data.measurements.file, no_such("state or output", quantity, known),
                          data.measurements.columns[c], data.measurements.columns[c]));
          return false;
        }
        data.columns.push_back({.column = c, .quantity = quantity});
      }
    }
    return true;
  }

  bool set_deviations() {
    for (const std::string& text : options_.deviations) {
      const auto setting = split_setting(text, "COLUMN=DEVIATION");
      if (!setting) return false;
      const auto value = positive(setting->second);
      bool found = false;
      for (studies::FitData& data : request_.data)
        for (studies::FitColumn& column : data.columns)
          if (data.measurements.columns[column.column] == setting->first) column.deviation = value, found = true;
      if (value && found) continue;
      say(value ? no_such("column", setting->first, request_.data.front().measurements.columns)
                : fmt::format("`{}`: a deviation is a positive number", text));
      return false;
    }
    return true;
  }

  bool set_unknowns() {
    const auto influences = influences_named(model_, options_.parameters, options_.initial);
    if (!influences) return false;
    for (const studies::Influence& influence : *influences) {
      studies::FitUnknown unknown{.influence = influence};
      if (influence.kind == studies::Influence::Kind::parameter) {
        const model::Parameter& parameter = model_.parameters[influence.index];
        if (parameter.range) unknown.low = parameter.range->low, unknown.high = parameter.range->high;
        for (const studies::FitData& data : request_.data) {
          if (!data.parameters.contains(parameter.name)) continue;
          say(fmt::format("`{}` cannot be fitted and be set in {} at once", parameter.name, data.measurements.file));
          return false;
        }
      }
      request_.unknowns.push_back(unknown);
    }
    return std::ranges::all_of(options_.bounds, [&](const std::string& text) { return set_bounds(text); });
  }

  bool set_bounds(const std::string& text) {
    const auto setting = split_setting(text, "NAME=LOW..HIGH");
    if (!setting) return false;
    const std::size_t dots = setting->second.find("..");
    const auto side = [](const std::string& number, double none) {
      return number.empty() ? std::optional(none) : model::cell_number(number);
    };
    const double low = side(setting->second.substr(0, dots), -INFINITY).value_or(NAN);
    const double high =
        dots == std::string::npos ? NAN : side(setting->second.substr(dots + 2), INFINITY).value_or(NAN);
    if (!(low < high)) {  // or one is no number
      say(fmt::format("`{}` is not NAME=LOW..HIGH", text));
      return false;
    }
    std::vector<std::string> names;
    for (studies::FitUnknown& unknown : request_.unknowns) {
      names.push_back(name_of(model_, unknown.influence));
      if (names.back() != setting->first) continue;
      unknown.low = low;
      unknown.high = high;
      return true;
    }
    say(no_such("unknown", setting->first, names));
    return false;
  }

  const FitOptions& options_;
  const model::Model& model_;
  studies::FitRequest request_;
};

std::string table_of(const studies::FitRequest& request, const studies::Fit& fit) {
  const model::Model& model = request.program->model;
  const studies::LeastSquaresResult& least = fit.least;
  std::string text = fmt::format("{:<12} {:>14} {:<8} {:>12}  {}\n", "", "value", "", "+-", "95 % interval");
  for (std::size_t u = 0; u < request.unknowns.size(); ++u) {
    const studies::Influence& influence = request.unknowns[u].influence;
    const double width = fit.half_width(u);
    text += fmt::format("{:<12} {:>14} {:<8} ", name_of(model, influence), short_number(least.p[u]),
                        unit_of(model, influence));
    if (least.at_bound[u]) {
      text += fmt::format("{:>12}  at its bound\n", "");
    } else if (!std::isfinite(width)) {
      text += fmt::format("{:>12}  the data do not determine it\n", "");
    } else {
      text += fmt::format("{:>12}  {} .. {}\n", short_number(width), short_number(least.p[u] - width),
                          short_number(least.p[u] + width));
    }
  }
  for (std::size_t a = 0; a < request.unknowns.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double correlation = least.covariance[a * least.p.size() + b] / (least.deviation(a) * least.deviation(b));
      if (std::abs(correlation) > 0.9)
        text += fmt::format("{} and {} are hard to tell apart: correlation {:.3f}\n",
                            name_of(model, request.unknowns[b].influence),
                            name_of(model, request.unknowns[a].influence), correlation);
    }
  }
  std::size_t scale = 0;
  for (const studies::FitData& data : request.data)
    for (const studies::FitColumn& column : data.columns)
      text += fmt::format("{}: {} is met within {}\n", data.measurements.file, column.quantity,
                          short_number(fit.scales[scale++]));
  text += fmt::format("{} values, {} iterations, {} runs", least.residuals.size(), least.iterations,
                      least.evaluations * request.data.size());
  if (least.starts_done > 1) text += fmt::format(", {} of {} starts agree", least.starts_agreeing, least.starts_done);
  return text + (least.interrupted ? "\ninterrupted: the best there was until then\n" : "\n");
}

results::Figure figure_of(const studies::FitRequest& request, const studies::Fit& fit) {
  const model::Model& model = request.program->model;
  results::Figure figure{.title = model.name, .panels = {}};
  for (const studies::FitCurve& curve : curves_of(request, fit)) {
    const studies::FitData& data = request.data[curve.data];
    const studies::FitColumn& column = data.columns[curve.column];
    const std::size_t state = model::find_state(model, column.quantity);
    std::string unit = state == model::npos ? "" : model.states[state].unit;
    for (const auto* list : {&model.outputs, &model.lets, &model.energies})
      for (const model::Quantity& quantity : *list)
        if (quantity.name == column.quantity) unit = quantity.unit;
    results::Curve band{.label = "95 % of measurements",
                        .x = curve.t,
                        .y = {},
                        .color = "#0072b2",
                        .style = results::Curve::Style::area};
    for (std::size_t i = 0; i < curve.y.size(); ++i) band.y.push_back(curve.y[i] - curve.half_width[i]);
    for (std::size_t i = curve.y.size(); i-- > 0;) {  // and back along its upper side
      band.x.push_back(curve.t[i]);
      band.y.push_back(curve.y[i] + curve.half_width[i]);
    }
    const std::vector<double>& measured = data.measurements.values[column.column];
    figure.panels.push_back({.x_label = results::label_of({"t", model.time_unit}),
                             .y_label = results::label_of({column.quantity, unit}),
                             .curves = {std::move(band),
                                        {.label = "fit", .x = curve.t, .y = curve.y, .color = "#0072b2"},
                                        {.label = std::filesystem::path(data.measurements.file).filename().string(),
                                         .x = data.measurements.times,
                                         .y = measured,
                                         .color = "#444444",
                                         .style = results::Curve::Style::empty_points}}});
  }
  return figure;
}

/// Runs less exact than the search would be noise to it: asked for, they are refused.
bool strict_enough(const model::Experiment& experiment) {
  std::vector<double> asked;
  if (experiment.rtol) asked.push_back(*experiment.rtol);
  for (const auto& [state, rtol] : experiment.rtol_of) asked.push_back(rtol);
  for (const double rtol : asked) {
    if (rtol <= studies::greatest_rtol_of_fit) continue;
    say(fmt::format("--tol {}: the runs of a fit need {} or less, beyond it they are noise to the search",
                    short_number(rtol), short_number(studies::greatest_rtol_of_fit)));
    return false;
  }
  return true;
}

ExitCode fit(const FitOptions& options) {
  if (!drawable(options.plot) || !loadable(least_squares_module)) return usage;
  Prepared prepared = prepare(options.experiment, Worlds::welcome);
  if (prepared.exit != done) return prepared.exit;
  if (!strict_enough(prepared.experiment)) return usage;
  say_step_has_no_part(prepared);
  auto request = Request(options, prepared).make();
  if (!request) return usage;
  request->options.interrupt = prepared.experiment.interrupt;
  studies::Fit found;
  {
    Progress progress;
    // How long one search takes nobody knows; of many, those that are done say it.
    if (options.starts > 1) {
      if (const auto show_part = progress.parts())
        request->options.progress = [show_part, starts = static_cast<double>(options.starts)](
                                        std::size_t start, double) { show_part(static_cast<double>(start) / starts); };
    } else if (const auto show_number = progress.number("residual")) {
      request->options.progress = [show_number](std::size_t, double cost) { show_number(std::sqrt(2 * cost)); };
    }
    // A run that is cut off says nothing of its parameters: the search stops between runs.
    request->experiment.interrupt = nullptr;
    found = studies::fit(*request);
  }
  show(found.diagnostics, prepared.loaded.source);
  if (!found.found()) {
    if (found.least.interrupted) {
      say("interrupted before anything was found");
      return interrupted;
    }
    say(found.problem);
    return found.diagnostics.empty() ? numerical_failure : wrong_model;
  }
  print(table_of(*request, found));
  if (!options.plot.empty()) {
    if (!written(results::draw(figure_of(*request, found), options.plot))) return usage;
  }
  return found.least.interrupted ? interrupted : done;
}

}  // namespace

void add_fit(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo fit spring.sim measured.csv --param k,c                the columns are t and names of states\n"
      "  continuo fit spring.sim measured.csv --param k,c --initial x --loss huber --plot fit.svg\n"
      "  continuo fit spring.sim a.csv b.csv --param k --in b.csv:m=2 --column \"pos=x\" --sigma pos=0.01\n";
  CLI::App* verb = add_verb(app, "fit", "Finds parameters and initial values from measurements", examples);
  auto options = std::make_shared<FitOptions>();
  add_model(*verb, options->experiment);
  refuse_option(*verb, "--until", "a fit's runs end with each data file's last time");
  refuse_option(*verb, "--output", "a fit's runs have their rows at the times of the data");
  refuse_methods(*verb);
  verb->add_option("data", options->data, "CSV files: t, and columns named like states or outputs")
      ->required()
      ->type_name("");
  const auto list = [&](const char* name, std::vector<std::string>& target, const char* text, const char* type) {
    verb->add_option(name, target, text)->delimiter(',')->allow_extra_args(false)->type_name(type);
  };
  list("--param", options->parameters, "Parameters to find, within the ranges the model gives them", "NAMES");
  list("--initial", options->initial, "States whose initial values are to be found", "STATES");
  list("--bounds", options->bounds, "Other ranges: k=1..20, x(0)=0..", "NAME=LOW..HIGH");
  list("--column", options->columns, "Which quantity a column is; - for none", "COLUMN=QUANTITY");
  list("--sigma", options->deviations, "The deviation of a column's measurements; else estimated", "COLUMN=NUMBER");
  list("--in", options->settings, "A parameter's value in one data file", "FILE:NAME=VALUE");
  verb->add_option("--loss", options->loss, "squares, or for outliers huber, soft_l1, cauchy, tukey")
      ->type_name("NAME");
  verb->add_option("--starts", options->starts, "Search from this many places")->type_name("N");
  add_tolerances(*verb, options->experiment);
  verb->add_option("--plot", options->plot, "Measurements, fit and prediction band, .svg or .png")->type_name("FILE");
  verb->callback([&exit, options] { exit = fit(*options); });
}

}  // namespace continuo::app
