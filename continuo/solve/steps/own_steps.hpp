// Many steps that a system takes itself, with the choice of their sizes: one which has its equations as machine code
// spares the way through the driver between two steps at which nobody looks. See also methods/explicit_rk/own_step.hpp.
//
//   template <class M>
//   std::size_t take_steps(const detail::OwnSteps<X>& steps);   // how many it has taken
//
// A method that takes them by other means of the system has the function itself (taylor_series/series_steps.hpp).
#pragma once
#include <concepts>
#include <cstddef>

#include <continuo/methods/explicit_rk/explicit_runge_kutta.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/solve/steps/controller.hpp>

namespace continuo::detail {

/// Steps from x at t. The system does what StepControl and M::step do, to the same bits, as long as each step is
/// accepted at once, ends before `limit` and before `until`, and changes t. It leaves everything as it is before the
/// first step that is not like that. Where guards are watched, no step may have a root of one in it.
template <State X>
struct OwnSteps {
  using Real = Scalar<X>;
  Real& t;
  X& x;
  Real &next, &carried;  // the size of the next step, and what t lacks
  ErrorHistory& errors;
  X& slope;  // f at t, of a method that computes f at the end of its steps
  Real limit, longest, until, forward;
  std::size_t most;
  Tolerance<Real> tolerance;
  const Controller& controller;
  Real* times;  // where the ends of the steps are noted, by a method that has the function itself
  bool has_guards;
};

/// The system takes many steps of the method M, whose error is that of its tableau.
template <class F, class M, class X>
concept TakesManySteps =
    std::derived_from<M, ExplicitRungeKutta<M>> && M::error_order > 0 && requires(F& f, const OwnSteps<X>& steps) {
      { f.template take_steps<M>(steps) } -> std::same_as<std::size_t>;
    };

/// The method M takes many steps by what the system has.
template <class F, class M, class X>
concept MethodTakesManySteps = requires(F& f, const OwnSteps<X>& steps, typename M::template Workspace<X>& work) {
  { M::take_steps(f, steps, work) } -> std::same_as<std::size_t>;
  { M::evaluations_of_step(work) } -> std::same_as<std::size_t>;
};

}  // namespace continuo::detail
