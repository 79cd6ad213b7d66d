// What can be seen of a boundary-value problem before it is solved, by evaluations at a few places. Internal to
// boundary_value.
#pragma once
#include <continuo/boundary/boundary_value.hpp>
#include <continuo/boundary/collocation_system.hpp>

namespace continuo::boundary {

/// Whether f and the conditions are linear in x, with whatever else is added; not where there are unknown constants.
[[nodiscard]] bool is_linear(const BoundaryValueProblem& problem);

/// Ends of the interval at which f has no value wherever x is, while it has some beside it: -2/t*x' at 0.
[[nodiscard]] OpenEnds open_ends(const BoundaryValueProblem& problem, const BoundaryValueGuess& guess);

}  // namespace continuo::boundary
