#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include <continuo/model/world.hpp>
#include <continuo/studies/fit.hpp>
#include <continuo/studies/fit_of_world.hpp>
#include <continuo/studies/sensitivity.hpp>
#include <continuo/studies/student_t.hpp>

namespace continuo::studies {

namespace {

/// A quantity, where it is no state, as a node.
std::optional<model::NodeId> quantity_node(const model::Model& model, const std::string& name) {
  for (const auto* list : {&model.outputs, &model.lets, &model.energies})
    for (const model::Quantity& quantity : *list)
      if (quantity.name == name) return quantity.node;
  return std::nullopt;
}

/// One set of measurements and the model's runs along it.
class Part {
 public:
  Part(const FitRequest& request, const FitData& data)
      : request_(request), data_(data), study_(request.program, influences(request), fixed(request, data)) {
    const model::Model& model = request.program->model;
    std::vector<model::NodeId> nodes;
    for (const FitColumn& column : data.columns) {
      states_.push_back(model::find_state(model, column.quantity));
      places_.push_back(nodes.size());
      if (states_.back() == model::npos) nodes.push_back(*quantity_node(model, column.quantity));
    }
    quantities_ = nodes.size();
    if (!nodes.empty()) along_ = study_.along(nodes);
    for (const double t : data.measurements.times)
      if (times_.empty() || t != times_.back()) times_.push_back(t);
  }

  static model::Overrides fixed(const FitRequest& request, const FitData& data) {
    model::Overrides parameters = request.experiment.parameters;
    for (const auto& [name, value] : data.parameters) parameters[name] = value;
    return parameters;
  }

  static std::vector<Influence> influences(const FitRequest& request) {
    std::vector<Influence> list;
    for (const FitUnknown& unknown : request.unknowns) list.push_back(unknown.influence);
    return list;
  }

  /// The values of every column, then their derivatives by the unknowns, at each of `times`.
  struct Values {
    std::vector<double> times;
    std::vector<double> numbers;
    bool good = false;
  };
  Values at(std::span<const double> p, const std::vector<double>& times, SensitivityRun* whole = nullptr) const {
    const model::Model& model = request_.program->model;
    SensitivityRequest request{.experiment = request_.experiment, .times = times};
    request.experiment.parameters = fixed(request_, data_);
    // Conditions at several times need the whole interval.
    if (!model.needs_boundary_solver()) request.experiment.to = times.back();
    if (!model.has_world())  // whose own tolerance is strict enough
      request.experiment.rtol = std::min(
          request_.experiment.rtol.value_or(model.run.rtol.value_or(greatest_rtol_of_fit)), greatest_rtol_of_fit);
    request.increments = increments_;
    for (std::size_t u = 0; u < p.size(); ++u) {
      const Influence& influence = request_.unknowns[u].influence;
      if (influence.kind == Influence::Kind::initial) {
        request.initial.emplace_back(influence.index, p[u]);
      } else {
        request.experiment.parameters[model.parameters[influence.index].name] = p[u];
      }
    }
    SensitivityRun run = study_.run(request);
    Values values;
    values.good = run.good() && run.rows() == times.size();
    if (values.good) {
      values.times = run.times;
      const std::vector<double> others = along_ ? along_(run) : std::vector<double>();
      const std::size_t width = 1 + p.size();
      for (std::size_t row = 0; row < run.rows(); ++row) {
        for (std::size_t c = 0; c < states_.size(); ++c) {
          for (std::size_t k = 0; k < width; ++k)
            values.numbers.push_back(states_[c] == model::npos ? others[(row * quantities_ + places_[c]) * width + k]
                                                               : run.row(row)[run.states * k + states_[c]]);
        }
      }
    }
    if (whole != nullptr) *whole = std::move(run);
    return values;
  }

