// A system together with the parameters of one run, or of one run per lane: as the steppers call it, f(t, x, dxdt).
#pragma once
#include <cstddef>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include <continuo/numerics/state.hpp>
#include <continuo/system/autonomy.hpp>
#include <continuo/system/system.hpp>

namespace continuo::detail {

/// Whether a run has parameters: an empty array is what a start without any has.
template <class P>
inline constexpr bool has_parameters = true;
template <FixedSize P>
inline constexpr bool has_parameters<P> = std::tuple_size_v<P> > 0;

/// f and p. The function is not owned.
template <class F, class P>
struct SystemWithParameters : AutonomyOf<F> {
  F* f;
  P p;

  SystemWithParameters(F* f_, P p_) : f(f_), p(std::move(p_)) {
    if constexpr (KnowsAutonomous<F>) this->autonomous = f->autonomous;
  }

  template <State X>
  [[gnu::always_inline]] void operator()(const Scalar<X>& t, const X& x, X& dxdt) {
    if constexpr (!has_parameters<P>) {
      evaluate(*f, t, x, dxdt);
    } else if constexpr (std::is_invocable_v<F&, const Scalar<X>&, const X&, X&, const P&>) {
      (*f)(t, x, dxdt, static_cast<const P&>(p));
    } else {
      dxdt = (*f)(t, x, static_cast<const P&>(p));
    }
  }

  /// df/dx and df/dt, where f has them: with the parameters as its last argument, if there are any.
  template <State X>
    requires(!has_parameters<P> && HasJacobian<F, X>)
  void jacobian(const Scalar<X>& t, const X& x, std::span<Scalar<X>> rows) {
    f->jacobian(t, x, rows);
  }
  template <State X>
    requires requires(F& g, const Scalar<X>& t, const X& x, std::span<Scalar<X>> rows, const P& q) {
      g.jacobian(t, x, rows, q);
    }
  void jacobian(const Scalar<X>& t, const X& x, std::span<Scalar<X>> rows) {
    f->jacobian(t, x, rows, static_cast<const P&>(p));
  }
  template <State X>
    requires(!has_parameters<P> && HasTimeDerivative<F, X>)
  void time_derivative(const Scalar<X>& t, const X& x, X& dfdt) {
    f->time_derivative(t, x, dfdt);
  }
  template <State X>
    requires requires(F& g, const Scalar<X>& t, const X& x, X& dfdt, const P& q) { g.time_derivative(t, x, dfdt, q); }
  void time_derivative(const Scalar<X>& t, const X& x, X& dfdt) {
    f->time_derivative(t, x, dfdt, static_cast<const P&>(p));
  }
};

/// A guard at (t, x): it takes the parameters too where it is written so.
template <class G, class Real, class X, class P>
[[nodiscard]] [[gnu::always_inline]] inline Real guard_value(const G& guard, const Real& t, const X& x, const P& p) {
  if constexpr (std::is_invocable_v<const G&, const Real&, const X&, const P&>) {
    return guard(t, x, p);
  } else {
    return guard(t, x);
  }
}

}  // namespace continuo::detail
