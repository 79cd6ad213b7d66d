// Runs a model along its measurements, and computes residuals and their derivatives.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <continuo/runs/kind.hpp>
#include <continuo/studies/fit/fit_of_world.hpp>
#include <continuo/studies/fit/fit_problem.hpp>

namespace continuo::studies::detail {

namespace {

model::Overrides parameters_of(const FitRequest& request, const FitData& data) {
  model::Overrides parameters = request.experiment.parameters;
  for (const auto& [name, value] : data.parameters) parameters[name] = value;
  return parameters;
}

std::vector<Influence> influences_of(const FitRequest& request) {
  std::vector<Influence> list;
  for (const FitUnknown& unknown : request.unknowns) list.push_back(unknown.influence);
  return list;
}

}  // namespace

std::optional<model::NodeId> quantity_node(const model::Model& model, const std::string& name) {
  for (const auto* list : {&model.outputs, &model.lets, &model.energies})
    for (const model::Quantity& quantity : *list)
      if (quantity.name == name) return quantity.node;
  return std::nullopt;
}

FitPart::FitPart(const FitRequest& request, const FitData& data)
    : request_(request), data_(data), study_(request.program, influences_of(request), parameters_of(request, data)) {
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

FitPart::Values FitPart::at(std::span<const double> unknowns, const std::vector<double>& times,
                            const std::vector<double>& increments, SensitivityRun* whole) const {
  const model::Model& model = request_.program->model;
  SensitivityRequest request{.experiment = request_.experiment, .times = times};
  request.experiment.parameters = parameters_of(request_, data_);
  // Conditions at several times need the whole interval.
  const runs::Kind kind = runs::kind_of(model);
  if (kind.has_start) request.experiment.to = times.back();
  if (kind.has_exact_derivatives)  // the own tolerance of bodies is strict enough
    request.experiment.rtol = std::min(request_.experiment.rtol.value_or(model.run.rtol.value_or(greatest_rtol_of_fit)),
                                       greatest_rtol_of_fit);
  request.increments = increments;
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    const Influence& influence = request_.unknowns[u].influence;
    if (influence.kind == Influence::Kind::initial) {
      request.initial.emplace_back(influence.index, unknowns[u]);
    } else {
      request.experiment.parameters[model.parameters[influence.index].name] = unknowns[u];
    }
  }
  SensitivityRun run = study_.run(request);
  Values values;
  values.good = run.good() && run.rows() == times.size();
  if (values.good) {
    values.times = run.times;
    const std::vector<double> others = along_ ? along_(run) : std::vector<double>();
    const std::size_t width = 1 + unknowns.size();
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

std::string FitPart::jumping_quantity() const {
  const model::Model& model = request_.program->model;
  for (std::size_t c = 0; c < states_.size(); ++c) {
    const std::string& name = data_.columns[c].quantity;
    if (jumps_at_impacts(model, states_[c] == model::npos
                                    ? model::variables_of(model.graph, *quantity_node(model, name))
                                    : std::vector{model.states[states_[c]].variable}))
      return name;
  }
  return {};
}

FitProblem::FitProblem(const FitRequest& request) : request_(request) {
  parts_.reserve(request.data.size());
  for (const FitData& data : request.data) {
    parts_.emplace_back(request, data);
    for (const FitColumn& column : data.columns) add_column(data, column);
  }
  add_components();
  for (std::size_t u = 0; u < request.unknowns.size(); ++u) {
    if (!request.unknowns[u].prior) continue;
    const FitPrior& prior = *request.unknowns[u].prior;
    priors_.push_back({u, prior});
    noise_.components.push_back({.variance = prior.deviation * prior.deviation, .known = true});
    noise_.rows.push_back({.shares = {{{noise_.components.size() - 1, 1}, {0, 0}}}, .group = prior_group});
  }
  take_deviations();
}

void FitProblem::add_column(const FitData& data, const FitColumn& column) {
  const results::Measurements& measurements = data.measurements;
  Column added{.column = &column, .components = {0, 0}};
  std::size_t row = 0;
  for (std::size_t i = 0; i < measurements.times.size(); ++i) {
    if (i > 0 && measurements.times[i] != measurements.times[i - 1]) ++row;
    const double value = measurements.values[column.column][i];
    if (std::isnan(value)) continue;
    const double deviation = column.deviations_in ? measurements.values[*column.deviations_in][i] : 1;
    const auto place = static_cast<std::size_t>(&column - data.columns.data());
    measured_.push_back({parts_.size() - 1, row, place, columns_.size(), value, deviation});
    added.largest = std::max(added.largest, std::abs(value));
  }
  columns_.push_back(added);
}

// Before anything was fitted deviations are taken from the spread of the values, which gives each column its say.
void FitProblem::add_components() {
  noise_.groups = columns_.size();
  std::vector<double> count(columns_.size(), 0), mean(columns_.size(), 0), spread(columns_.size(), 0);
  for (const Measured& m : measured_) mean[m.group] += m.value, count[m.group] += 1;
  for (const Measured& m : measured_)
    spread[m.group] += std::pow(m.value - mean[m.group] / count[m.group], 2) / count[m.group];
  std::map<std::string, std::size_t> shared;  // by quantity, or all that are short
  std::map<std::string, double> largest;      // of a quantity
  for (const Column& column : columns_)
    largest[column.column->quantity] = std::max(largest[column.column->quantity], column.largest);
  for (std::size_t g = 0; g < columns_.size(); ++g) {
    const FitColumn& column = *columns_[g].column;
    const bool is_relative = column.error == ErrorModel::proportional || column.error == ErrorModel::lognormal;
    const bool known =
        column.deviations_in || column.error == ErrorModel::poisson ||
        (column.error == ErrorModel::proportional ? column.relative.has_value() : column.deviation.has_value());
    const bool both = column.error == ErrorModel::both && !column.deviations_in;
    const double given =
        column.error == ErrorModel::proportional ? column.relative.value_or(1) : column.deviation.value_or(1);
    const double size = spread[g] > 0 ? spread[g] : columns_[g].largest > 0 ? std::pow(columns_[g].largest, 2) : 1;
    const bool is_short = count[g] < static_cast<double>(fewest_of_own_deviation);
    const bool takes_part = !known && !both && count[g] > 0 && (request_.one_deviation || is_short);
    const std::string pool =
        fmt::format("{} {}", static_cast<int>(column.error), request_.one_deviation ? column.quantity : std::string());
    // Short columns of several quantities are taken to be off by the same part of their largest values.
    const double unit = largest[column.quantity] > 0 ? largest[column.quantity] : 1;
    if (takes_part && !is_relative && !request_.one_deviation) columns_[g].pooled = unit * unit;
    const auto other = shared.find(pool);
    if (takes_part && other != shared.end()) {
      columns_[g].components[0] = columns_[g].components[1] = other->second;
      continue;
    }
    columns_[g].components[0] = columns_[g].components[1] = noise_.components.size();
    if (takes_part) shared[pool] = noise_.components.size();
    // The digits of the runs end there.
    constexpr double least = 1e-20;
    noise_.components.push_back(
        {.variance = known         ? (column.deviations_in || column.error == ErrorModel::poisson ? 1 : given * given)
                     : is_relative ? 1
                     : columns_[g].pooled != 1 ? size / columns_[g].pooled
                                               : size,
         .known = known,
         .least = least * (is_relative ? 1 : size / columns_[g].pooled)});
    if (!both) continue;
    columns_[g].components[1] = noise_.components.size();
    noise_.components.push_back({.variance = column.relative ? *column.relative * *column.relative : 1,
                                 .known = column.relative.has_value(),
                                 .least = least});
  }
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    noise_.rows.push_back({.group = measured_[i].group});
    // A value of zero does not mean that the model will say zero.
    constexpr double smallest = 0.03;
    const double size = std::max(std::abs(measured_[i].value), smallest * columns_[measured_[i].group].largest);
    shape(i, size);
  }
}

void FitProblem::shape(std::size_t measured, double value) {
  const Measured& m = measured_[measured];
  const Column& column = columns_[m.group];
  constexpr double smallest = 1e-6;  // of the largest value: weights stay finite where the model comes through zero
  const double size = std::max(std::abs(value), smallest * (column.largest > 0 ? column.largest : 1));
  auto& shares = noise_.rows[measured].shares;
  shares = {{{column.components[0], column.pooled}, {column.components[0], 0}}};
  if (column.column->deviations_in) {
    shares[0].factor = m.deviation * m.deviation;
  } else if (column.column->error == ErrorModel::proportional) {
    shares[0].factor = size * size;
  } else if (column.column->error == ErrorModel::poisson) {
    shares[0].factor = size;
  } else if (column.column->error == ErrorModel::both) {
    shares[1] = {column.components[1], size * size};
  }
}

void FitProblem::take_deviations() {
  deviations_.clear();
  for (std::size_t r = 0; r < noise_.rows.size(); ++r) deviations_.push_back(std::sqrt(noise_.variance(r)));
}

double FitProblem::update_noise(std::span<const double> residuals, std::span<const double> rows, Loss loss) {
  const std::vector<double> before = deviations_, off = raw(residuals, 1), slopes = raw(rows, request_.unknowns.size());
  const std::size_t width = request_.unknowns.size();
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    shape(i, fitted(i, off[i]));
    // A start that was copied from the model, as the first row of many files, was not measured.
    constexpr double digits = 1e-12;
    const auto begin = slopes.begin() + static_cast<std::ptrdiff_t>(i * width);
    const bool is_fixed =
        std::all_of(begin, begin + static_cast<std::ptrdiff_t>(width), [](double x) { return x == 0; });
    noise_.rows[i].counts = !(is_fixed && std::abs(off[i]) <= digits * std::abs(measured_[i].value));
  }
  estimate_variances(noise_, off, slopes, loss, request_.likelihood);
  take_deviations();
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t r = 0; r < before.size(); ++r) {
    const double change = std::log(deviations_[r] / before[r]);
    least = std::min(least, change), most = std::max(most, change);
  }
  const bool free = loss == Loss::squares && std::ranges::none_of(noise_.components, &VarianceComponent::known);
  return free ? most - least : std::max(std::abs(most), std::abs(least));
}

