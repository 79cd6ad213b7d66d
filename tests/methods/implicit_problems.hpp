// tests/methods/implicit_problems.hpp
// Small problems with closed forms for implicit methods, and their errors, in long double: high orders have room before
// round-off.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <continuo/methods/method.hpp>

namespace continuo::testing {

template <class X>
using EntriesOf = std::span<Scalar<X>>;

/// M x' = f(t, x) with a diagonal M and its derivatives, the solution known, of one type for all problems: each method
/// is compiled once for a kind of number, and not once for each problem.
template <class Real>
struct AnyProblem {
  using X = std::array<Real, 2>;
  void (*f)(const Real&, const X&, X&);
  void (*slopes)(const Real&, const X&, std::span<Real>);
  void (*slope_in_time)(const Real&, const X&, X&);
  X (*solution)(const Real&);
  X masses;
  int duration;

  void operator()(const Real& t, const X& x, X& dxdt) const { f(t, x, dxdt); }
  void jacobian(const Real& t, const X& x, std::span<Real> rows) const { slopes(t, x, rows); }
  void time_derivative(const Real& t, const X& x, X& dfdt) const { slope_in_time(t, x, dfdt); }
  [[nodiscard]] bool has_mass() const { return masses != X{Real(1), Real(1)}; }
  [[nodiscard]] Real mass(std::size_t i) const { return masses[i]; }
  [[nodiscard]] X exact(const Real& t) const { return solution(t); }
};

/// A problem that gives its Jacobian. One that gives no df/dt does not depend on t.
template <class Real, class Problem>
AnyProblem<Real> any_problem() {
  using X = std::array<Real, 2>;
  AnyProblem<Real> any{
      .f = [](const Real& t, const X& x, X& dxdt) { Problem{}(t, x, dxdt); },
      .slopes = [](const Real& t, const X& x, std::span<Real> rows) { Problem{}.jacobian(t, x, rows); },
      .slope_in_time = [](const Real&, const X&, X& dfdt) { dfdt = X{Real(0), Real(0)}; },
      .solution = nullptr,
      .masses = {Real(1), Real(1)},
      .duration = 1};
  if constexpr (HasTimeDerivative<Problem, X>)
    any.slope_in_time = [](const Real& t, const X& x, X& dfdt) { Problem{}.time_derivative(t, x, dfdt); };
  if constexpr (requires { Problem::exact(Real(0)); }) {
    any.solution = [](const Real& t) -> X { return Problem::exact(t); };
    any.duration = Problem::duration;
  }
  if constexpr (HasMassDiagonal<Problem, X>)
    for (std::size_t i = 0; i < any.masses.size(); ++i) any.masses[i] = Real(Problem::mass(i));
  return any;
}

/// x' = v, v' = -x^3 + g(t), g such that x = sin(t): not linear, f depends on t.
struct ForcedAlone {
  template <class X>
  void operator()(const Scalar<X>& t, const X& x, X& dxdt) const {
    using std::sin;
    const Scalar<X> s = sin(t);
    dxdt[0] = x[1];
    dxdt[1] = -x[0] * x[0] * x[0] + s * s * s - s;
  }
  template <class Real>
  static std::array<Real, 2> exact(const Real& t) {
    using std::cos, std::sin;
    return {sin(t), cos(t)};
  }
  static constexpr int duration = 2;
};

/// The same with its derivatives.
struct Forced : ForcedAlone {
  template <class X>
  void jacobian(const Scalar<X>&, const X& x, EntriesOf<X> rows) const {
    rows[0] = 0, rows[1] = 1, rows[2] = -3 * x[0] * x[0], rows[3] = 0;
  }
  template <class X>
  void time_derivative(const Scalar<X>& t, const X&, X& dfdt) const {
    using std::cos, std::sin;
    dfdt[0] = 0, dfdt[1] = (3 * sin(t) * sin(t) - 1) * cos(t);
  }
};

/// x' = z, 0 = x^2 + z^2 - 1: x = sin(t) and, by an equation of index 1, z = cos(t).
struct Circle {
  static double mass(std::size_t i) { return i == 0 ? 1 : 0; }
  static constexpr bool autonomous = true;
  template <class X>
  void operator()(const Scalar<X>&, const X& x, X& dxdt) const {
    dxdt[0] = x[1];
    dxdt[1] = x[0] * x[0] + x[1] * x[1] - 1;
  }
  template <class X>
  void jacobian(const Scalar<X>&, const X& x, EntriesOf<X> rows) const {
    rows[0] = 0, rows[1] = 1, rows[2] = 2 * x[0], rows[3] = 2 * x[1];
  }
  template <class Real>
  static std::array<Real, 2> exact(const Real& t) {
    return Forced::exact(t);
  }
  static constexpr int duration = 1;
};

/// x' = lambda (x - sin(t)) + cos(t) with lambda = -1e6, twice (A. Prothero, A. Robinson 1974). df/dt is given.
struct ProtheroRobinson {
  static constexpr double lambda = -1e6;
  template <class X>
  void operator()(const Scalar<X>& t, const X& x, X& dxdt) const {
    using std::cos, std::sin;
    dxdt[0] = lambda * (x[0] - sin(t)) + cos(t);
    dxdt[1] = lambda * (x[1] - cos(t)) - sin(t);
  }
  template <class X>
  void jacobian(const Scalar<X>&, const X&, EntriesOf<X> rows) const {
    rows[0] = lambda, rows[1] = 0, rows[2] = 0, rows[3] = lambda;
  }
  template <class X>
  void time_derivative(const Scalar<X>& t, const X&, X& dfdt) const {
    using std::cos, std::sin;
    dfdt[0] = -lambda * cos(t) - sin(t);
    dfdt[1] = lambda * sin(t) - cos(t);
  }
  template <class Real>
  static std::array<Real, 2> exact(const Real& t) {
    return Forced::exact(t);
  }
  static constexpr int duration = 2;
};

/// f alone, with a mass matrix where there is one, of one type for all systems.
template <class X>
struct AnyFunction {
  using Rows = std::span<Scalar<X>>;
  void (*f)(const Scalar<X>&, const X&, X&);
  void (*matrix)(Rows) = nullptr;

