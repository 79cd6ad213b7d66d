// Exact derivatives of a right-hand side that takes any number type, by forward dual numbers:
//
//   auto f = differentiable([](auto t, const auto& x, auto& dxdt) {
//     dxdt[0] = x[1];
//     dxdt[1] = 1000.0 * (1.0 - x[0] * x[0]) * x[1] - x[0] + sin(t);
//   });
//   solve(f, std::array{2.0, 0.0}, {0, 2000}, Bdf{});  // with the exact Jacobian
//
// A dual number is a value with its derivatives by several variables: one call of f gives a chunk of columns of the
// Jacobian. Functions must be found by their argument: sin, not std::sin. Needs <ceres/jet.h>, so nothing includes this
// file but who wants it.
#pragma once
#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <ceres/jet.h>

#include <continuo/numerics/sparse_pattern.hpp>
#include <continuo/numerics/state.hpp>
#include <continuo/system/rebound_state.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

namespace detail {

template <class X>
inline constexpr bool is_fixed = requires { std::tuple_size<X>::value; };

template <class Real, std::size_t Count>
using Dual = ceres::Jet<Real, static_cast<int>(Count)>;

/// The state of the duals of a state.
template <State X, std::size_t Count>
using DualState = ReboundState<X, Dual<Scalar<X>, Count>>;

/// The duals of one right-hand side. Real is the scalar of states of run-time size.
template <class Real>
class DualEvaluation {
 public:
  template <class F, State X>
  void jacobian(F& f, const Scalar<X>& t, const X& x, std::span<Scalar<X>> rows) {
    constexpr std::size_t columns = columns_of<X>();
    const std::size_t n = dimension(x);
    auto&& [dual_x, dual_f] = duals<columns>(x);
    for (std::size_t first = 0; first < n; first += columns) {
      const std::size_t count = std::min(columns, n - first);
      for (std::size_t j = 0; j < count; ++j) dual_x[first + j].v[static_cast<int>(j)] = Scalar<X>(1);
      call(f, t, dual_x, dual_f);
      for (std::size_t j = 0; j < count; ++j) {
        dual_x[first + j].v.setZero();
        for (std::size_t i = 0; i < n; ++i) rows[i * n + first + j] = dual_f[i].v[static_cast<int>(j)];
      }
    }
  }

  /// Columns that share no row are one variable.
  template <class F, State X>
  void entries(F& f, const Scalar<X>& t, const X& x, const SparsePattern& pattern, std::span<Scalar<X>> values) {
    constexpr std::size_t columns = columns_of<X>();
    if (groups_.count() == 0) groups_ = ColumnGroups(pattern);
    auto&& [dual_x, dual_f] = duals<columns>(x);
    for (std::size_t first = 0; first < groups_.count(); first += columns) {
      const std::size_t count = std::min(columns, groups_.count() - first);
      for (std::size_t g = 0; g < count; ++g)
        for (const std::size_t j : groups_.group(first + g)) dual_x[j].v[static_cast<int>(g)] = Scalar<X>(1);
      call(f, t, dual_x, dual_f);
      for (std::size_t g = 0; g < count; ++g) {
        for (const std::size_t j : groups_.group(first + g)) {
          dual_x[j].v.setZero();
          for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p)
            values[p] = dual_f[pattern.row(p)].v[static_cast<int>(g)];
        }
      }
    }
  }

  template <class F, State X>
  void time_derivative(F& f, const Scalar<X>& t, const X& x, X& dfdt) {
    auto&& [dual_x, dual_f] = duals<1>(x);
    evaluate(f, Dual<Scalar<X>, 1>(t, 0), dual_x, dual_f);
    for (std::size_t i = 0; i < dimension(x); ++i) dfdt.data()[i] = dual_f[i].v[0];
  }

 private:
  /// Columns per call of f, at most: more derivatives than these do not stay in registers.
  static constexpr std::size_t most_columns = 8;

