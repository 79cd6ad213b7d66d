// Fits the unknowns of a model: checks of the request, search, uncertainties, doubts.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <continuo/language/world.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/studies/fit.hpp>
#include <continuo/studies/fit/fit_of_world.hpp>
#include <continuo/studies/fit/fit_problem.hpp>
#include <continuo/studies/fit/fit_search.hpp>
#include <continuo/studies/fit/fit_statistics.hpp>

namespace continuo::studies {

namespace {

using detail::FitPart;
using detail::FitProblem;
using detail::FitSearch;

/// Why the run at p has no rows to compare: said once, at the start.
Status failure_at_start(const FitRequest& request, const FitProblem& problem, std::span<const double> p,
                        std::vector<model::Diagnostic>& diagnostics) {
  for (std::size_t part = 0; part < problem.parts().size(); ++part) {
    SensitivityRun run;
    const FitPart::Values values = problem.values(part, p, problem.parts()[part].times(), &run);
    const FitData& data = problem.parts()[part].data();
    if (values.good) {
      const std::size_t width = 1 + p.size();
      for (std::size_t c = 0; c < data.columns.size(); ++c) {
        if (data.columns[c].error != ErrorModel::lognormal) continue;
        for (std::size_t i = c * width; i < values.numbers.size(); i += data.columns.size() * width)
          if (!(values.numbers[i] > 0))
            return invalid_input(
                fmt::format("{}: {} has lognormal errors, but is {} in the run from the starting values",
                            data.measurements.file, data.columns[c].quantity, values.numbers[i]));
      }
      continue;
    }
    diagnostics = run.diagnostics;
    if (!diagnostics.empty()) return invalid_input("the model cannot be run");
    if (!run.status && !run.has_no_derivative())
      run.status.message = "the run from the starting values fails: " + run.status.message;
    if (!run.status) return run.status;
    return invalid_input(fmt::format("{}:{}: the run from the starting values ends at t = {}, before the data do",
                                     data.measurements.file, data.measurements.lines.back(), run.outcome.t));
  }
  for (const FitUnknown& unknown : request.unknowns)
    if (unknown.prior && unknown.prior->kind == FitPrior::Kind::lognormal && !unknown.logarithmic)
      return {
          .ending = Ending::not_finite,
          .message = "the runs give no finite numbers, or an unknown with a lognormal prior does not start above 0"};
  return {.ending = Ending::not_finite, .message = "the runs give no finite numbers"};
}

/// A failure where no derivative says how the quantities depend on the unknowns; a success where places alone are
/// measured, or nothing meets.
Status jump_of(const FitProblem& problem, const model::Model& model, std::span<const double> p) {
  for (std::size_t part = 0; part < problem.parts().size(); ++part) {
    const std::string name = problem.parts()[part].jumping_quantity();
    SensitivityRun run;
    if (name.empty() || !problem.values(part, p, problem.parts()[part].times(), &run).good) continue;
    if (model::collisions_of(*model.world, run.row(run.rows() - 1).first(run.states)) > 0)
      return invalid_input(
          fmt::format("`{}` jumps where bodies meet, at instants that the unknowns move: it cannot be fitted; "
                      "measured places can",
                      name));
  }
  return {};
}

/// A failure where a measurement lies before the model's start, or behind its end where conditions stand there.
Status outside(const FitRequest& request, double start) {
  const model::Model& model = request.program->model;
  for (const FitData& data : request.data) {
    const results::Measurements& measured = data.measurements;
    const double end = runs::kind_of(model).has_start ? std::numeric_limits<double>::infinity()
                                                      : request.experiment.to.value_or(model.run.to->value);
    for (std::size_t i = 0; i < measured.times.size(); ++i) {
      const double t = measured.times[i];
      if (t < start)
        return invalid_input(fmt::format("{}:{}: the time {} is before the model's start at {}", measured.file,
                                         measured.lines[i], t, start));
      if (t > end)
        return invalid_input(fmt::format("{}:{}: the time {} is behind the model's end at {}", measured.file,
                                         measured.lines[i], t, end));
    }
  }
  return {};
}

/// Sizes of values and of their deviations: the squares of their quotients are numbers then.
constexpr double least_size = 1e-60, greatest_size = 1e60;

bool is_beyond_numbers(double size) {
  return size > greatest_size || size < least_size;
}

/// A failure where a column of the data is so large or small that sums of its squares would be no numbers.
/// Of deviations each must be within, of values the largest.
Status beyond_numbers(const results::Measurements& measured, std::size_t column, bool each) {
  const auto& values = measured.values[column];
  std::size_t largest = values.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    if (largest == values.size() || std::abs(values[i]) > std::abs(values[largest]) ||
        (each && is_beyond_numbers(values[i])))
      largest = i;
    if (each && is_beyond_numbers(values[i])) break;
  }
  if (largest == values.size() || values[largest] == 0 || !is_beyond_numbers(std::abs(values[largest]))) return {};
  return invalid_input(fmt::format("{}:{}: {} in column `{}` is too {} to be squared: give it in another unit",
                                   measured.file, measured.lines[largest], values[largest], measured.columns[column],
                                   std::abs(values[largest]) < 1 ? "small" : "large"));
}

Status beyond_numbers(const FitRequest& request) {
  const auto deviation_beyond = [](const std::string& of_what, double deviation, std::string_view option) {
    return invalid_input(fmt::format("{}: a deviation of {} is too {} to be squared ({})", of_what, deviation,
                                     deviation < 1 ? "small" : "large", option));
  };
  for (const FitData& data : request.data)
    for (const FitColumn& column : data.columns) {
      Status status = beyond_numbers(data.measurements, column.column, false);
      if (status && column.deviations_in) status = beyond_numbers(data.measurements, *column.deviations_in, true);
      if (!status) return status;
      for (const auto& deviation : {column.deviation, column.relative})
        if (deviation && is_beyond_numbers(*deviation))
          return deviation_beyond(data.measurements.file + ": " + column.quantity, *deviation, "--sigma");
    }
  for (const FitUnknown& unknown : request.unknowns) {
    if (!unknown.prior) continue;
    const std::string name = name_of(request.program->model, unknown.influence);
    if (!(std::abs(unknown.prior->center) <= greatest_size))
      return invalid_input(
          fmt::format("{}: a prior about {} is too far away to be squared (--prior)", name, unknown.prior->center));
    if (is_beyond_numbers(unknown.prior->deviation)) return deviation_beyond(name, unknown.prior->deviation, "--prior");
  }
  return {};
}

/// A failure where the noise of a measured value makes that value impossible.
Status impossible_value(const FitRequest& request) {
  for (const FitData& data : request.data) {
    for (const FitColumn& column : data.columns) {
      for (std::size_t i = 0; i < data.measurements.times.size(); ++i) {
        const double value = data.measurements.values[column.column][i];
        if (std::isnan(value)) continue;
        const auto line = [&](std::string_view what) {
          return invalid_input(fmt::format("{}:{}: {}", data.measurements.file, data.measurements.lines[i], what));
        };
        if (column.error == ErrorModel::lognormal && !(value > 0))
          return line(fmt::format("{} in column `{}` cannot have a lognormal error: only positive numbers can", value,
                                  data.measurements.columns[column.column]));
        if (column.error == ErrorModel::poisson && value < 0)
          return line(fmt::format("{} in column `{}` is no count", value, data.measurements.columns[column.column]));
        if (!column.deviations_in || data.measurements.values[*column.deviations_in][i] > 0) continue;
        return line(fmt::format("the deviation in column `{}` must be a positive number",
                                data.measurements.columns[*column.deviations_in]));
      }
    }
  }
  return {};
}

/// What of derivatives is to be believed: the runs' tolerance, with some air.
double accuracy_of(const FitRequest& request) {
  return runs::kind_of(request.program->model).has_exact_derivatives ? 10 * greatest_rtol_of_fit : 1e-6;
}

std::vector<FitEstimate> estimates_of(const FitRequest& request, const FitProblem& problem, const Fit& fit) {
  std::vector<FitEstimate> estimates;
  const std::size_t m = fit.least.p.size();
  for (std::size_t u = 0; u < m; ++u) {
    const double p = fit.least.p[u], deviation = std::sqrt(fit.sure.covariance[u * (m + 1)]);
    FitEstimate estimate{.value = problem.from_search(u, p),
                         .degrees = fit.sure.degrees[u],
                         .at_bound = fit.least.at_bound[u] != 0,
                         .undetermined = fit.sure.undetermined[u] != 0};
    const double factor = fit.sure.factors[u];
    const double width = estimate.at_bound ? 0 : std::isfinite(factor) ? factor * deviation : factor;
    estimate.deviation = request.unknowns[u].logarithmic ? estimate.value * deviation : deviation;
    estimate.low = problem.from_search(u, p - width);
    estimate.high = problem.from_search(u, p + width);
    estimates.push_back(estimate);
  }
  return estimates;
}

void judge(const FitRequest& request, const FitProblem& problem, bool settled, Fit& fit) {
  std::vector<double> sizes;
  for (std::size_t u = 0; u < fit.least.p.size(); ++u)
    sizes.push_back(request.unknowns[u].logarithmic ? 1 : fit.least.p[u]);
  const std::vector<double> off = problem.raw(fit.least.residuals, 1),
                            slopes = problem.raw(fit.least.rows, fit.least.p.size());
  fit.sure = detail::uncertainty_of(problem.noise(), off, slopes, fit.least, request.options.loss, sizes,
                                    accuracy_of(request), request.likelihood);
  fit.noise = problem.noise();
  fit.estimates = estimates_of(request, problem, fit);
  fit.columns = detail::column_results(request, problem, fit);
  fit.statistics = detail::statistics_of(request, problem, fit);
  fit.doubts = detail::doubts_of(request, fit);
  if (!settled && !fit.least.interrupted)
    fit.doubts.push_back({FitDoubt::Kind::weights,
                          "the deviations of the columns did not settle: fit and deviations "
                          "change each other without end; give some of them (--sigma)"});
}

/// One search after the other, from the start and, where its end is doubtful, from other places.
class Fitting {
 public:
  Fitting(const FitRequest& request, FitProblem& problem) : request_(request), problem_(problem) {}

