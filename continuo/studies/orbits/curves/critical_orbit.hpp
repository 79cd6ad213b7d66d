// A closed orbit one of whose multipliers is on the unit circle, as the solution of equations. Internal to orbit_curve.
//
// Unknowns z: x at the nodes as in orbit_collocation, then the period T, two constants p and q, the angle a of the
// multiplier. Equations: collocation; a shift along the orbit is no change; one multiplier is exp(i a), by the scalar g
// of a bordered linear system
//
//   ( M  b ) (v)   (0)        M v: v' - T df/dx v by collocation, the last node being exp(i a) times the first;
//   ( c* 0 ) (g) = (1),       of a fold (a = 0, and 1 is always a multiplier) with a change of the period and v . f =
//   0.
//
// g is zero where M is singular, and its derivative is -w* dM v with the solution w of the adjoint system.
#pragma once
#include <array>
#include <complex>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <continuo/studies/orbit_curve.hpp>
#include <continuo/studies/orbits/collocation/orbit_collocation.hpp>

namespace continuo::studies::detail {

/// The right and left vectors of the bordered system, of length 1; the next borders.
struct CriticalVectors {
  std::vector<std::complex<double>> right{}, left{};
};

class CriticalOrbit {
 public:
  static constexpr std::size_t behind = 4;  // unknowns behind the nodes: T, p, q, a

  CriticalOrbit(const ParametricSystem& system, std::array<std::size_t, 2> constants, OrbitBifurcation kind,
                std::shared_ptr<const OrbitMesh> mesh, const std::array<double, 2>& sizes_of_constants);

  [[nodiscard]] std::size_t states() const { return states_; }
  [[nodiscard]] std::size_t unknowns() const { return states_ + behind; }

  /// All of it at z; x counts in `sizes`, an unknown in `scale`. `borders` may be empty: then some are found. False
  /// where f is not finite, or the equations have no one solution.
  [[nodiscard]] bool evaluate(std::span<const double> z, std::span<const double> sizes, std::span<const double> scale,
                              std::span<const double> shift, const CriticalVectors& borders);
  [[nodiscard]] const CriticalVectors& vectors() const { return vectors_; }
  [[nodiscard]] std::complex<double> test() const { return test_; }
  /// The derivatives of the collocation by both constants seen by the left vector: the curve of folds is upright to it.
  [[nodiscard]] std::array<double, 2> normal() const;

  /// The residuals in `sizes`; the last one, of the step, is 0.
  [[nodiscard]] std::vector<double> residuals(std::span<const double> z, std::span<const double> reference,
                                              std::span<const double> shift) const;
  /// Solves d(all, last . z)/dz y = b at the last evaluation. False where there is no one solution.
  [[nodiscard]] bool solve(std::span<const double> last, std::vector<double>& b) const;

 private:
  struct GaussPoint {
    std::vector<double> x, f, residual, a, by_constant;  // by_constant: 2 columns
  };
  [[nodiscard]] bool evaluate_points(std::span<const double> z);
  [[nodiscard]] bool solve_bordered(const CriticalVectors& borders);
  void differentiate();
  [[nodiscard]] double width(std::size_t interval) const { return (*mesh_)[interval + 1] - (*mesh_)[interval]; }
  [[nodiscard]] bool is_fold() const { return kind_ == OrbitBifurcation::fold; }
  [[nodiscard]] std::size_t bordered_size() const { return states_ + (is_fold() ? 2 : 1); }
  /// Into p_.
  void set(double p, double q);

  const ParametricSystem& system_;
  std::array<std::size_t, 2> constants_;
  OrbitBifurcation kind_;
  std::shared_ptr<const OrbitMesh> mesh_;
  std::size_t n_, states_;
  std::vector<double> p_, sizes_of_constants_;
  // Of the last evaluation.
  double period_ = 0, angle_ = 0;
  std::array<double, 2> values_{};
  std::vector<double> sizes_, scale_, shift_;
  std::vector<GaussPoint> points_;
  CriticalVectors vectors_;
  std::vector<std::complex<double>> right_, left_;  // as they solve the bordered system
  std::complex<double> test_;
  std::vector<std::complex<double>> gradient_;  // of the test by z in units of scale
};

}  // namespace continuo::studies::detail