  template <class Values>
  struct Pair {
    Values x, f;
  };
  template <class Number>
  using Kept = Pair<std::vector<Number>>;

  template <State X>
  [[nodiscard]] static constexpr std::size_t columns_of() {
    if constexpr (is_fixed<X>) {
      return std::clamp(std::tuple_size<X>::value, std::size_t{1}, most_columns);
    } else {
      return most_columns;
    }
  }

  /// x as duals without derivatives, and room for f: on the stack, or kept.
  template <std::size_t Count, State X>
  decltype(auto) duals(const X& x) {
    const auto fill = [&x](auto& pair) {
      for (std::size_t i = 0; i < dimension(x); ++i) pair.x[i] = Dual<Scalar<X>, Count>(x.data()[i]);
    };
    if constexpr (is_fixed<X>) {
      Pair<DualState<X, Count>> pair;
      fill(pair);
      return pair;
    } else {
      auto& pair = std::get<Kept<Dual<Real, Count>>>(kept_);
      pair.x.resize(dimension(x));
      pair.f.resize(dimension(x));
      fill(pair);
      return (pair);
    }
  }

  /// f(t, x), with a dual t where f takes one.
  template <class F, class T, class Duals>
  static void call(F& f, const T& t, const Duals& x, Duals& dxdt) {
    if constexpr (RightHandSide<F, Duals>) {
      evaluate(f, typename Duals::value_type(t), x, dxdt);
    } else if constexpr (std::invocable<F&, const T&, const Duals&, Duals&>) {
      f(t, x, dxdt);
    } else {
      static_assert(std::invocable<F&, const T&, const Duals&>,
                    "f must take states of any number type: [](auto t, const auto& x, auto& dxdt) { ... }");
      dxdt = f(t, x);
    }
  }

  std::tuple<Kept<Dual<Real, most_columns>>, Kept<Dual<Real, 1>>> kept_;
  ColumnGroups groups_;
};

template <class X, class Real>
concept DualsFor = State<X> && (is_fixed<X> || std::same_as<Scalar<X>, Real>);

}  // namespace detail

/// F with `jacobian`, `jacobian_values` (where F knows its pattern) and `time_derivative` (where F takes a dual t); all
/// else F has stays as it is. Real is the scalar of states of run-time size, whose duals are kept from call to call;
/// states of fixed size may have any scalar.
template <class F, class Real = double>
class Differentiable : public F {
 public:
  Differentiable() = default;
  /// The right-hand side f, which may be called with any number type.
  explicit Differentiable(F f) : F(std::move(f)) {}

  /// df/dx at (t, x), n*n numbers row by row. One call of f for each eight columns.
  template <detail::DualsFor<Real> X>
  void jacobian(const Scalar<X>& t, const X& x, std::span<Scalar<X>> rows) {
    duals_.jacobian(static_cast<F&>(*this), t, x, rows);
  }
  /// The entries of df/dx at (t, x) in the order of f's pattern. One call of f for each eight groups of columns that
  /// share no row.
  template <detail::DualsFor<Real> X>
    requires HasJacobianPattern<F>
  void jacobian_values(const Scalar<X>& t, const X& x, std::span<Scalar<X>> values) {
    duals_.entries(static_cast<F&>(*this), t, x, F::jacobian_pattern(), values);
  }
  /// df/dt at (t, x), by one call of f.
  template <detail::DualsFor<Real> X>
    requires RightHandSide<F, detail::DualState<X, 1>>
  void time_derivative(const Scalar<X>& t, const X& x, X& dfdt) {
    duals_.time_derivative(static_cast<F&>(*this), t, x, dfdt);
  }

 private:
  detail::DualEvaluation<Real> duals_;
};

/// f with its derivatives.
template <class Real = double, class F>
[[nodiscard]] Differentiable<std::decay_t<F>, Real> differentiable(F&& f) {
  return Differentiable<std::decay_t<F>, Real>(std::forward<F>(f));
}

}  // namespace continuo
