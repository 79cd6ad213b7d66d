// continuo/system/jacobian.hpp
// df/dx and df/dt at one point, from the best there is: given by the system (by hand, by duals, from a model's graph),
// else by forward differences.
#pragma once
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <continuo/numerics/sparse_pattern.hpp>
#include <continuo/numerics/state.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

/// The increment of a component for a forward difference: the square root of epsilon times the component, and never
/// below `least`. Returns what the sum x + increment really adds.
template <class Real>
[[nodiscard]] Real difference_increment(const Real& x, const Real& least) {
  using std::abs, std::max, std::sqrt;
  const Real moved = x + max(sqrt(std::numeric_limits<Real>::epsilon()) * abs(x), least);
  return moved - x;
}

/// Whether a system that has the members for df/dx gives it. A type whose values differ in this (an f of another
/// language, with or without a Jacobian) says so by a member gives_jacobian(); else differences are taken.
template <class F>
[[nodiscard]] bool gives_jacobian(const F& f) {
  if constexpr (requires {
                  { f.gives_jacobian() } -> std::convertible_to<bool>;
                }) {
    return f.gives_jacobian();
  } else {
    return true;
  }
}

/// df/dx row by row from the entries of its pattern, for a system that gives no other. `values` is scratch, which keeps
/// its size from call to call.
template <State X, HasSparseJacobian<X> F>
void scatter_jacobian_values(F& f, const Scalar<X>& t, const X& x, std::vector<Scalar<X>>& values,
                             std::span<Scalar<X>> rows) {
  const SparsePattern& pattern = f.jacobian_pattern();
  values.assign(pattern.entries(), Scalar<X>(0));
  f.jacobian_values(t, x, std::span<Scalar<X>>(values));
  std::ranges::fill(rows, Scalar<X>(0));
  const std::size_t n = dimension(x);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p) rows[pattern.row(p) * n + j] = values[p];
}

/// df/dx row by row; fx = f(t, x), `moved` and `slope` are scratch, least(j) > 0 is the least increment of
/// component j. Returns the number of evaluations of f.
template <class F, State X, class Least>
int evaluate_jacobian(F& f, const Scalar<X>& t, const X& x, const X& fx, X& moved, X& slope, const Least& least,
                      std::span<Scalar<X>> rows) {
  if constexpr (HasJacobian<F, X>) {
    if (gives_jacobian(f)) {
      // A Jacobian that writes only its nonzero entries, or adds to them, is right only on zeros.
      std::ranges::fill(rows, Scalar<X>(0));
      f.jacobian(t, x, rows);
      return 0;
    }
  } else if constexpr (HasSparseJacobian<F, X>) {
    if (gives_jacobian(f)) {
      std::vector<Scalar<X>> values;
      scatter_jacobian_values(f, t, x, values, rows);
      return 0;
    }
  }
  const std::size_t n = dimension(x);
  moved = x;
  for (std::size_t j = 0; j < n; ++j) {
    const Scalar<X> increment = difference_increment(x.data()[j], least(j));
    moved.data()[j] = x.data()[j] + increment;
    evaluate(f, t, moved, slope);
    moved.data()[j] = x.data()[j];
    for (std::size_t i = 0; i < n; ++i) rows[i * n + j] = (slope.data()[i] - fx.data()[i]) / increment;
  }
  return static_cast<int>(n);
}

/// The nonzero entries of df/dx, in the order of the pattern: given, or by differences, one evaluation for each group
/// of columns that share no row.
template <class F, State X, class Least>
int evaluate_jacobian(F& f, const Scalar<X>& t, const X& x, const X& fx, X& moved, X& slope, const Least& least,
                      const SparsePattern& pattern, const ColumnGroups& groups, std::span<Scalar<X>> values) {
  if constexpr (HasSparseJacobian<F, X>) {
    if (gives_jacobian(f)) {
      std::ranges::fill(values, Scalar<X>(0));
      f.jacobian_values(t, x, values);
      return 0;
    }
  }
  moved = x;
  for (std::size_t g = 0; g < groups.count(); ++g) {
    for (const std::size_t j : groups.group(g))
      moved.data()[j] = x.data()[j] + difference_increment(x.data()[j], least(j));
    evaluate(f, t, moved, slope);
    for (const std::size_t j : groups.group(g)) {
      const Scalar<X> increment = moved.data()[j] - x.data()[j];
      for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p)
        values[p] = (slope.data()[pattern.row(p)] - fx.data()[pattern.row(p)]) / increment;
      moved.data()[j] = x.data()[j];
    }
  }
  return static_cast<int>(groups.count());
}

/// df/dt; h says how fast time goes. Returns the number of evaluations.
template <class F, State X>
[[nodiscard]] int evaluate_time_derivative(F& f, const Scalar<X>& t, const Scalar<X>& h, const X& x, const X& fx,
                                           X& dfdt) {
  if constexpr (HasTimeDerivative<F, X>) {
    f.time_derivative(t, x, dfdt);
    detail::keep_size(x, dfdt);
    return 0;
  } else {
    using Real = Scalar<X>;
    using std::abs, std::max, std::sqrt;
    const Real wanted = sqrt(std::numeric_limits<Real>::epsilon()) * max(abs(t), abs(h)) * (h < 0 ? Real(-1) : Real(1));
    const Real moved = t + wanted;
    evaluate(f, moved, x, dfdt);
    for (std::size_t i = 0; i < dimension(x); ++i) dfdt.data()[i] = (dfdt.data()[i] - fx.data()[i]) / (moved - t);
    return 1;
  }
}

}  // namespace continuo
