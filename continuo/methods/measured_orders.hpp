// continuo/methods/measured_orders.hpp
// The orders of a method, measured. The compiler can check that a method has all members, not that they are right: a
// wrong coefficient costs an order, and an error estimate that is 0 accepts every step.
//
//   require(check_orders<MyMethod>());  // "my_method claims order 3, and its error decreases with order 2.0"
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include <continuo/methods/check_method.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/status/status.hpp>

namespace continuo {

/// The orders to which errors decrease with the step size; not a number where the method has no such error.
struct MeasuredOrders {
  double order;        // of x_new after many steps
  double error_order;  // the order of the error estimate of one step, less 1
  double dense_order;  // the order of the error of the interpolant over one step, with both ends, less 1
};

namespace detail {

/// q'' = -q^3 + g(t) with the solution q = sin(t) + cos(2 t) / 2: nonlinear, and g depends on time. It has the form
/// that methods for x'' = a(t, x) need.
template <class Real>
struct ForcedSpring {
  using X = std::array<Real, 2>;
  [[nodiscard]] static X exact(const Real& t) {
    using std::cos, std::sin;
    return {sin(t) + cos(2 * t) / 2, cos(t) - sin(2 * t)};
  }
  void operator()(const Real& t, const X& x, X& dxdt) const {
    using std::cos, std::sin;
    const Real q = exact(t)[0];
    dxdt = {x[1], -x[0] * x[0] * x[0] + q * q * q - sin(t) - 2 * cos(2 * t)};
  }
  void jacobian(const Real&, const X& x, std::span<Real> rows) const {
    rows[0] = 0;
    rows[1] = 1;
    rows[2] = -3 * x[0] * x[0];
    rows[3] = 0;
  }
  [[nodiscard]] std::size_t pair_count(std::size_t) const { return 1; }
  void time_derivative(const Real& t, const X&, X& dfdt) const {
    using std::cos, std::sin;
    const X x = exact(t);
    dfdt = {Real(0), 3 * x[0] * x[0] * x[1] - cos(t) + 4 * sin(2 * t)};
  }
  [[nodiscard]] PositionVelocity pair(std::size_t, std::size_t) const { return {0, 1}; }
  [[nodiscard]] bool ignores_velocity(const X&) const { return true; }
};

/// The errors of one method, without a driver.
template <class M, class Real>
class ErrorsOf {
 public:
  using System = ForcedSpring<Real>;
  using X = typename System::X;
  using Work = typename M::template Workspace<X>;

  /// The largest error of n steps from 0 to `end`.
  [[nodiscard]] static Real after(int n) {
    System system;
    X x = System::exact(Real(0)), x_new = x;
    Work work = M::workspace(x);
    const Real h = Real(end) / n;
    Real worst(0);
    for (int i = 0; i < n; ++i) {
      if (!take(system, Real(h * i), x, h, i == 0, work, x_new)) return failed;
      M::accept(work);
      x = x_new;
      worst = larger(worst, distance(x, System::exact(h * (i + 1))));
    }
    return worst;
  }
  /// The error estimate of one step of size end / n from an exact state.
  [[nodiscard]] static Real estimate(int n) {
    const OneStep one(n);
    return one.solved ? Real(M::error_norm(one.work, one.h, one.x, one.x_new, Tolerance<Real>{Real(0), Real(1)}))
                      : failed;
  }
  /// The largest error of the interpolant of one step of size end / n from an exact state, both ends included.
  [[nodiscard]] static Real dense(int n) {
    OneStep one(n);
    if (!one.solved) return failed;
    one.interpolate();
    Real worst(0);
    for (int i = 0; i <= 16; ++i) {
      const Real theta = Real(i) / 16;
      worst = larger(worst, distance(one.at(theta), System::exact(start + theta * one.h)));
    }
    return worst;
  }
  /// The distances of the interpolant from x and from x_new at the ends of one step.
  [[nodiscard]] static Real gap(int n) {
    OneStep one(n);
    if (!one.solved) return failed;
    one.interpolate();
    return larger(distance(one.at(Real(0)), one.x), distance(one.at(Real(1)), one.x_new));
  }

 private:
  static constexpr double start = 0.25, end = 2;

  static constexpr Real failed = std::numeric_limits<Real>::quiet_NaN();

