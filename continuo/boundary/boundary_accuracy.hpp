// How good the solution of one mesh is: what is left of the equations, how far that and rounding move the motion, and
// in which motion the conditions leave it undetermined. Internal to boundary_value.
//
// Where p solves the equations of collocation, r = p' - f(t, p) is left between their points. To first order the error
// e = x - p obeys e' = df/dx e - r under conditions without right-hand sides, and the same collocation solves that:
// J e = -R, with J the matrix of Newton's iteration and R the integrals of r. What rounding leaves of each equation,
// some 1e-16 of the sizes of its terms, is moved by the inverse of J as well; random signs sample its norm (C. S.
// Kenney, A. J. Laub, "Small-sample statistical condition estimates", SIAM J. Sci. Comput. 15 (1994) 36-61).
#pragma once
#include <cstddef>
#include <vector>

#include <continuo/boundary/boundary_value.hpp>
#include <continuo/boundary/collocation_system.hpp>

namespace continuo::boundary {

/// What is left of x' = f over each interval: root mean squares of (x' - f) / (1 + |f|), and the integrals of x' - f
/// from the interval's start to each of its points but the first, for all components. Where it is far above the
/// tolerance no polynomial may be near f, and the integrals are of |x' - f|.
struct Residuals {
  std::vector<double> of_intervals;
  std::vector<std::size_t> jumps;  // intervals made so short that the residual, which does not fall, matters no more
  std::vector<double> shares;      // by interval: the greatest of the integrals relative to the size of its component
  std::vector<double> integrals;   // as the rows of the system but those of conditions
};
/// Evaluates the residuals at further points of each interval, and counts the evaluations in `solution`.
[[nodiscard]] Residuals residuals_of(const BoundaryValueProblem& problem, BoundaryValueSolution& solution,
                                     const CollocationSystem& system, double tolerance);

/// By component, then by constant: the greatest over the interval, in its own unit.
struct ErrorBounds {
  std::vector<double> of_mesh;       // that more intervals would take away
  std::vector<double> of_rounding;   // that nothing would
  std::vector<double> sizes;         // of the components, to compare with
  std::vector<double> undetermined;  // that rounding of as much as each component is large on the average would make
  double condition = 0;
  /// The greatest error relative to the size of its component, and which one it is.
  struct Worst {
    double part = 0;
    std::size_t component = 0;
  };
  /// The component with the greatest of these errors, relative to its size.
  [[nodiscard]] Worst worst(const std::vector<double>& errors) const;
};
/// Needs the matrix of an iteration at, or close to, the solution.
[[nodiscard]] ErrorBounds error_bounds(CollocationSystem& system, const Residuals& residuals);
/// Of rounding alone.
[[nodiscard]] ErrorBounds rounding_bounds(CollocationSystem& system);

}  // namespace continuo::boundary
