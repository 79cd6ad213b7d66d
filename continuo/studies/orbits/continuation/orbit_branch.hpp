// One place after the other on a branch of closed orbits: predicted along the tangent, corrected by Newton's iteration.
// Internal to orbit_continuation.
//
// Behind the equations of collocation stand two more. A shift along the orbit is no change: the integral of f(y) . (x -
// y) over the period is 0, where y is the orbit before (Doedel 1981). And the step has the length that was asked for:
// (z - guess) . tangent = 0 (Keller 1977). Lengths are measured in sizes: of x, whose square is integrated over the
// period, what it reaches on the branch, of the period itself, of the constant its range.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <continuo/studies/orbit_continuation.hpp>
#include <continuo/studies/orbits/collocation/orbit_collocation.hpp>
#include <continuo/studies/orbits/continuation/multiplier_tests.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

struct OrbitPlace {
  std::shared_ptr<const OrbitMesh> mesh;
  std::vector<double> z;        // the unknowns of OrbitCollocation
  std::vector<double> tangent;  // of the branch, of length 1 in sizes
  std::vector<double> shift;    // along the orbit, of length 1 in sizes
  OrbitPoint point;             // its extremes only by `complete`

  double error = 0;  // estimated, of x inside of the intervals, in sizes

  // Zero where something happens, of size 1 at most.
  double fold = 0;  // the constant's part of the tangent
  MultiplierTests tests{};
};

/// The equilibrium in which a branch begins or ends, as an orbit without extent.
[[nodiscard]] OrbitPoint as_orbit(const HopfPoint& hopf, bool stable);

class OrbitBranchSteps {
 public:
  OrbitBranchSteps(const ParametricSystem& system, const OrbitContinuationOptions& options);

  [[nodiscard]] const OrbitCollocation& equations() const { return *equations_; }
  [[nodiscard]] std::size_t iterations() const { return iterations_; }  // of the last correction

  /// The mesh of the orbits that are passed by their unknowns alone.
  void use(const std::shared_ptr<const OrbitMesh>& mesh);
  /// Takes the sizes from here; those of x only grow. Keeps the direction of the tangent. A mesh that is no longer good
  /// is exchanged.
  void measure(OrbitPlace& place);
  void measure(const std::vector<double>& z);
  /// Those of x begin anew, from these.
  void forget_sizes(const std::vector<double>& sizes);

  /// The orbit near z with this value of the constant.
  [[nodiscard]] std::optional<OrbitPlace> at_constant(std::vector<double> z, double value);
  /// The orbit near z whose distance from it has no part along `along` (in sizes).
  [[nodiscard]] std::optional<OrbitPlace> across(const std::vector<double>& z, const std::vector<double>& along);
  /// Where branches cross or the period doubles, the direction in which the equations hold beside that of the branch,
  /// of length 1 in sizes. z lies next to that place, on the mesh that is used, `along` is the branch's tangent.
  [[nodiscard]] std::optional<std::vector<double>> other_direction(const std::vector<double>& z,
                                                                   const std::vector<double>& along);
  /// x(s) - x(s + 1/2) at the nodes, in sizes: nothing is left of it where twice the same orbit is run through.
  [[nodiscard]] std::vector<double> halves(const OrbitPlace& place);
  /// A step along the branch. Nothing where none is found, or only one that is farther off than the step is long.
  [[nodiscard]] std::optional<OrbitPlace> stepped(const OrbitPlace& from, double step);
  /// Whether the mesh of `place` serves it.
  [[nodiscard]] bool is_exact(const OrbitPlace& place) const { return place.error <= error_wanted_; }
  /// Solves for `here` again, on a mesh that serves `there` (on the same mesh as `here`). False where no finer one is
  /// allowed, or nothing is found on it.
  [[nodiscard]] bool refine(OrbitPlace& here, const OrbitPlace& there);
  /// The least and greatest values of the components.
  void complete(OrbitPlace& place);

  /// How far the nodes are from the mean, in sizes, all together.
  [[nodiscard]] std::vector<double> deviations(const OrbitPlace& place);
  [[nodiscard]] std::vector<double> mean(const OrbitPlace& place);
  /// The cosine between tangents on the same mesh.
  [[nodiscard]] static double alike(const OrbitPlace& a, const OrbitPlace& b);
  /// Of the unknowns.
  [[nodiscard]] const std::vector<double>& sizes() const { return scale_; }
  [[nodiscard]] double size(std::size_t unknown) const { return scale_[unknown]; }
  /// Of a component.
  [[nodiscard]] double size_of(std::size_t component) const { return component_sizes_[component]; }

 private:
  void use_for(const OrbitPlace& place);
  void set_scales(const std::vector<double>& z);
  void exchange_mesh(OrbitPlace& place, const std::shared_ptr<const OrbitMesh>& mesh);
  [[nodiscard]] std::vector<double> on_mesh(const std::vector<double>& z, const OrbitMesh& mesh) const;
  [[nodiscard]] std::vector<double> shift_at(const std::vector<double>& z) const;
  [[nodiscard]] std::optional<std::vector<double>> solved(const std::vector<double>& shift,
                                                          const std::vector<double>& last, std::vector<double> b);
  /// With the tangent nearest to `along`, multipliers and tests.
  [[nodiscard]] std::optional<OrbitPlace> described(std::vector<double> z, const std::vector<double>& along);
  [[nodiscard]] std::optional<std::vector<double>> corrected(const std::vector<double>& guess,
                                                             const std::vector<double>& reference,
                                                             const std::vector<double>& shift,
                                                             const std::vector<double>& last);

  const OrbitContinuationOptions& options_;
  ParametricSystem system_;  // of the one constant
  double error_wanted_;
  std::optional<OrbitCollocation> equations_;
  std::size_t n_, unknowns_ = 0;
  std::vector<double> sizes_, component_sizes_, scale_;
  std::size_t iterations_ = 0;
};

}  // namespace continuo::studies::detail
