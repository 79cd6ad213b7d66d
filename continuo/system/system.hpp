// continuo/system/system.hpp
// What a continuous system is: dx/dt = f(t, x). A lambda is one already:
//
//   auto decay = [](double t, const std::array<double, 1>& x) { return std::array{-x[0]}; };
//   auto heavy = [](double t, const std::vector<double>& x, std::vector<double>& dxdt) { dxdt[0] = -x[0]; };
//
// What a lambda cannot say (names of the components, Jacobian, mass matrix, the pairs of position and velocity)
// stands in the members of `System` or of a type of your own; each is found by its name and may be missing.
#pragma once
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include <continuo/numerics/sparse_pattern.hpp>
#include <continuo/numerics/state.hpp>

namespace continuo {

/// f writes its result: f(t, x, dxdt).
template <class F, class X>
concept WritesDerivative = State<X> && std::invocable<F&, Scalar<X>, const X&, X&>;

/// f returns its result: dxdt = f(t, x).
template <class F, class X>
concept ReturnsDerivative = State<X> && std::invocable<F&, Scalar<X>, const X&> &&
                            std::convertible_to<std::invoke_result_t<F&, Scalar<X>, const X&>, X>;

/// A right-hand side for states of type X.
template <class F, class X>
concept RightHandSide = WritesDerivative<F, X> || ReturnsDerivative<F, X>;

namespace detail {
/// A result of another size than the state. It becomes one of the size of the state that is not a number, so that
/// nothing is read beyond its end, and the step is rejected.
template <State X>
[[gnu::noinline]] void discard_result(const X& x, X& dxdt) {
  dxdt = x;
  for (std::size_t i = 0; i < dimension(dxdt); ++i)
    dxdt.data()[i] = Scalar<X>(std::numeric_limits<double>::quiet_NaN());
}
/// Discards what a function of the system has written for a state x where it has another size.
template <State X>
void keep_size(const X& x, X& result) {
  if constexpr (!FixedSize<X>) {
    if (dimension(result) != dimension(x)) [[unlikely]]
      discard_result(x, result);
  }
}
}  // namespace detail

/// dxdt = f(t, x), for an f that writes its result or returns it. If it has another size than x, all of dxdt is NaN.
template <State X, RightHandSide<X> F>
void evaluate(F& f, const Scalar<X>& t, const X& x, X& dxdt) {
  if constexpr (WritesDerivative<F, X>) {
    f(t, x, dxdt);
  } else {
    dxdt = f(t, x);
  }
  detail::keep_size(x, dxdt);
}

/// Why dx/dt at (t, x) cannot be used: its size is not that of x. Empty where it is. Evaluates f once.
template <State X, RightHandSide<X> F>
[[nodiscard]] std::string problem_of_result(F& f, const Scalar<X>& t, const X& x) {
  if constexpr (FixedSize<X>) {
    return {};
  } else {
    X dxdt = x;
    if constexpr (WritesDerivative<F, X>) {
      f(t, x, dxdt);
    } else {
      dxdt = f(t, x);
    }
    if (dimension(dxdt) == dimension(x)) return {};
    return "f gives " + std::to_string(dimension(dxdt)) + " derivatives of " + std::to_string(dimension(x)) +
           " components: it must give one for each component of the state";
  }
}

/// The system knows the names of its components (used in messages and tables).
template <class F>
concept Named = requires(const F& f, std::size_t i) {
  { f.component_name(i) } -> std::convertible_to<std::string_view>;
};

/// A position and its velocity, as components of the state.
struct PositionVelocity {
  std::size_t position;  // the component x[position], a position
  std::size_t velocity;  // the component that is its derivative
};
/// The system says which components are a position and which the velocity of that position: pair_count(size) and
/// pair(i, size), with x[position]' = x[velocity]. Methods for x'' = a(t, x) need it.
template <class F>
concept SecondOrder = requires(const F& f, std::size_t size) {
  { f.pair_count(size) } -> std::convertible_to<std::size_t>;
  { f.pair(std::size_t{}, size) } -> std::convertible_to<PositionVelocity>;
};

/// The system gives df/dx: f.jacobian(t, x, span of n*n, row by row), which begins as zeros. Implicit methods need it.
template <class F, class X>
concept HasJacobian = requires(F& f, Scalar<X> t, const X& x, std::span<Scalar<X>> rows) { f.jacobian(t, x, rows); };

/// The system knows where df/dx may differ from zero. The pattern must hold the run long; an empty one says nothing.
template <class F>
concept HasJacobianPattern = requires(F& f) {
  { f.jacobian_pattern() } -> std::convertible_to<const SparsePattern&>;
};
/// The system gives the entries of df/dx in the order of its pattern: f.jacobian_values(t, x, span), which begins as
/// zeros.
template <class F, class X>
concept HasSparseJacobian =
    HasJacobianPattern<F> &&
    requires(F& f, Scalar<X> t, const X& x, std::span<Scalar<X>> values) { f.jacobian_values(t, x, values); };
/// The system gives them as they lie in the layout of the pattern's band, and writes nothing else: f.jacobian_band(t,
/// x, span).
template <class F, class X>
concept HasBandJacobian =
    HasSparseJacobian<F, X> &&
    requires(F& f, Scalar<X> t, const X& x, std::span<Scalar<X>> band) { f.jacobian_band(t, x, band); };
/// The system gives df/dt: f.time_derivative(t, x, dfdt).
template <class F, class X>
concept HasTimeDerivative = requires(F& f, Scalar<X> t, const X& x, X& dfdt) { f.time_derivative(t, x, dfdt); };

/// The system multiplies by df/dx without writing it down: f.jacobian_action(t, x, v, product).
template <class F, class X>
concept HasJacobianAction =
    requires(F& f, Scalar<X> t, const X& x, X& product) { f.jacobian_action(t, x, x, product); };
/// The system solves (c M - df/dx) y = r approximately, to help an iteration without a matrix: what is needed for it is
/// set up at a state and a c, then used for many r, each of which becomes its y.
template <class F, class X>
concept HasPreconditioner = requires(F& f, Scalar<X> t, const X& x, X& r) {
  f.set_up_preconditioner(t, x, t);
  f.precondition(r);
};

/// The system says that f does not depend on t: f.autonomous, true or false, when compiling or at run time. Methods
/// that need df/dt then do without; of a system that says nothing they take it by a difference, one evaluation a step.
template <class F>
concept KnowsAutonomous = requires(const F& f) {
  { f.autonomous } -> std::convertible_to<bool>;
};
/// Whether the system says that f does not depend on t; false of a system that says nothing.
template <class F>
[[nodiscard]] constexpr bool is_autonomous(const F& f) {
  if constexpr (KnowsAutonomous<F>) {
    return f.autonomous;
  } else {
    return false;
  }
}

/// Whether the system says that f depends on t; a function alone says neither.
template <class F>
[[nodiscard]] constexpr bool is_known_to_depend_on_time(const F& f) {
  if constexpr (KnowsAutonomous<F>) {
    return !f.autonomous;
  } else {
    return false;
  }
}

/// The system knows how large the eigenvalues of df/dx become: f.spectral_radius(t, x), not below the greatest of
/// their sizes. Stabilised explicit methods choose their stages by it.
template <class F, class X>
concept HasSpectralRadius = requires(F& f, Scalar<X> t, const X& x) {
  { f.spectral_radius(t, x) } -> std::convertible_to<Scalar<X>>;
};

/// The system reads M x' = f(t, x) with a constant M: f.mass_matrix(span of n*n, row by row). M may be singular: the
/// system is then one of differential and algebraic equations.
template <class F, class X>
concept HasMassMatrix = requires(const F& f, std::span<Scalar<X>> rows) { f.mass_matrix(rows); };
/// The same for a diagonal M: f.mass(i), 0 for an algebraic equation.
template <class F, class X>
concept HasMassDiagonal = requires(const F& f, std::size_t i) {
  { f.mass(i) } -> std::convertible_to<Scalar<X>>;
};
/// The system is a sum of a stiff and a nonstiff part: f.stiff(t, x, dxdt), f.nonstiff(t, x, dxdt); f itself is the
/// sum.
template <class F, class X>
concept IsSplit = requires(F& f, Scalar<X> t, const X& x, X& dxdt) {
  f.stiff(t, x, dxdt);
  f.nonstiff(t, x, dxdt);
};
/// The Jacobian of the stiff part of a split system: f.stiff_jacobian(t, x, span of n*n, row by row).
template <class F, class X>
concept HasStiffJacobian =
    requires(F& f, Scalar<X> t, const X& x, std::span<Scalar<X>> rows) { f.stiff_jacobian(t, x, rows); };

/// The name of component i, `x[i]` where the system has none.
template <class F>
[[nodiscard]] std::string component_name(const F& f, std::size_t i) {
  if constexpr (Named<F>) {
    return std::string(f.component_name(i));
  } else {
    return "x[" + std::to_string(i) + "]";
  }
}

}  // namespace continuo
