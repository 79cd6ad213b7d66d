// continuo/studies/equilibria/curve_steps.cpp
// Predictor and corrector on a curve of folds or Hopf points.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <continuo/numerics/central_difference.hpp>
#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/numerics/newton_iteration.hpp>
#include <continuo/studies/conservation_laws.hpp>
#include <continuo/studies/equilibria/algebraic_elimination.hpp>
#include <continuo/studies/equilibria/curve_steps.hpp>
#include <continuo/studies/equilibria/normal_form.hpp>
#include <continuo/studies/support/arclength.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;
using Complex = std::complex<double>;

constexpr double no_frequency = 1e-3;  // in parts of |A| on the plane of the pair

/// The product of the sums of all pairs, each in parts of the largest value.
double product_of_sums(const std::vector<Complex>& values) {
  double size = 0;
  for (const Complex& value : values) size = std::max(size, std::abs(value));
  Complex product = 1;
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t j = i + 1; j < values.size(); ++j) product *= (values[i] + values[j]) / size;
  return product.real();
}
double product_of(const std::vector<Complex>& values) {
  double size = 0;
  for (const Complex& value : values) size = std::max(size, std::abs(value));
  Complex product = 1;
  for (const Complex& value : values) product *= value / size;
  return product.real();
}

}  // namespace

CurveSteps::CurveSteps(const ParametricSystem& system, const CurveStart& start, const CurveOptions& options)
    : system_(system), options_(options), n_(system.size), p_(system.constants), units_(n_ + 2) {
  for (std::size_t i = 0; i < n_; ++i) units_[i] = std::max(std::abs(start.x[i]), 1.0);
  for (std::size_t k = 0; k < 2; ++k) units_[n_ + k] = options.high[k] - options.low[k];
}

Vector CurveSteps::scaled(const Vector& x, const std::array<double, 2>& constants) const {
  Vector z(x);
  z.insert(z.end(), constants.begin(), constants.end());
  for (std::size_t i = 0; i < z.size(); ++i) z[i] /= units_[i];
  return z;
}
Vector CurveSteps::state_of(const Vector& z) const {
  Vector x(n_);
  for (std::size_t i = 0; i < n_; ++i) x[i] = z[i] * units_[i];
  return x;
}
std::array<double, 2> CurveSteps::constants_of(const Vector& z) const {
  return {z[n_] * units_[n_], z[n_ + 1] * units_[n_ + 1]};
}

void CurveSteps::set(const Vector& z) {
  const auto constants = constants_of(z);
  for (std::size_t k = 0; k < 2; ++k) p_[options_.constants[k]] = constants[k];
}

Vector CurveSteps::f(const Vector& z) {
  Vector result(n_);
  set(z);
  system_.derivative(options_.t, state_of(z), p_, result);
  for (std::size_t i = 0; i < n_; ++i) result[i] /= units_[i];
  return result;
}

/// What is small of each constant: of those that move a part of their range, for their values may be zero on the way.
Vector CurveSteps::sizes_of_constants() const {
  Vector sizes(p_);
  for (double& size : sizes) size = size == 0 ? 1 : std::abs(size);
  for (std::size_t k = 0; k < 2; ++k) sizes[options_.constants[k]] = units_[n_ + k] / 100;
  return sizes;
}

/// df/dz, n rows of n + 2.
Vector CurveSteps::jacobian(const Vector& z) {
  set(z);
  const Vector x = state_of(z), by_x = jacobian_of(system_, options_.t, x, p_),
               by_p = constant_jacobian_of(system_, options_.t, x, p_, sizes_of_constants());
  Vector rows(n_ * (n_ + 2));
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j < n_; ++j) rows[i * (n_ + 2) + j] = by_x[i * n_ + j] * units_[j] / units_[i];
    for (std::size_t k = 0; k < 2; ++k)
      rows[i * (n_ + 2) + n_ + k] = by_p[i * p_.size() + options_.constants[k]] * units_[n_ + k] / units_[i];
  }
  return rows;
}

