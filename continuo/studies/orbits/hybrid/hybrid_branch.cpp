// Predictor and corrector on a branch of closed orbits through events.
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <continuo/numerics/newton_iteration.hpp>
#include <continuo/studies/orbits/hybrid/hybrid_branch.hpp>
#include <continuo/studies/orbits/hybrid/orbit_trace.hpp>
#include <continuo/studies/orbits/hybrid/return_multipliers.hpp>
#include <continuo/studies/support/forcing_period.hpp>
#include <continuo/studies/support/hybrid_run.hpp>
#include <continuo/studies/support/state_roles.hpp>

namespace continuo::studies::detail {

namespace {

using Vec = Eigen::VectorXd;

constexpr double rtol_of_returns = 1e-12;
constexpr NewtonLimits limits_of_returns{
    .most_iterations = 12, .solved_to = 1e-9, .rounding = 1e-7, .farthest = 10, .each_is_smaller = true};  // in sizes
constexpr double near_an_event = 0.02, well_away = 2;  // of the period; so many times as far away is worth a new start

std::vector<double> sizes_between(const std::vector<double>& low, const std::vector<double>& high) {
  std::vector<double> sizes;
  for (std::size_t i = 0; i < low.size(); ++i) sizes.push_back(std::max(std::abs(low[i]), std::abs(high[i])));
  const double largest = std::ranges::max(sizes);
  for (double& size : sizes)
    if (!(size > 1e-12 * largest)) size = largest > 0 ? largest : 1;
  return sizes;
}

}  // namespace

HybridBranchSteps::HybridBranchSteps(const std::shared_ptr<const model::ModelProgram>& program,
                                     const model::Experiment& experiment, const HybridContinuationOptions& options,
                                     double period, const std::vector<double>& low, const std::vector<double>& high)
    : program_(program),
      options_(options),
      exact_(exactly(*program, experiment, rtol_of_returns)),
      name_(program->model.parameters[options.constant].name),
      range_(options.high - options.low),
      period_(period),
      sizes_(sizes_between(low, high)) {
  exact_.interrupt = options.interrupt;
  exact_.max_steps = model::usual_max_steps;
  exact_.atol.clear();
  for (const double size : sizes_) exact_.atol.push_back(rtol_of_returns * size);
  if (!options.forcing) return;
  const Forcing known = forcing_of(*program, experiment.parameters);
  if (known.period) forcing_ratio_ = std::round(*options.forcing / *known.period);
}

std::optional<double> HybridBranchSteps::forcing_at(double constant) const {
  if (!(forcing_ratio_ > 0)) return options_.forcing;
  const Forcing there = forcing_of(*program_, experiment_at(constant).parameters);
  if (!there.period) return std::nullopt;
  return forcing_ratio_ * *there.period;
}

model::Experiment HybridBranchSteps::experiment_at(double constant) const {
  model::Experiment experiment = exact_;
  experiment.parameters.insert_or_assign(name_, constant);
  return experiment;
}

bool HybridBranchSteps::begin(const model::Instant& start, double period, double constant) {
  flow_.emplace(program_, std::vector{options_.constant}, experiment_at(constant));
  flow_->set(0, constant);
  if (is_forced()) {
    const std::optional<double> forcing = forcing_at(constant);
    const double aside = 1e-6 * range_;
    const auto before = forcing_at(constant - aside), after = forcing_at(constant + aside);
    const auto about = [&](const std::optional<double>& other) {
      return other && std::abs(*other - *forcing) < 0.1 * *forcing;
    };
    if (!forcing || !about(before) || !about(after)) {
      status_ = {.ending = Ending::cannot_continue,
                 .message = fmt::format("the time-dependent terms have no common period beside {} = {:.10g}", name_,
                                        constant)};
      return false;
    }
    turns_ = std::round(period / *forcing);
  }
  const FlowImage image = (*flow_)(start, period);
  status_ = image.status;
  if (!image.status) return false;
  for (const std::size_t i : directions_of(*program_)) {
    const bool comes_back = std::abs(image.x[i] - start.x[i]) <= 0.01 * sizes_[i];
    if (!is_unread(*program_, i) || comes_back) directions_.push_back(i);
  }
  for (std::size_t i = 0; i < sizes_.size(); ++i)
    if (is_discrete(*program_, i) && !is_unread(*program_, i)) held_.push_back(i);
  if (directions_.empty())
    status_ = {.ending = Ending::cannot_continue,
               .message = "no state has neighbours: all of them are flags and counters"};
  return succeeded(status_.ending);
}

Vec HybridBranchSteps::scaled(const model::Instant& start, double period, double constant) const {
  std::vector<double> direction;
  for (const std::size_t i : directions_) direction.push_back(start.x[i]);
  direction.push_back(period);
  direction.push_back(constant);
  return scaled_direction(direction);
}

Vec HybridBranchSteps::scaled_direction(const std::vector<double>& direction) const {
  Vec z(unknowns());
  Eigen::Index k = 0;
  for (; k < static_cast<Eigen::Index>(directions_.size()); ++k)
    z[k] = direction[static_cast<std::size_t>(k)] / sizes_[directions_[static_cast<std::size_t>(k)]];
  if (!is_forced()) z[k] = direction[directions_.size()] / period_;
  z[z.size() - 1] = direction.back() / range_;
  return z;
}

std::vector<double> HybridBranchSteps::unscaled_direction(const Vec& direction) const {
  std::vector<double> result;
  for (std::size_t k = 0; k < directions_.size(); ++k)
    result.push_back(direction[static_cast<Eigen::Index>(k)] * sizes_[directions_[k]]);
  result.push_back(is_forced() ? 0 : direction[direction.size() - 2] * period_);
  result.push_back(direction[direction.size() - 1] * range_);
  return result;
}

double HybridBranchSteps::period_of(const Vec& z) const {
  if (!is_forced()) return z[z.size() - 2] * period_;
  return turns_ * forcing_at(constant_of(z)).value_or(*options_.forcing);
}

model::Instant HybridBranchSteps::instant(const model::Instant& start, const Vec& z) const {
  model::Instant there(start);
  for (std::size_t k = 0; k < directions_.size(); ++k)
    there.x[directions_[k]] = z[static_cast<Eigen::Index>(k)] * sizes_[directions_[k]];
  return there;
}

/// x' where the orbit begins, of length 1 in sizes: a shift along the orbit.
Vec HybridBranchSteps::shift_at(const model::Instant& start, const Vec& z) {
  Vec shift = Vec::Zero(unknowns());
  if (is_forced()) return shift;
  flow_->set(0, constant_of(z));
  const std::vector<double> rates = flow_->rates(instant(start, z));
  for (std::size_t k = 0; k < directions_.size(); ++k)
    shift[static_cast<Eigen::Index>(k)] = rates[directions_[k]] / sizes_[directions_[k]];
  if (shift.norm() > 0) shift.normalize();
  return shift;
}

std::optional<HybridBranchSteps::Equations> HybridBranchSteps::evaluate(const model::Instant& start, const Vec& z,
                                                                        const Vec& reference, const Vec& shift) {
  const double constant = constant_of(z);
  double period = is_forced() ? 0 : z[z.size() - 2] * period_, period_by = 0;
  if (is_forced()) {
    const double aside = 1e-6 * range_;
    const auto here = forcing_at(constant), before = forcing_at(constant - aside), after = forcing_at(constant + aside);
    if (!here || !before || !after || std::abs(*after - *before) > 0.1 * *here) {
      status_ = {
          .ending = Ending::cannot_continue,
          .message = fmt::format("the time-dependent terms have no common period at {} = {:.10g}", name_, constant)};
      return std::nullopt;
    }
    period = turns_ * *here;
    period_by = turns_ * (*after - *before) / (2 * aside);
  }
  if (!(period > 0)) return std::nullopt;
  flow_->set(0, constant);
  const model::Instant begin = instant(start, z);
  Equations equations{.image = (*flow_)(begin, period), .residual = {}, .rows = {}};
  const FlowImage& image = equations.image;
  if (!image.run.events.empty() || image.status) last_events_ = image.run.events;
  status_ = image.status;
  if (!status_) return std::nullopt;
  if (image.mode != begin.mode || std::ranges::any_of(held_, [&](std::size_t i) { return image.x[i] != begin.x[i]; })) {
    status_ = {.ending = Ending::nonlinear_solve_failed, .message = "a mode, a flag or a counter does not come back"};
    return std::nullopt;
  }
  const auto n = static_cast<Eigen::Index>(directions_.size());
  const Eigen::Index size = unknowns();
  equations.residual = Vec::Zero(size - 1);
  equations.rows = Eigen::MatrixXd::Zero(size - 1, size);
  model::Instant end = begin;
  end.x = image.x;
  end.t += period;
  const std::vector<double> rates = flow_->rates(end);
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t i = directions_[static_cast<std::size_t>(k)];
    equations.residual[k] = (image.x[i] - begin.x[i]) / sizes_[i];
    for (Eigen::Index l = 0; l < n; ++l) {
      const std::size_t j = directions_[static_cast<std::size_t>(l)];
      equations.rows(k, l) = image.by_start[i * flow_->size() + j] * sizes_[j] / sizes_[i] - (k == l ? 1 : 0);
    }
    if (!is_forced()) equations.rows(k, n) = rates[i] / sizes_[i] * period_;
    equations.rows(k, size - 1) = (image.by_parameters[i] + rates[i] * period_by) / sizes_[i] * range_;
  }
  if (!is_forced()) {
    equations.residual[n] = shift.dot(z - reference);
    equations.rows.row(n) = shift.transpose();
  }
  if (equations.residual.allFinite() && equations.rows.allFinite()) return equations;
  status_ = {.ending = Ending::not_finite, .message = "the derivative of the motion is not finite"};
  return std::nullopt;
}

