// continuo/studies/equilibria/critical_space.cpp
// Finds the critical eigenvectors of a matrix, and follows them to a matrix nearby.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/numerics/newton_iteration.hpp>
#include <continuo/studies/equilibria/critical_space.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;
using Complex = std::complex<double>;

Vector transposed(const Vector& a, std::size_t n) {
  Vector result(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) result[j * n + i] = a[i * n + j];
  return result;
}

/// A v
Vector times(const Vector& a, std::span<const double> v) {
  const std::size_t n = v.size();
  Vector result(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) result[i] += a[i * n + j] * v[j];
  return result;
}

/// Two columns made orthonormal (Gram, Schmidt); false where they are parallel.
bool make_orthonormal(Vector& columns, std::size_t n) {
  const std::span<double> first(columns.data(), n), second(columns.data() + n, n);
  const auto shorten = [](std::span<double> v) {
    const double size = std::sqrt(product(v, v));
    for (double& part : v) part /= size;
    return size;
  };
  shorten(first);
  shorten(second);
  double left = 1;
  for (int k = 0; k < 2; ++k) {
    const double along = product(first, second);
    for (std::size_t i = 0; i < n; ++i) second[i] -= along * first[i];
    left *= shorten(second);
  }
  return left > 1e-13 && std::isfinite(left);
}

using Square = std::array<double, 4>;  // 2 by 2, row by row

/// V^T A V of orthonormal columns.
Square within(const Vector& a, const Vector& columns) {
  const std::size_t n = columns.size() / 2;
  Square t{};
  for (std::size_t j = 0; j < 2; ++j) {
    const Vector moved = times(a, std::span(columns).subspan(j * n, n));
    for (std::size_t i = 0; i < 2; ++i) t[i * 2 + j] = product(std::span(columns).subspan(i * n, n), moved);
  }
  return t;
}

/// The plane with A V = V T nearest to one that was invariant before, by Newton with V0^T V = 1.
std::optional<Vector> invariant_plane(const Vector& a, std::size_t n, const Vector& begin) {
  Vector v(begin);
  Square t = within(a, begin);
  const std::size_t size = 2 * n + 4;
  const auto correct = [&]() -> NewtonCorrection {
    Vector matrix(size * size), b(size);
    for (std::size_t c = 0; c < 2; ++c) {
      const Vector moved = times(a, std::span(v).subspan(c * n, n));
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t row = c * n + i;
        b[row] = moved[i] - v[i] * t[c] - v[n + i] * t[2 + c];
        for (std::size_t j = 0; j < n; ++j) matrix[row * size + c * n + j] = a[i * n + j];
        for (std::size_t k = 0; k < 2; ++k) {
          matrix[row * size + k * n + i] -= t[k * 2 + c];
          matrix[row * size + 2 * n + k * 2 + c] = -v[k * n + i];
        }
      }
      for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t j = 0; j < n; ++j) matrix[(2 * n + k * 2 + c) * size + c * n + j] = begin[k * n + j];
    }
    const Vector step = solution_of(matrix, std::move(b));
    if (step.empty()) return NewtonEnding::singular;
    double moved = 0;
    for (std::size_t j = 0; j < 2 * n; ++j) v[j] -= step[j], moved = std::max(moved, std::abs(step[j]));
    for (std::size_t j = 0; j < 4; ++j) t[j] -= step[2 * n + j];
    return moved;
  };
  // A correction of 1: the planes have nothing to do with each other.
  constexpr NewtonLimits limits{.most_iterations = 12, .solved_to = 1e-14, .rounding = 1e-9, .farthest = 1};
  return newton_iteration(limits, correct) && make_orthonormal(v, n) ? std::optional(v) : std::nullopt;
}

std::optional<CriticalSpace> continued_fold(const Vector& a, std::size_t n, const CriticalSpace& near) {
  const std::size_t size = n + 1;
  Vector matrix(size * size), b(size);
  for (std::size_t i = 0; i < n; ++i) {
    std::copy_n(a.begin() + static_cast<std::ptrdiff_t>(i * n), n,
                matrix.begin() + static_cast<std::ptrdiff_t>(i * size));
    matrix[i * size + n] = near.left[i];
    matrix[n * size + i] = near.right[i];
  }
  b[n] = 1;
  Vector right = solution_of(matrix, b), left = solution_of(transposed(matrix, size), b);
  if (right.empty() || left.empty()) return std::nullopt;
  CriticalSpace space{.dimension = 1, .test = right[n]};
  right.pop_back();
  left.pop_back();
  for (const double w : left)
    for (const double v : right) space.weights.push_back(-w * v);
  normalize(right);
  normalize(left);
  space.margin = product(left, right);
  space.right = std::move(right);
  space.left = std::move(left);
  return space;
}

/// trace T and its derivative trace((W^T V)^-1 W^T dA V) from both planes.
std::optional<CriticalSpace> of_planes(const Vector& a, std::size_t n, Vector right, Vector left) {
  const Square t = within(a, right);
  Square m{};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      m[i * 2 + j] = product(std::span(left).subspan(i * n, n), std::span(right).subspan(j * n, n));
  const double determinant = m[0] * m[3] - m[1] * m[2];
  if (!(std::abs(determinant) > 1e-13)) return std::nullopt;
  const Square inverse{m[3] / determinant, -m[1] / determinant, -m[2] / determinant, m[0] / determinant};
  CriticalSpace space{.dimension = 2, .test = t[0] + t[3], .weights = Vector(n * n)};
  space.margin = t[0] * t[3] - t[1] * t[2];
  space.size = std::sqrt(product(t, t));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t c = 0; c < 2; ++c)
        for (std::size_t k = 0; k < 2; ++k)
          space.weights[i * n + j] += right[c * n + j] * inverse[c * 2 + k] * left[k * n + i];
  space.right = std::move(right);
  space.left = std::move(left);
  return space;
}