  void operator()(const Scalar<X>& t, const X& x, X& dxdt) const { f(t, x, dxdt); }
  [[nodiscard]] bool has_mass() const { return matrix != nullptr; }
  void mass_matrix(Rows rows) const {
    if (matrix) return matrix(rows);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = Scalar<X>(i % 3 == 0 ? 1 : 0);  // of two components
  }
};
template <class Problem, class X = std::array<double, 2>>
AnyFunction<X> any_function() {
  AnyFunction<X> any{.f = [](const Scalar<X>& t, const X& x, X& dxdt) { Problem{}(t, x, dxdt); }};
  if constexpr (HasMassMatrix<Problem, X>) any.matrix = Problem::mass_matrix;
  return any;
}

/// x[1] appears in no equation: the matrix of any implicit step is singular.
struct LostUnknown {
  static void mass_matrix(std::span<double> rows) { rows[0] = 1, rows[1] = rows[2] = rows[3] = 0; }
  template <class X>
  void operator()(const Scalar<X>&, const X& x, X& dxdt) const {
    dxdt[0] = -x[0];
    dxdt[1] = x[0] - 1;
  }
};

/// f is not a number from t = 0.5 on.
struct NotANumberBeyond {
  template <class X>
  void operator()(const Scalar<X>& t, const X& x, X& dxdt) const {
    using std::sqrt;
    dxdt[0] = -x[0] + 0 * sqrt(Scalar<X>(0.5) - t);
    dxdt[1] = x[0];
  }
};

struct NotANumberInJacobian {
  template <class X>
  void operator()(const Scalar<X>&, const X& x, X& dxdt) const {
    dxdt[0] = -x[0];
    dxdt[1] = x[0];
  }
  template <class X>
  void jacobian(const Scalar<X>&, const X&, EntriesOf<X> rows) const {
    for (auto& entry : rows) entry = std::numeric_limits<Scalar<X>>::quiet_NaN();
  }
};

template <class X>
Scalar<X> greatest_difference(const X& a, const X& b) {
  using std::abs;
  Scalar<X> greatest(0);
  for (std::size_t i = 0; i < a.size(); ++i) greatest = std::max<Scalar<X>>(greatest, abs(a[i] - b[i]));
  return greatest;
}

/// The greatest error at the ends of n equal steps from t = 0 to the end of the problem.
template <class M, class Real = long double>
Real error_of_steps(auto problem, int n) {
  const Real h = Real(problem.duration) / n;
  Real worst(0);
  auto x = problem.exact(Real(0)), x_new = x;
  auto work = M::workspace(x);
  if constexpr (requires { M::set_tolerance(work, Tolerance<Real>{}); })
    M::set_tolerance(work, Tolerance<Real>{Real(1e-14), Real(1e-14)});
  for (int i = 0; i < n; ++i) {
    M::step(problem, Real(h * i), x, h, i == 0, work, x_new);
    M::accept(work);
    x = x_new;
    worst = std::max<Real>(worst, greatest_difference(x, problem.exact(Real(h * (i + 1)))));
  }
  return worst;
}

/// The greatest error of the interpolant of one step of size 1 / n from the exact state at t = 1/4.
template <class M, class Real = long double>
Real dense_error(auto problem, int n) {
  const Real t(0.25), h = Real(1) / n;
  auto x = problem.exact(t), x_new = x, value = x;
  auto work = M::workspace(x);
  if constexpr (requires { M::set_tolerance(work, Tolerance<Real>{}); })
    M::set_tolerance(work, Tolerance<Real>{Real(1e-14), Real(1e-14)});
  Interpolant<std::array<Real, 2>, M::dense_degree> interpolant(x);
  M::step(problem, t, x, h, true, work, x_new);
  M::interpolate(problem, t, x, h, x_new, work, interpolant);
  Real worst(0);
  for (Real theta(0.0625); theta < 1; theta += Real(0.0625)) {
    interpolant(theta, value);
    worst = std::max<Real>(worst, greatest_difference(value, problem.exact(Real(t + theta * h))));
  }
  return worst;
}

/// Both of a problem in long double, compiled once for all of them.
template <class M, class Problem>
long double error_of_steps(int n) {
  return error_of_steps<M>(any_problem<long double, Problem>(), n);
}
template <class M, class Problem>
long double dense_error(int n) {
  return dense_error<M>(any_problem<long double, Problem>(), n);
}

/// log2 of the ratio of the errors of n and 2 n steps.
template <class Error>
double measured_order(const Error& error, int n) {
  return std::log2(static_cast<double>(error(n) / error(2 * n)));
}

}  // namespace continuo::testing