std::optional<Vec> HybridBranchSteps::corrected(const model::Instant& start, const Vec& guess, const Vec& reference,
                                                const Vec& last) {
  Vec z = guess;
  const Vec shift = shift_at(start, reference);
  const Eigen::Index size = unknowns();
  const auto correct = [&]() -> NewtonCorrection {
    const auto equations = evaluate(start, z, reference, shift);
    if (!equations) return NewtonEnding::not_finite;
    Eigen::MatrixXd matrix(size, size);
    matrix << equations->rows, last.transpose();
    Vec b(size);
    b << equations->residual, last.dot(z - guess);
    const Vec step = matrix.fullPivLu().solve(b);
    z -= step;
    return step.norm();
  };
  const auto is_near = [&] {
    return is_forced() || (z[size - 2] > 0.5 * guess[size - 2] && z[size - 2] < 2 * guess[size - 2]);
  };
  const NewtonOutcome outcome = newton_iteration(limits_of_returns, correct, is_near);
  if (outcome) return z;
  if (outcome.ending != NewtonEnding::not_finite)
    status_ = {.ending = Ending::nonlinear_solve_failed, .message = "Newton's method does not converge"};
  return std::nullopt;
}

std::optional<HybridPlace> HybridBranchSteps::described(const model::Instant& start, const Vec& z, const Vec& along) {
  const Vec shift = shift_at(start, z);
  const auto equations = evaluate(start, z, z, shift);
  if (!equations) return std::nullopt;
  HybridPlace place{.start = instant(start, z), .z = z};
  const Eigen::Index size = unknowns();
  Eigen::MatrixXd matrix(size, size);
  matrix << equations->rows, along.transpose();
  place.tangent = matrix.fullPivLu().solve(Vec::Unit(size, size - 1));
  if (!place.tangent.allFinite() || !(place.tangent.norm() > 0)) return std::nullopt;
  place.tangent.normalize();
  place.events = equations->image.run.events;
  OrbitPoint& point = place.point;
  point.constant = constant_of(z);
  point.period = period_of(z);
  point.x = place.start.x;
  const auto n = static_cast<Eigen::Index>(directions_.size());
  const Eigen::MatrixXd m = equations->rows.topLeftCorner(n, n) + Eigen::MatrixXd::Identity(n, n);
  point.multipliers = is_forced() ? multipliers_of_flow(m, false) : multipliers_of_flow(m, Vec(shift.head(n)), false);
  if (!is_forced() && !point.multipliers.empty())  // that of the shift
    point.multipliers.erase(
        std::ranges::min_element(point.multipliers, {}, [](const auto& value) { return std::abs(value - 1.0); }));
  point.stable = std::ranges::all_of(point.multipliers, [](const auto& value) { return std::abs(value) < 1; });
  place.noise = rtol_of_returns * m.norm();
  place.fold = place.tangent[size - 1];
  place.tests = tests_of(point.multipliers);
  return place;
}

