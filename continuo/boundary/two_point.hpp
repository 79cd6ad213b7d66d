// Two-point boundary-value problems whose functions take many points in one call, as those of other languages should:
// y' = f(x, y, p) + S y / (x - a) between a and b, with n + k conditions g(y(a), y(b), p) = 0 on n components and k
// unknown parameters, real or complex.
//
// The solution is a cubic spline that meets the equation at the nodes of a mesh and at the middles between them
// (collocation at three Lobatto points, of fourth order). The nodes are added where the residual of the spline, root
// mean square over an interval and relative to 1 + |f|, is above the tolerance. J. Kierzenka, L. F. Shampine, "A BVP
// solver based on residual control and the MATLAB PSE", ACM TOMS 27 (2001) 299-316; for S: L. F. Shampine, P. H. Muir,
// H. Xu, "A user-friendly Fortran BVP solver", JNAIAM 1 (2006) 201-217. The rules by which the mesh is refined and the
// iteration ends are those of scipy.integrate.solve_bvp, so that the nodes are the same, until a mesh is accepted: then
// residuals near the tolerance are found once more by nine points, where SciPy trusts five.
//
// boundary_value.hpp is for conditions at more times than two, of higher order and with an estimate of the error; its
// functions take one point at a time.
#pragma once
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <continuo/numerics/complex_number.hpp>

namespace continuo::boundary {

/// The problem. Number is double or ComplexNumber<double>, of which f and g are differentiable functions. Arrays are
/// those of C: a(i, q) is at i * columns + q.
template <class Number>
struct TwoPointProblem {
  using Numbers = std::span<const Number>;
  std::size_t size = 0;        // n, of y
  std::size_t parameters = 0;  // k, of p
  /// f(i, q) at the points x[q], ascending, from y(i, q). The points must not depend on each other.
  std::function<void(std::span<const double> x, Numbers y, Numbers p, std::span<Number> f)> derivative{};
  /// The residuals g, n + k of them.
  std::function<void(Numbers y_first, Numbers y_last, Numbers p, std::span<Number> residuals)> conditions{};
  /// df_i/dy_j at (i, j, q) and df_i/dp_l at (i, l, q); empty: by differences.
  std::function<void(std::span<const double> x, Numbers y, Numbers p, std::span<Number> dfdy, std::span<Number> dfdp)>
      derivative_jacobian{};
  /// dg_i/dy_j at both ends and dg_i/dp_l; empty: by differences.
  std::function<void(Numbers y_first, Numbers y_last, Numbers p, std::span<Number> first, std::span<Number> last,
                     std::span<Number> of_parameters)>
      condition_jacobian{};
  /// S, n x n, or empty. Then S y(a) = 0: y(a) is made one of the range of I - S^+ S, and y'(a) = (I - S)^+ f(a).
  std::vector<Number> singular_term{};
};

/// What was reached on one mesh.
struct TwoPointProgress {
  std::size_t iteration = 0;  // the number of meshes so far
  double residual = 0;        // the greatest of an interval
  double condition = 0;       // the greatest |g_i|
  std::size_t nodes = 0;      // of this mesh
  std::size_t added = 0;      // to it, for the next
  bool exceeds = false;       // these are not added, as there would be more than the most allowed
};

/// How exactly, and how much may be spent.
struct TwoPointOptions {
  double tolerance = 1e-3;            // of the residual of each interval
  double condition_tolerance = 1e-3;  // of each |g_i|
  std::size_t most_nodes = 1000;
  std::function<void(const TwoPointProgress&)> progress{};  // after each mesh
};

/// How it ended.
/// `undetermined`: the residual is small, but its estimated effect is as large as the solution, on a finer mesh too.
enum class TwoPointEnding { solved, too_many_nodes, singular, conditions_not_met, not_finite, too_fine, undetermined };

/// What was found to be infinite or not a number.
enum class TwoPointQuantity { derivative, conditions, jacobian };

/// The solution, or the last mesh and what was found on it. y and f are node by node.
template <class Number>
struct TwoPointSolution {
  TwoPointEnding ending = TwoPointEnding::solved;
  TwoPointQuantity not_finite = TwoPointQuantity::derivative;  // where that is the ending
  std::size_t component = 0;                                   // of it
  double where = 0;  // x there, or where the mesh cannot be refined, as its nodes would be equal
  std::vector<double> x;
  std::vector<Number> y, f, p;
  std::vector<double> residuals;  // of each interval
  TwoPointProgress last;          // on the last mesh
};

/// A cubic on an interval of length h by value and slope at both ends: sum_k c[k] s^(3 - k), s from its first end.
template <class Number>
[[nodiscard]] std::array<Number, 4> cubic(double h, const Number& y_first, const Number& y_last, const Number& f_first,
                                          const Number& f_last) {
  const Number slope = (y_last - y_first) * (1 / h);
  const Number t = (f_first + f_last - slope - slope) * (1 / h);
  return {t * (1 / h), (slope - f_first) * (1 / h) - t, f_first, y_first};
}

/// y (node by node) and p are where the iteration begins; x is the first mesh, ascending, of at least two nodes.
/// Exceptions of the functions pass through.
template <class Number>
[[nodiscard]] TwoPointSolution<Number> solve_two_point(const TwoPointProblem<Number>& problem, std::vector<double> x,
                                                       std::vector<Number> y, std::vector<Number> p,
                                                       const TwoPointOptions& options);

extern template TwoPointSolution<double> solve_two_point(const TwoPointProblem<double>&, std::vector<double>,
                                                         std::vector<double>, std::vector<double>,
                                                         const TwoPointOptions&);
extern template TwoPointSolution<ComplexNumber<double>> solve_two_point(const TwoPointProblem<ComplexNumber<double>>&,
                                                                        std::vector<double>,
                                                                        std::vector<ComplexNumber<double>>,
                                                                        std::vector<ComplexNumber<double>>,
                                                                        const TwoPointOptions&);

}  // namespace continuo::boundary
