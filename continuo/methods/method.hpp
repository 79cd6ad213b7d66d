// continuo/methods/method.hpp
// What a method is: one step x(t) -> x(t+h), an error estimate, a polynomial that joins the two ends.
// A method never chooses h, never looks at events and allocates only in `workspace`.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>

#include <continuo/numerics/state.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

/// x(t + theta h) = c[0] + theta (c[1] + theta (c[2] + ...)) for theta in 0..1. Each c is a state.
template <State X, int Degree>
struct Interpolant {
  static constexpr int degree = Degree;  // of the polynomial
  std::array<X, Degree + 1> c;           // its coefficients, that of theta^0 first

  /// Room for coefficients like x.
  explicit Interpolant(const X& x) { c.fill(x); }

  /// x = x(t + theta h), theta in 0..1.
  void operator()(Scalar<X> theta, X& x) const {
    for (std::size_t i = 0; i < dimension(x); ++i) x.data()[i] = component(theta, i);
  }
  /// Component i of x(t + theta h).
  [[nodiscard]] Scalar<X> component(Scalar<X> theta, std::size_t i) const {
    Scalar<X> value = c[Degree].data()[i];
#pragma GCC unroll 20
    for (int j = Degree - 1; j >= 0; --j) value = value * theta + c[static_cast<std::size_t>(j)].data()[i];
    return value;
  }

  /// xs[k] = x(t + thetas[k] h), to the same bits as one at a time, but in half the time where states are small: the
  /// chains of operations of the places are independent of each other.
  template <std::size_t Count>
  void operator()(std::span<const Scalar<X>, Count> thetas, std::span<X, Count> xs) const {
    std::array<Scalar<X>, Count> theta, values;
    std::ranges::copy(thetas, theta.begin());
    for (std::size_t i = 0; i < dimension(xs.front()); ++i) {
      values.fill(c[Degree].data()[i]);
#pragma GCC unroll 20
      for (int j = Degree - 1; j >= 0; --j) {
        const Scalar<X> next = c[static_cast<std::size_t>(j)].data()[i];
#pragma GCC unroll 20
        for (std::size_t k = 0; k < Count; ++k) values[k] = values[k] * theta[k] + next;
      }
      for (std::size_t k = 0; k < Count; ++k) xs[k].data()[i] = values[k];
    }
  }

  /// Becomes the cubic with the values x, x_new and the slopes slope, slope_new (x') at the ends of a step of size h.
  void set_cubic_hermite(const X& x, const X& slope, const X& x_new, const X& slope_new, const Scalar<X>& h)
    requires(Degree >= 3)
  {
    for (std::size_t i = 0; i < dimension(x); ++i) {
      const Scalar<X> difference = x_new.data()[i] - x.data()[i];
      const Scalar<X> first = h * slope.data()[i], last = h * slope_new.data()[i];
      c[0].data()[i] = x.data()[i];
      c[1].data()[i] = first;
      c[2].data()[i] = 3 * difference - 2 * first - last;
      c[3].data()[i] = first + last - 2 * difference;
      for (std::size_t j = 4; j < c.size(); ++j) c[j].data()[i] = Scalar<X>(0);
    }
  }
};

/// Of Tolerance::rounding_of_time: a solution that ends or jumps is not to be passed by steps that measure nothing.
inline constexpr double greatest_rounding_of_time = 0.1;

/// Weights of the error norm: |error_i| is measured against atol_i + rtol_i max(|x_i|, |x_new_i|).
/// One number each, or one per component (then the spans have the size of the state).
template <class Real>
struct Tolerance {
  Real rtol;                        // relative
  Real atol;                        // absolute, in the unit of the components
  const Real* rtol_each = nullptr;  // null, or one per component
  const Real* atol_each = nullptr;  // null, or one per component
  Real rounding_of_time{};          // what rounding of t leaves undecided of a step, as a part of the change it makes

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
  std::size_t jacobians = 0;       // df/dx computed
  std::size_t factorizations = 0;  // of matrices made of it
  std::size_t linear_solves = 0;   // with these factors

  /// For checkpoints.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(jacobians, factorizations, linear_solves);
  }
};

