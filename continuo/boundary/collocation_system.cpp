// The equations of collocation, their matrix, and Newton's iteration with it.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <continuo/boundary/collocation_system.hpp>
#include <continuo/numerics/central_difference.hpp>
#include <continuo/numerics/finite.hpp>

namespace continuo::boundary {

namespace {

constexpr std::size_t stages = lobatto4.stages;

/// The parabola through the values at the last three points of an interval, at its first point; by symmetry also that
/// through the first three in reverse, at its last.
constexpr std::array<double, stages> end_by_others = [] {
  std::array<double, stages> weights{};
  for (std::size_t j = 1; j < stages; ++j) {
    weights[j] = 1;
    for (std::size_t k = 1; k < stages; ++k)
      if (k != j) weights[j] *= (lobatto4.c[0] - lobatto4.c[k]) / (lobatto4.c[j] - lobatto4.c[k]);
  }
  return weights;
}();

/// The places of a block that may differ from zero: those of the pattern, all where there is none.
std::vector<MatrixPlace> block_places(const BoundaryValueProblem& problem) {
  std::vector<MatrixPlace> places;
  const std::size_t n = problem.system.size;
  if (problem.system.pattern.size() == 0) {
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = 0; j < n; ++j) places.push_back({i, j});
    return places;
  }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::size_t e = problem.system.pattern.begin(j); e < problem.system.pattern.end(j); ++e)
      places.push_back({static_cast<std::uint32_t>(problem.system.pattern.row(e)), j});
  return places;
}

}  // namespace

CollocationSystem::CollocationSystem(const BoundaryValueProblem& problem, std::span<const double> mesh, OpenEnds open)
    : problem_(problem),
      n_(problem.system.size),
      m_(problem.system.parameters()),
      mesh_(mesh.begin(), mesh.end()),
      open_(open) {
  const std::size_t unknowns = point_count() * n_ + m_;
  for (std::vector<double>* list : {&z_, &trial_, &residuals_, &correction_, &simplified_}) list->assign(unknowns, 0.0);
  f_.assign(point_count() * n_, 0.0);
  for (const double t : problem.times) {
    const auto found = std::ranges::lower_bound(mesh_, t);
    condition_points_.push_back(per_interval * static_cast<std::size_t>(found - mesh_.begin()));
  }
  condition_places_ = problem.condition_places;
  const std::size_t columns = condition_points_.size() * n_ + m_;
  if (condition_places_.empty()) {
    for (std::uint32_t i = 0; i < n_ + m_; ++i)
      for (std::uint32_t j = 0; j < columns; ++j) condition_places_.push_back({i, j});
  }
  condition_values_.resize(condition_places_.size());
  gathered_.resize(condition_points_.size() * n_);
  moved_.resize(std::max(n_, columns));
  moved_slope_.resize(n_ + m_);
  make_pattern();
}

double CollocationSystem::time(std::size_t point) const {
  const std::size_t k = std::min(point / per_interval, intervals() - 1);
  const std::size_t i = point - k * per_interval;
  return i == per_interval ? mesh_[k + 1] : mesh_[k] + table.c[i] * (mesh_[k + 1] - mesh_[k]);
}

/// The pattern, and for every number that `fill_matrix` adds, in its order, the entry it is added to.
void CollocationSystem::make_pattern() {
  const std::vector<MatrixPlace>& block = block_ = block_places(problem_);
  std::vector<MatrixPlace> places;
  const auto n = static_cast<std::uint32_t>(n_), m = static_cast<std::uint32_t>(m_);
  const auto constants = static_cast<std::uint32_t>(point_count()) * n;
  for (const MatrixPlace& place : condition_places_) {
    const std::size_t at = place.column / n_;
    const std::uint32_t column = at < condition_points_.size()
                                     ? static_cast<std::uint32_t>(condition_points_[at]) * n + place.column % n
                                     : constants + place.column - static_cast<std::uint32_t>(gathered_.size());
    places.push_back({place.row < n ? place.row : constants + place.row - n, column});
  }
  for (std::uint32_t k = 0; k < intervals(); ++k) {
    const std::uint32_t first = k * static_cast<std::uint32_t>(per_interval);
    for (std::uint32_t i = 1; i < stages; ++i) {
      const std::uint32_t row = (first + i) * n;
      for (std::uint32_t c = 0; c < n; ++c) places.push_back({row + c, row + c});
      for (std::uint32_t c = 0; c < n; ++c) places.push_back({row + c, first * n + c});
      for (std::uint32_t j = 0; j < stages; ++j)
        for (const MatrixPlace& at : block) places.push_back({row + at.row, (first + j) * n + at.column});
      for (std::uint32_t c = 0; c < n; ++c)
        for (std::uint32_t p = 0; p < m; ++p) places.push_back({row + c, constants + p});
    }
  }
  const SparsePattern pattern(point_count() * n_ + m_, places);
  slots_.clear();
  slots_.reserve(places.size());
  for (const MatrixPlace& place : places)
    slots_.push_back(static_cast<std::uint32_t>(pattern.find(place.row, place.column)));
  jacobians_.resize(point_count() * block.size());
  constant_jacobians_.resize(point_count() * n_ * m_);
  lu_.emplace(pattern);
}