std::optional<HybridPlace> HybridBranchSteps::across(const model::Instant& start, const Vec& z, const Vec& along) {
  const auto found = corrected(start, z, z, along);
  return found ? described(start, *found, along) : std::nullopt;
}

std::optional<HybridPlace> HybridBranchSteps::at_constant(const model::Instant& start, double period, double value) {
  return across(start, scaled(start, period, value), Vec::Unit(unknowns(), unknowns() - 1));
}

std::optional<HybridPlace> HybridBranchSteps::at_constant(const HybridPlace& a, const HybridPlace& b, double value) {
  const double part = (value - a.point.constant) / (b.point.constant - a.point.constant);
  Vec z = a.z + part * (b.z - a.z);
  z[z.size() - 1] = value / range_;
  return across(a.start, z, Vec::Unit(unknowns(), unknowns() - 1));
}

std::optional<HybridPlace> HybridBranchSteps::stepped(const HybridPlace& from, double step) {
  const Vec guess = from.z + step * from.tangent;
  const auto z = corrected(from.start, guess, from.z, from.tangent);
  if (!z) return std::nullopt;
  if ((*z - guess).norm() > step) {
    status_ = {.ending = Ending::nonlinear_solve_failed, .message = "the next orbit is farther away than the step"};
    return std::nullopt;
  }
  return described(from.start, *z, from.tangent);
}