namespace detail {

/// A number that is no truth value and no whole number: a method that returns one where a real number is expected has
/// returned another thing, such as its verdict on the step.
template <class T, class Real>
concept RealResult = std::convertible_to<T, Real> && !std::integral<std::remove_cvref_t<T>>;
template <class T>
concept CountResult = std::integral<std::remove_cvref_t<T>> && !std::same_as<std::remove_cvref_t<T>, bool>;

/// A system that has only declarations, for the concept `Method` where no system is given. A method that takes it by
/// value finds it different from one that takes it by reference.
template <class X, bool Copyable>
struct AnySystem {
  AnySystem(const AnySystem&)
    requires Copyable;
  void operator()(const Scalar<X>& t, const X& x, X& dxdt);
  [[nodiscard]] std::size_t pair_count(std::size_t size) const;
  [[nodiscard]] PositionVelocity pair(std::size_t i, std::size_t size) const;
  void jacobian(const Scalar<X>& t, const X& x, std::span<Scalar<X>> rows);
  [[nodiscard]] Scalar<X> mass(std::size_t i) const;
  void mass_matrix(std::span<Scalar<X>> rows) const;
  void stiff(const Scalar<X>& t, const X& x, X& dxdt);
  void nonstiff(const Scalar<X>& t, const X& x, X& dxdt);
};

// ---- the members of a method, one concept each; the driver finds optional ones by the same concepts

template <class M>
concept HasName = requires {
  { M::name } -> std::convertible_to<std::string_view>;
};
template <class M>
concept HasOrder = requires { requires std::integral_constant<int, M::order>::value >= 1; };
template <class M>
concept HasErrorOrder = requires { requires std::integral_constant<int, M::error_order>::value >= 0; };
template <class M>
concept HasDenseOrder = requires { requires std::integral_constant<int, M::dense_order>::value >= 0; };
template <class M>
concept HasDenseDegree = requires { requires std::integral_constant<int, M::dense_degree>::value >= 1; };
template <class M>
concept HasSecondOrder = requires { typename std::bool_constant<M::second_order>; };
template <class M, class X>
concept HasWorkspace = requires(const X& x) {
  requires std::copy_constructible<typename M::template Workspace<X>>;
  { M::workspace(x) } -> std::same_as<typename M::template Workspace<X>>;
};

template <class M, class X, class System, class Work>
concept HasStep = requires(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                           Work& work, X& x_new) {
  { M::step(system, t, x, h, discontinuity, work, x_new) } -> CountResult;
};
template <class M, class X, class System, class Work, class Polynomial>
concept HasInterpolate = requires(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, const X& x_new,
                                  Work& work, Polynomial& interpolant) {
  { M::interpolate(system, t, x, h, x_new, work, interpolant) } -> CountResult;
};
template <class M, class Work>
concept HasAccept = requires(Work& work) { M::accept(work); };
template <class M, class X, class Work>
concept HasErrorNorm =
    requires(const Work& work, const Scalar<X>& h, const X& x, const X& x_new, const Tolerance<Scalar<X>>& tolerance) {
      { M::error_norm(work, h, x, x_new, tolerance) } -> RealResult<Scalar<X>>;
    };
template <class M, class X, class Work>
concept HasErrorOf = requires(const Work& work, const Scalar<X>& h, std::size_t i) {
  { M::error_of(work, h, i) } -> RealResult<Scalar<X>>;
};
template <class M, class X, class Work>
concept HasDerivative = requires(const Work& work) {
  { M::derivative(work) } -> std::convertible_to<const X&>;
};

template <class M>
concept HasImplicit = requires { typename std::bool_constant<M::implicit>; };
template <class M>
concept HasAutomatic = requires { typename std::bool_constant<M::automatic>; };
template <class M>
concept HasStartingOrder = requires { requires std::integral_constant<int, M::starting_order>::value >= 1; };
template <class M>
concept HasOrderOfFixedSteps = requires { requires std::integral_constant<int, M::order_of_fixed_steps>::value >= 1; };
template <class M, class X, class System>
concept HasUnsupportedReason = requires(const System& system, const X& x) {
  { M::unsupported_reason(system, x) } -> std::convertible_to<std::string_view>;
};
template <class M, class X, class Work>
concept HasSetTolerance =
    requires(Work& work, const Tolerance<Scalar<X>>& tolerance) { M::set_tolerance(work, tolerance); };
template <class M, class Work>
concept HasStatus = requires(const Work& work) {
  { M::status(work) } -> std::convertible_to<StepStatus>;
};
template <class M, class Work>
concept HasFailure = requires(const Work& work) {
  { M::failure(work) } -> std::convertible_to<std::string_view>;
};
template <class M, class Work>
concept HasCosts = requires(const Work& work) {
  { M::costs(work) } -> std::convertible_to<EquationCosts>;
};
template <class M, class Work>
concept HasErrorOrderOf = requires(const Work& work) {
  { M::error_order_of(work) } -> CountResult;
};
template <class M, class X, class Work>
concept HasErrorSquare =
    requires(const Work& work, const Scalar<X>& h, const X& x, const X& x_new, const Tolerance<Scalar<X>>& tolerance) {
      { M::error_square(work, h, x, x_new, tolerance) } -> RealResult<Scalar<X>>;
    };
template <class M, class X, class Work>
concept HasNextFactor = requires(Work& work, const Scalar<X>& factor, const Scalar<X>& h, const X& x, const X& x_new,
                                 const Tolerance<Scalar<X>>& tolerance) {
  { M::next_factor(work, factor, h, x, x_new, tolerance) } -> RealResult<Scalar<X>>;
};
template <class M, class X, class Work>
concept HasRejected = requires(Work& work, const Scalar<X>& h_next) { M::rejected(work, h_next); };
template <class M, class Work>
concept HasStabilityLimits = requires(const Work& work) {
  { M::stability_limits(work) } -> std::convertible_to<bool>;
};
template <class M, class Work>
concept HasRetaken = requires(Work& work) { M::retaken(work); };

template <class M, class X, class Work>
concept HasMoved = requires(Work& work, const X& from, const X& to) { M::moved(work, from, to); };
template <class M, class Work>
concept HasFault = requires(const Work& work) {
  { M::fault(work) } -> std::convertible_to<std::string_view>;
};

template <class M>
[[nodiscard]] constexpr bool is_implicit() {
  if constexpr (HasImplicit<M>) {
    return M::implicit;
  } else {
    return false;
  }
}
template <class M>
[[nodiscard]] constexpr bool is_automatic() {
  if constexpr (HasAutomatic<M>) {
    return M::automatic;
  } else {
    return false;
  }
}
template <class M>
[[nodiscard]] constexpr bool estimates_error() {
  if constexpr (HasErrorOrder<M>) {
    return M::error_order > 0;
  } else {
    return false;
  }
}
template <class M, class Work>
[[nodiscard]] StepStatus status_of(const Work& work) {
  if constexpr (HasStatus<M, Work>) {
    return M::status(work);
  } else {
    return StepStatus::done;
  }
}
template <class M>
[[nodiscard]] constexpr int starting_order() {
  if constexpr (HasStartingOrder<M>) {
    return M::starting_order;
  } else {
    return M::order;
  }
}
template <class M>
[[nodiscard]] constexpr int order_of_fixed_steps() {
  if constexpr (HasOrderOfFixedSteps<M>) {
    return M::order_of_fixed_steps;
  } else {
    return M::order;
  }
}
template <class M, class Work>
[[nodiscard]] int error_order_of(const Work& work) {
  if constexpr (HasErrorOrderOf<M, Work>) {
    return M::error_order_of(work);
  } else {
    return M::error_order;
  }
}

}  // namespace detail

