// continuo/studies/equilibria/branch_point.cpp
// Solves for the crossing of two branches and for their directions.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/numerics/central_difference.hpp>
#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/numerics/newton_iteration.hpp>
#include <continuo/studies/equilibria/branch_point.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;

constexpr double farthest = 0.1;  // from where it is looked for
constexpr double parted = 1e-6;   // directions nearer to each other are one

/// The combination of rows that is least: the eigenvector of J J^T that belongs to the least eigenvalue.
Vector least_combination(const Vector& rows, std::size_t n) {
  Vector square(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k <= n; ++k) square[i * n + j] += rows[i * (n + 1) + k] * rows[j * (n + 1) + k];
  const auto found = eigenvalues(square, n);
  Vector psi(n);
  if (found.found)
    for (std::size_t i = 0; i < n; ++i) psi[i] = found.vectors.back()[i].real();
  return psi;
}

/// J^T psi
Vector combined(const Vector& rows, const Vector& psi) {
  const std::size_t n = psi.size();
  Vector sum(n + 1);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k <= n; ++k) sum[k] += rows[i * (n + 1) + k] * psi[i];
  return sum;
}

/// psi . d^2f/dz^2, n + 1 by n + 1.
Vector curvature(const CrossingEquations& equations, const Vector& z, const Vector& psi) {
  const std::size_t size = z.size();
  Vector h(size * size), moved(z);
  for (std::size_t k = 0; k < size; ++k) {
    const double step = increment_for_jacobians * std::max(1.0, std::abs(z[k]));
    const auto [above, below] = on_both_sides(moved[k], step, [&] { return combined(equations.jacobian(moved), psi); });
    for (std::size_t i = 0; i < size; ++i) h[i * size + k] = (above[i] - below[i]) / (2 * step);
  }
  return h;
}

bool solve(Vector matrix, Vector& b) {
  DenseLU<double, run_time_size> lu(b.size());
  std::ranges::copy(matrix, lu.matrix().begin());
  if (!lu.factor()) return false;
  lu.solve(b.data());
  return std::isfinite(length(b));
}

/// A direction across `along` that J does not see either: J y + psi s = 0, along . y = 0, and some component is 1.
Vector second_direction(const Vector& rows, const Vector& psi, const Vector& along) {
  const std::size_t n = psi.size(), size = n + 2;
  Vector best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k <= n; ++k) {
    Vector matrix(size * size), y(size);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j <= n; ++j) matrix[i * size + j] = rows[i * (n + 1) + j];
      matrix[i * size + n + 1] = psi[i];
    }
    for (std::size_t j = 0; j <= n; ++j) matrix[n * size + j] = along[j];
    matrix[(n + 1) * size + k] = 1;
    y[n + 1] = 1;
    if (!solve(std::move(matrix), y)) continue;
    y.pop_back();
    if (length(y) < least) least = length(y), best = std::move(y);
  }
  for (double& part : best) part /= least;
  return best;
}

}  // namespace

std::optional<Crossing> find_crossing(const CrossingEquations& equations, Vector z, const Vector& along) {
  const std::size_t n = equations.n, size = 2 * n + 2;
  const Vector begin(z);
  Vector psi = least_combination(equations.jacobian(z), n);
  double beta = 0;
  const auto correct = [&]() -> NewtonCorrection {
    const Vector f = equations.f(z), rows = equations.jacobian(z), h = curvature(equations, z, psi),
                 gone = combined(rows, psi);
    Vector matrix(size * size), step(size);
    for (std::size_t i = 0; i < n; ++i) {
      step[i] = f[i] + beta * psi[i];
      for (std::size_t k = 0; k <= n; ++k) matrix[i * size + k] = rows[i * (n + 1) + k];
      matrix[i * size + n + 1] = psi[i];
      matrix[i * size + n + 2 + i] = beta;
    }
    for (std::size_t k = 0; k <= n; ++k) {
      step[n + k] = gone[k];
      for (std::size_t j = 0; j <= n; ++j) matrix[(n + k) * size + j] = h[k * (n + 1) + j];
      for (std::size_t i = 0; i < n; ++i) matrix[(n + k) * size + n + 2 + i] = rows[i * (n + 1) + k];
    }
    step[size - 1] = (product(psi, psi) - 1) / 2;
    for (std::size_t i = 0; i < n; ++i) matrix[(size - 1) * size + n + 2 + i] = psi[i];
    if (!solve(std::move(matrix), step)) return NewtonEnding::singular;
    for (std::size_t k = 0; k <= n; ++k) z[k] -= step[k];
    beta -= step[n + 1];
    for (std::size_t i = 0; i < n; ++i) psi[i] -= step[n + 2 + i];
    double apart = 0;
    for (std::size_t k = 0; k <= n; ++k) apart = std::max(apart, std::abs(z[k] - begin[k]));
    if (!(apart < farthest)) return NewtonEnding::diverged;
    return length(step);
  };
  constexpr NewtonLimits limits{.most_iterations = 15, .solved_to = 1e-12, .rounding = 1e-8};
  if (!newton_iteration(limits, correct) || std::abs(beta) > 1e-9) return std::nullopt;
  const Vector rows = equations.jacobian(z), other = second_direction(rows, psi, along);
  if (other.empty()) return std::nullopt;
  // a^2 d1 H d1 + 2 a b d1 H d2 + b^2 d2 H d2 = 0 in the plane of both.
  const Vector h = curvature(equations, z, psi);
  const auto form = [&](const Vector& u, const Vector& v) {
    double sum = 0;
    for (std::size_t i = 0; i <= n; ++i)
      for (std::size_t k = 0; k <= n; ++k) sum += u[i] * h[i * (n + 1) + k] * v[k];
    return sum;
  };
  const double c11 = form(along, along), c12 = form(along, other), c22 = form(other, other);
  const double discriminant = c12 * c12 - c11 * c22;
  if (!(discriminant > 0)) return std::nullopt;
  // With b / a = -c11 / q for one and -q / c22 for the other, q = c12 + sign(c12) sqrt(discriminant): no cancellation.
  const double q = c12 + std::copysign(std::sqrt(discriminant), c12);
  const auto direction = [&](double a, double b) {
    Vector d(n + 1);
    for (std::size_t k = 0; k <= n; ++k) d[k] = a * along[k] + b * other[k];
    const double size_of = length(d);
    for (double& part : d) part /= size_of;
    return d;
  };
  Crossing crossing{std::move(z), direction(q, -c11), direction(c22, -q)};
  if (std::abs(product(crossing.own, along)) < std::abs(product(crossing.other, along)))
    std::swap(crossing.own, crossing.other);
  if (1 - std::abs(product(crossing.own, crossing.other)) < parted) return std::nullopt;
  return crossing;
}

}  // namespace continuo::studies::detail
