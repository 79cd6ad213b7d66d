// A closed orbit as the solution of equations, by orthogonal collocation. Internal to orbit_continuation.
//
// Unknowns z: x at the nodes of all intervals of a mesh over s = t / T, n numbers each, the last node being the first
// again, or the first and ParametricSystem::advance; then the period T and one constant p. Equations: dx/ds = T f(x, p)
// at the Gauss points. Nothing is integrated, so that orbits can be solved for along which an error would grow beyond
// all bounds either way (canards), and the mesh is where the orbit needs it: a jump may be a million times as short as
// the period. E. J. Doedel, H. B. Keller, J. P. Kernevez, "Numerical analysis and control of bifurcation problems
// (II)", Int. J. Bifurcation Chaos 1 (1991); U. M. Ascher, R. M. M. Mattheij, R. D. Russell, "Numerical Solution of
// Boundary Value Problems for Ordinary Differential Equations" (1995), chapter 9.
#pragma once
#include <complex>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <continuo/studies/orbits/collocation/bordered_cycle.hpp>
#include <continuo/studies/orbits/collocation/gauss_collocation.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies::detail {

/// Descending; of a pair of conjugates the one with positive imaginary part first.
void sort_by_size(std::vector<std::complex<double>>& values);

/// The same system of one of its constants; `size` is what is small of it.
[[nodiscard]] ParametricSystem with_one_constant(const ParametricSystem& system, std::size_t constant, double size);

/// 0 = s_0 < s_1 < ... = 1.
using OrbitMesh = std::vector<double>;

class OrbitCollocation {
 public:
  static constexpr std::size_t degree = 6;
  [[nodiscard]] static const GaussCollocation<degree>& table();

  /// `system` has one constant.
  OrbitCollocation(const ParametricSystem& system, std::shared_ptr<const OrbitMesh> mesh);

  [[nodiscard]] const std::shared_ptr<const OrbitMesh>& mesh() const { return mesh_; }
  [[nodiscard]] std::size_t size() const { return n_; }
  [[nodiscard]] std::size_t intervals() const { return mesh_->size() - 1; }
  [[nodiscard]] std::size_t nodes() const { return intervals() * degree; }
  [[nodiscard]] std::size_t unknowns() const { return nodes() * n_ + 2; }
  [[nodiscard]] double period(std::span<const double> z) const { return z[nodes() * n_]; }
  [[nodiscard]] double constant(std::span<const double> z) const { return z[nodes() * n_ + 1]; }
  /// Where a node stands, as a part of the period; its weight in an integral over the period, all of them 1 together.
  [[nodiscard]] double place(std::size_t node) const;
  [[nodiscard]] double weight(std::size_t node) const;
  /// x at s.
  void state(std::span<const double> z, double s, std::span<double> x) const;

  /// Residuals and their derivatives at z, `sizes` being what is small of each component; false where f is not finite.
  [[nodiscard]] bool evaluate(std::span<const double> z, std::span<const double> sizes);
  [[nodiscard]] std::span<const double> residuals() const { return residuals_; }
  /// Solves d(residuals, shift . z, last . z)/dz y = b at the last evaluation, in which z_j counts in units of scale_j
  /// and the residuals in `sizes`. b becomes the solution; false where there is no one.
  [[nodiscard]] bool solve(std::span<const double> scale, std::span<const double> sizes, std::span<const double> shift,
                           std::span<const double> last, std::span<double> b);

  /// f at the nodes: where a shift along the orbit moves them.
  [[nodiscard]] std::vector<double> field(std::span<const double> z) const;

  /// Of each interval the estimated error inside, in sizes. `is_open`: the first interval is not the last one's
  /// neighbour.
  [[nodiscard]] std::vector<double> errors(std::span<const double> z, std::span<const double> sizes,
                                           bool is_open = false) const;
  /// A mesh on which these errors are the same everywhere and, if that takes no more than `most` intervals, below
  /// `wanted`.
  [[nodiscard]] std::shared_ptr<const OrbitMesh> better_mesh(std::span<const double> errors, double wanted,
                                                             std::size_t most) const;

  /// The least and the greatest value of each component on the orbit.
  struct Extremes {
    std::vector<double> low, high;
  };
  [[nodiscard]] Extremes extremes(std::span<const double> z) const;

 private:
  [[nodiscard]] std::span<const double> node(std::span<const double> z, std::size_t k) const {
    return z.subspan(k % nodes() * n_, n_);
  }
  /// Component i at node k; behind the last one it is that of the first a period later.
  [[nodiscard]] double value(std::span<const double> z, std::size_t k, std::size_t i) const {
    return k < nodes() || system_.advance.empty() ? z[k % nodes() * n_ + i] : z[i] + system_.advance[i];
  }

  const ParametricSystem& system_;
  std::shared_ptr<const OrbitMesh> mesh_;
  std::size_t n_;
  std::vector<double> residuals_, f_, jacobians_, by_constant_;  // of all Gauss points
  double period_ = 0;                                            // of the last evaluation
  BorderedCycle equations_;
};

}  // namespace continuo::studies::detail