  const std::vector<double>& times() const { return times_; }
  const FitData& data() const { return data_; }
  /// Of a world.
  void set_increments(std::vector<double> increments) { increments_ = std::move(increments); }
  /// A quantity that jumps at impacts; empty: none.
  std::string jumping_quantity() const {
    const model::Model& model = request_.program->model;
    for (std::size_t c = 0; c < states_.size(); ++c) {
      const std::string& name = data_.columns[c].quantity;
      if (detail::jumps_at_impacts(model, states_[c] == model::npos
                                              ? model::variables_of(model.graph, *quantity_node(model, name))
                                              : std::vector{model.states[states_[c]].variable}))
        return name;
    }
    return {};
  }

 private:
  const FitRequest& request_;
  const FitData& data_;
  SensitivityStudy study_;
  std::vector<std::size_t> states_, places_;
  std::size_t quantities_ = 0;
  SensitivityStudy::Along along_;
  std::vector<double> times_, increments_;
};

/// A measured value: its row among the run's, its column, and the scale that makes its residual a number.
struct Measured {
  std::size_t part, row, column, scale;
  double value;
};

class Problem {
 public:
  explicit Problem(const FitRequest& request) : unknowns_(request.unknowns.size()) {
    for (const FitData& data : request.data) parts_.emplace_back(request, data);
    std::size_t scale = 0;
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      const Measurements& measurements = request.data[part].measurements;
      for (std::size_t c = 0; c < request.data[part].columns.size(); ++c, ++scale) {
        const FitColumn& column = request.data[part].columns[c];
        scales_.push_back(column.deviation.value_or(1));
        known_.push_back(column.deviation.has_value());
        quantities_.push_back(column.quantity);
        std::size_t row = 0;
        for (std::size_t i = 0; i < measurements.times.size(); ++i) {
          if (i > 0 && measurements.times[i] != measurements.times[i - 1]) ++row;
          const double value = measurements.values[column.column][i];
          if (!std::isnan(value)) measured_.push_back({part, row, c, scale, value});
        }
      }
    }
  }

  bool evaluate(std::span<const double> p, std::span<double> residuals, std::span<double> rows) {
    values_.clear();
    for (const Part& part : parts_) {
      values_.push_back(part.at(p, part.times()));
      if (!values_.back().good) return false;
    }
    for (std::size_t r = 0; r < measured_.size(); ++r) {
      const Measured& measured = measured_[r];
      const std::size_t width = 1 + unknowns_, columns = parts_[measured.part].data().columns.size();
      const double* number = &values_[measured.part].numbers[(measured.row * columns + measured.column) * width];
      residuals[r] = (number[0] - measured.value) / scales_[measured.scale];
      for (std::size_t u = 0; u < unknowns_ && !rows.empty(); ++u)
        rows[r * unknowns_ + u] = number[1 + u] / scales_[measured.scale];
    }
    return true;
  }

  std::size_t size() const { return measured_.size(); }
  const std::vector<double>& scales() const { return scales_; }
  std::vector<double>& scales() { return scales_; }
  bool all_known() const {
    return std::ranges::all_of(known_, [](bool known) { return known; });
  }
  /// Residuals of different quantities have different deviations, some of them unknown.
  bool several_unknown() const {
    std::set<std::string> groups;
    for (std::size_t s = 0; s < known_.size(); ++s) groups.insert(known_[s] ? "" : quantities_[s]);
    return groups.size() > 1;
  }

  /// Scales of unknown deviations: from the spread of the values, or from the residuals of the fit before. Columns of
  /// one quantity have one scale.
  void estimate_scales(std::span<const double> residuals) {
    for (std::size_t s = 0; s < scales_.size(); ++s) {
      if (known_[s]) continue;
      double sum = 0, mean = 0, count = 0;
      const auto mine = [&](const Measured& m) { return !known_[m.scale] && quantities_[m.scale] == quantities_[s]; };
      for (const Measured& m : measured_)
        if (mine(m)) mean += m.value, count += 1;
      mean /= count;
      for (std::size_t r = 0; r < measured_.size(); ++r) {
        if (!mine(measured_[r])) continue;
        const double off = residuals.empty() ? measured_[r].value - mean : residuals[r];
        sum += off * off;
      }
      // A few values that happen to be met well would draw all weight to themselves.
      constexpr double fewest = 10;
      if (!residuals.empty() && count < fewest + static_cast<double>(unknowns_)) return;
      pending_.resize(scales_.size());
      pending_[s] = std::sqrt(sum / count) * (residuals.empty() ? 1 : scales_[s]);
    }
    for (std::size_t s = 0; s < scales_.size(); ++s)
      if (!known_[s] && pending_[s] > 0) scales_[s] = pending_[s];
  }
  const std::vector<Part>& parts() const { return parts_; }
  void set_increments(const std::vector<double>& increments) {
    for (Part& part : parts_) part.set_increments(increments);
  }

