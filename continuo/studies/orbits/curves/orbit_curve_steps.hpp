// One place after the other on a curve of folds, period doublings or tori of orbits. Internal to orbit_curve.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <continuo/studies/orbit_curve.hpp>
#include <continuo/studies/orbits/collocation/orbit_collocation.hpp>
#include <continuo/studies/orbits/curves/critical_orbit.hpp>

namespace continuo::studies::detail {

struct OrbitCurvePlace {
  std::shared_ptr<const OrbitMesh> mesh{};
  std::vector<double> z{};        // x at the nodes, period, both constants, angle
  std::vector<double> tangent{};  // of length 1, in sizes
  CriticalVectors vectors{};
  std::array<double, 2> normal{};  // of a curve of folds: upright to it in the plane of the constants
  OrbitCurvePoint point{};
  double error = 0;  // of the collocation inside of an interval, in sizes
  /// By OrbitDegeneracy; each changes its sign there. Not a number where it cannot be on this curve.
  std::array<double, orbit_degeneracies> tests{};
  [[nodiscard]] double test(OrbitDegeneracy kind) const { return tests[static_cast<std::size_t>(kind)]; }
};

class OrbitCurveSteps {
 public:
  OrbitCurveSteps(const ParametricSystem& system, OrbitBifurcation kind, const OrbitCurveOptions& options);

  /// Near a mark of a branch of orbits; nothing where it is not found.
  [[nodiscard]] std::optional<OrbitCurvePlace> first(const OrbitMark& mark);
  /// Nothing where none is found, or only one that is farther off than the step is long.
  [[nodiscard]] std::optional<OrbitCurvePlace> stepped(const OrbitCurvePlace& from, double step);
  /// Between two neighbours on the same mesh, with one constant (0 or 1) at this value.
  [[nodiscard]] std::optional<OrbitCurvePlace> at_bound(const OrbitCurvePlace& a, const OrbitCurvePlace& b,
                                                        std::size_t constant, double value);
  /// Takes a mesh that serves the place, and solves for it there, where that has become worth it.
  [[nodiscard]] bool renew(OrbitCurvePlace& place);
  /// The least and greatest values of the components.
  void complete(OrbitCurvePlace& place);
  /// How far the nodes are from their mean, each by the root of its weight.
  [[nodiscard]] std::vector<double> deviations(const OrbitCurvePlace& place);
  [[nodiscard]] bool is_exact(const OrbitCurvePlace& place) const { return place.error <= error_wanted_; }
  [[nodiscard]] std::size_t size() const { return system_.size; }

 private:
  void use(const std::shared_ptr<const OrbitMesh>& mesh);
  void measure(const std::vector<double>& z);
  [[nodiscard]] std::vector<double> shift_at(const std::vector<double>& z);
  [[nodiscard]] std::optional<OrbitCurvePlace> corrected(const std::vector<double>& guess,
                                                         const std::vector<double>& reference,
                                                         const std::vector<double>& last,
                                                         const CriticalVectors& borders,
                                                         const std::array<double, 2>& normal);
  [[nodiscard]] std::optional<OrbitCurvePlace> described(std::vector<double> z, const std::vector<double>& along,
                                                         const std::array<double, 2>& normal);
  void set_tests(OrbitCurvePlace& place) const;
  [[nodiscard]] std::vector<double> on_mesh(const std::vector<double>& z, const OrbitMesh& mesh);
  /// The system with the second constant at its value there, and z as orbit_collocation has it.
  [[nodiscard]] ParametricSystem there(const std::vector<double>& z) const;

  const ParametricSystem& system_;
  OrbitBifurcation kind_;
  const OrbitCurveOptions& options_;
  double error_wanted_;
  std::shared_ptr<const OrbitMesh> mesh_;
  std::optional<CriticalOrbit> equations_;
  std::vector<double> sizes_, scale_;
};

}  // namespace continuo::studies::detail
