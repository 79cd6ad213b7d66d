// One place after the other on a curve of degenerate homoclinic orbits in three constants. Internal to
// degenerate_homoclinic.
#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <continuo/studies/degenerate_homoclinic.hpp>
#include <continuo/studies/orbits/curves/homoclinic_steps.hpp>

namespace continuo::studies::detail {

struct DegeneratePlace {
  HomoclinicPlace orbit;              // its unknowns: the constants but the one held, in their order
  std::size_t held = 2;               // 0, 1 or 2
  std::array<double, 3> constants{};  // their values
  /// The secant to the place before, and how it has bent, in the constants; in the unknowns the orbit carries both.
  std::array<double, 3> direction{}, bend{};

  [[nodiscard]] DegenerateHomoclinicPoint point() const;
};

class DegenerateHomoclinicSteps {
  using Vector = std::vector<double>;

 public:
  DegenerateHomoclinicSteps(const ParametricSystem& system, HomoclinicTest test,
                            const DegenerateHomoclinicOptions& options);

  /// Where the first two constants are the unknowns, with the curve's direction. Nothing where it is not found.
  [[nodiscard]] std::optional<DegeneratePlace> first(const HomoclinicPlace& start);
  /// Predicted along the direction, as far as `step` in sizes; with the direction of the secant. Nothing where none is
  /// found, or only one that is much farther off than the step is long. `from` holds the constant that `fastest` names.
  [[nodiscard]] std::optional<DegeneratePlace> stepped(const DegeneratePlace& from, double step);
  /// Between neighbours, so far from the first, of which the second has been found.
  [[nodiscard]] std::optional<DegeneratePlace> between(const DegeneratePlace& a, const DegeneratePlace& b, double part);
  /// Likewise with a constant at this value.
  [[nodiscard]] std::optional<DegeneratePlace> at_bound(const DegeneratePlace& a, const DegeneratePlace& b,
                                                        std::size_t constant, double value);
  /// The same place with another constant held.
  [[nodiscard]] std::optional<DegeneratePlace> turned(const DegeneratePlace& place, std::size_t held);
  /// Which constant is to be held on the way from here.
  [[nodiscard]] std::size_t fastest(const DegeneratePlace& place) const;
  /// The cosine between the directions of neighbours on the same mesh.
  [[nodiscard]] double alike(const DegeneratePlace& a, const DegeneratePlace& b);
  /// Gives a place the direction of another one on the same mesh.
  static void take_direction(DegeneratePlace& place, const DegeneratePlace& of);
  /// Takes a length and a mesh that serve the place.
  [[nodiscard]] bool renew(DegeneratePlace& place);

 private:
  /// A constant is held: the system with its value, and what follows homoclinic orbits in the other two.
  struct Plane {
    Plane(const ParametricSystem& system, const DegenerateHomoclinicOptions& options, std::size_t held);
    ParametricSystem system;
    OrbitCurveOptions options;
    HomoclinicSteps steps;
    std::size_t constant;  // which of the system's is held
    void hold(double value) { system.constants[constant] = value; }
  };
  [[nodiscard]] std::optional<DegeneratePlace> solved(const DegeneratePlace& from, double value, const Vector& guess);
  [[nodiscard]] std::optional<HomoclinicPlace> zero_from(Plane& plane, HomoclinicPlace place) const;
  [[nodiscard]] std::optional<DegeneratePlace> near_start(const DegeneratePlace& start, std::size_t held);
  void set_direction(DegeneratePlace& place, const DegeneratePlace& from, double part) const;
  [[nodiscard]] Vector in_sizes(const DegeneratePlace& at, const DegeneratePlace& of);
  [[nodiscard]] double range(std::size_t k) const { return options_.high[k] - options_.low[k]; }

  HomoclinicTest test_;
  const DegenerateHomoclinicOptions& options_;
  std::array<std::unique_ptr<Plane>, 3> planes_{};
};

}  // namespace continuo::studies::detail
