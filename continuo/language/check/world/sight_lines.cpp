// continuo/language/check/world/sight_lines.cpp
// Gaps and ways from the places of bodies, the normals of walls and the corners of meshes.
#include <algorithm>
#include <limits>

#include <continuo/language/check/world/sight_lines.hpp>
#include <continuo/language/check/world/turns.hpp>

namespace continuo::model::detail {

NodeId SightLines::way_to(const Thing& thing, const NodePoint& from, const NodePoint& direction, NodeId reach) const {
  if (thing.is_mesh()) return way_to_facet(thing, from, direction, reach);
  return thing.is_wall() ? way_to_wall(made_.walls[thing.wall], from, direction, reach)
                         : way_to_body(thing, from_to(from, thing.point), direction, reach);
}

NodeId SightLines::gap_between(const Thing& a, const Thing& b) const {
  Graph& g = graph_;
  NodeId gap;
  if (b.is_wall()) {
    const WallDescription& wall = made_.walls[b.wall];
    gap = g.divide(g.subtract(inner_product(wall.normal, a.point), wall.offset), length_of(wall.normal));
    if (wall.thin) gap = g.apply(Op::absolute, gap);
  } else {
    gap = length_of(from_to(a.point, b.point));
  }
  for (const Thing* thing : {&a, &b})
    if (thing->body != no_body) gap = g.subtract(gap, made_.bodies[thing->body].radius);
  return gap;
}

/// A ray along the unit vector d from 0 enters the sphere of radius r round c at s - w and leaves it at s + w, where
/// s = c.d and w^2 = r^2 - |c - s d|^2; 0 where it starts inside. A point has no size: no ray meets it.
NodeId SightLines::way_to_body(const Thing& body, const NodePoint& centre, const NodePoint& d, NodeId reach) const {
  Graph& g = graph_;
  if (body.body == no_body) return reach;
  const NodeId radius = made_.bodies[body.body].radius, along = inner_product(centre, d), zero = g.constant(0);
  NodePoint across{};
  for (std::size_t axis = 0; axis < axes(); ++axis) across[axis] = g.subtract(centre[axis], g.multiply(along, d[axis]));
  const NodeId square = g.subtract(g.multiply(radius, radius), inner_product(across, across));
  const NodeId width = g.apply(Op::square_root, g.apply(Op::maximum, square, zero));
  const NodeId is_met = g.apply(Op::logical_and, g.less_equal(zero, square), g.less_equal(zero, g.add(along, width)));
  return g.select(is_met, g.apply(Op::maximum, g.subtract(along, width), zero), reach);
}

/// From the height h before a wall, at the rate f towards it: h/f; 0 from behind it. Before a thin one is where the ray
/// starts.
NodeId SightLines::way_to_wall(const WallDescription& wall, const NodePoint& from, const NodePoint& d,
                               NodeId reach) const {
  Graph& g = graph_;
  const NodeId zero = g.constant(0);
  NodeId height = g.subtract(inner_product(wall.normal, from), wall.offset);
  NodeId rate = g.negate(inner_product(wall.normal, d));
  if (wall.thin) {
    rate = g.select(g.less(height, zero), g.negate(rate), rate);
    height = g.apply(Op::absolute, height);
  }
  const NodeId comes = g.less(zero, rate);
  const NodeId way = g.select(comes, g.divide(height, g.select(comes, rate, g.constant(1))), reach);
  return g.select(g.less_equal(height, zero), zero, way);
}

std::vector<Thing> SightLines::facets_of(std::size_t number) const {
  Graph& g = graph_;
  const MeshDescription& mesh = made_.meshes[number];
  const std::size_t count = std::max(mesh.points.size(), mesh.corners.size());
  std::vector<NodePoint> corners;
  for (std::size_t i = 0; i < count; ++i) {
    NodePoint corner{};
    for (std::size_t axis = 0; axis < axes(); ++axis)
      corner[axis] =
          g.multiply(mesh.scale, mesh.points.empty() ? g.constant(mesh.corners[i][axis]) : mesh.points[i][axis]);
    corner = turned(g, corner, mesh.orientation, dimension_);
    for (std::size_t axis = 0; axis < axes(); ++axis) corner[axis] = g.add(mesh.position[axis], corner[axis]);
    corners.push_back(corner);
  }
  std::vector<Thing> facets;
  for (const auto& [a, b, c] : mesh.triangles)
    facets.push_back({.mesh = number, .facet = {corners[a], corners[b], corners[c]}});
  for (std::size_t i = 0; dimension_ == 2 && i + (mesh.is_closed ? 0 : 1) < count; ++i)
    facets.push_back({.mesh = number, .facet = {corners[i], corners[(i + 1) % count], {}}});
  return facets;
}

/// Seen from the start of a ray along d, a, b, c are the corners. The ray passes a triangle on the inner side of the
/// sides where d.(b x c), d.(c x a) and d.(a x b) have one sign, that of d.n for its normal n; with the determinants as
/// weights they make the point that is hit. In the plane d x a and d x b have different signs. Two facets have the same
/// numbers for a side that they share, so that no ray passes between them. A ray from behind meets only what is thin.
NodeId SightLines::way_to_facet(const Thing& thing, const NodePoint& from, const NodePoint& d, NodeId reach) const {
  Graph& g = graph_;
  const NodeId zero = g.constant(0);
  std::array<NodePoint, 3> corners{};
  for (std::size_t k = 0; k < axes(); ++k) corners[k] = from_to(from, thing.facet[k]);
  const auto& [a, b, c] = corners;
  std::vector<NodeId> weights;
  if (dimension_ == 2) {
    const auto across = [&](const NodePoint& v) { return g.subtract(g.multiply(d[0], v[1]), g.multiply(d[1], v[0])); };
    weights = {g.negate(across(b)), across(a)};
  } else {
    weights = {determinant(d, b, c), determinant(d, c, a), determinant(d, a, b)};
  }
  NodeId sum = weights[0], least = weights[0], most = weights[0];
  for (std::size_t k = 1; k < weights.size(); ++k) {
    sum = g.add(sum, weights[k]);
    least = g.apply(Op::minimum, least, weights[k]);
    most = g.apply(Op::maximum, most, weights[k]);
  }
  NodeId passes = g.apply(Op::logical_and, g.less_equal(most, zero), g.less(sum, zero));
  if (made_.meshes[thing.mesh].thin)
    passes = g.apply(Op::logical_or, passes, g.apply(Op::logical_and, g.less_equal(zero, least), g.less(zero, sum)));
  NodeId way = zero;
  for (std::size_t k = 0; k < weights.size(); ++k)
    way = g.add(way, g.multiply(weights[k], inner_product(d, corners[k])));
  way = g.divide(way, g.select(passes, sum, g.constant(1)));
  return g.select(g.apply(Op::logical_and, passes, g.less_equal(zero, way)), way, reach);
}

/// u.(v x w).
NodeId SightLines::determinant(const NodePoint& u, const NodePoint& v, const NodePoint& w) const {
  Graph& g = graph_;
  NodeId sum = g.constant(0);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    sum = g.add(sum, g.multiply(u[k], g.subtract(g.multiply(v[i], w[j]), g.multiply(v[j], w[i]))));
  }
  return sum;
}

NodeId SightLines::length_of(const NodePoint& v) const {
  Graph& g = graph_;
  const NodeId length = g.apply(Op::hypotenuse, v[0], v[1]);
  return dimension_ == 2 ? length : g.apply(Op::hypotenuse, length, v[2]);
}

NodeId SightLines::inner_product(const NodePoint& v, const NodePoint& w) const {
  Graph& g = graph_;
  NodeId sum = g.multiply(v[0], w[0]);
  for (std::size_t axis = 1; axis < axes(); ++axis) sum = g.add(sum, g.multiply(v[axis], w[axis]));
  return sum;
}

NodePoint SightLines::from_to(const NodePoint& from, const NodePoint& to) const {
  NodePoint difference{};
  for (std::size_t axis = 0; axis < axes(); ++axis) difference[axis] = graph_.subtract(to[axis], from[axis]);
  return difference;
}

}  // namespace continuo::model::detail
