// The equations of collocation on one mesh, and Newton's iteration on them. Internal to boundary_value.
//
// Unknowns: x at all points (the mesh's and those between, n numbers each), then the constants p. Equations, in the
// rows of the point they determine: g = 0 at the first point (and in the last rows, as many as constants), and for each
// interval and each of its points but the first, X_i - X_1 - h sum_j a_ij f(t_j, X_j) = 0. The matrix is almost block
// diagonal; it is decomposed by a sparse solver whose analysis is made once for the mesh.
//
// Where f has no value at an end of the whole interval (x'' = -2/t*x' at 0), the slope there is that of the parabola
// through the slopes at the other three points: the equations are met at these only.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <continuo/boundary/boundary_value.hpp>
#include <continuo/boundary/lobatto.hpp>
#include <continuo/numerics/newton_iteration.hpp>
#include <continuo/numerics/sparse_lu.hpp>

namespace continuo::boundary {

/// Ends of the whole interval at which f has no value.
struct OpenEnds {
  bool first = false, last = false;
};

/// The equations of one problem on one mesh.
class CollocationSystem {
 public:
  static constexpr const auto& table = lobatto4;
  static constexpr std::size_t per_interval = lobatto4.stages - 1;  // points of an interval but its first

  /// `mesh` holds every one of problem.times.
  CollocationSystem(const BoundaryValueProblem& problem, std::span<const double> mesh, OpenEnds open = {});

  /// The number of components of x.
  [[nodiscard]] std::size_t components() const { return n_; }
  /// The number of collocation points, those of the mesh among them.
  [[nodiscard]] std::size_t point_count() const { return per_interval * intervals() + 1; }
  /// The number of intervals of the mesh.
  [[nodiscard]] std::size_t intervals() const { return mesh_.size() - 1; }
  /// The time of a collocation point.
  [[nodiscard]] double time(std::size_t point) const;
  /// Whether the interval touches an end at which f has no value.
  [[nodiscard]] bool has_open_end(std::size_t interval) const {
    return (open_.first && interval == 0) || (open_.last && interval + 1 == intervals());
  }

  /// Unknowns, to be set before `iterate` and read after it.
  std::span<double> unknowns() { return z_; }
  /// x at collocation point q, to be read or set.
  std::span<double> point(std::size_t q) { return std::span(z_).subspan(q * n_, n_); }
  /// The constants p, to be read or set.
  std::span<double> constants() { return std::span(z_).subspan(point_count() * n_, m_); }
  /// f at the points, of the last iteration.
  [[nodiscard]] std::span<const double> slopes() const { return f_; }

  /// Damped until a correction is below `target`, relative to the size of each component.
  NewtonEnding iterate(double target, const BoundaryValueOptions& options);
  /// Iterations of Newton so far.
  [[nodiscard]] std::size_t iterations() const { return iterations_; }
  /// Evaluations of f so far.
  [[nodiscard]] std::size_t evaluations() const { return evaluations_; }
  /// The component or constant that moved most, in its measure, in the last correction.
  [[nodiscard]] std::size_t worst() const { return worst_; }
  /// The size of the corrections, in that measure, below which rounding did not let them fall; else 0.
  [[nodiscard]] double held_at() const { return held_at_; }
  /// Whether there is a matrix of an iteration.
  [[nodiscard]] bool is_factored() const { return factored_; }
  /// The inverse of that matrix times b, in place.
  void solve(std::span<double> b) { lu_->solve(b.data()); }
  /// How large the terms are whose sum is each equation where the unknowns are z: what rounding leaves of it is some
  /// 1e-16 of that.
  std::vector<double> magnitudes(std::span<const double> z);

 private:
  void make_pattern();
  void evaluate_slopes(std::span<const double> z);
  [[nodiscard]] bool is_open(std::size_t point) const {
    return (open_.first && point == 0) || (open_.last && point + 1 == point_count());
  }
  [[nodiscard]] double weight(std::size_t interval, std::size_t i, std::size_t j) const;
  void evaluate_residuals(std::span<const double> z, std::span<double> residuals);
  void evaluate_jacobians();
  void difference_jacobian(std::size_t q, std::span<double> block);
  void evaluate_condition_jacobian();
  void fill_matrix();
  void measure();
  double size_of(std::span<const double> correction);
  [[nodiscard]] std::span<const double> constants_of(std::span<const double> z) const {
    return z.subspan(point_count() * n_, m_);
  }
  std::span<const double> gather(std::span<const double> z);

  const BoundaryValueProblem& problem_;
  std::size_t n_, m_;
  std::vector<double> mesh_;
  OpenEnds open_;
  std::vector<std::size_t> condition_points_;
  std::vector<double> z_, f_, trial_, residuals_, correction_, simplified_;
  std::vector<MatrixPlace> block_;          // the entries of df/dx, in their order
  std::vector<double> jacobians_;           // of all points, entries of problem.pattern or rows
  std::vector<double> constant_jacobians_;  // df/dp of all points, n * m row by row
  std::vector<double> condition_values_, gathered_;
  std::vector<MatrixPlace> condition_places_;
  std::vector<double> scales_;  // of the components, then the constants
  std::vector<std::uint32_t> slots_;
  std::optional<SparseLU<double>> lu_;
  std::vector<double> moved_, moved_slope_;
  std::size_t iterations_ = 0, evaluations_ = 0, worst_ = 0;
  double held_at_ = 0;
  bool factored_ = false;
};

}  // namespace continuo::boundary
