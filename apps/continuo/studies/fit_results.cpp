// A fit as text, as JSON and as a figure.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <apps/continuo/studies/fit_results.hpp>
#include <apps/continuo/studies/fit_units.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/plots.hpp>
#include <continuo/results/summary.hpp>

namespace continuo::app {
namespace {

using results::short_number;
using studies::ErrorModel;

std::string name_of_unknown(const studies::FitRequest& request, std::size_t unknown) {
  return name_of(request.program->model, request.unknowns[unknown].influence);
}

double correlation_of(const studies::Fit& fit, std::size_t a, std::size_t b) {
  const std::size_t m = fit.least.p.size();
  const auto& c = fit.sure.covariance;
  return c[a * m + b] / std::sqrt(c[a * m + a] * c[b * m + b]);
}

std::string interval_text(double low, double high) {
  if (std::isinf(low) && std::isinf(high)) return "no limit on either side";
  if (std::isinf(low)) return "up to " + short_number(high);
  if (std::isinf(high)) return "from " + short_number(low) + " on";
  return fmt::format("{} .. {}", short_number(low), short_number(high));
}

std::string unknowns_text(const studies::FitRequest& request, const studies::Fit& fit) {
  std::string text = fmt::format("{:<12} {:>14} {:<8} {:>12}  {}\n", "", "value", "", "+-", "95 % interval");
  for (std::size_t u = 0; u < fit.estimates.size(); ++u) {
    const studies::FitEstimate& estimate = fit.estimates[u];
    text += fmt::format("{:<12} {:>14} {:<8} ", name_of_unknown(request, u), short_number(estimate.value),
                        unit_of(request.program->model, request.unknowns[u].influence));
    if (estimate.at_bound) {
      text += fmt::format("{:>12}  at its bound\n", "");
    } else if (estimate.undetermined) {
      text += fmt::format("{:>12}  the data do not determine it\n", "");
    } else if (!std::isfinite(fit.half_width(u))) {
      text += fmt::format("{:>12}  there are as many unknowns as values how sure it is\n", "");
    } else {
      const std::string width = request.unknowns[u].logarithmic
                                    ? "times " + short_number(estimate.high / estimate.value)
                                    : short_number(fit.half_width(u));
      text += fmt::format("{:>12}  {}\n", width, interval_text(estimate.low, estimate.high));
    }
  }
  return text;
}

/// Which moves of the unknowns change nothing, and which are hard to tell apart.
std::string relations_text(const studies::FitRequest& request, const studies::Fit& fit) {
  std::string text;
  for (const std::vector<double>& direction : fit.sure.directions) {
    std::vector<std::string> moves;
    std::string only;
    for (std::size_t u = 0; u < direction.size(); ++u) {
      if (std::abs(direction[u]) < 1e-4) continue;
      only = name_of_unknown(request, u);
      moves.push_back(fmt::format("{} by {:+.3g} %", only, direction[u]));
    }
    text += moves.size() == 1
                ? fmt::format("not determined: {} changes no measured quantity\n", only)
                : fmt::format("not determined: moving {} changes no measured quantity\n", fmt::join(moves, ", "));
  }
  for (std::size_t a = 0; a < fit.estimates.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (std::abs(correlation_of(fit, a, b)) > 0.9)
        text += fmt::format("{} and {} are strongly correlated: {:.3f}\n", name_of_unknown(request, b),
                            name_of_unknown(request, a), correlation_of(fit, a, b));
  return text;
}

std::string deviation_text(const studies::FitData& data, const studies::FitColumn& asked,
                           const studies::FitColumnResult& column) {
  if (!std::isfinite(column.ratio)) return "no residual deviation: there are as many unknowns as values";
  std::string text;
  if (asked.deviations_in) {
    text = fmt::format("{:.3g} times its deviations in `{}`", column.ratio,
                       data.measurements.columns[*asked.deviations_in]);
  } else {
    switch (asked.error) {
      case ErrorModel::constant:
        text = short_number(column.residual_deviation);
        break;
      case ErrorModel::proportional:
        text = short_number(100 * column.residual_deviation_relative) + " %";
        break;
      case ErrorModel::both:
        text = fmt::format("{} and {} %", short_number(column.residual_deviation),
                           short_number(100 * column.residual_deviation_relative));
        break;
      case ErrorModel::poisson:
        text = fmt::format("{:.3g} times the square root of the count", column.ratio);
        break;
      case ErrorModel::lognormal:
        text = "a factor of " + short_number(std::exp(column.residual_deviation));
        break;
    }
  }
  if (column.given && !asked.deviations_in && asked.error != ErrorModel::poisson)
    text += fmt::format(", {:.3g} times the given one", column.ratio);
  return "residual deviation " + text;
}

std::string columns_text(const studies::FitRequest& request, const studies::Fit& fit) {
  std::string text;
  for (const studies::FitColumnResult& column : fit.columns) {
    const studies::FitData& data = request.data[column.data];
    const studies::FitColumn& asked = data.columns[column.column];
    text += fmt::format("{}: {}: {}\n", data.measurements.file, asked.quantity, deviation_text(data, asked, column));
  }
  return text;
}

std::string statistics_text(const studies::FitStatistics& statistics) {
  std::vector<std::string> parts;
  if (statistics.sum_of_squares) parts.push_back(fmt::format("sum of squares {:.4g}", *statistics.sum_of_squares));
  parts.push_back(fmt::format("{:.4g} degrees of freedom", statistics.degrees));
  if (statistics.chi_squared)
    parts.push_back(fmt::format("chi squared {:.4g} (p = {:.2g})", *statistics.chi_squared, *statistics.chi_squared_p));
  if (statistics.aic) parts.push_back(fmt::format("AIC {:.1f}, BIC {:.1f}", *statistics.aic, *statistics.bic));
  return fmt::format("{}\n", fmt::join(parts, ", "));
}

std::string profiles_text(const studies::FitRequest& request, const std::vector<studies::Profile>& profiles) {
  std::string text;
  for (const studies::Profile& profile : profiles) {
    const std::string name = name_of_unknown(request, profile.unknown);
    if (profile.values.empty()) {
      text += fmt::format("profile of {}: there are as many unknowns as values\n", name);
      continue;
    }
    text += fmt::format("profile of {}: {}", name, interval_text(profile.low, profile.high));
    if (profile.low_is_bound || profile.high_is_bound)
      text += fmt::format(" (its range ends {})", !profile.high_is_bound  ? "below"
                                                  : !profile.low_is_bound ? "above"
                                                                          : "on both sides");
    text += profile.better ? "; a better fit was found on the way: use --starts\n" : "\n";
  }
  return text;
}

}  // namespace

std::string fit_text(const studies::FitRequest& request, const studies::Fit& fit,
                     const std::vector<studies::Profile>& profiles) {
  const studies::LeastSquaresResult& least = fit.least;
  std::string text = unknowns_text(request, fit) + relations_text(request, fit) + profiles_text(request, profiles) +
                     columns_text(request, fit) + statistics_text(fit.statistics);
  text += fmt::format("{} values, {} iterations, {} runs", fit.statistics.values, least.iterations, fit.runs);
  if (least.starts_done > 1) text += fmt::format(", {} of {} starts agree", least.starts_agreeing, least.starts_done);
  text += "\n";
  for (const studies::FitDoubt& doubt : fit.doubts)
    if (doubt.kind != studies::FitDoubt::Kind::undetermined)  // said above, by name
      text += "doubt: " + doubt.text + "\n";
  return text + (least.interrupted ? "interrupted: the best there was until then\n" : "");
}

nlohmann::json fit_json(const studies::FitRequest& request, const studies::Fit& fit,
                        const std::vector<studies::Profile>& profiles) {
  using nlohmann::json;
  const model::Model& model = request.program->model;
  const std::size_t m = fit.estimates.size();
  json unknowns = json::array(), correlations = json::array(), columns = json::array(), directions = json::array(),
       doubts = json::array();
  for (std::size_t u = 0; u < m; ++u) {
    const studies::FitEstimate& estimate = fit.estimates[u];
    json unknown{{"name", name_of_unknown(request, u)},
                 {"unit", unit_of(model, request.unknowns[u].influence)},
                 {"value", estimate.value},
                 {"deviation", estimate.deviation},
                 {"interval", {estimate.low, estimate.high}},
                 {"degrees", estimate.degrees},
                 {"logarithmic", request.unknowns[u].logarithmic},
                 {"status", estimate.at_bound       ? "at bound"
                            : estimate.undetermined ? "undetermined"
                                                    : "determined"}};
    for (const studies::Profile& profile : profiles)
      if (profile.unknown == u)
        unknown["profile"] = {{"interval", {profile.low, profile.high}},
                              {"ends_at_bound", {profile.low_is_bound, profile.high_is_bound}},
                              {"threshold", profile.threshold},
                              {"values", profile.values},
                              {"rises", profile.rises},
                              {"better_than_fit", profile.better}};
    unknowns.push_back(std::move(unknown));
    json row = json::array();
    for (std::size_t v = 0; v < m; ++v) row.push_back(correlation_of(fit, u, v));
    correlations.push_back(std::move(row));
  }
  for (const std::vector<double>& direction : fit.sure.directions) {
    json moves = json::object();
    for (std::size_t u = 0; u < m; ++u)
      if (std::abs(direction[u]) >= 1e-4) moves[name_of_unknown(request, u)] = direction[u];
    directions.push_back(std::move(moves));
  }
  for (const studies::FitColumnResult& column : fit.columns) {
    const studies::FitData& data = request.data[column.data];
    const studies::FitColumn& asked = data.columns[column.column];
    json entry{{"file", data.measurements.file},
               {"column", data.measurements.columns[asked.column]},
               {"quantity", asked.quantity},
               {"unit", unit_of_quantity(model, asked.quantity)},
               {"error_model", studies::error_model_names[static_cast<std::size_t>(asked.error)]},
               {"deviation_given", column.given},
               {"values", column.values},
               {"degrees", column.degrees},
               {"residual_deviation", column.residual_deviation},
               {"residual_deviation_relative", column.residual_deviation_relative},
               {"sum_of_squares", column.sum_of_squares},
               {"signs_p", column.signs_p},
               {"t", column.times},
               {"measured", column.measured},
               {"fitted", column.fitted},
               {"residuals", column.residuals},
               {"deviations", column.deviations},
               {"weights", column.weights}};
    if (column.given) {
      entry["chi_squared"] = column.chi_squared;
      entry["p"] = column.p;
      entry["residual_over_given"] = column.ratio;
    }
    columns.push_back(std::move(entry));
  }
  for (const studies::FitDoubt& doubt : fit.doubts)
    doubts.push_back({{"kind", studies::doubt_names[static_cast<std::size_t>(doubt.kind)]}, {"text", doubt.text}});
  const studies::FitStatistics& s = fit.statistics;
  const auto known = [](const std::optional<double>& value) { return value ? json(*value) : json(); };
  json result{{"model", model.name},
              {"likelihood", studies::likelihood_names[static_cast<std::size_t>(request.likelihood)]},
              {"loss", studies::loss_names[static_cast<std::size_t>(request.options.loss)]},
              {"converged", fit.least.converged},
              {"interrupted", fit.least.interrupted},
              {"unknowns", std::move(unknowns)},
              {"correlations", std::move(correlations)},
              {"undetermined", std::move(directions)},
              {"columns", std::move(columns)},
              {"statistics",
               {{"values", s.values},
                {"free_unknowns", s.free_unknowns},
                {"estimated_variances", s.estimated_variances},
                {"degrees", s.degrees},
                {"sum_of_squares", known(s.sum_of_squares)},
                {"chi_squared", known(s.chi_squared)},
                {"p", known(s.chi_squared_p)},
                {"log_likelihood", known(s.log_likelihood)},
                {"aic", known(s.aic)},
                {"aicc", known(s.aicc)},
                {"bic", known(s.bic)}}},
              {"search",
               {{"iterations", fit.least.iterations},
                {"runs", fit.runs},
                {"starts", fit.least.starts_done},
                {"starts_agreeing", fit.least.starts_agreeing},
                {"best_start", fit.least.best_start}}},
              {"doubts", std::move(doubts)}};
  return result;
}

results::Figure fit_figure(const studies::FitRequest& request, const studies::Fit& fit,
                           const std::vector<studies::Profile>& profiles) {
  const model::Model& model = request.program->model;
  const char* blue = "#0072b2";
  const char* grey = "#444444";
  results::Figure figure{.title = model.name, .panels = {}};
  std::size_t group = 0;
  for (const studies::FitCurve& curve : curves_of(request, fit)) {
    const studies::FitData& data = request.data[curve.data];
    const studies::FitColumn& column = data.columns[curve.column];
    const std::string time = results::label_of({"t", model.time_unit});
    results::Curve band{.label = "95 % of measurements",
                        .x = curve.t,
                        .y = curve.low,
                        .color = blue,
                        .style = results::Curve::Style::area};
    for (std::size_t i = curve.y.size(); i-- > 0;) {  // and back along its upper side
      band.x.push_back(curve.t[i]);
      band.y.push_back(curve.high[i]);
    }
    figure.panels.push_back({.x_label = time,
                             .y_label = results::label_of({column.quantity, unit_of_quantity(model, column.quantity)}),
                             .curves = {std::move(band),
                                        {.label = "fit", .x = curve.t, .y = curve.y, .color = blue},
                                        {.label = std::filesystem::path(data.measurements.file).filename().string(),
                                         .x = data.measurements.times,
                                         .y = data.measurements.values[column.column],
                                         .color = grey,
                                         .style = results::Curve::Style::empty_points}}});
    const studies::FitColumnResult& met = fit.columns[group++];
    std::vector<double> over;
    for (std::size_t i = 0; i < met.residuals.size(); ++i) over.push_back(-met.residuals[i] / met.deviations[i]);
    figure.panels.push_back({.x_label = time,
                             .y_label = column.quantity + " off, in deviations",
                             .curves = {{.label = "",  // from end to end, as above
                                         .x = {curve.t.front(), curve.t.back()},
                                         .y = {0, 0},
                                         .color = grey,
                                         .style = results::Curve::Style::thin_line},
                                        {.label = "measured less fit",
                                         .x = met.times,
                                         .y = std::move(over),
                                         .color = grey,
                                         .style = results::Curve::Style::empty_points}}});
  }
  for (const studies::Profile& profile : profiles) {
    if (profile.values.size() < 2) continue;
    results::Curve rise{.label = "rise of chi squared", .x = {}, .y = {}, .color = blue};
    for (std::size_t i = 0; i < profile.values.size(); ++i) {
      // Far beyond the threshold the parabola would hide what matters.
      if (!(profile.rises[i] < 3 * profile.threshold)) continue;
      rise.x.push_back(profile.values[i]);
      rise.y.push_back(profile.rises[i]);
    }
    results::Curve threshold{.label = "95 %",
                             .x = {rise.x.front(), rise.x.back()},
                             .y = {profile.threshold, profile.threshold},
                             .color = grey,
                             .style = results::Curve::Style::dashed_line};
    figure.panels.push_back(
        {.x_label = results::label_of(
             {name_of_unknown(request, profile.unknown), unit_of(model, request.unknowns[profile.unknown].influence)}),
         .y_label = "rise of chi squared",
         .curves = {std::move(rise), std::move(threshold)}});
  }
  return figure;
}

}  // namespace continuo::app
