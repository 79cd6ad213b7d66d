// A whole step of an explicit Runge-Kutta method that the system takes itself: one which has its equations as machine
// code, with the tableau in it, spares the calls of f and the way through memory between two stages.
//
//   template <class M>
//   bool take_step(double t, const X& x, double h, typename M::template Workspace<X>& work, X& x_new);
#pragma once
#include <concepts>

#include <continuo/methods/method.hpp>

namespace continuo::detail {

/// The system takes steps of the method M: f.take_step<M>(t, x, h, work, x_new). It does what M::step does, to the same
/// bits and as if with as many evaluations, from f at the start where work.start_fresh says that it is there; or it
/// does nothing and returns false.
template <class F, class M, class X>
concept TakesSteps = requires(F& f, const Scalar<X>& t, const X& x, typename M::template Workspace<X>& work, X& x_new) {
  { f.template take_step<M>(t, x, t, work, x_new) } -> std::same_as<bool>;
};

/// The square of the error of a step, which a system that takes the step may give with it.
template <class Real>
struct OwnStep {
  Tolerance<Real> tolerance{};  // by which it is measured
  Real square{};                // as M::error_square
  bool has_square = false;

  /// Whether it is the square by this tolerance.
  [[nodiscard]] bool is_measured_by(const Tolerance<Real>& other) const {
    if constexpr (std::floating_point<Real>) {
      return has_square && tolerance.rtol == other.rtol && tolerance.atol == other.atol &&
             tolerance.rtol_each == other.rtol_each && tolerance.atol_each == other.atol_each;
    } else {
      return false;  // lanes are compared by masks, and no system takes steps of other numbers
    }
  }
};

}  // namespace continuo::detail
