// A closed orbit as the solution of equations, by multiple shooting. Internal to orbit_continuation.
//
// Unknowns z: x at K points that stand evenly in time on the orbit, n numbers each, then the period T and one constant
// p. Equations: phi(x_k, T/K, p) - x_{k+1} = 0, the last point being followed by the first. Their derivatives come from
// the variational equations, run along with phi. Several points instead of one: what a motion makes of an error then
// grows over a part of the period only, and orbits that repel can be solved for.
#pragma once
#include <atomic>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include <continuo/solve/options.hpp>
#include <continuo/studies/parametric_system.hpp>

namespace continuo::studies::detail {

/// Descending; of a pair of conjugates the one with positive imaginary part first.
void sort_by_size(std::vector<std::complex<double>>& values);

class OrbitShooting {
 public:
  /// `constant_size`: what is small of the constant.
  OrbitShooting(const ParametricSystem& system, std::size_t constant, double constant_size, double rtol,
                const std::atomic<bool>* interrupt);

  std::size_t size() const { return n_; }
  std::size_t points() const { return points_; }
  std::size_t equations() const { return n_ * points_; }
  std::size_t unknowns() const { return n_ * points_ + 2; }
  double period(std::span<const double> z) const { return z[n_ * points_]; }
  double constant(std::span<const double> z) const { return z[n_ * points_ + 1]; }

  /// What is small, of each component of x: an error of rtol times this.
  void set_sizes(std::vector<double> sizes);

  /// Residuals, their derivatives and the monodromy matrix at z; false where a run does not end.
  bool evaluate(std::span<const double> z);
  std::span<const double> residuals() const { return residuals_; }
  /// d residuals / dz, equations() rows of unknowns().
  std::span<const double> rows() const { return rows_; }

  /// f at the points: where a shift along the orbit moves them.
  std::vector<double> field(std::span<const double> z) const;
  /// The multipliers of the last evaluation but that of the shift along the orbit, by descending size: eigenvalues of
  /// the monodromy matrix on what is left of the space when the direction of f is taken out. Those that are too small
  /// to be told from the errors of the largest are zero.
  std::vector<std::complex<double>> multipliers(std::span<const double> field_at_first) const;

  /// The least and the greatest value of each component on the orbit.
  struct Extremes {
    std::vector<double> low, high;
  };
  Extremes extremes(std::span<const double> z) const;

  const ParametricSystem& system() const { return system_; }

 private:
  ParametricSystem system_, varied_;  // of the one constant; and with its variational equations
  std::size_t n_, points_;
  double constant_size_, rtol_;
  std::vector<double> sizes_, residuals_, rows_, monodromy_;
  Options<std::vector<double>> run_{}, plain_run_{};
};

}  // namespace continuo::studies::detail
