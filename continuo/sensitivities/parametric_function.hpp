// A right-hand side with parameters, x' = f(t, x, p), as a C++ function: f(t, x, p) returns the derivative, or f(t, x,
// p, dxdt) writes it. Its derivatives come from members, each found by its name, else from one traced evaluation where
// f takes any number type, else from differences:
//
//   jacobian(t, x, p, rows)                           df/dx, n * n numbers row by row, which begin as zeros
//   parameter_jacobian(t, x, p, rows)                 df/dp, n * m numbers row by row, which begin as zeros
//   vector_jacobian(t, x, p, lambda, product)         lambda^T df/dx; only adjoints use it
//   vector_parameter_jacobian(t, x, p, lambda, product)  lambda^T df/dp; only adjoints use it
#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>

#include <continuo/numerics/state.hpp>
#include <continuo/sensitivities/traced.hpp>
#include <continuo/system/check_system.hpp>
#include <continuo/system/rebound_state.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

/// f writes its result: f(t, x, p, dxdt).
template <class F, class T, class X, class P>
concept WritesParametricDerivative = std::invocable<F&, T, const X&, const P&, X&>;
/// f returns its result: dxdt = f(t, x, p).
template <class F, class T, class X, class P>
concept ReturnsParametricDerivative = std::invocable<F&, T, const X&, const P&> &&
                                      std::convertible_to<std::invoke_result_t<F&, T, const X&, const P&>, X>;
/// A right-hand side with parameters, for states of type X and parameters of type P. T is the type of t.
template <class F, class X, class P, class T = Scalar<X>>
concept ParametricFunction = WritesParametricDerivative<F, T, X, P> || ReturnsParametricDerivative<F, T, X, P>;

/// dxdt = f(t, x, p), for an f that writes its result or returns it. If it has another size than x, all of dxdt is NaN.
template <class F, class T, class X, class P>
void evaluate(F& f, const T& t, const X& x, const P& p, X& dxdt) {
  if constexpr (WritesParametricDerivative<F, T, X, P>) {
    f(t, x, p, dxdt);
  } else {
    dxdt = f(t, x, p);
  }
  if constexpr (requires { detail::keep_size(x, dxdt); }) detail::keep_size(x, dxdt);
}

/// The number of evaluations that derivatives have cost. A traced evaluation is one of f.
struct DerivativeCosts {
  std::size_t evaluations = 0;               // of f
  std::size_t jacobians = 0;                 // of df/dx or df/dp, as members of f
  std::size_t vector_jacobian_products = 0;  // lambda^T df/dx and lambda^T df/dp together
};

namespace detail {

template <State X>
using TracedState = ReboundState<X, Traced<Scalar<X>>>;

/// f takes traced numbers, with a traced t or a plain one.
template <class F, class X, class P>
concept TraceableWithTime = ParametricFunction<F, TracedState<X>, TracedState<P>, Traced<Scalar<X>>>;
template <class F, class X, class P>
concept Traceable = TraceableWithTime<F, X, P> || ParametricFunction<F, TracedState<X>, TracedState<P>, Scalar<X>>;

template <class F, class X, class P>
concept HasParametricJacobian =
    requires(F& f, Scalar<X> t, const X& x, const P& p, std::span<Scalar<X>> rows) { f.jacobian(t, x, p, rows); };
template <class F, class X, class P>
concept HasParameterJacobian = requires(F& f, Scalar<X> t, const X& x, const P& p, std::span<Scalar<X>> rows) {
  f.parameter_jacobian(t, x, p, rows);
};
template <class F, class X, class P>
concept HasVectorJacobian =
    requires(F& f, Scalar<X> t, const X& x, const P& p, X& product) { f.vector_jacobian(t, x, p, x, product); };
template <class F, class X, class P>
concept HasVectorParameterJacobian = requires(F& f, Scalar<X> t, const X& x, const P& p, P& product) {
  f.vector_parameter_jacobian(t, x, p, x, product);
};

struct NameParameterJacobian {
  int parameter_jacobian;
};
template <class F>
concept MentionsParameterJacobian =
    Inspectable<F> && !requires { &WithName<F, NameParameterJacobian>::parameter_jacobian; };
struct NameVectorJacobian {
  int vector_jacobian;
};
template <class F>
concept MentionsVectorJacobian = Inspectable<F> && !requires { &WithName<F, NameVectorJacobian>::vector_jacobian; };
struct NameVectorParameterJacobian {
  int vector_parameter_jacobian;
};
template <class F>
concept MentionsVectorParameterJacobian =
    Inspectable<F> && !requires { &WithName<F, NameVectorParameterJacobian>::vector_parameter_jacobian; };

/// Members of systems that sensitivities would leave out.
template <class F>
concept MentionsUnusedMember =
    MentionsPairCount<F> || MentionsPair<F> || MentionsJacobianPattern<F> || MentionsJacobianValues<F> ||
    MentionsJacobianBand<F> || MentionsJacobianAction<F> || MentionsTimeDerivative<F> || MentionsPrecondition<F> ||
    MentionsSetUpPreconditioner<F> || MentionsSpectralRadius<F> || MentionsStiff<F> || MentionsNonstiff<F> ||
    MentionsStiffJacobian<F> || MentionsIgnoresVelocity<F>;

}  // namespace detail