std::optional<CriticalSpace> pair_from(const Vector& a, std::size_t n, const Vector& near_right,
                                       const Vector& near_left) {
  auto right = invariant_plane(a, n, near_right);
  auto left = right ? invariant_plane(transposed(a, n), n, near_left) : std::nullopt;
  if (!left) return std::nullopt;
  return of_planes(a, n, std::move(*right), std::move(*left));
}

/// Real and imaginary part of the eigenvector of the eigenvalue nearest to `wanted`.
Vector eigenvector_parts(const Vector& a, std::size_t n, const Complex& wanted) {
  const auto found = eigenvalues(a, n);
  if (!found.found) return {};
  const auto best =
      std::ranges::min_element(found.values, {}, [&](const Complex& value) { return std::abs(value - wanted); });
  const auto& vector = found.vectors[static_cast<std::size_t>(best - found.values.begin())];
  Vector parts(2 * n);
  for (std::size_t i = 0; i < n; ++i) parts[i] = vector[i].real(), parts[n + i] = vector[i].imag();
  return parts;
}

/// The real direction of a vector that is real but for a factor.
Vector greatest_part(const Vector& parts, std::size_t n) {
  std::size_t greatest = 0;
  const auto size = [&](std::size_t i) { return std::hypot(parts[i], parts[n + i]); };
  for (std::size_t i = 1; i < n; ++i)
    if (size(i) > size(greatest)) greatest = i;
  Vector v(n);
  for (std::size_t i = 0; i < n; ++i) v[i] = parts[i] * parts[greatest] + parts[n + i] * parts[n + greatest];
  normalize(v);
  return v;
}

}  // namespace

std::vector<double> solution_of(const Vector& matrix, Vector b) {
  DenseLU<double, run_time_size> lu(b.size());
  std::ranges::copy(matrix, lu.matrix().begin());
  if (!lu.factor()) return {};
  lu.solve(b.data());
  return std::isfinite(length(b)) ? b : Vector();
}

std::optional<CriticalSpace> continued_space(const Vector& a, std::size_t n, const CriticalSpace& near) {
  return near.dimension == 1 ? continued_fold(a, n, near) : pair_from(a, n, near.right, near.left);
}

// The vectors that A and its transpose see least do well for a border even where the eigenvalue is nearly a double one.
std::optional<CriticalSpace> fold_space(const Vector& a, std::size_t n) {
  Vector squares(n * n), other_squares(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n; ++k) {
        squares[i * n + j] += a[k * n + i] * a[k * n + j];
        other_squares[i * n + j] += a[i * n + k] * a[j * n + k];
      }
  const auto least = [&](const Vector& rows) {
    const Vector parts = eigenvector_parts(rows, n, 0);
    return parts.empty() ? parts : greatest_part(parts, n);
  };
  CriticalSpace near{.dimension = 1, .right = least(squares), .left = least(other_squares)};
  if (near.right.empty() || near.left.empty()) return std::nullopt;
  auto space = continued_fold(a, n, near);
  return space ? continued_fold(a, n, *space) : std::nullopt;
}

std::optional<CriticalSpace> pair_space(const Vector& a, std::size_t n, double angular_frequency) {
  Vector right = eigenvector_parts(a, n, {0, angular_frequency}),
         left = eigenvector_parts(transposed(a, n), n, {0, angular_frequency});
  if (right.empty() || left.empty() || !make_orthonormal(right, n) || !make_orthonormal(left, n)) return std::nullopt;
  return pair_from(a, n, right, left);
}

// A q1 = q0 makes the plane of a double zero with its null vector q0.
std::optional<CriticalSpace> double_zero_space(const Vector& a, std::size_t n, const CriticalSpace& fold) {
  const auto plane_of = [&](const Vector& rows, const Vector& null, const Vector& other) -> Vector {
    const std::size_t size = n + 1;
    Vector matrix(size * size), b(null);
    for (std::size_t i = 0; i < n; ++i) {
      std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(i * n), n,
                  matrix.begin() + static_cast<std::ptrdiff_t>(i * size));
      matrix[i * size + n] = other[i];
      matrix[n * size + i] = null[i];
    }
    b.push_back(0);
    const Vector next = solution_of(matrix, std::move(b));
    if (next.empty()) return {};
    Vector plane(null);
    plane.insert(plane.end(), next.begin(), next.end() - 1);
    return make_orthonormal(plane, n) ? plane : Vector();
  };
  const Vector right = plane_of(a, fold.right, fold.left), left = plane_of(transposed(a, n), fold.left, fold.right);
  if (right.empty() || left.empty()) return std::nullopt;
  return pair_from(a, n, right, left);
}

std::vector<Complex> other_eigenvalues(const std::vector<Complex>& eigenvalues, const CriticalSpace& space) {
  std::vector<Complex> others(eigenvalues), critical{0.0};
  if (space.dimension == 2) {
    const Complex root = std::sqrt(Complex(space.test * space.test / 4 - space.margin));
    critical = {space.test / 2 + root, space.test / 2 - root};
  }
  for (const Complex& value : critical) {
    const auto nearest =
        std::ranges::min_element(others, {}, [&](const Complex& other) { return std::abs(other - value); });
    if (nearest != others.end()) others.erase(nearest);
  }
  return others;
}

}  // namespace continuo::studies::detail
