// A homoclinic orbit as the solution of equations: collocation on a finite interval, whose ends lie in the tangents of
// the invariant manifolds of a saddle. Internal to homoclinic_curve.
//
// Unknowns z: x at the nodes of all intervals of a mesh over s = t / T, both ends among them, the saddle x0, two
// constants p and q. Equations: dx/ds = T f(x, p, q) at the Gauss points; f(x0) = 0; x - x0 has at the beginning no
// part in the stable eigenspace of x0, at the end none in the unstable one, by bases of the left eigenspaces; a shift
// along the orbit is no change. T is given. What is cut off is as small as the ends are near to x0: each misses its
// manifold by the square of its distance, and the constants feel that by as much as the adjoint solution is there.
// W.-J. Beyn, "The numerical computation of connecting orbits in dynamical systems", IMA J. Numer. Anal. 10 (1990)
// 379-405; A. R. Champneys, Yu. A. Kuznetsov, B. Sandstede, "A numerical toolbox for homoclinic bifurcation analysis",
// Int. J. Bifurcation Chaos 6 (1996) 867-887.
//
// Of a central homoclinic orbit x0 is a saddle-node, an eigenvalue of which, the centre's, is zero: one equation more.
// The orbit leaves x0 and comes back to it along the centre, as 1/t does, so that at the beginning it has no part in
// the strong stable eigenspace only, at the end none in the strong unstable one: one equation less.
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseLU>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <continuo/studies/orbits/collocation/orbit_collocation.hpp>
#include <continuo/studies/orbits/curves/saddle_spaces.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies::detail {

/// What x0 is. A saddle-node has so many stable eigenvalues beside its centre.
struct HomoclinicRest {
  std::size_t stable = 0;
  bool is_saddle_node = false;
};

class HomoclinicOrbit {
  using Vector = std::vector<double>;

 public:
  HomoclinicOrbit(const ParametricSystem& system, std::array<std::size_t, 2> constants, HomoclinicRest kind,
                  std::shared_ptr<const OrbitMesh> mesh, double length,
                  const std::array<double, 2>& sizes_of_constants);

  [[nodiscard]] std::size_t nodes() const { return (mesh_->size() - 1) * OrbitCollocation::degree + 1; }
  [[nodiscard]] std::size_t rest() const { return nodes() * n_; }  // where x0 stands in z
  [[nodiscard]] std::size_t unknowns() const { return rest() + n_ + 2; }
  [[nodiscard]] double length() const { return length_; }

  /// Components count in `sizes`, an unknown in `scale`.
  void measure_in(const Vector& sizes, const Vector& scale);
  /// The bases of both eigenspaces are to be like those at z. False where x0 has no such spaces there.
  [[nodiscard]] bool refer_to(std::span<const double> z);
  /// All equations at z, and their derivatives. False where f is not finite, or the spaces have turned too far.
  [[nodiscard]] bool evaluate(std::span<const double> z);
  /// The residuals, those of the shift and of the step being 0.
  [[nodiscard]] const Vector& residuals() const { return residuals_; }
  /// Decomposes the derivatives of all equations, of shift . z and of last . z, z in scale. False where they are
  /// singular.
  [[nodiscard]] bool decompose(std::span<const double> shift, std::span<const double> last);
  [[nodiscard]] Vector solve(const Vector& b) const;
  [[nodiscard]] Vector solve_transposed(const Vector& b) const;

  /// At the last evaluation, in sizes.
  [[nodiscard]] const SaddleSpaces& spaces() const { return spaces_; }
  [[nodiscard]] Eigen::VectorXd from_rest(std::span<const double> z, bool at_end) const;
  /// Along the centre of a saddle-node at z, y' = c y^2 + ...: c.
  [[nodiscard]] double centre_curvature(std::span<const double> z) const;
  /// At the last evaluation, of a saddle-node: how fast f along the centre changes with the constants, in ranges and
  /// rates. About 0 where x0 is an equilibrium whatever they are, or by a symmetry: it is no fold then.
  [[nodiscard]] double unfolding() const;
  /// Of a solution of the transposed equations: the adjoint solution at the beginning, or at the end.
  [[nodiscard]] Eigen::VectorXd adjoint_at(const Vector& solution, bool at_end) const;
  /// By how much each equation of both ends misses its manifold, as a right-hand side.
  [[nodiscard]] Vector missed(std::span<const double> z) const;
  /// df/dx at x0.
  [[nodiscard]] Eigen::MatrixXd matrix_at(std::span<const double> x0, std::span<const double> constants) const;

 private:
  struct GaussPoint {
    Vector f, residual, a, by_constant;  // by_constant: 2 columns
  };
  [[nodiscard]] Vector constants_at(std::span<const double> values) const;
  [[nodiscard]] bool evaluate_points(std::span<const double> z);
  [[nodiscard]] bool evaluate_rest(std::span<const double> z);
  [[nodiscard]] bool evaluate_ends(std::span<const double> z);
  [[nodiscard]] std::optional<SaddleSpaces> spaces_at(const Eigen::MatrixXd& a) const;
  [[nodiscard]] std::size_t unstable() const { return n_ - kind_.stable - (kind_.is_saddle_node ? 1 : 0); }
  [[nodiscard]] Eigen::VectorXd missed_at(std::span<const double> z, bool at_end) const;
  /// Both ends' equations, with spaces of another x0 or other constants.
  [[nodiscard]] std::optional<Eigen::VectorXd> ends_at(std::span<const double> z,
                                                       const Vector& rest_and_constants) const;
  [[nodiscard]] double width(std::size_t interval) const { return (*mesh_)[interval + 1] - (*mesh_)[interval]; }
  [[nodiscard]] double advance(std::size_t i) const { return system_.advance.empty() ? 0 : system_.advance[i]; }

  const ParametricSystem& system_;
  std::array<std::size_t, 2> constants_;
  HomoclinicRest kind_;
  std::size_t n_;
  std::shared_ptr<const OrbitMesh> mesh_;
  double length_;
  Vector sizes_of_constants_;  // of all
  Vector sizes_, scale_;
  Eigen::MatrixXd like_stable_, like_unstable_;  // to which the bases are alike
  double rate_of_reference_ = 1;                 // by which the centre's eigenvalue is measured
  // Of the last evaluation.
  std::vector<GaussPoint> points_;
  Vector residuals_;
  SaddleSpaces spaces_;
  Eigen::MatrixXd left_stable_, left_unstable_;  // in sizes
  Vector rest_matrix_, rest_by_constant_;
  double rate_ = 1;          // of x0, by which f there is measured
  Eigen::MatrixXd ends_by_;  // both ends' equations by x0 and constants
  std::unique_ptr<Eigen::SparseLU<Eigen::SparseMatrix<double>>> lu_{};
};

}  // namespace continuo::studies::detail