std::vector<double> FitProblem::raw(std::span<const double> over_deviations, std::size_t width) const {
  std::vector<double> result(over_deviations.begin(), over_deviations.end());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] *= deviations_[i / width];
  return result;
}

double FitProblem::fitted(std::size_t measured, double raw_residual) const {
  const Measured& m = measured_[measured];
  return columns_[m.group].column->error == ErrorModel::lognormal ? m.value * std::exp(raw_residual)
                                                                  : m.value + raw_residual;
}

std::vector<double> FitProblem::noise_variances() const {
  std::vector<double> variances;
  for (const VarianceComponent& component : noise_.components) variances.push_back(component.variance);
  return variances;
}

double FitProblem::deviation_at(std::size_t group, double value, std::span<const double> variances) const {
  const Column& column = columns_[group];
  if (column.column->deviations_in) {  // as large as those that were given, in the mean
    double sum = 0, count = 0;
    for (const Measured& m : measured_)
      if (m.group == group) sum += m.deviation * m.deviation, count += 1;
    return std::sqrt(sum / count);
  }
  const double first = variances[column.components[0]] * column.pooled;
  switch (column.column->error) {
    case ErrorModel::constant:
    case ErrorModel::lognormal:
      break;
    case ErrorModel::proportional:
      return std::sqrt(first) * std::abs(value);
    case ErrorModel::poisson:
      return std::sqrt(first * std::abs(value));
    case ErrorModel::both:
      return std::sqrt(first + variances[column.components[1]] * value * value);
  }
  return std::sqrt(first);
}