void CollocationSystem::evaluate_slopes(std::span<const double> z) {
  for (std::size_t q = 0; q < point_count(); ++q)
    if (!is_open(q))
      problem_.system.derivative(time(q), z.subspan(q * n_, n_), constants_of(z), std::span(f_).subspan(q * n_, n_));
  evaluations_ += point_count();
  const std::size_t last = point_count() - 1;
  for (std::size_t c = 0; c < n_; ++c) {
    double at_first = 0, at_last = 0;
    for (std::size_t j = 1; j < stages; ++j) {
      at_first += end_by_others[j] * f_[j * n_ + c];
      at_last += end_by_others[j] * f_[(last - j) * n_ + c];
    }
    if (open_.first) f_[c] = at_first;
    if (open_.last) f_[last * n_ + c] = at_last;
  }
}

/// a_ij of an interval, where the slope at an open end is made of the others.
double CollocationSystem::weight(std::size_t interval, std::size_t i, std::size_t j) const {
  double weight = table.a[i][j];
  if (open_.first && interval == 0) weight = j == 0 ? 0 : weight + table.a[i][0] * end_by_others[j];
  if (open_.last && interval + 1 == intervals())
    weight = j + 1 == stages ? 0 : weight + table.a[i][stages - 1] * end_by_others[stages - 1 - j];
  return weight;
}

std::span<const double> CollocationSystem::gather(std::span<const double> z) {
  for (std::size_t at = 0; at < condition_points_.size(); ++at)
    std::ranges::copy(z.subspan(condition_points_[at] * n_, n_),
                      gathered_.begin() + static_cast<std::ptrdiff_t>(at * n_));
  return gathered_;
}

void CollocationSystem::evaluate_residuals(std::span<const double> z, std::span<double> residuals) {
  evaluate_slopes(z);
  problem_.conditions(gather(z), constants_of(z), moved_slope_);
  std::copy_n(moved_slope_.begin(), n_, residuals.begin());
  std::copy_n(moved_slope_.begin() + static_cast<std::ptrdiff_t>(n_), m_,
              residuals.end() - static_cast<std::ptrdiff_t>(m_));
  for (std::size_t k = 0; k < intervals(); ++k) {
    const std::size_t first = k * per_interval;
    const double h = mesh_[k + 1] - mesh_[k];
    for (std::size_t i = 1; i < stages; ++i) {
      for (std::size_t c = 0; c < n_; ++c) {
        double sum = 0;
        for (std::size_t j = 0; j < stages; ++j) sum += table.a[i][j] * f_[(first + j) * n_ + c];
        const std::size_t row = (first + i) * n_ + c;
        residuals[row] = z[row] - z[first * n_ + c] - h * sum;
      }
    }
  }
}

void CollocationSystem::evaluate_jacobians() {
  const std::size_t entries = jacobians_.size() / point_count();
  const auto constants = constants_of(z_);
  for (std::size_t q = 0; q < point_count(); ++q) {
    if (is_open(q)) continue;  // its entries stay zero
    const double t = time(q);
    const auto x = point(q);
    const auto block = std::span(jacobians_).subspan(q * entries, entries);
    if (problem_.system.jacobian) problem_.system.jacobian(t, x, constants, block);
    // y^1.5 has a derivative at 0 that its formula does not give.
    const bool is_given = problem_.system.jacobian != nullptr && all_finite(block);
    if (!is_given) difference_jacobian(q, block);
    for (std::size_t p = 0; p < m_; ++p) {
      std::vector<double> moved(constants.begin(), constants.end());
      const double increment = difference_increment(constants[p], 1e-8);
      moved[p] += increment;
      const auto slope = std::span(moved_slope_).first(n_);
      problem_.system.derivative(t, x, moved, slope);
      for (std::size_t i = 0; i < n_; ++i)
        constant_jacobians_[(q * n_ + i) * m_ + p] = (slope[i] - f_[q * n_ + i]) / increment;
      ++evaluations_;
    }
  }
}

