// continuo/shapes/mesh_shape.hpp
// Surfaces that never move, as their users describe them: numbers and points, not yet checked. A surface consists of
// facets: segments in the plane, triangles in space.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <variant>
#include <vector>

#include <continuo/numerics/vector.hpp>

namespace continuo {

/// A chain of segments in the plane from each point to the next one. What is free lies to the right of the way, as
/// outside of a polygon whose corners go counter-clockwise.
template <class Real>
struct Chain {
  std::vector<Vector<Real, 2>> points{};    // at least two
  bool is_loop = false;                     // a further segment leads from the last point to the first
  bool is_two_sided = false;                // both sides are free
  std::optional<Vector<Real, 2>> before{};  // a corner before the first point, without a segment: see `after`
  std::optional<Vector<Real, 2>> after{};   // where the surface goes on in another chain, so that bodies pass smoothly
  /// Whether all numbers are equal.
  friend bool operator==(const Chain&, const Chain&) = default;
};

/// Triangles in space. What is free lies on the side from which the corners go counter-clockwise. Corners at the same
/// place, to the bit, count as one.
template <class Real>
struct TriangleMesh {
  std::vector<Vector<Real, 3>> corners{};                 // in any order
  std::vector<std::array<std::uint32_t, 3>> triangles{};  // numbers of their corners; at least one triangle
  bool is_two_sided = false;                              // both sides are free
  /// Whether all numbers are equal.
  friend bool operator==(const TriangleMesh&, const TriangleMesh&) = default;
};

/// Heights over the points of a grid, joined by segments, or by two triangles in each cell. What is above is free.
template <class Real, int Dim>
struct HeightField {
  static constexpr std::size_t axes = Dim - 1;       // of the grid
  Vector<Real, Dim> origin{};                        // the first point of the grid, from which heights are measured
  std::array<Real, axes> spacing = filled(Real(1));  // of the grid along its axes
  std::array<std::uint32_t, axes> counts{};          // points along each axis, at least two
  std::vector<Real> heights{};                       // one for each point, the first axis first
  /// Whether all numbers are equal.
  friend bool operator==(const HeightField&, const HeightField&) = default;

 private:
  [[nodiscard]] static constexpr std::array<Real, axes> filled(Real value) {
    std::array<Real, axes> values{};
    values.fill(value);
    return values;
  }
};

/// A surface that never moves.
template <class Real, int Dim>
using MeshShape = std::variant<std::conditional_t<Dim == 2, Chain<Real>, TriangleMesh<Real>>, HeightField<Real, Dim>>;

}  // namespace continuo
