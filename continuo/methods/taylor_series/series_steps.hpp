// Many steps of a Taylor series that a system takes itself, with the choice of their sizes: one which has its series as
// machine code spares the way through the method and the driver between two steps at which nobody looks.
//
//   std::size_t take_series_steps(SeriesSteps<double>& steps);   // a member of the system: how many it has taken
#pragma once
#include <concepts>
#include <cstddef>

#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/numerics/state.hpp>

namespace continuo {

/// Where the steps are, and how they are judged. The system does what StepControl and TaylorSeries::step do, to the
/// same bits, as long as each step is accepted at once, ends before `limit` and before `until`, changes t, and has no
/// root of a guard in it where they are watched. It leaves everything as it is before the first step that is not like
/// that.
template <class Real>
struct SeriesSteps {
  Real *x, *rest;                // the state at t, and what rounding has taken from it
  Real *now, *next;              // the series at t, in units of the time `scale`; room for that at the end of a step
  Real t, scale, size, carried;  // size: of the next step; carried: what t lacks
  Real limit, longest, until, forward;
  std::size_t components, order, most;  // most: steps
  Tolerance<Real> tolerance;
  Real terms[2];                 // units of a tolerance for the last two terms: see TaylorSeries::allowance
  Real greatest_factor, safety;  // of one step to the next
  Real* times;                   // where the ends of the steps are noted
  bool has_guards;               // steps with a root of a guard are not taken
};

/// The system takes many steps of the method of Taylor series.
template <class F, class X>
concept TakesSeriesSteps = requires(F& f, SeriesSteps<Scalar<X>>& steps) {
  { f.take_series_steps(steps) } -> std::same_as<std::size_t>;
};

}  // namespace continuo