void CollocationSystem::difference_jacobian(std::size_t q, std::span<double> block) {
  const auto moved = std::span(moved_).first(n_), slope = std::span(moved_slope_).first(n_);
  std::ranges::copy(point(q), moved.begin());
  for (std::size_t j = 0; j < n_; ++j) {
    const double here = moved[j], increment = difference_increment(here, 1e-3 * std::sqrt(2.2e-16) * scales_[j]);
    moved[j] = here + increment;
    problem_.system.derivative(time(q), moved, constants_of(z_), slope);
    moved[j] = here;
    for (std::size_t e = 0; e < block.size(); ++e)
      if (block_[e].column == j) block[e] = (slope[block_[e].row] - f_[q * n_ + block_[e].row]) / increment;
  }
  evaluations_ += n_;
}

/// By central differences, which are exact but for rounding where a condition is linear.
void CollocationSystem::evaluate_condition_jacobian() {
  std::vector<double> x(gather(z_).begin(), gather(z_).end()),
      constants(constants_of(z_).begin(), constants_of(z_).end());
  std::vector<double> residuals(n_ + m_);
  const std::size_t columns = x.size() + m_;
  std::vector<std::vector<std::size_t>> of_column(columns);
  for (std::size_t e = 0; e < condition_places_.size(); ++e) of_column[condition_places_[e].column].push_back(e);
  for (std::size_t j = 0; j < columns; ++j) {
    if (of_column[j].empty()) continue;
    double& value = j < x.size() ? x[j] : constants[j - x.size()];
    const double increment = central_increment(value, scales_[j < x.size() ? j % n_ : n_ + j - x.size()]);
    const auto [above, below] = on_both_sides(value, increment, [&] {
      problem_.conditions(x, constants, residuals);
      return residuals;
    });
    for (const std::size_t e : of_column[j]) {
      const std::size_t row = condition_places_[e].row;
      condition_values_[e] = (above[row] - below[row]) / (2 * increment);
    }
  }
}

void CollocationSystem::fill_matrix() {
  const auto values = lu_->values();
  std::ranges::fill(values, 0.0);
  auto slot = slots_.begin();
  for (const double value : condition_values_) values[*slot++] += value;
  const std::size_t entries = jacobians_.size() / point_count();
  for (std::size_t k = 0; k < intervals(); ++k) {
    const std::size_t first = k * per_interval;
    const double h = mesh_[k + 1] - mesh_[k];
    for (std::size_t i = 1; i < stages; ++i) {
      for (std::size_t c = 0; c < n_; ++c) values[*slot++] += 1;
      for (std::size_t c = 0; c < n_; ++c) values[*slot++] -= 1;
      for (std::size_t j = 0; j < stages; ++j) {
        const double of_block = h * weight(k, i, j);
        const double* block = jacobians_.data() + (first + j) * entries;
        for (std::size_t e = 0; e < entries; ++e) values[*slot++] -= of_block * block[e];
      }
      for (std::size_t c = 0; c < n_; ++c) {
        for (std::size_t p = 0; p < m_; ++p) {
          double sum = 0;
          for (std::size_t j = 0; j < stages; ++j)
            sum += weight(k, i, j) * constant_jacobians_[((first + j) * n_ + c) * m_ + p];
          values[*slot++] -= h * sum;
        }
      }
    }
  }
}

/// How large each component is over the interval, each constant: what corrections are measured by.
void CollocationSystem::measure() {
  scales_.assign(n_ + m_, 0.0);
  for (std::size_t i = 0; i < point_count() * n_; ++i) scales_[i % n_] = std::max(scales_[i % n_], std::abs(z_[i]));
  for (std::size_t p = 0; p < m_; ++p) scales_[n_ + p] = std::abs(constants()[p]);
  for (double& scale : scales_) scale = scale > 1e-3 ? scale : 1;
}

double CollocationSystem::size_of(std::span<const double> correction) {
  double sum = 0, greatest = 0;
  const std::size_t of_points = point_count() * n_;
  for (std::size_t i = 0; i < correction.size(); ++i) {
    const std::size_t component = i < of_points ? i % n_ : n_ + i - of_points;
    const double part = std::abs(correction[i]) / scales_[component];
    if (part > greatest) greatest = part, worst_ = component;
    sum += part * part;
  }
  return std::sqrt(sum / static_cast<double>(correction.size()));
}

