// continuo/language/check/world/sight_lines.cpp
// Gaps and ways from the places of bodies and the normals of walls.
#include <limits>

#include <continuo/language/check/world/sight_lines.hpp>

namespace continuo::model::detail {

NodeId SightLines::way_to(const Thing& thing, const NodePoint& from, const NodePoint& direction, NodeId reach) const {
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
