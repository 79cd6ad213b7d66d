// continuo/studies/equilibria/degenerate_points.cpp
// Coefficients of the normal forms of degenerate folds.
#include <cmath>
#include <utility>

#include <continuo/studies/equilibria/critical_space.hpp>
#include <continuo/studies/equilibria/degenerate_points.hpp>
#include <continuo/studies/equilibria/normal_form.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;

/// y of A y = b with `across` . y = 0, where `column` is what A does not reach; A row by row or, if `transposed`,
/// column by column.
Vector solved_across(const Vector& a, const Vector& column, const Vector& across, Vector b, bool transposed) {
  const std::size_t n = b.size(), size = n + 1;
  Vector matrix(size * size);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) matrix[i * size + j] = transposed ? a[j * n + i] : a[i * n + j];
    matrix[i * size + n] = column[i];
    matrix[n * size + i] = across[i];
  }
  b.push_back(0);
  Vector y = solution_of(matrix, std::move(b));
  if (!y.empty()) y.pop_back();
  return y;
}

}  // namespace

std::vector<NormalFormNumber> cusp_numbers(const ParametricSystem& system, const Vector& x, std::span<const double> p,
                                           double t) {
  if (system.algebraic > 0) return {};
  const Vector a = jacobian_of(system, t, x, p);
  const auto null = fold_space(a, system.size);
  if (!null || std::abs(null->margin) < 1e-10) return {};
  const DirectionalDerivatives f(system, x, Vector(p.begin(), p.end()), t);
  const Vector& q = null->right;
  Vector bent = f.second(q, q);
  for (double& part : bent) part = -part;
  const Vector h = solved_across(a, null->left, q, std::move(bent), false);
  if (h.empty()) return {};
  const Vector cubic = f.third(q, q), mixed = f.second(q, h);
  const double c = (product(null->left, cubic) + 3 * product(null->left, mixed)) / (6 * null->margin);
  return std::isfinite(c) ? std::vector<NormalFormNumber>{{"c", c}} : std::vector<NormalFormNumber>{};
}

std::vector<NormalFormNumber> double_zero_numbers(const ParametricSystem& system, const Vector& x,
                                                  std::span<const double> p, double t) {
  if (system.algebraic > 0) return {};
  const Vector m = jacobian_of(system, t, x, p);
  const auto null = fold_space(m, system.size);
  if (!null) return {};
  const Vector &q0 = null->right, q1 = solved_across(m, null->left, q0, q0, false);
  if (q1.empty()) return {};
  Vector p1(null->left);
  const double size = product(p1, q1);
  for (double& part : p1) part /= size;
  Vector p0 = solved_across(m, q0, q1, p1, true);
  if (p0.empty()) return {};
  const DirectionalDerivatives f(system, x, Vector(p.begin(), p.end()), t);
  const Vector bent = f.second(q0, q0), mixed = f.second(q1, q0);
  const double a = product(p1, bent) / 2, b = product(p0, bent) + product(p1, mixed);
  if (!std::isfinite(a) || !std::isfinite(b)) return {};
  return {{"a", a}, {"b", b}};
}

}  // namespace continuo::studies::detail