/// A method is a type with these static members, with Real = Scalar<X>. M::Workspace<X> contains the stages; it lives
/// as long as the run, and can be copied. `check_method` (check_method.hpp) tells by a sentence what a type lacks to be
/// a method; docs/extending.md has an example.
///   M::name           its name in models and on the command line
///   M::order          order of x_new; M::error_order: order of the embedded solution, 0 where there is no estimate
///   M::dense_order    order of the interpolant, M::dense_degree its degree in theta
///   M::second_order   true where the system must be SecondOrder (x'' = a(t, x))
///   M::workspace(const X& x) -> Workspace<X>; the only member that allocates
///   M::step(System& system, Real t, const X& x, Real h, bool discontinuity, Workspace<X>& work, X& x_new) -> number of
///       evaluations of f;
///       discontinuity: x is not where the last step ended, drop what was kept of it (FSAL stage, history)
///   M::interpolate(System& system, Real t, const X& x, Real h, const X& x_new, Workspace<X>& work,
///       Interpolant<X, dense_degree>& interpolant) -> number of evaluations; at most once, after a step
///   M::accept(Workspace<X>& work)   the step is valid: its end becomes the start of the next
/// and with an error estimate:
///   M::error_norm(const Workspace<X>& work, Real h, const X& x, const X& x_new, const Tolerance<Real>& tolerance) ->
///       the step is good where it is <= 1 (root mean square)
///   M::error_of(const Workspace<X>& work, Real h, std::size_t i) -> estimated local error of component i, to name the
///       worst one
///   M::derivative(const Workspace<X>& work) -> x' at the start of the last step; not needed of implicit methods,
///   except
///       by Switching
/// Optional members. One that has the name and another signature is refused by `check_method`:
///   M::unsupported_reason(const System& system, const X& x)  why the method does not support this system, to be read
///       after its name; empty where it does. A run that it does not support does not begin
///   M::error_square(work, h, x, x_new, tolerance)  the square of error_norm, for a driver that does not need the root;
///       not a number where a component of x_new is not finite
///   M::implicit       true where M x' = f(t, x) with a mass matrix (singular, of index 1) can be integrated. With the
///       next three inherited from ImplicitMethod (implicit/implicit_method.hpp):
///   M::set_tolerance(Workspace<X>& work, const Tolerance<Real>& tolerance)  before every step: how accurately the
///       equations of the step must be solved
///   M::status(const Workspace<X>& work)   -> StepStatus of the last step; a step that is not `done` is rejected and
///       tried with a smaller h
///   M::costs(const Workspace<X>& work)    -> EquationCosts
///   M::failure(const Workspace<X>& work)  -> where the status of the last step is not `done`, why; empty where the
///       method knows no more than its status says. A run that ends there has it as its hint
///   M::automatic      true where it is an explicit and a stiff method that hand over to each other
///   M::error_order_of(const Workspace<X>& work) -> error_order where the order varies (then M::order and
///       M::error_order are the greatest)
///   M::starting_order order of the first step of a run and after a jump, where the order varies
///   M::order_of_fixed_steps where the order varies: the one that steps of a fixed size keep
///   M::next_factor(Workspace<X>& work, Real factor, Real h, const X& x, const X& x_new, const Tolerance<Real>&
///       tolerance) -> after a step whose error passed and before `accept`: the factor for the next h, where `factor`
///       is the one of the controller. A method of variable order chooses its next order here; one that keeps a
///       factorization may return 1. A factor that is not above 0 is replaced by that of the controller
///   M::sizes_its_steps  true where `next_factor` needs no controller: `factor` is 1
///   M::at_part(const Workspace<X>& work, Real h, Real theta, X& x)  x at a part of the last step, where that is
///       quicker than the polynomial of `interpolate`, from which it differs by rounding
///   M::rejected(Workspace<X>& work, Real h_next) the last step was not accepted and will be tried again
///   M::stability_limits(const Workspace<X>& work) -> whether stability may limit the last step; assumed of every
///       explicit method without it
///   M::retaken(Workspace<X>& work)  the last step was good and is taken once more, to end at an event; where there is
///       none, nothing needs to be done
///   M::moved(Workspace<X>& work, const X& from, const X& to)  after `accept`: the next step begins at `to` and not at
///       `from`, where the last one ended, which is nearer than the tolerance; f is the same. A method that keeps
///       states of before moves them by the same way, and drops f at `from`
///   M::fault(const Workspace<X>& work) -> why the run cannot go on with this method, after a step whose error was
///       measured and after `next_factor`; empty where it can. A method with it is refused where steps have a fixed
///       size: it controls the error by something of its own (with_norm.hpp, with_controller.hpp)
template <class M, class X, class System = detail::AnySystem<X, false>>
concept Method =
    State<X> && detail::HasName<M> && detail::HasOrder<M> && detail::HasErrorOrder<M> && detail::HasDenseOrder<M> &&
    detail::HasDenseDegree<M> && detail::HasSecondOrder<M> && detail::HasWorkspace<M, X> &&
    detail::HasStep<M, X, System, typename M::template Workspace<X>> &&
    detail::HasInterpolate<M, X, System, typename M::template Workspace<X>, Interpolant<X, M::dense_degree>> &&
    detail::HasAccept<M, typename M::template Workspace<X>> &&
    (!detail::estimates_error<M>() ||
     (detail::HasErrorNorm<M, X, typename M::template Workspace<X>> &&
      detail::HasErrorOf<M, X, typename M::template Workspace<X>> &&
      (detail::is_implicit<M>() || detail::HasDerivative<M, X, typename M::template Workspace<X>>)));

}  // namespace continuo
