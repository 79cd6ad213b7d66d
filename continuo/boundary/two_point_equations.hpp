// The equations of a two-point problem on one mesh, and Newton's iteration on them. Internal to two_point.
//
// Unknowns: y at the nodes, then p. For each interval y_(i+1) - y_i = h/6 (f_i + 4 f_(i+1/2) + f_(i+1)), where y in the
// middle is that of the cubic with values y and slopes f at both ends; then the conditions.
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <continuo/boundary/almost_block_diagonal.hpp>
#include <continuo/boundary/two_point_functions.hpp>
#include <continuo/numerics/newton_iteration.hpp>

namespace continuo::boundary {

/// f at some points, component by component, as far as it is known: f_i of point q at i * count + q.
template <class Number>
struct PartlyKnown {
  std::vector<Number> f;
  std::vector<char> is_missing;  // at each point; empty: at all
};

/// What is known on a mesh of those before it: f at the nodes and at the middles between them, and the derivatives at
/// all of them in their order, where they were last taken.
template <class Number>
struct KnownSlopes {
  PartlyKnown<Number> nodes, middles;
  PointJacobians<Number> jacobians;
  std::vector<char> jacobian_is_known;  // of each point; empty: nowhere
};

/// The spline at some points: x, y, its slope and f there, component by component.
template <class Number>
struct SplineSamples {
  std::vector<double> x;
  std::vector<Number> y, yp, f;
};

/// The equations on one mesh. What is said of the solution holds for the unknowns evaluated last.
template <class Number>
class TwoPointEquations {
 public:
  /// On the mesh x, from the unknowns z, for which f may be known already.
  TwoPointEquations(TwoPointFunctions<Number>& functions, std::span<const double> x, std::vector<Number> z,
                    KnownSlopes<Number> known);

  /// Until residuals are well below the tolerances or no progress is made.
  NewtonEnding iterate(double tolerance, double condition_tolerance);

  /// y at the nodes, node by node.
  [[nodiscard]] std::span<const Number> y() const { return std::span(z_).first(nodes() * n_); }
  /// The parameters.
  [[nodiscard]] std::span<const Number> p() const { return std::span(z_).subspan(nodes() * n_); }
  /// f at the nodes and in the middles, component by component.
  /// @{
  [[nodiscard]] const std::vector<Number>& f_at_nodes() const { return node_f_; }
  [[nodiscard]] const std::vector<Number>& f_in_middles() const { return middle_f_; }
  /// @}
  /// The derivatives last taken, at the nodes and the middles between them in their order.
  [[nodiscard]] const PointJacobians<Number>& jacobians() const { return jacobians_; }
  /// The spline's component i in interval k.
  [[nodiscard]] std::array<Number, 4> spline(std::size_t k, std::size_t i) const {
    const Number* const y = &node_y_[i * nodes() + k];
    const Number* const f = &node_f_[i * nodes() + k];
    return cubic(length(k), y[0], y[1], f[0], f[1]);
  }
  /// Of each interval: y' - f, relative to 1 + |f|, root mean square.
  [[nodiscard]] std::vector<double> residuals();
  /// Finds those of the residuals above `least` more exactly, by f at four more points of each interval.
  void refine_residuals(std::vector<double>& residuals, double least);
  /// What these residuals, just found, make of the solution, estimated: the greatest error of a component, relative to
  /// its size and what a residual of the tolerance may add. `iterate` must have factored a matrix.
  [[nodiscard]] double relative_error(double tolerance);
  /// The residuals of the conditions.
  [[nodiscard]] std::span<const Number> conditions() const { return std::span(equations_).subspan(intervals() * n_); }
  /// Whether f and the conditions are finite; if not, `note` is told where.
  [[nodiscard]] bool is_finite(TwoPointSolution<Number>& note) const;

 private:
  [[nodiscard]] std::size_t nodes() const { return x_.size(); }
  [[nodiscard]] std::size_t intervals() const { return x_.size() - 1; }
  [[nodiscard]] double length(std::size_t k) const { return x_[k + 1] - x_[k]; }
  void set_nodes(const std::vector<Number>& z);
  void set_middles();
  template <std::size_t count>
  [[nodiscard]] SplineSamples<Number> sampled(const std::array<double, count>& thetas,
                                              std::span<const std::size_t> intervals) const;
  void set_residual_points();
  void evaluate_with_residual_points(std::span<const Number> p);
  void evaluate(const std::vector<Number>& z, bool expects_solution = false);
  void evaluate_equations(const std::vector<Number>& z);
  void take_jacobians(const std::vector<char>& middle_is_missing);
  [[nodiscard]] bool is_solved_by_known(double tolerance, double condition_tolerance);
  bool fill_matrix();
  void fill_interval(std::size_t k);
  [[nodiscard]] bool is_solved(double tolerance, double condition_tolerance) const;

  TwoPointFunctions<Number>& functions_;
  std::size_t n_, k_;
  std::span<const double> x_;
  std::vector<Number> z_, trial_;
  std::vector<double> middles_;
  std::vector<Number> node_y_, node_f_, middle_y_, middle_f_;  // component by component, as those that follow
  SplineSamples<Number> at_residuals_;                         // at two points of each interval
  bool has_residuals_ = false;                                 // f is known there
  std::vector<double> middle_squares_, other_squares_;         // of the residual in the middle and at these points
  std::vector<Number> equations_;                              // what is left of each, interval by interval
  std::vector<Number> correction_, simplified_;
  PointJacobians<Number> jacobians_;
  std::vector<char> jacobian_is_known_;  // of the mesh before, for the first correction
  bool has_jacobians_ = false;           // taken already for the first correction
  AlmostBlockDiagonal<Number> matrix_;
};

extern template class TwoPointEquations<double>;
extern template class TwoPointEquations<ComplexNumber<double>>;

}  // namespace continuo::boundary