Vector CurveSteps::matrix(const Vector& z) {
  set(z);
  Vector rows = jacobian_of(system_, options_.t, state_of(z), p_);
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < n_; ++j) rows[i * n_ + j] *= units_[j] / units_[i];
  const std::size_t states = system_.differential();
  if (states == n_) return rows;
  const auto first_of_equations = static_cast<std::ptrdiff_t>(states * n_);
  return without_unknowns(std::span(rows).first(states * n_), Vector(rows.begin() + first_of_equations, rows.end()),
                          {.states = states, .unknowns = n_ - states});
}

std::optional<Vector> CurveSteps::rows_at(const Vector& z, const CriticalSpace& space) {
  Vector rows = jacobian(z), moved(z);
  for (std::size_t k = 0; k < n_ + 2; ++k) {
    const double step = increment_for_jacobians * std::max(1.0, std::abs(z[k]));
    const auto [above, below] = on_both_sides(moved[k], step, [&] { return matrix(moved); });
    if (above.size() != space.weights.size() || below.size() != above.size()) return std::nullopt;
    double sum = 0;
    for (std::size_t e = 0; e < above.size(); ++e) sum += space.weights[e] * (above[e] - below[e]);
    rows.push_back(sum / (2 * step));
  }
  return rows;
}

std::optional<CurveSteps::Found> CurveSteps::corrected(const Vector& guess, const CriticalSpace& near,
                                                       const Vector& last) {
  Vector z(guess);
  CriticalSpace reference(near), latest;
  const auto space_at = [&]() -> std::optional<CriticalSpace> {
    const Vector a = matrix(z);
    return a.empty() ? std::nullopt : continued_space(a, matrix_size(), reference);
  };
  const auto correct = [&]() -> NewtonCorrection {
    auto space = space_at();
    auto rows = space ? rows_at(z, *space) : std::nullopt;
    if (!rows) return NewtonEnding::singular;
    Vector b = f(z);
    b.push_back(space->test);
    b.push_back(0);
    for (std::size_t i = 0; i < z.size(); ++i) b.back() += (z[i] - guess[i]) * last[i];
    rows->insert(rows->end(), last.begin(), last.end());
    const Vector step = solution_of(*rows, std::move(b));
    if (step.empty()) return NewtonEnding::singular;
    double size = 0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      z[i] -= step[i];
      size = std::max(size, std::abs(step[i]) / std::max(1.0, std::abs(z[i])));
    }
    // A fold's test depends on its border, which stays; the plane of a pair is looked for from the last one.
    latest = std::move(*space);
    if (near.dimension == 2) reference = latest;
    return size;
  };
  constexpr NewtonLimits limits{.most_iterations = 12, .solved_to = 1e-13, .rounding = 1e-8, .farthest = 1e3};
  if (!newton_iteration(limits, correct)) return std::nullopt;
  reference = std::move(latest);
  auto space = space_at();
  return space ? std::optional(Found{std::move(z), std::move(*space)}) : std::nullopt;
}

// On the curve w . (f_p p' + f_q q') = 0 with w the left null vector of df/dx: the direction is s (-w . f_q, w . f_p),
// and s goes through zero where both constants keep still along the curve.
double CurveSteps::turning(const CurvePlace& place, const Vector& rows) const {
  const std::size_t size = n_ + 1;
  Vector matrix(size * size), b(size);
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < n_; ++j) matrix[j * size + i] = rows[i * (n_ + 2) + j];
  for (std::size_t i = 0; i < matrix_size(); ++i) {
    matrix[i * size + n_] = place.space.right[i];
    matrix[n_ * size + i] = place.space.left[i];
  }
  b[n_] = 1;
  const Vector w = solution_of(matrix, std::move(b));
  if (w.empty()) return std::nan("");
  double by_p = 0, by_q = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    by_p += w[i] * rows[i * (n_ + 2) + n_];
    by_q += w[i] * rows[i * (n_ + 2) + n_ + 1];
  }
  return (place.tangent[n_ + 1] * by_p - place.tangent[n_] * by_q) / std::hypot(by_p, by_q);
}

