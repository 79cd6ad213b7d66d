// continuo/methods/with_controller.hpp
// A method with a step size controller of your own, as a type: methods without one pay nothing. The exponents of the
// controllers P, PI and PID are options of a run (Controller); here are those that are no such product.
//
//   solve(f, x0, {0, 10}, with_controller(Tsitouras5{}, H211b{}), {.rtol = 1e-9});
#pragma once
#include <cmath>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <type_traits>

#include <continuo/methods/check_method.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/numerics/finite.hpp>

namespace continuo {

/// What a controller is told of an accepted step.
template <class Real>
struct StepError {
  Real error;  // in tolerances, at most 1, and above 0
  Real h;      // the step; its sign is that of time
  int order;   // of the error estimate: the error is of the size of h^(order + 1)
};

/// A controller of step sizes: called with each accepted step it returns the factor for the next one, within
/// least_factor_of_controllers .. greatest_factor_of_controllers. What it keeps of the steps before are its members; it
/// begins anew, as `C{}`, where a run does.
template <class C, class Real>
concept StepController =
    std::copyable<C> && std::default_initializable<C> && requires(C& controller, const StepError<Real>& step) {
      { controller(step) } -> detail::RealResult<Real>;
    };
inline constexpr double least_factor_of_controllers = 1e-3, greatest_factor_of_controllers = 1e3;

/// Each step by the error of the last alone, so that it would be the safety factor to the power order + 1: the
/// elementary controller.
struct Deadbeat {
  /// The factor for the next step.
  template <class Real>
  [[nodiscard]] Real operator()(const StepError<Real>& step) const {
    using std::max, std::min, std::pow;
    const Real factor = Real(0.9) * pow(step.error, Real(-1) / Real(step.order + 1));
    return max(Real(0.2), min(Real(5), factor));
  }
};

/// The filter H211b with b = 4 and the limiter 1 + atan(factor - 1), for smooth sequences of steps: the roughness of
/// the errors is averaged out. G. Soderlind, "Digital filters in adaptive time-stepping", ACM TOMS 29 (2003), 5.2; G.
/// Soderlind, L. Wang, "Adaptive time-stepping and computational stability", J. Comput. Appl. Math. 185 (2006).
struct H211b {
  /// The factor for the next step.
  template <class Real>
  [[nodiscard]] Real operator()(const StepError<Real>& step) {
    using std::atan, std::pow;
    const Real exponent = Real(1) / Real(4 * (step.order + 1));
    const Real goal = pow(Real(0.8), Real(step.order + 1));
    const Real here = pow(goal / step.error, exponent);
    const Real before = known ? Real(last) : here, ratio = known ? Real(last_factor) : Real(1);
    const Real factor = Real(1) + atan(here * before * pow(ratio, Real(-0.25)) - Real(1));
    last = static_cast<double>(here);
    last_factor = static_cast<double>(factor);
    known = true;
    return factor;
  }

  double last = 1, last_factor = 1;
  bool known = false;
};

/// The method M with steps chosen by C. A step after a rejected one is no longer than that, and rejected steps are
/// taken again by the controller of the options. It has the static functions of the concept Method.
template <class M, class C>
struct WithController : M {
  static_assert(detail::estimates_error<M>(), "the method has no error estimate that a controller could follow");

  /// The workspace of M, and the controller.
  template <State X>
  struct Workspace : M::template Workspace<X> {
    C controller{};
    mutable Scalar<X> error{};  // of the last step
    bool controls = true;
  };

  /// Refuses, by a sentence, what cannot be combined for states X; true where all can.
  template <State X>
  [[nodiscard]] static consteval bool check_for_states() {
    constexpr bool controller = StepController<C, Scalar<X>>;
    static_assert(controller,
                  "a controller is called as controller(const StepError<Real>& step) and returns a Real, and can be "
                  "copied and made as C{}");
    constexpr bool free = !detail::HasErrorOrderOf<M, typename M::template Workspace<X>>;
    static_assert(free, "the method chooses its order and its step together: it has a controller of its own");
    if constexpr (requires { M::template check_for_states<X>(); }) return M::template check_for_states<X>();
    return controller && free;
  }

  /// Allocates for M.
  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    static_assert(check_for_states<X>());
    return {M::workspace(x)};
  }

  /// As that of M. After a discontinuity the controller begins anew.
  template <class System, State X>
  [[nodiscard]] static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                                Workspace<X>& work, X& x_new) {
    if (discontinuity) work.controller = C{};
    return M::step(system, t, x, h, discontinuity, work, x_new);
  }

  /// As that of M.
  /// @{
  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>& work, const Scalar<X>& h, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    work.error = M::error_norm(work, h, x, x_new, tolerance) + detail::zero_if_all_finite(x_new);
    return work.error;
  }
  template <State X>
  [[nodiscard]] static Scalar<X> error_square(const Workspace<X>& work, const Scalar<X>& h, const X& x, const X& x_new,
                                              const Tolerance<Scalar<X>>& tolerance) {
    const Scalar<X> norm = error_norm<X>(work, h, x, x_new, tolerance);
    return norm * norm;
  }
  /// @}

  /// The factor of the controller. A method that keeps a factorization may still return 1.
  template <State X>
  [[nodiscard]] static Scalar<X> next_factor(Workspace<X>& work, const Scalar<X>&, const Scalar<X>& h, const X& x,
                                             const X& x_new, const Tolerance<Scalar<X>>& tolerance) {
    using Real = Scalar<X>;
    using std::max;
    const Real factor = work.controller(StepError<Real>{max(work.error, Real(1e-10)), h, M::error_order});
    work.controls = factor >= Real(least_factor_of_controllers) && factor <= Real(greatest_factor_of_controllers);
    if (!work.controls) return Real(1);
    if constexpr (detail::HasNextFactor<M, X, typename M::template Workspace<X>>) {
      return M::next_factor(work, factor, h, x, x_new, tolerance);
    } else {
      return factor;
    }
  }

  /// What is wrong with the controller, as the last step has shown; empty where nothing is.
  template <State X>
  [[nodiscard]] static std::string_view fault(const Workspace<X>& work) {
    if constexpr (detail::HasFault<M, typename M::template Workspace<X>>) {
      if (const std::string_view why = M::fault(work); !why.empty()) return why;
    }
    if (work.controls) return {};
    return "the step controller has returned a factor that is not a number, or not in 1e-3..1e3";
  }
};

/// The method with this controller of its steps.
template <class M, class C>
[[nodiscard]] constexpr WithController<M, C> with_controller(M, C) {
  return {};
}

}  // namespace continuo
