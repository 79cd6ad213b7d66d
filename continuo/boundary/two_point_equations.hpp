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

/// f at nodes and the middles between them, in order, as far as it is known.
template <class Number>
struct KnownSlopes {
  std::vector<Number> f;
  std::vector<bool> is_known;  // of each point; empty: nowhere
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

  /// y at the nodes.
  [[nodiscard]] std::span<const Number> y() const { return std::span(z_).first(nodes() * n_); }
  /// The parameters.
  [[nodiscard]] std::span<const Number> p() const { return std::span(z_).subspan(nodes() * n_); }
  /// f at node k.
  [[nodiscard]] std::span<const Number> f_at_node(std::size_t k) const { return at(f_, 2 * k); }
  /// f in the middle of interval k.
  [[nodiscard]] std::span<const Number> f_in_middle(std::size_t k) const { return at(f_, 2 * k + 1); }
  /// The spline's component i in interval k.
  [[nodiscard]] std::array<Number, 4> spline(std::size_t k, std::size_t i) const {
    return cubic(length(k), at(y_, 2 * k)[i], at(y_, 2 * k + 2)[i], at(f_, 2 * k)[i], at(f_, 2 * k + 2)[i]);
  }
  /// Of each interval: y' - f, relative to 1 + |f|, root mean square.
  [[nodiscard]] std::vector<double> residuals();
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
  /// The numbers of a point.
  [[nodiscard]] std::span<const Number> at(const std::vector<Number>& numbers, std::size_t point) const {
    return std::span(numbers).subspan(point * n_, n_);
  }
  [[nodiscard]] std::span<Number> at(std::vector<Number>& numbers, std::size_t point) const {
    return std::span(numbers).subspan(point * n_, n_);
  }
  void set_nodes(const std::vector<Number>& z);
  void set_middles();
  void set_residual_points();
  void begin_points() { part_x_.clear(), part_y_.clear(); }
  void add_point(double x, std::span<const Number> y);
  void evaluate_points(std::span<const Number> p);
  void evaluate_unknown(const std::vector<bool>& is_known);
  void evaluate(const std::vector<Number>& z);
  void evaluate_equations(const std::vector<Number>& z);
  bool fill_matrix();
  void fill_interval(std::size_t k);
  [[nodiscard]] bool is_solved(double tolerance, double condition_tolerance) const;

  TwoPointFunctions<Number>& functions_;
  std::size_t n_, k_;
  std::span<const double> x_;
  std::vector<Number> z_, trial_;
  std::vector<double> points_;                                 // nodes and middles in order
  std::vector<Number> y_, f_;                                  // there
  std::vector<double> residual_x_;                             // two points of each interval
  std::vector<Number> residual_y_, residual_yp_, residual_f_;  // the spline, its slope and f there
  bool has_residuals_ = false;                                 // f is known there
  std::vector<double> part_x_;                                 // the points of a call of f
  std::vector<Number> part_y_, part_f_;
  std::vector<Number> equations_;  // what is left of each
  std::vector<Number> correction_, simplified_;
  PointJacobians<Number> jacobians_;
  AlmostBlockDiagonal<Number> matrix_;
};

extern template class TwoPointEquations<double>;
extern template class TwoPointEquations<ComplexNumber<double>>;

}  // namespace continuo::boundary
