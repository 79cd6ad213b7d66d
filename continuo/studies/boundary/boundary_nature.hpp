// What can be seen of a boundary-value problem before it is solved, by evaluations at a few places. Internal to
// boundary_value.
#pragma once
#include <continuo/studies/boundary/collocation_system.hpp>
#include <continuo/studies/boundary_value.hpp>

namespace continuo::studies::detail {

/// Whether f and the conditions are linear in x, with whatever else is added; not where there are unknown constants.
bool is_linear(const BoundaryValueProblem& problem);

/// Ends of the interval at which f has no value wherever x is, while it has some beside it: -2/t*x' at 0.
OpenEnds open_ends(const BoundaryValueProblem& problem, const BoundaryValueGuess& guess);

}  // namespace continuo::studies::detail
