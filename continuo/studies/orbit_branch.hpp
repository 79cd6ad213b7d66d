// One place after the other on a branch of closed orbits: predicted along the tangent, corrected by Newton's iteration.
// Internal to orbit_continuation.
//
// Behind the equations of shooting stand two more. A shift along the orbit is no change: sum_k f(y_k) . (x_k - y_k) =
// 0, where y are the points of the orbit before (an integral phase condition, on the points; Doedel 1981). And the step
// has the length that was asked for: (z - guess) . tangent = 0 (Keller 1977). Lengths are measured in sizes: of x what
// it reaches on the branch, of the period itself, of the constant its range.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include <continuo/studies/orbit_continuation.hpp>
#include <continuo/studies/orbit_shooting.hpp>

namespace continuo::studies::detail {

struct OrbitPlace {
  std::vector<double> z;        // the unknowns of OrbitShooting
  std::vector<double> tangent;  // of the branch, of length 1 in sizes
  std::vector<double> shift;    // along the orbit, of length 1 in sizes
  OrbitPoint point;             // its extremes only by `complete`

  // Zero where something happens, of size 1 at most.
  double fold = 0;      // the constant's part of the tangent
  double unity = 0;     // a multiplier is 1
  double doubling = 0;  // a multiplier is -1
  double torus = 0;     // the product of two multipliers is 1
};

/// The equilibrium in which a branch begins or ends, as an orbit without extent.
OrbitPoint as_orbit(const HopfPoint& hopf, bool stable);

class OrbitBranchSteps {
 public:
  OrbitBranchSteps(const ParametricSystem& system, const OrbitContinuationOptions& options);

  const OrbitShooting& equations() const { return equations_; }
  std::size_t iterations() const { return iterations_; }  // of the last correction

  /// Takes the sizes from here; those of x only grow. Keeps the direction of the tangent.
  void measure(OrbitPlace& place);
  void measure(const std::vector<double>& z);
  /// Those of x begin anew, from these.
  void forget_sizes(const std::vector<double>& sizes);

  /// The orbit near z with this value of the constant.
  std::optional<OrbitPlace> at_constant(std::vector<double> z, double value);
  /// The orbit near z whose distance from it has no part along `along` (in sizes).
  std::optional<OrbitPlace> across(const std::vector<double>& z, const std::vector<double>& along);
  /// A step along the branch. Nothing where none is found, or only one that is farther off than the step is long.
  std::optional<OrbitPlace> stepped(const OrbitPlace& from, double step);
  /// The least and greatest values of the components.
  void complete(OrbitPlace& place) const;

  /// How far the points are from their mean, in sizes, all together.
  std::vector<double> deviations(const std::vector<double>& z) const;
  std::vector<double> mean(const std::vector<double>& z) const;
  /// The cosine between tangents.
  static double alike(const OrbitPlace& a, const OrbitPlace& b);
  /// z in sizes.
  double size(std::size_t unknown) const { return scale_[unknown]; }

 private:
  std::vector<double> shift_at(const std::vector<double>& z) const;
  std::optional<std::vector<double>> solved(const std::vector<double>& shift, const std::vector<double>& last,
                                            std::vector<double> b) const;
  std::optional<std::vector<double>> corrected(const std::vector<double>& guess, const std::vector<double>& reference,
                                               const std::vector<double>& shift, const std::vector<double>& last);
  std::optional<OrbitPlace> described(std::vector<double> z, const std::vector<double>& along);

  const OrbitContinuationOptions& options_;
  OrbitShooting equations_;
  std::size_t n_, points_, unknowns_;
  std::vector<double> sizes_, scale_;
  std::size_t iterations_ = 0;
};

}  // namespace continuo::studies::detail
