// Newton's method on the return of a motion, with steps cut off in weak directions.
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include <continuo/numerics/newton_iteration.hpp>
#include <continuo/studies/orbits/hybrid/shooting.hpp>

namespace continuo::studies::detail {

namespace {

constexpr double longest_step = 1;  // in sizes of the motion
constexpr double relative_noise = 1e-10;

Eigen::Index row_of(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

/// The smallest step that the matrix takes to -residual, but for directions that it hardly moves.
Eigen::VectorXd smallest_step(const Shot& shot, double cut) {
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(shot.matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  svd.setThreshold(cut);
  return svd.solve(-shot.residual);
}

}  // namespace

Shooting::Shooting(const ReturnFlow& flow, std::vector<std::size_t> unknowns, std::vector<std::size_t> held,
                   std::vector<double> sizes, bool forced, ShootingPoint from)
    : flow_(flow),
      unknowns_(std::move(unknowns)),
      held_(std::move(held)),
      sizes_(std::move(sizes)),
      forced_(forced),
      from_(std::move(from)) {
  if (forced_) return;
  const std::vector<double> rates = flow_.rates(from_.start);
  phase_.resize(row_of(unknowns_.size()));
  for (std::size_t k = 0; k < unknowns_.size(); ++k) phase_[row_of(k)] = rates[unknowns_[k]] / sizes_[unknowns_[k]];
  phase_.normalize();
}

std::optional<Shot> Shooting::shoot(const ShootingPoint& point) {
  Shot shot{.image = flow_(point.start, point.period), .residual = {}, .matrix = {}};
  const FlowImage& image = shot.image;
  interrupted_ = interrupted_ || image.status.ending == Ending::interrupted;
  if (!image.status) {
    status_ = image.status;
    return std::nullopt;
  }
  const bool comes_back = image.mode == point.start.mode &&
                          std::ranges::all_of(held_, [&](std::size_t i) { return image.x[i] == point.start.x[i]; });
  if (!comes_back) {
    status_ = {.ending = Ending::nonlinear_solve_failed, .message = "a mode, a flag or a counter does not come back"};
    return std::nullopt;
  }
  const std::size_t n = unknowns_.size(), size = n + (forced_ ? 0 : 1);
  shot.residual.setZero(row_of(size));
  shot.matrix.setZero(row_of(size), row_of(size));
  model::Instant end = point.start;
  end.x = image.x;
  end.t += point.period;
  const std::vector<double> rates = flow_.rates(end);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = unknowns_[k];
    shot.residual[row_of(k)] = (image.x[i] - point.start.x[i]) / sizes_[i];
    for (std::size_t l = 0; l < n; ++l)
      shot.matrix(row_of(k), row_of(l)) =
          image.by_start[i * flow_.size() + unknowns_[l]] * sizes_[unknowns_[l]] / sizes_[i] - (k == l ? 1 : 0);
    if (forced_) continue;
    shot.matrix(row_of(k), row_of(n)) = rates[i] / sizes_[i] * from_.period;
    shot.matrix(row_of(n), row_of(k)) = phase_[row_of(k)];
    shot.residual[row_of(n)] += phase_[row_of(k)] * (point.start.x[i] - from_.start.x[i]) / sizes_[i];
  }
  if (shot.residual.allFinite() && shot.matrix.allFinite()) return shot;
  status_ = {.ending = Ending::not_finite, .message = "the derivative of the motion is not finite"};
  return std::nullopt;
}

ShootingPoint Shooting::moved(ShootingPoint point, const Eigen::VectorXd& step) const {
  for (std::size_t k = 0; k < unknowns_.size(); ++k)
    point.start.x[unknowns_[k]] += step[row_of(k)] * sizes_[unknowns_[k]];
  if (!forced_) point.period += step[row_of(unknowns_.size())] * from_.period;
  return point;
}

double Shooting::distance(const ShootingPoint& a, const ShootingPoint& b) const {
  double most = std::abs(a.period - b.period) / from_.period;
  for (const std::size_t i : unknowns_) most = std::max(most, std::abs(a.start.x[i] - b.start.x[i]) / sizes_[i]);
  return most;
}

std::optional<ShootingPoint> Shooting::solve(ShootingPoint point, double cut, double tolerance) {
  std::optional<Shot> shot = shoot(point);
  Eigen::VectorXd step;
  double now = 0;
  bool last = false;
  const auto correct = [&]() -> NewtonCorrection {
    step = smallest_step(*shot, cut);
    const double length = step.lpNorm<Eigen::Infinity>();
    if (!(length <= 1 / cut)) return NewtonEnding::diverged;
    if (length > longest_step) step *= longest_step / length;
    now = shot->residual.norm();
    // The flow is off by a few times its tolerance, which neighbours that part make larger.
    last = length <= tolerance && now <= 10 * tolerance + relative_noise * shot->matrix.norm();
    return length;
  };
  const auto attempt = [&](double part, double) {
    ShootingPoint there = moved(point, part * step);
    if (interrupted_ || !(there.period > 0.2 * from_.period && there.period < 5 * from_.period))
      return NewtonAttempt::refused;
    std::optional<Shot> next = shoot(there);
    const bool is_better = next && next->residual.norm() < now;
    if (!next || !(last || is_better)) return NewtonAttempt::refused;
    if (is_better) point = std::move(there), shot = std::move(next);
    return last ? NewtonAttempt::solved : NewtonAttempt::taken;
  };
  if (shot) {
    constexpr DampedNewtonLimits limits{.most_iterations = 40, .least_damping = 0x1p-7};
    const NewtonOutcome outcome = damped_newton(limits, correct, attempt);
    // Where rounding keeps the residual from falling, the point is as good as it can be.
    if (outcome || (last && outcome.ending == NewtonEnding::no_descent)) return point;
  }
  if (status_) status_ = {.ending = Ending::nonlinear_solve_failed, .message = "Newton's method does not converge"};
  return std::nullopt;
}

}  // namespace continuo::studies::detail