 private:
  std::size_t unknowns_;
  std::vector<Part> parts_;
  std::vector<Measured> measured_;
  std::vector<double> scales_, pending_;
  std::vector<bool> known_;
  std::vector<std::string> quantities_;
  std::vector<Part::Values> values_;
};

/// Why the run at p has no rows to compare: said once, at the start.
std::string why_not(const Problem& problem, std::span<const double> p, std::vector<model::Diagnostic>& diagnostics) {
  for (const Part& part : problem.parts()) {
    SensitivityRun run;
    if (part.at(p, part.times(), &run).good) continue;
    diagnostics = run.diagnostics;
    if (!diagnostics.empty()) return "the model cannot be run";
    if (!run.problem.empty()) return run.problem;
    if (!succeeded(run.outcome.ending)) return "the run from the starting values fails: " + describe(run.outcome);
    const Measurements& data = part.data().measurements;
    return fmt::format("{}:{}: the run from the starting values ends at t = {}, before the data do", data.file,
                       data.lines.back(), run.outcome.t);
  }
  return "the runs give no finite numbers";
}

/// Why no derivative says how the quantities depend on the unknowns; empty: places alone are measured, or nothing
/// meets.
std::string jump_of(const Problem& problem, const model::Model& model, std::span<const double> p) {
  for (const Part& part : problem.parts()) {
    const std::string name = part.jumping_quantity();
    SensitivityRun run;
    if (name.empty() || !part.at(p, part.times(), &run).good) continue;
    if (model::collisions_of(*model.world, run.row(run.rows() - 1).first(run.states)) > 0)
      return fmt::format(
          "`{}` jumps where bodies meet, at instants that the unknowns move: it cannot be fitted; "
          "measured places can",
          name);
  }
  return {};
}

/// Which measurement lies before the model's start, or behind its end where conditions stand there; empty: none.
std::string outside(const FitRequest& request, double start) {
  const model::Model& model = request.program->model;
  for (const FitData& data : request.data) {
    const Measurements& measured = data.measurements;
    const double end = model.needs_boundary_solver() ? request.experiment.to.value_or(model.run.to->value)
                                                     : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < measured.times.size(); ++i) {
      const double t = measured.times[i];
      if (t < start)
        return fmt::format("{}:{}: the time {} is before the model's start at {}", measured.file, measured.lines[i], t,
                           start);
      if (t > end)
        return fmt::format("{}:{}: the time {} is behind the model's end at {}", measured.file, measured.lines[i], t,
                           end);
    }
  }
  return {};
}

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
  std::vector<Influence> influences = Part::influences(request);
  if (auto refused = no_sensitivity(model, influences)) {
    result.diagnostics.push_back(std::move(*refused));
    result.problem = "the model cannot be fitted";
    return result;
  }
  const std::vector<double> variables =
      model::start_values(model, request.experiment.parameters, request.experiment.from);
  result.problem = outside(request, variables[0]);
  if (!result.problem.empty()) return result;
  Problem problem(request);
  LeastSquares least;
  for (const FitUnknown& unknown : request.unknowns) {
    const std::uint32_t variable = unknown.influence.kind == Influence::Kind::initial
                                       ? model.states[unknown.influence.index].variable
                                       : model.parameters[unknown.influence.index].variable;
    least.start.push_back(std::clamp(unknown.start.value_or(variables[variable]), unknown.low, unknown.high));
    least.low.push_back(unknown.low);
    least.high.push_back(unknown.high);
  }
  least.residuals = problem.size();
  if (least.residuals < least.start.size()) {
    result.problem = fmt::format("{}: {} measured values cannot determine {} unknowns",
                                 request.data.front().measurements.file, least.residuals, least.start.size());
    return result;
  }
  least.evaluate = [&](std::span<const double> p, std::span<double> r, std::span<double> rows) {
    return problem.evaluate(p, r, rows);
  };
  if (model.has_world()) result.problem = jump_of(problem, model, least.start);
  if (!result.problem.empty()) return result;
  if (problem.several_unknown()) problem.estimate_scales({});
  LeastSquaresOptions options = request.options;
  options.known_deviation = problem.all_known();
  result.least = least_squares(least, options);
  // Where deviations differ from column to column they come from the residuals, and the fit once more from them.
  const auto goes_on = [&] { return result.least.found && !result.least.interrupted && problem.several_unknown(); };
  for (int round = 0; round < 2 && goes_on(); ++round) {
    problem.estimate_scales(result.least.residuals);
    least.start = result.least.p;
    options.starts = 1;
    LeastSquaresResult before = std::move(result.least);
    result.least = least_squares(least, options);
    if (!result.least.found && result.least.interrupted) {  // before its first iteration
      result.least = std::move(before);
      result.least.interrupted = true;
      break;
    }
    result.least.starts_done = before.starts_done;
    result.least.starts_agreeing = before.starts_agreeing;
    result.least.iterations += before.iterations;
    result.least.evaluations += before.evaluations;
  }
  if (!result.least.found) {
    if (!result.least.interrupted) result.problem = why_not(problem, least.start, result.diagnostics);
    return result;
  }
  if (model.has_world() && !result.least.interrupted) {
    std::vector<std::string> names;
    for (const Influence& influence : influences) names.push_back(name_of(model, influence));
    result.problem = detail::judge_slopes(
        least, options, names, [&](const std::vector<double>& increments) { problem.set_increments(increments); },
        result.least);
    if (!result.problem.empty()) {
      result.least.found = false;
      return result;
    }
  }
  for (const double scale : problem.scales()) result.scales.push_back(scale * result.least.residual_deviation);
  result.confidence_factor = options.known_deviation ? student_t_quantile(0.95, 1e9)
                             : result.least.degrees > 0
                                 ? student_t_quantile(0.95, static_cast<double>(result.least.degrees))
                                 : std::numeric_limits<double>::infinity();
  return result;
}

