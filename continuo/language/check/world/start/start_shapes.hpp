// Bodies where they begin, to see which of them are within each other or within a wall.
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include <continuo/language/model.hpp>
#include <continuo/language/world.hpp>
#include <continuo/shapes/polytope.hpp>

namespace continuo::model::detail {

/// Of a radius: less is round-off of bodies that touch.
inline constexpr double least_depth = 1e-9;

/// A part of a body at its place: all points within `rounding` of the core.
template <int Dim>
struct PlacedCore {
  Polytope<double, Dim> core;  // corners and edges; faces are of no use here
  double rounding = 0;
};

template <int Dim>
using PlacedCores = std::vector<PlacedCore<Dim>>;

class StartShapes {
 public:
  /// The bodies of a model without errors, where `variables` has them.
  StartShapes(const Model& model, const WorldDescription& made, std::span<const double> variables);

  /// How deep two bodies are within each other; 0 or below where they are apart or touch.
  [[nodiscard]] double depth(std::size_t i, std::size_t j) const;
  /// How deep a body is behind a wall with a normal of length 1.
  [[nodiscard]] double depth_in_wall(std::size_t i, const std::array<double, 3>& normal, double offset,
                                     bool is_thin) const;

  /// How deep a body is within a segment or a triangle; 0 or below where they are apart or touch.
  template <int Dim>
  [[nodiscard]] double depth_in_facet(std::size_t i, const std::array<Vector<double, Dim>, Dim>& corners) const;

  std::vector<std::array<double, 3>> centre;
  std::vector<double> radius;  // as in BodyDescription

 private:
  template <int Dim>
  void place(const Model& model, const WorldDescription& made, std::span<const double> variables);

  std::variant<std::vector<PlacedCores<2>>, std::vector<PlacedCores<3>>> cores_;  // of each body
};

}  // namespace continuo::model::detail