  /// False where the equations of the step could not be solved.
  [[nodiscard]] static bool take(System& system, const Real& t, const X& x, const Real& h, bool discontinuity,
                                 Work& work, X& x_new) {
    constexpr Tolerance<Real> close{Real(0), 100 * std::numeric_limits<Real>::epsilon()};
    if constexpr (HasSetTolerance<M, X, Work>) M::set_tolerance(work, close);
    M::step(system, t, x, h, discontinuity, work, x_new);
    return status_of<M>(work) == StepStatus::done;
  }

  /// A step from an exact state.
  struct OneStep {
    System system{};
    Real h;
    X x = System::exact(Real(start)), x_new = x;
    Work work = M::workspace(x);
    Interpolant<X, M::dense_degree> interpolant{x};
    bool solved;

    explicit OneStep(int n) : h(Real(end) / n), solved(take(system, Real(start), x, h, true, work, x_new)) {}
    void interpolate() { M::interpolate(system, Real(start), x, h, x_new, work, interpolant); }
    [[nodiscard]] X at(const Real& theta) const {
      X between = x;
      interpolant(theta, between);
      return between;
    }
  };

  [[nodiscard]] static Real larger(const Real& a, const Real& b) { return b <= a ? a : b; }  // NaN stays
  [[nodiscard]] static Real distance(const X& a, const X& b) {
    using std::abs;
    return larger(abs(a[0] - b[0]), abs(a[1] - b[1]));
  }
};

/// log2(error(n) / error(2 n)) where this is equal for two halvings of the step size in succession: of the shortest
/// steps, since long ones are not short enough, and the shortest of all have only rounding errors. If nowhere: of the
/// longest steps.
template <class Real, class Error>
[[nodiscard]] double order_of_decrease(Error&& error) {
  constexpr int first = 2, last = 512;
  constexpr double equal = 0.35, least = 0.5;
  const Real rounding = 100 * std::numeric_limits<Real>::epsilon();
  double previous = std::numeric_limits<double>::quiet_NaN(), order = previous, longest = previous;
  Real coarse = error(first);
  for (int n = 2 * first; n <= last && !(coarse < rounding); n *= 2) {
    const Real fine = error(n);
    using std::log2;
    const auto here = static_cast<double>(log2(coarse / fine));
    if (std::abs(here - previous) < equal && here > least) order = std::min(here, previous);
    if (longest != longest && std::isfinite(here)) longest = here;
    previous = here;
    coarse = fine;
  }
  return order == order ? order : longest;
}

}  // namespace detail

/// Measures the orders of a method whose order does not vary, on a nonlinear problem that depends on time.
template <class M, class Real = long double>
[[nodiscard]] MeasuredOrders measured_orders() {
  using Errors = detail::ErrorsOf<M, Real>;
  MeasuredOrders found{};
  if constexpr (check_method<M, typename Errors::X, typename Errors::System>()) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    found.order = detail::order_of_decrease<Real>(Errors::after);
    found.dense_order = detail::order_of_decrease<Real>(Errors::dense) - 1;
    found.error_order = none;
    if constexpr (M::error_order > 0) found.error_order = detail::order_of_decrease<Real>(Errors::estimate) - 1;
  }
  return found;
}

/// Fails where a measured order is below the one that the method claims, with the numbers: an error estimate that is
/// always 0 has no order. Fails too where the interpolant does not join x and x_new.
template <class M, class Real = long double>
[[nodiscard]] Status check_orders() {
  constexpr double below = 0.4;  // what the terms of higher order leave undecided
  const MeasuredOrders found = measured_orders<M, Real>();
  const auto wrong = [](std::string_view what, int claimed, std::string_view which, double measured) {
    char number[32];
    std::snprintf(number, sizeof number, "%.1f", measured);
    return invalid_input(
        std::string(M::name) + " claims " + std::string(what) + " " + std::to_string(claimed) + ", but " +
        std::string(which) +
        (measured == measured ? " decreases with order " + std::string(number) : std::string(" is 0 or not a number")));
  };
  if (!(found.order > M::order - below)) return wrong("order", M::order, "its error", found.order);
  if (!(found.dense_order > M::dense_order - below))
    return wrong("dense_order", M::dense_order, "the error of its interpolant", found.dense_order);
  constexpr int steps = 64;
  const Real gap = detail::ErrorsOf<M, Real>::gap(steps);
  if (!(gap < 1e6 * std::numeric_limits<Real>::epsilon()))
    return invalid_input("the interpolant of " + std::string(M::name) + " does not join x and x_new");
  if constexpr (M::error_order > 0) {
    if (!(found.error_order > M::error_order - below))
      return wrong("error_order", M::error_order, "its error estimate", found.error_order);
  }
  return {};
}

}  // namespace continuo