  void fit_from(std::span<const double> start, Fit& result) {
    search_from(start, request_.options.starts, problem_, result);
    if (!result.found() || result.least.interrupted || request_.options.starts > 1 || request_.starts_in_doubt == 0)
      return;
    // Where there are no derivatives every end is judged by its slopes, and where meetings change with the start,
    // chance would be searched.
    if (result.doubts.empty() || !runs::kind_of(request_.program->model).has_exact_derivatives) return;
    FitProblem problem(request_);
    Fit other;
    search_from(start, 1 + request_.starts_in_doubt, problem, other);
    const std::size_t iterations = result.least.iterations + other.least.iterations;
    const std::size_t evaluations = result.least.evaluations + other.least.evaluations;
    const std::size_t done = other.least.starts_done, agreeing = other.least.starts_agreeing;
    constexpr double clearly = 1e-4;  // of chi squared: no interval sees less
    const double gain = !other.found() || other.least.interrupted
                            ? -std::numeric_limits<double>::infinity()
                            : detail::badness(problem_, result.least) - detail::badness(problem, other.least);
    const bool better =
        other.least.converged == result.least.converged ? gain > clearly : other.least.converged && gain > -clearly;
    if (better) {
      problem_.take_noise(problem.noise());
      result = std::move(other);
      result.doubts.insert(result.doubts.begin(),
                           {FitDoubt::Kind::better_start,
                            fmt::format("the search from the start did not end at the best minimum; this one came from "
                                        "another of {} starts",
                                        done)});
    } else {
      result.least.interrupted = other.least.interrupted;
      result.least.starts_done = done;
      result.least.starts_agreeing = agreeing;
    }
    result.least.iterations = iterations;
    result.least.evaluations = evaluations;
  }

