// continuo/shapes/polytope.hpp
// A convex polygon or polyhedron by its corners, faces and edges.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/numerics/vector.hpp>

namespace continuo {

/// The points x with normal . x <= offset are on the inner side of a face.
template <class Real, int Dim>
struct Face {
  Vector<Real, Dim> normal{};  // of length 1, outwards
  Real offset{};               // normal . x of the points of the face
};

/// An edge of a polyhedron. Seen from outside, from its beginning to its end, `left` is on the left.
struct Edge {
  std::uint8_t from = 0, to = 0;     // corners
  std::uint8_t left = 0, right = 0;  // faces
  /// Whether all numbers are equal.
  friend bool operator==(const Edge&, const Edge&) = default;
};

/// A convex polytope. In the plane, corners and faces go counter-clockwise, and face i is the side from corner i to the
/// next one. One corner without faces is a point, two are a segment.
template <class Real, int Dim>
struct Polytope {
  static constexpr std::size_t most_corners = 64;  // of a hull

  std::vector<Vector<Real, Dim>> corners{};  // at least one
  std::vector<Face<Real, Dim>> faces{};      // with their normals outwards
  std::vector<std::uint8_t> loops{};         // in space: the corners of each face, counter-clockwise seen from outside
  std::vector<std::uint16_t> loop_begin{};   // in space: where the corners of face i begin in `loops`, and their end
  std::vector<Edge> edges{};                 // in space

  /// The corners of a face of a polyhedron, counter-clockwise seen from outside.
  [[nodiscard]] std::span<const std::uint8_t> loop(std::size_t face) const {
    return std::span(loops).subspan(loop_begin[face], std::size_t(loop_begin[face + 1] - loop_begin[face]));
  }
};

/// The number of the corner that is farthest in a direction; the first of equal ones.
template <class Real, int Dim>
[[nodiscard]] std::size_t support(const Polytope<Real, Dim>& polytope, const Vector<Real, Dim>& direction) {
  std::size_t best = 0;
  Real most = dot(polytope.corners[0], direction);
  for (std::size_t i = 1; i < polytope.corners.size(); ++i)
    if (const Real here = dot(polytope.corners[i], direction); here > most) most = here, best = i;
  return best;
}

}  // namespace continuo
