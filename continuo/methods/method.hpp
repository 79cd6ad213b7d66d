// continuo/methods/method.hpp
// What a method is: one step x(t) -> x(t+h), an error estimate, a polynomial that joins the two ends.
// A method never chooses h, never looks at events and allocates only in `workspace`.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include <continuo/numerics/state.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

/// x(t + theta h) = c[0] + theta (c[1] + theta (c[2] + ...)) for theta in 0..1. Each c is a state.
template <State X, int Degree>
struct Interpolant {
  static constexpr int degree = Degree;
  std::array<X, Degree + 1> c;

  /// Room for coefficients like x.
  explicit Interpolant(const X& x) { c.fill(x); }

  /// x = x(t + theta h), theta in 0..1.
  void operator()(Scalar<X> theta, X& x) const {
    for (std::size_t i = 0; i < dimension(x); ++i) x.data()[i] = component(theta, i);
  }
  /// Component i of x(t + theta h).
  [[nodiscard]] Scalar<X> component(Scalar<X> theta, std::size_t i) const {
    Scalar<X> value = c[Degree].data()[i];
    for (int j = Degree - 1; j >= 0; --j) value = value * theta + c[static_cast<std::size_t>(j)].data()[i];
    return value;
  }
};

/// Of Tolerance::rounding_of_time: a solution that ends or jumps is not to be passed by steps that measure nothing.
inline constexpr double greatest_rounding_of_time = 0.1;

/// Weights of the error norm: |error_i| is measured against atol_i + rtol_i max(|x_i|, |x_new_i|).
/// One number each, or one per component (then the spans have the size of the state).
template <class Real>
struct Tolerance {
  Real rtol, atol;
  const Real* rtol_each = nullptr;  // null, or one per component
  const Real* atol_each = nullptr;
  Real rounding_of_time{};  // what rounding of t leaves undecided of a step, as a part of the change it makes

  /// The size against which an error of component i is measured; the unit is that of the component.
  [[nodiscard]] Real scale(std::size_t i, const Real& x, const Real& x_new) const {
    using std::abs;
    using std::max;
    return (atol_each ? atol_each[i] : atol) + (rtol_each ? rtol_each[i] : rtol) * max(abs(x), abs(x_new));
  }
  /// Of a step from x to x_new. An unknown of 0 = g(t, x) is known no better than t is: to |x'| times the spacing of
  /// numbers at t, which no shorter step makes less.
  [[nodiscard]] Real scale_of_step(std::size_t i, const Real& x, const Real& x_new) const {
    using std::abs;
    return scale(i, x, x_new) + rounding_of_time * abs(x_new - x);
  }
  /// For an error that is multiplied by a factor before it is measured: rounding is not.
  [[nodiscard]] Tolerance of_error_times(const Real& factor) const {
    Tolerance result = *this;
    result.rounding_of_time *= factor;
    return result;
  }
};

/// How a step ended, of the methods that solve equations in it.
enum class StepStatus { done, newton_diverged, singular_matrix, not_finite };

/// What the solving of equations cost since the workspace was made.
struct EquationCosts {
  std::size_t jacobians = 0, factorizations = 0, linear_solves = 0;
};

/// A method is a type with these static members. M::Workspace<X> holds the stages; it lives as long as the run.
///   M::name           its name in models and on the command line
///   M::order          order of x_new; M::error_order: order of the embedded solution, 0 where there is no estimate
///   M::dense_order    order of the interpolant, M::dense_degree its degree in theta
///   M::second_order   true where the system must be SecondOrder (x'' = a(t, x))
///   M::workspace(x)   allocates once
///   M::step(system, t, x, h, discontinuity, work, x_new) -> number of evaluations of f;
///       discontinuity: x is not where the last step ended, drop what was kept of it (FSAL stage, history)
///   M::error_norm(work, h, x, x_new, tolerance) -> the step is good where it is <= 1 (root mean square); not a number
///       where a component of x_new is not finite
///   M::error_of(work, h, i) -> estimated local error of component i, to name the worst one
///   M::interpolate(system, t, x, h, x_new, work, interpolant) -> number of evaluations; once, after a step
///   M::accept(work)   the step stands: its end becomes the start of the next
///   M::derivative(work) -> x' at the start of the last step
/// Methods that need more of the driver have, each found by its name and missing elsewhere:
///   M::unsupported_reason(system, x)  what the method has against this system, to be read after its name; empty where
///       nothing. A run of what it refuses does not begin
///   M::implicit       true where M x' = f(t, x) with a mass matrix (singular, of index 1) can be integrated. With the
///       next three inherited from ImplicitMethod (implicit/implicit_method.hpp):
///   M::set_tolerance(work, tolerance)  before every step: how close the equations of the step must be solved
///   M::status(work)   -> StepStatus of the last step; what is not `done` is rejected and tried with a smaller h
///   M::costs(work)    -> EquationCosts
///   M::automatic      true where it is an explicit and a stiff method that hand over to each other
///   M::error_order_of(work) -> error_order where the order varies (then M::order and M::error_order are the greatest)
///   M::starting_order order of the first step of a run and after a jump, where the order varies
///   M::order_of_fixed_steps where the order varies: the one that steps of a fixed size keep
///   M::next_factor(work, factor, h, x, x_new, tolerance) -> after a step whose error passed and before `accept`: the
///       factor for the next h, where `factor` is what the controller wants. A method of variable order chooses its
///       next order here; one that keeps a factorization may answer 1.
///   M::rejected(work, h_next) the last step was not accepted and will be tried again
///   M::retaken(work)  the last step was good and is taken once more, to end at an event; where there is none, nothing
///       needs to be done
template <class M, class X>
concept Method = State<X> && requires(const X& x) {
  typename M::template Workspace<X>;
  { M::name } -> std::convertible_to<std::string_view>;
  { M::order } -> std::convertible_to<int>;
  { M::error_order } -> std::convertible_to<int>;
  { M::dense_degree } -> std::convertible_to<int>;
  { M::second_order } -> std::convertible_to<bool>;
  { M::workspace(x) } -> std::same_as<typename M::template Workspace<X>>;
};

namespace detail {

template <class M>
[[nodiscard]] constexpr bool is_implicit() {
  if constexpr (requires { M::implicit; }) {
    return M::implicit;
  } else {
    return false;
  }
}
template <class M>
[[nodiscard]] constexpr bool is_automatic() {
  if constexpr (requires { M::automatic; }) {
    return M::automatic;
  } else {
    return false;
  }
}
template <class M, class Work>
[[nodiscard]] StepStatus status_of(const Work& work) {
  if constexpr (requires { M::status(work); }) {
    return M::status(work);
  } else {
    return StepStatus::done;
  }
}
template <class M>
[[nodiscard]] constexpr int starting_order() {
  if constexpr (requires { M::starting_order; }) {
    return M::starting_order;
  } else {
    return M::order;
  }
}
template <class M>
[[nodiscard]] constexpr int order_of_fixed_steps() {
  if constexpr (requires { M::order_of_fixed_steps; }) {
    return M::order_of_fixed_steps;
  } else {
    return M::order;
  }
}
template <class M, class Work>
[[nodiscard]] int error_order_of(const Work& work) {
  if constexpr (requires { M::error_order_of(work); }) {
    return M::error_order_of(work);
  } else {
    return M::error_order;
  }
}

}  // namespace detail

}  // namespace continuo