std::vector<FitCurve> curves_of(const FitRequest& request, const Fit& fit, std::size_t points) {
  std::vector<FitCurve> curves;
  const std::size_t m = fit.least.p.size();
  const double from =
      model::start_values(request.program->model, request.experiment.parameters, request.experiment.from)[0];
  std::size_t scale = 0;
  for (std::size_t d = 0; d < request.data.size(); ++d) {
    const Part part(request, request.data[d]);
    const double to = part.times().back();
    std::vector<double> times;
    for (std::size_t i = 0; i < points; ++i)
      times.push_back(i + 1 == points ? to
                                      : from + (to - from) * static_cast<double>(i) / static_cast<double>(points - 1));
    const auto values = part.at(fit.least.p, times);
    for (std::size_t c = 0; c < request.data[d].columns.size(); ++c, ++scale) {
      FitCurve curve{.data = d, .column = c, .t = values.times, .y = {}, .half_width = {}};
      for (std::size_t row = 0; row < values.times.size(); ++row) {
        const double* number = &values.numbers[(row * request.data[d].columns.size() + c) * (1 + m)];
        double variance = fit.scales[scale] * fit.scales[scale];
        for (std::size_t i = 0; i < m; ++i)
          for (std::size_t j = 0; j < m; ++j)
            variance += number[1 + i] * fit.least.covariance[i * m + j] * number[1 + j];
        curve.y.push_back(number[0]);
        curve.half_width.push_back(fit.confidence_factor * std::sqrt(variance));
      }
      curves.push_back(std::move(curve));
    }
  }
  return curves;
}

}  // namespace continuo::studies
