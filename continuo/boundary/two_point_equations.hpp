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

template <class Number>
class TwoPointEquations {
 public:
  /// On the mesh x, from the unknowns z.
  TwoPointEquations(TwoPointFunctions<Number>& functions, std::span<const double> x, std::vector<Number> z);

  /// Until residuals are well below the tolerances or no progress is made.
  NewtonEnding iterate(double tolerance, double condition_tolerance);

  /// y at the nodes.
  [[nodiscard]] std::span<const Number> y() const { return std::span(z_).first(nodes() * n_); }
  /// The parameters.
  [[nodiscard]] std::span<const Number> p() const { return std::span(z_).subspan(nodes() * n_); }
  /// f at the nodes.
  [[nodiscard]] std::vector<Number> f() const;
  /// The spline's component i in interval k.
  [[nodiscard]] std::array<Number, 4> spline(std::size_t k, std::size_t i) const;
  /// Of each interval: y' - f, relative to 1 + |f|, root mean square.
  [[nodiscard]] std::vector<double> residuals();
  /// The residuals of the conditions.
  [[nodiscard]] std::span<const Number> conditions() const { return std::span(equations_).subspan(intervals() * n_); }
  /// Whether f and the conditions are finite; if not, `note` is told where.
  [[nodiscard]] bool is_finite(TwoPointSolution<Number>& note) const;

 private:
  [[nodiscard]] std::size_t nodes() const { return x_.size(); }
  [[nodiscard]] std::size_t intervals() const { return x_.size() - 1; }
  [[nodiscard]] double length(std::size_t k) const { return x_[k + 1] - x_[k]; }
  /// f at the point 2k of node k, 2k + 1 of the middle after it.
  [[nodiscard]] const Number& slope(std::size_t point, std::size_t i) const { return f_[point * n_ + i]; }
  void evaluate(const std::vector<Number>& z);
  void fill_matrix();
  void fill_interval(std::size_t k);
  [[nodiscard]] bool is_solved(double tolerance, double condition_tolerance) const;

  TwoPointFunctions<Number>& functions_;
  std::size_t n_, k_;
  std::span<const double> x_;
  std::vector<double> points_, middles_;  // nodes and middles in order; middles alone
  std::vector<Number> z_, trial_;
  std::vector<Number> y_, f_;  // at `points_`
  std::vector<Number> part_y_, part_f_;
  std::vector<Number> equations_;  // what is left of each
  std::vector<Number> correction_, simplified_;
  PointJacobians<Number> jacobians_;
  ConditionJacobians<Number> condition_jacobians_;
  AlmostBlockDiagonal<Number> matrix_;
};

extern template class TwoPointEquations<double>;
extern template class TwoPointEquations<ComplexNumber<double>>;

}  // namespace continuo::boundary
