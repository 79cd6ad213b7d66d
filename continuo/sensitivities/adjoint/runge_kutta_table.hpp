// The tableau of a Runge-Kutta method as numbers in one layout for all of them: its stages, then those that only the
// interpolant needs, and the weights of the interpolant,
//   k_i = f(t + c_i h, x + h sum_j a_ij k_j),   x(t + theta h) = x + h sum_i B_i(theta) k_i.
#pragma once
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <vector>

#include <continuo/methods/dirk/diagonally_implicit_runge_kutta.hpp>
#include <continuo/methods/explicit_rk/explicit_runge_kutta.hpp>

namespace continuo::detail {

template <class M>
concept ExplicitTableau = std::derived_from<M, ExplicitRungeKutta<M>>;
template <class M>
concept DiagonallyImplicitTableau = std::derived_from<M, DiagonallyImplicitRungeKutta<M>>;
template <class M>
concept HasRungeKuttaTable = ExplicitTableau<M> || DiagonallyImplicitTableau<M>;

template <class Real>
struct RungeKuttaTable {
  std::size_t stages = 0;           // of the interpolant too
  std::size_t step_stages = 0;      // of which x_new needs so many
  std::size_t estimate_stages = 0;  // and the estimate of the error
  std::size_t degree = 0;           // of the interpolant
  std::vector<Real> a, b, c;        // a by rows
  std::vector<Real> error;          // b - embedded; empty where the method has no estimate
  std::vector<Real> dense;          // B_i(theta) = sum_n dense[i (degree + 1) + n] theta^n

  RungeKuttaTable(std::size_t count, std::size_t dense_degree)
      : stages(count), degree(dense_degree), a(count * count), b(count), c(count), dense(count * (dense_degree + 1)) {}

  /// Whether stage i appears in its own argument.
  [[nodiscard]] bool is_implicit(std::size_t i) const { return a[i * stages + i] != Real(0); }
  [[nodiscard]] Real interpolant_weight(std::size_t i, const Real& theta) const {
    Real sum(0);
    for (std::size_t n = degree + 1; n-- > 0;) sum = sum * theta + dense[i * (degree + 1) + n];
    return sum;
  }
  /// B_i'(theta).
  [[nodiscard]] Real interpolant_slope(std::size_t i, const Real& theta) const {
    Real sum(0);
    for (std::size_t n = degree + 1; n-- > 1;) sum = sum * theta + Real(n) * dense[i * (degree + 1) + n];
    return sum;
  }
};

/// The weights of an estimate by the embedded method. A tableau without its weights has no sum of 1 in them.
template <class M, class Real>
void set_error_weights(RungeKuttaTable<Real>& table) {
  table.estimate_stages = table.step_stages;
  if constexpr (M::error_order > 0) {
    using std::abs;
    Real sum(0);
    for (std::size_t i = 0; i < M::tableau.stages; ++i) sum += M::tableau.embedded[i].template as<Real>();
    if (abs(sum - Real(1)) > Real(0.001)) return;
    for (std::size_t i = 0; i < M::tableau.stages; ++i) {
      table.error.push_back((M::tableau.b[i] - M::tableau.embedded[i]).template as<Real>());
      if (table.error.back() != Real(0)) table.estimate_stages = std::max(table.step_stages, i + 1);
    }
  }
}

/// The table of an explicit method. Where the last stage is f at the end of the step, the column `end` is that stage.
template <ExplicitTableau M, class Real>
[[nodiscard]] RungeKuttaTable<Real> runge_kutta_table() {
  constexpr auto& tableau = M::tableau;
  constexpr bool shared = tableau.first_same_as_last();
  constexpr std::size_t end = shared ? tableau.stages - 1 : tableau.end, count = end + 1 + tableau.extra;
  const auto column = [](std::size_t stage) { return shared && stage > end ? stage + 1 : stage; };
  RungeKuttaTable<Real> table(count, tableau.degree);
  for (std::size_t i = 0; i < tableau.stages; ++i) {
    table.b[i] = tableau.b[i].template as<Real>();
    table.c[i] = tableau.c[i].template as<Real>();
    for (std::size_t j = 0; j < i; ++j) table.a[i * count + j] = tableau.a[i][j].template as<Real>();
    if (table.b[i] != Real(0)) table.step_stages = i + 1;
  }
  set_error_weights<M>(table);
  if constexpr (!shared) {
    table.c[end] = Real(1);
    for (std::size_t j = 0; j < tableau.stages; ++j) table.a[end * count + j] = table.b[j];
  }
  for (std::size_t e = 0; e < tableau.extra; ++e) {
    table.c[end + 1 + e] = tableau.extra_c[e].template as<Real>();
    for (std::size_t j = 0; j < end + 1 + e; ++j)
      table.a[(end + 1 + e) * count + j] = tableau.extra_a[e][column(j)].template as<Real>();
  }
  // The cubic Hermite polynomial of both ends, and theta^2 (1 - theta)^2 theta^n for each dense term (tableau.hpp).
  for (std::size_t i = 0; i < count; ++i) {
    Real* const power = &table.dense[i * (tableau.degree + 1)];
    power[2] += 3 * table.b[i];
    power[3] -= 2 * table.b[i];
    if (i == 0) power[1] += Real(1), power[2] -= Real(2), power[3] += Real(1);
    if (i == end) power[2] -= Real(1), power[3] += Real(1);
    for (std::size_t n = 0; n < tableau.dense_terms; ++n) {
      const Real weight = tableau.dense[column(i)][n].template as<Real>();
      power[n + 2] += weight;
      power[n + 3] -= 2 * weight;
      power[n + 4] += weight;
    }
  }
  return table;
}

/// The table of a diagonally implicit method.
template <DiagonallyImplicitTableau M, class Real>
[[nodiscard]] RungeKuttaTable<Real> runge_kutta_table() {
  constexpr auto& tableau = M::tableau;
  constexpr std::size_t count = tableau.stages;
  RungeKuttaTable<Real> table(count, tableau.degree);
  for (std::size_t i = 0; i < count; ++i) {
    table.b[i] = tableau.b[i].template as<Real>();
    table.c[i] = tableau.c[i].template as<Real>();
    for (std::size_t j = 0; j < i; ++j) table.a[i * count + j] = tableau.a[i][j].template as<Real>();
    if (!tableau.a[i][i].is_zero()) table.a[i * count + i] = tableau.gamma.template as<Real>();
    for (std::size_t n = 0; n < tableau.degree; ++n)
      table.dense[i * (tableau.degree + 1) + n + 1] = tableau.dense[n][i].template as<Real>();
    if (table.b[i] != Real(0)) table.step_stages = i + 1;
  }
  set_error_weights<M>(table);
  return table;
}

}  // namespace continuo::detail