double FitProblem::to_search(std::size_t unknown, double value) const {
  return request_.unknowns[unknown].logarithmic ? std::log(value) : value;
}
double FitProblem::from_search(std::size_t unknown, double p) const {
  return request_.unknowns[unknown].logarithmic ? std::exp(p) : p;
}
std::vector<double> FitProblem::from_search(std::span<const double> p) const {
  std::vector<double> values;
  for (std::size_t u = 0; u < p.size(); ++u) values.push_back(from_search(u, p[u]));
  return values;
}

FitPart::Values FitProblem::values(std::size_t part, std::span<const double> p, const std::vector<double>& times,
                                   SensitivityRun* whole) const {
  const std::vector<double> unknowns = from_search(p);
  std::vector<double> increments = increments_;
  for (std::size_t u = 0; u < increments.size(); ++u)
    if (request_.unknowns[u].logarithmic) increments[u] *= unknowns[u];
  FitPart::Values values = parts_[part].at(unknowns, times, increments, whole);
  const std::size_t width = 1 + p.size();
  for (std::size_t u = 0; u < p.size(); ++u)
    if (request_.unknowns[u].logarithmic)
      for (std::size_t i = 1 + u; i < values.numbers.size(); i += width) values.numbers[i] *= unknowns[u];
  return values;
}

