// Angles of the plane, and rotation vectors as quaternions.
#include <limits>

#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/turns.hpp>

namespace continuo::model::detail {

/// In space p + 2 q x (q x p + w p) for the quaternion (w, q).
NodePoint turned(Graph& g, const NodePoint& p, const std::array<NodeId, 4>& orientation, int dimension) {
  if (dimension == 2) {
    const NodeId c = g.apply(Op::cosine, orientation[0]), s = g.apply(Op::sine, orientation[0]);
    return {g.subtract(g.multiply(c, p[0]), g.multiply(s, p[1])), g.add(g.multiply(s, p[0]), g.multiply(c, p[1])), {}};
  }
  const NodePoint q{orientation[1], orientation[2], orientation[3]};
  const auto cross = [&](const NodePoint& a, const NodePoint& b) {
    NodePoint made;
    for (std::size_t k = 0; k < 3; ++k)
      made[k] = g.subtract(g.multiply(a[(k + 1) % 3], b[(k + 2) % 3]), g.multiply(a[(k + 2) % 3], b[(k + 1) % 3]));
    return made;
  };
  NodePoint inner = cross(q, p);
  for (std::size_t k = 0; k < 3; ++k) inner[k] = g.add(inner[k], g.multiply(orientation[0], p[k]));
  NodePoint made = cross(q, inner);
  for (std::size_t k = 0; k < 3; ++k) made[k] = g.add(p[k], g.multiply(g.constant(2), made[k]));
  return made;
}

/// In space an angle is three numbers, the axis about which it is turned, and by how much as its length; or one number
/// about `axis`.
NodePoint Turns::rotation_vector(const ast::WorldAttributes& attributes, Scope& scope) const {
  Graph& g = graph_;
  const Measured pure = Measured::known(Unit());
  const ast::Expression *angle = attribute(attributes, "angle"), *axis = attribute(attributes, "axis");
  if (!axis) return numbers_.in_space(*angle, scope, pure, "an angle");
  const NodePoint about = numbers_.point(*axis, scope, Measured::unknown(), "an axis");
  const NodeId by = numbers_.number(*angle, scope, pure, "an angle about an axis", Sort::any);
  if (!about[0].valid() || !by.valid()) return {};
  const NodeId length = g.apply(Op::hypotenuse, g.apply(Op::hypotenuse, about[0], about[1]), about[2]);
  numbers_.expect(length, Sort::positive, axis->span, "the length of an axis");
  const NodeId part = g.divide(by, length);
  return {g.multiply(about[0], part), g.multiply(about[1], part), g.multiply(about[2], part)};
}

Turn Turns::turn_of(const ast::WorldAttributes& attributes, Scope& scope) const {
  Graph& g = graph_;
  const NodeId zero = g.constant(0);
  Turn turn{.orientation = {zero}, .spin = {zero, zero, zero}};
  const bool plane = text_.dimension == 2;
  if (!plane) turn.orientation = {g.constant(1), zero, zero, zero};
  const Measured pure = Measured::known(Unit());
  const Measured rate = expressions_.workspace.time.per_time(work_.length.is_known() ? pure : Measured::unknown());
  const ast::Expression *angle = attribute(attributes, "angle"), *spin = attribute(attributes, "spin"),
                        *axis = attribute(attributes, "axis");
  if (spin && plane) turn.spin[0] = numbers_.in_plane(*spin, scope, rate, "a spin");
  if (spin && !plane) turn.spin = numbers_.in_space(*spin, scope, rate, "a spin");
  if (axis && (plane || !angle))
    report_.fail("E225", axis->span,
                 plane ? "all bodies of the plane turn about one axis" : "by how much is it turned?", {},
                 plane ? "leave `axis` out" : "add angle 30 [deg]");
  if (angle && plane) turn.orientation[0] = numbers_.in_plane(*angle, scope, pure, "an angle");
  if (!angle || plane) return turn;
  const NodePoint about = rotation_vector(attributes, scope);
  if (!about[0].valid()) return turn;
  const NodeId whole = g.apply(Op::hypotenuse, g.apply(Op::hypotenuse, about[0], about[1]), about[2]);
  const NodeId half = g.multiply(whole, g.constant(0.5));
  // sin(a/2)/a times the three numbers, which are all 0 where a is.
  const NodeId least = g.constant(std::numeric_limits<double>::min());
  const NodeId part = g.divide(g.apply(Op::sine, half), g.apply(Op::maximum, whole, least));
  turn.orientation[0] = g.apply(Op::cosine, half);
  for (std::size_t k = 0; k < 3; ++k) turn.orientation[k + 1] = g.multiply(about[k], part);
  return turn;
}

}  // namespace continuo::model::detail