 private:
  void search_from(std::span<const double> start, std::size_t starts, FitProblem& problem, Fit& result) {
    FitSearch search(request_, problem);
    result.least = search.from(start, starts);
    if (result.least.found) judge(request_, problem, search.settled(), result);
  }

  const FitRequest& request_;
  FitProblem& problem_;
};

}  // namespace

std::vector<std::string> quantities_of(const model::Model& model) {
  std::vector<std::string> names;
  for (const model::State& state : model.states) names.push_back(state.column);
  for (const auto* list : {&model.outputs, &model.lets, &model.energies})
    for (const model::Quantity& quantity : *list) names.push_back(quantity.name);
  return names;
}

Fit fit(const FitRequest& request) {
  Fit result;
  const model::Model& model = request.program->model;
  std::vector<Influence> influences;
  for (const FitUnknown& unknown : request.unknowns) influences.push_back(unknown.influence);
  if (auto refused = no_sensitivity(model, influences)) {
    result.diagnostics.push_back(std::move(*refused));
    result.status = invalid_input("the model cannot be fitted");
    return result;
  }
  const std::vector<double> variables =
      model::start_values(model, request.experiment.parameters, request.experiment.from);
  result.status = outside(request, variables[0]);
  if (result.status) result.status = impossible_value(request);
  if (result.status) result.status = beyond_numbers(request);
  if (!result.status) return result;
  FitProblem problem(request);
  std::vector<double> start;
  for (std::size_t u = 0; u < request.unknowns.size(); ++u) {
    const FitUnknown& unknown = request.unknowns[u];
    const std::uint32_t variable = unknown.influence.kind == Influence::Kind::initial
                                       ? model.states[unknown.influence.index].variable
                                       : model.parameters[unknown.influence.index].variable;
    const double value = std::clamp(unknown.start.value_or(variables[variable]), unknown.low, unknown.high);
    if (unknown.logarithmic && !(value > 0)) {
      result.status = invalid_input(fmt::format("{} starts at {}: only what is positive has a logarithm",
                                                name_of(model, unknown.influence), value));
      return result;
    }
    start.push_back(problem.to_search(u, value));
  }
  if (problem.size() < start.size()) {
    result.status = invalid_input(fmt::format("{}: {} measured values cannot determine {} unknowns",
                                              request.data.front().measurements.file, problem.size(), start.size()));
    return result;
  }
  const bool by_differences = !runs::kind_of(model).has_exact_derivatives;
  if (by_differences) result.status = jump_of(problem, model, start);
  if (!result.status) return result;
  Fitting(request, problem).fit_from(start, result);
  result.runs = result.least.evaluations * request.data.size();
  if (!result.found()) {
    result.status = result.least.interrupted
                        ? Status{.ending = Ending::interrupted, .message = "interrupted before anything was found"}
                        : failure_at_start(request, problem, start, result.diagnostics);
    return result;
  }
  if (!by_differences || result.least.interrupted) return result;
  std::vector<std::string> names;
  for (const Influence& influence : influences) names.push_back(name_of(model, influence));
  LeastSquares least = problem.least_squares(result.least.p);
  result.status = detail::judge_slopes(
      least, request.options, names, [&](const std::vector<double>& increments) { problem.set_increments(increments); },
      result.least);
  result.runs = result.least.evaluations * request.data.size();
  if (result.status) {
    std::vector<FitDoubt> doubts = std::move(result.doubts);
    judge(request, problem, true, result);
    result.doubts = std::move(doubts);
  } else {
    result.least.found = false;
  }
  return result;
}

}  // namespace continuo::studies