std::optional<Vec> HybridBranchSteps::other_direction(const model::Instant& start, const Vec& z, const Vec& along) {
  const auto equations = evaluate(start, z, z, shift_at(start, z));
  if (!equations) return std::nullopt;
  Eigen::MatrixXd matrix(unknowns(), unknowns());
  matrix << equations->rows, along.transpose();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeFullV);
  return Vec(svd.matrixV().col(unknowns() - 1));
}

void HybridBranchSteps::complete(HybridPlace& place) {
  OrbitTrace trace = traced(program_, experiment_at(place.point.constant), place.start, place.point.period);
  place.point.low = std::move(trace.low);
  place.point.high = std::move(trace.high);
}

bool HybridBranchSteps::waits(const HybridPlace& place) const {
  const OrbitTrace trace = traced(program_, experiment_at(place.point.constant), place.start, place.point.period);
  const auto apart = [&](std::size_t a, std::size_t b) {
    double most = 0;
    for (const std::size_t i : directions_)
      if (const double extent = trace.high[i] - trace.low[i]; extent > 0)
        most = std::max(most, std::abs(trace.x[a][i] - trace.x[b][i]) / extent);
    return most;
  };
  std::size_t slowest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < trace.t.size(); ++k)
    if (const double step = trace.t[k] - trace.t[k - 1]; step > 0)
      if (const double speed = apart(k, k - 1) / step; speed < least) least = speed, slowest = k;
  double waited = 0;
  for (std::size_t k = 1; k < trace.t.size(); ++k)
    if (apart(k, slowest) < 0.01) waited += trace.t[k] - trace.t[k - 1];
  return waited > 0.3 * place.point.period;
}

void HybridBranchSteps::begin_anew(HybridPlace& place) {
  if (place.events.empty()) return;
  const double period = place.point.period, from = place.start.t;
  const auto distance = [&](double t) {
    double least = period;
    for (const SensitivityEvent& event : place.events) {
      const double apart = std::abs(event.t - t);
      least = std::min({least, apart, std::abs(apart - period)});
    }
    return least;
  };
  if (distance(from) > near_an_event * period) return;
  double best = from;
  constexpr int parts = 64;
  for (int k = 1; k < parts; ++k)
    if (const double t = from + period * k / parts; distance(t) > distance(best)) best = t;
  if (!(distance(best) > well_away * distance(from))) return;
  Outcome<double> outcome;
  const model::Experiment here = experiment_at(place.point.constant);
  std::optional<model::Plan> plan = plan_of(*program_, here, outcome);
  if (!plan) return;
  plan->to = best;
  HybridRun run(program_, *plan, here);
  run.go_on(place.start);
  if (!run.advance_to(best) || run.slides()) return;
  // What the tangent becomes on the way: a short piece of the branch, seen from there.
  const Vec old_tangent = place.tangent;
  flow_->set(0, place.point.constant);
  const FlowImage image = (*flow_)(place.start, best - from);
  if (!image.status) return;
  std::vector<double> old = unscaled_direction(old_tangent), moved;
  for (const std::size_t i : directions_) {
    double sum = image.by_parameters[i] * old.back();
    for (std::size_t l = 0; l < directions_.size(); ++l)
      sum += image.by_start[i * flow_->size() + directions_[l]] * old[l];
    moved.push_back(sum);
  }
  moved.push_back(old[old.size() - 2]);
  moved.push_back(old.back());
  const model::Instant start = run.instant();
  Vec along = scaled_direction(moved);
  along.normalize();
  auto again = across(start, scaled(start, period, place.point.constant), along);
  if (!again || again->events.size() != place.events.size()) return;
  if (again->tangent.dot(along) < 0) again->tangent = -again->tangent, again->fold = -again->fold;
  again->point.low = place.point.low;
  again->point.high = place.point.high;
  place = std::move(*again);
}

std::optional<Vec> HybridBranchSteps::halves(const HybridPlace& place) {
  flow_->set(0, place.point.constant);
  const FlowImage image = (*flow_)(place.start, place.point.period / 2);
  if (!image.status) return std::nullopt;
  Vec apart(static_cast<Eigen::Index>(directions_.size()));
  for (std::size_t k = 0; k < directions_.size(); ++k)
    apart[static_cast<Eigen::Index>(k)] =
        (image.x[directions_[k]] - place.start.x[directions_[k]]) / sizes_[directions_[k]];
  return apart;
}

}  // namespace continuo::studies::detail