std::vector<double> CollocationSystem::magnitudes(std::span<const double> z) {
  std::vector<double> result(z.size());
  const auto at_times = gather(z), constants = constants_of(z);
  const std::size_t columns = gathered_.size();
  for (std::size_t e = 0; e < condition_places_.size(); ++e) {
    const MatrixPlace& place = condition_places_[e];
    const double x = place.column < columns ? at_times[place.column] : constants[place.column - columns];
    result[place.row < n_ ? place.row : point_count() * n_ + place.row - n_] += std::abs(condition_values_[e] * x);
  }
  const std::vector<MatrixPlace>& block = block_;
  std::vector<double> slopes(f_.size());  // sizes of the terms of f at each point
  for (std::size_t q = 0; q < point_count(); ++q)
    for (std::size_t e = 0; e < block.size(); ++e)
      slopes[q * n_ + block[e].row] += std::abs(jacobians_[q * block.size() + e] * z[q * n_ + block[e].column]);
  for (std::size_t i = 0; i < slopes.size(); ++i) slopes[i] = std::max(slopes[i], std::abs(f_[i]));
  for (std::size_t k = 0; k < intervals(); ++k) {
    const std::size_t first = k * per_interval;
    const double h = mesh_[k + 1] - mesh_[k];
    for (std::size_t i = 1; i < stages; ++i)
      for (std::size_t c = 0; c < n_; ++c) {
        double sum = 0;
        for (std::size_t j = 0; j < stages; ++j) sum += std::abs(weight(k, i, j)) * slopes[(first + j) * n_ + c];
        const std::size_t row = (first + i) * n_ + c;
        result[row] = std::abs(z[row]) + h * sum;
      }
  }
  return result;
}

/// Newton's iteration, damped so that the correction that the same matrix gives at the new place is smaller than the
/// one before: P. Deuflhard, "Newton Methods for Nonlinear Problems" (2004), 3.3, the natural monotonicity test.
NewtonEnding CollocationSystem::iterate(double target, const BoundaryValueOptions& options) {
  constexpr double held_by_rounding = 1e-7;
  double last = 0;
  bool is_first = true;
  measure();
  evaluate_residuals(z_, residuals_);
  const auto correct = [&]() -> NewtonCorrection {
    if (options.interrupt && options.interrupt->load()) return NewtonEnding::interrupted;
    ++iterations_;
    evaluate_jacobians();
    evaluate_condition_jacobian();
    fill_matrix();
    if (!all_finite(lu_->values())) return NewtonEnding::not_finite;
    factored_ = lu_->factor();
    if (!factored_) return NewtonEnding::singular;
    std::ranges::copy(residuals_, correction_.begin());
    lu_->solve(correction_.data());
    last = size_of(correction_);
    if (!std::isfinite(last)) return is_first ? NewtonEnding::not_finite : NewtonEnding::singular;
    is_first = false;
    return last;
  };
  const auto attempt = [&](double part, double size) {
    for (std::size_t i = 0; i < z_.size(); ++i) trial_[i] = z_[i] - part * correction_[i];
    evaluate_residuals(trial_, residuals_);
    const bool is_small = size <= target && part == 1;
    if (!is_small) {
      std::ranges::copy(residuals_, simplified_.begin());
      lu_->solve(simplified_.data());
      const double next = size_of(simplified_);
      if (!(next <= (1 - part / 4) * size)) return NewtonAttempt::refused;
      if (next <= target && part == 1) {  // the better of the two, as it is there
        for (std::size_t i = 0; i < z_.size(); ++i) trial_[i] -= simplified_[i];
        evaluate_residuals(trial_, residuals_);
        z_.swap(trial_);
        return NewtonAttempt::solved;
      }
    }
    z_.swap(trial_);
    if (is_small) return NewtonAttempt::solved;
    measure();
    return NewtonAttempt::taken;
  };
  const NewtonEnding ending =
      damped_newton({.most_iterations = options.most_iterations, .least_damping = 1e-4, .recovery = 4}, correct,
                    attempt)
          .ending;
  if (ending == NewtonEnding::no_descent) evaluate_slopes(z_);
  if (ending != NewtonEnding::no_descent && ending != NewtonEnding::too_many) return ending;
  // Close to a solution corrections fall with their square; here rounding holds them, which the error tells.
  if (last > held_by_rounding || !options.check_error) return ending;
  held_at_ = last;
  return NewtonEnding::converged;
}

}  // namespace continuo::boundary