void CurveSteps::set_tests(CurvePlace& place, const Vector& rows) {
  using enum Degeneracy;
  place.tests.fill(std::nan(""));
  const auto set = [&](Degeneracy kind, double value) { place.tests[static_cast<std::size_t>(kind)] = value; };
  const auto others = other_eigenvalues(place.point.eigenvalues, place.space);
  if (place.space.dimension == 1) {
    set(cusp, turning(place, rows));
    set(bogdanov_takens, place.space.margin);
    if (others.size() > 1) set(zero_hopf, product_of_sums(others));
    return;
  }
  set(bogdanov_takens, place.space.margin);
  if (!others.empty()) set(zero_hopf, product_of(others));
  if (others.size() > 1) set(double_hopf, product_of_sums(others));
  // l1 goes through infinity where another eigenvalue goes through zero, its product with that does not.
  if (place.point.coefficient) set(generalized_hopf, *place.point.coefficient * product_of(others));
}

std::optional<CurvePlace> CurveSteps::described(Found found, const Vector& along) {
  CurvePlace place{.z = std::move(found.z), .space = std::move(found.space)};
  auto rows = rows_at(place.z, place.space);
  if (!rows) return std::nullopt;
  Vector square(*rows), b(n_ + 2);
  square.insert(square.end(), along.begin(), along.end());
  b.back() = 1;
  place.tangent = solution_of(square, std::move(b));
  if (place.tangent.empty()) return std::nullopt;
  normalize(place.tangent);
  CurvePoint& point = place.point;
  point.constants = constants_of(place.z);
  point.x = state_of(place.z);
  set(place.z);
  const auto spectrum = eigenvalues(matrix(place.z), matrix_size());
  if (!spectrum.found) return std::nullopt;
  point.eigenvalues = spectrum.values;
  leave_out_conserved(system_, -system_.conserved_rate, point.eigenvalues);
  if (place.space.dimension == 1) {
    point.coefficient = fold_coefficient(system_, point.x, p_, options_.t);
  } else if (place.space.margin > 0) {
    const double angular_frequency = std::sqrt(place.space.margin);
    point.frequency = angular_frequency / (2 * std::numbers::pi);
    // Next to a double zero, where both eigenvectors are nearly one, differences leave nothing of it.
    if (angular_frequency > no_frequency * place.space.size)
      if (const auto coefficient = first_lyapunov_coefficient(system_, point.x, p_, angular_frequency, options_.t))
        point.coefficient = coefficient->value;
  }
  set_tests(place, *rows);
  return place;
}

std::optional<CurvePlace> CurveSteps::stepped(const CurvePlace& from, double step) {
  auto found = arclength_step(from.z, from.tangent, step, {},
                              [&](const Vector& guess) { return corrected(guess, from.space, from.tangent); });
  return found ? described(std::move(*found), from.tangent) : std::nullopt;
}

// Any row that leaves the equations regular gives the tangent, and that is the best row to solve them with.
std::optional<CurvePlace> CurveSteps::first(const Vector& z, const CriticalSpace& near) {
  const auto rows = rows_at(z, near);
  if (!rows) return std::nullopt;
  Vector tangent;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = n_ + 2; k-- > 0;) {
    Vector square(*rows), b(n_ + 2);
    square.resize((n_ + 2) * (n_ + 2));
    square[(n_ + 1) * (n_ + 2) + k] = 1;
    b.back() = 1;
    Vector direction = solution_of(square, std::move(b));
    if (direction.empty() || length(direction) > least) continue;
    least = length(direction);
    tangent = std::move(direction);
  }
  if (tangent.empty()) return std::nullopt;
  normalize(tangent);
  auto found = corrected(z, near, tangent);
  return found ? described(std::move(*found), tangent) : std::nullopt;
}

}  // namespace continuo::studies::detail