/// Refuses, at compile time, an f that is no right-hand side with parameters, or of which a part would be ignored; true
/// where it can be called.
template <class F, class X, class P>
[[nodiscard]] consteval bool check_parametric_function() {
  using namespace detail;
  constexpr bool states = check_state<X>() && check_state<P>();
  if constexpr (!states) {
    return false;
  } else {
    constexpr bool callable = ParametricFunction<F, X, P>, same = std::same_as<Scalar<X>, Scalar<P>>;
    static_assert(same, "the state x0 and the parameters p must have components of the same number type");
    static_assert(
        callable,
        "f can be called neither as dxdt = f(t, x, p) nor as f(t, x, p, dxdt), with t a number, x and dxdt of "
        "the type of x0, and p of the type of the parameters");
    static_assert(!MentionsJacobian<F> || HasParametricJacobian<F, X, P>,
                  "the member `jacobian` would be ignored: with parameters it must be public: void jacobian(Real t, "
                  "const X& x, const P& p, std::span<Real> rows), with the n*n numbers row by row");
    static_assert(!MentionsParameterJacobian<F> || HasParameterJacobian<F, X, P>,
                  "the member `parameter_jacobian` would be ignored: it must be public: void parameter_jacobian(Real "
                  "t, const X& x, const P& p, std::span<Real> rows), with the n*m numbers row by row");
    static_assert(
        !MentionsVectorJacobian<F> || HasVectorJacobian<F, X, P>,
        "the member `vector_jacobian` would be ignored: it must be public: void vector_jacobian(Real t, const "
        "X& x, const P& p, const X& lambda, X& product)");
    static_assert(!MentionsVectorParameterJacobian<F> || HasVectorParameterJacobian<F, X, P>,
                  "the member `vector_parameter_jacobian` would be ignored: it must be public: void "
                  "vector_parameter_jacobian(Real t, const X& x, const P& p, const X& lambda, P& product)");
    static_assert(!(MentionsMassMatrix<F> || MentionsMass<F> || MentionsHasMass<F>),
                  "sensitivities are those of x' = f(t, x, p): a mass matrix is not supported, so M must be divided by "
                  "within f");
    static_assert(!MentionsUnusedMember<F>,
                  "a member of the system would be ignored: sensitivities use jacobian, parameter_jacobian, "
                  "vector_jacobian, vector_parameter_jacobian, component_name and autonomous");
    static_assert(!MentionsComponentName<F> || Named<F>,
                  "the member `component_name` of the system would be ignored: it must be public and const, and give a "
                  "text: std::string component_name(std::size_t i) const");
    static_assert(
        !MentionsAutonomous<F> || KnowsAutonomous<F>,
        "the member `autonomous` of the system would be ignored: it must be a public variable: bool autonomous");
    return callable && same;
  }
}

}  // namespace continuo
