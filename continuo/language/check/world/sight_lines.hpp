// continuo/language/check/world/sight_lines.hpp
// Gaps between bodies, walls and points, and ways along a ray, also to facets of meshes, as nodes.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include <continuo/language/world.hpp>
#include <continuo/symbolic/graph/expression.hpp>

namespace continuo::model::detail {

/// What a query asks about: a body, a wall, a facet of a mesh, or a point.
struct Thing {
  std::size_t body = no_body, wall = no_body, mesh = no_body;  // wall and mesh: by their numbers
  NodePoint point{};                                           // of a body its centre
  std::array<NodePoint, 3>
      facet{};  // of a mesh the corners of a triangle, or of a segment, whose third is of no meaning
  [[nodiscard]] bool is_wall() const { return wall != no_body; }
  [[nodiscard]] bool is_mesh() const { return mesh != no_body; }
};

class SightLines {
 public:
  SightLines(Graph& graph, const WorldDescription& made, int dimension)
      : graph_(graph), made_(made), dimension_(dimension) {}

  /// Between surfaces; below 0 where they overlap.
  [[nodiscard]] NodeId gap_between(const Thing& a, const Thing& b) const;
  /// How far it is from a point along a unit vector to a body or a wall; the reach where none is met.
  [[nodiscard]] NodeId way_to(const Thing& thing, const NodePoint& from, const NodePoint& direction,
                              NodeId reach) const;
  [[nodiscard]] NodeId length_of(const NodePoint& v) const;
  /// The facets of a mesh, as it stands.
  [[nodiscard]] std::vector<Thing> facets_of(std::size_t mesh) const;

 private:
  [[nodiscard]] std::size_t axes() const { return static_cast<std::size_t>(dimension_); }
  [[nodiscard]] NodeId way_to_body(const Thing& body, const NodePoint& centre, const NodePoint& direction,
                                   NodeId reach) const;
  [[nodiscard]] NodeId way_to_wall(const WallDescription& wall, const NodePoint& from, const NodePoint& direction,
                                   NodeId reach) const;
  [[nodiscard]] NodeId way_to_facet(const Thing& facet, const NodePoint& from, const NodePoint& direction,
                                    NodeId reach) const;
  [[nodiscard]] NodeId determinant(const NodePoint& u, const NodePoint& v, const NodePoint& w) const;
  [[nodiscard]] NodeId inner_product(const NodePoint& v, const NodePoint& w) const;
  [[nodiscard]] NodePoint from_to(const NodePoint& from, const NodePoint& to) const;

  Graph& graph_;
  const WorldDescription& made_;
  int dimension_;
};

}  // namespace continuo::model::detail
