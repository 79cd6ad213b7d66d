// continuo/methods/implicit/jacobian_of_step.hpp
// The Jacobian of the steps from a state: at the state itself, or where a slope is infinite there, a tolerance further.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <continuo/methods/implicit/linearization.hpp>
#include <continuo/methods/implicit/newton.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/numerics/finite.hpp>

namespace continuo::detail {

/// The slope of a root is infinite at 0, and next to it huge: with such a matrix no correction of Newton's iteration is
/// large enough to be seen, and stages pass for solved as they are. So where J is steep it is held against f: what is 0
/// within the tolerance goes on by the tolerance, the way it moves, and if J promises more than ten times the change,
/// it is taken there. Not with a mass, where f is not the way that an unknown goes. fx = f(t, x). Returns the number of
/// evaluations of f.
template <class System, State X>
[[nodiscard]] int leave_infinite_slope(System& system, const Scalar<X>& t, const X& x, const X& fx, const Scalar<X>& h,
                                       const Tolerance<Scalar<X>>& tolerance, Linearization<X>& linear) {
  using Real = Scalar<X>;
  using std::abs;
  constexpr double steep = 1e3, too_much = 10;  // of the change in a step to the state; of the promise to the change
  const auto is_steep = [&](const Real& slope) { return !(abs(h * slope) < Real(steep)); };
  if (linear.has_mass() || std::ranges::none_of(linear.entries(), is_steep)) return 0;
  const auto scale = [&](std::size_t i) { return tolerance.scale(i, x.data()[i], x.data()[i]); };
  const auto moves = [&](std::size_t i) { return abs(x.data()[i]) < scale(i) && fx.data()[i] != Real(0); };
  bool any_moves = false;
  for (std::size_t i = 0; i < dimension(x); ++i) any_moves = any_moves || moves(i);
  if (!any_moves) return 0;  // as nearly always; nothing has been allocated so far
  auto [move, promised] = linear.scratch();
  for (std::size_t i = 0; i < dimension(x); ++i)
    move.data()[i] = !moves(i) ? Real(0) : fx.data()[i] > Real(0) ? Real(scale(i)) : Real(-scale(i));
  linear.multiply_jacobian(move, promised);
  const auto counts = [&](std::size_t i) { return !(abs(h * promised.data()[i]) <= scale(i)); };
  bool any_counts = false;
  for (std::size_t i = 0; i < dimension(x); ++i) any_counts = any_counts || counts(i);
  if (!any_counts) return 0;
  X further = x, f_further = fx;
  for (std::size_t i = 0; i < dimension(x); ++i) further.data()[i] += move.data()[i];
  evaluate(system, t, further, f_further);
  if (!is_finite_state(f_further)) return 1;
  for (std::size_t i = 0; i < dimension(x); ++i) {
    const Real promise = abs(promised.data()[i]), change = abs(f_further.data()[i] - fx.data()[i]);
    if (promise <= Real(too_much) * change || !counts(i)) continue;
    return 1 + linear.evaluate(system, t, further, f_further, LeastIncrements(tolerance, h, further, f_further, false));
  }
  return 1;
}

/// Evaluates J for steps of about h from x; fx = f(t, x). Returns the number of evaluations of f.
template <class System, State X>
[[nodiscard]] int evaluate_jacobian_of_step(System& system, const Scalar<X>& t, const X& x, const X& fx,
                                            const Scalar<X>& h, const Tolerance<Scalar<X>>& tolerance,
                                            Linearization<X>& linear) {
  const int evaluations = linear.evaluate(system, t, x, fx, LeastIncrements(tolerance, h, x, fx, linear.has_mass()));
  return evaluations + leave_infinite_slope(system, t, x, fx, h, tolerance, linear);
}

}  // namespace continuo::detail