bool FitProblem::prior_residual(const PriorRow& row, double p, double& residual, double& slope) const {
  const bool logarithmic = request_.unknowns[row.unknown].logarithmic;
  const double value = from_search(row.unknown, p);
  if (row.prior.kind == FitPrior::Kind::normal) {
    residual = value - row.prior.center;
    slope = logarithmic ? value : 1;
    return true;
  }
  if (!(value > 0)) return false;
  residual = std::log(value / row.prior.center);
  slope = logarithmic ? 1 : 1 / value;
  return true;
}

bool FitProblem::evaluate(std::span<const double> p, std::span<double> residuals, std::span<double> rows) {
  values_.clear();
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    values_.push_back(values(part, p, parts_[part].times()));
    if (!values_.back().good) return false;
  }
  const std::size_t unknowns = p.size(), width = 1 + unknowns;
  for (std::size_t r = 0; r < measured_.size(); ++r) {
    const Measured& m = measured_[r];
    const std::size_t columns = parts_[m.part].data().columns.size();
    const double* number = &values_[m.part].numbers[(m.row * columns + m.column) * width];
    double residual = number[0] - m.value, slope = 1;
    if (columns_[m.group].column->error == ErrorModel::lognormal) {
      if (!(number[0] > 0)) return false;
      residual = std::log(number[0] / m.value);
      slope = 1 / number[0];
    }
    residuals[r] = residual / deviations_[r];
    for (std::size_t u = 0; u < unknowns && !rows.empty(); ++u)
      rows[r * unknowns + u] = slope * number[1 + u] / deviations_[r];
  }
  for (std::size_t k = 0; k < priors_.size(); ++k) {
    const std::size_t r = measured_.size() + k;
    double residual = 0, slope = 0;
    if (!prior_residual(priors_[k], p[priors_[k].unknown], residual, slope)) return false;
    residuals[r] = residual / deviations_[r];
    for (std::size_t u = 0; u < unknowns && !rows.empty(); ++u)
      rows[r * unknowns + u] = u == priors_[k].unknown ? slope / deviations_[r] : 0;
  }
  return true;
}

LeastSquares FitProblem::least_squares(std::span<const double> start) {
  LeastSquares least{.start = {start.begin(), start.end()}, .residuals = size()};
  for (std::size_t u = 0; u < request_.unknowns.size(); ++u) {
    const FitUnknown& unknown = request_.unknowns[u];
    least.low.push_back(unknown.logarithmic && !(unknown.low > 0) ? -INFINITY : to_search(u, unknown.low));
    least.high.push_back(to_search(u, unknown.high));
  }
  least.evaluate = [this](std::span<const double> p, std::span<double> r, std::span<double> rows) {
    return evaluate(p, r, rows);
  };
  return least;
}

}  // namespace continuo::studies::detail
