// Volumes by Steiner's formula: rounding adds a slab to each face, a part of a cylinder to each edge, a ball in all.
#include <array>
#include <numbers>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/body_shapes.hpp>
#include <continuo/shapes/solid.hpp>

namespace continuo::model::detail {

namespace {

constexpr std::array<std::string_view, 3> shape_words = {"box", "capsule", "hull"};

}  // namespace

MadeShape BodyShapes::make(const ast::WorldAttributes& attributes, Scope& scope) const {
  if (!is_one_shape(attributes)) return {};
  if (const auto* size = attribute(attributes, "box")) return make_box(attributes, *size, scope);
  if (const auto* points = attribute(attributes, "hull")) return make_hull(attributes, *points, scope);
  if (const auto* length = attribute(attributes, "capsule")) return make_capsule(attributes, *length, scope);
  return make_ball(attributes, scope);
}

/// E225 where it has two shapes, or a length that its shape has not.
bool BodyShapes::is_one_shape(const ast::WorldAttributes& attributes) const {
  std::string_view first;
  for (const ast::WorldAttribute& one : attributes) {
    if (std::ranges::find(shape_words, one.name.text) == shape_words.end()) continue;
    if (!first.empty()) {
      report_.fail("E225", one.name.span, "a body has one shape", fmt::format("it is a {} already", first),
                   "leave one of them out, or write it as a part: part of NAME at (1, 0) box (1, 1)");
      return false;
    }
    first = one.name.text;
  }
  const bool has_corners = first == "box" || first == "hull";
  const auto *radius = attribute(attributes, "radius"), *rounding = attribute(attributes, "rounding");
  if (has_corners && radius)
    report_.fail("E225", radius->span, fmt::format("a {} has no radius", first), {},
                 "`rounding` is the radius of its corners");
  if (!has_corners && rounding)
    report_.fail("E225", rounding->span,
                 fmt::format("a {} has no corners to be rounded", first.empty() ? "ball" : first), {},
                 "write `radius`");
  return !(has_corners ? radius : rounding);
}

NodeId BodyShapes::radius_of(const ast::WorldAttributes& attributes, Scope& scope) const {
  const ast::Expression* radius = attribute(attributes, "radius");
  return radius ? numbers_.number(*radius, scope, work_.length, "the radius", Sort::positive) : graph_.constant(0.5);
}

/// In the plane the area of a disc.
NodeId BodyShapes::ball_volume(NodeId radius) const {
  const bool plane = text_.dimension == 2;
  const double factor = plane ? std::numbers::pi : 4 * std::numbers::pi / 3;
  return graph_.multiply(graph_.constant(factor), graph_.power(radius, graph_.constant(plane ? 2 : 3)));
}

MadeShape BodyShapes::make_ball(const ast::WorldAttributes& attributes, Scope& scope) const {
  MadeShape made;
  made.radius = made.shape.radius = radius_of(attributes, scope);
  if (!made.radius.valid()) return made;
  made.volume = ball_volume(made.radius);
  made.height = graph_.multiply(graph_.constant(2), made.radius);
  return made;
}

MadeShape BodyShapes::make_capsule(const ast::WorldAttributes& attributes, const ast::Expression& length,
                                   Scope& scope) const {
  const NodeId radius = radius_of(attributes, scope);
  const NodeId way = numbers_.number(length, scope, work_.length, "the length of a capsule", Sort::positive);
  if (radius.valid() && way.valid()) return capsule(radius, way);
  MadeShape made;
  made.shape.kind = ShapeDescription::Kind::capsule;
  made.shape.radius = radius, made.shape.length = way;
  return made;
}

MadeShape BodyShapes::capsule(NodeId r, NodeId l) const {
  Graph& g = graph_;
  MadeShape made;
  made.shape.kind = ShapeDescription::Kind::capsule;
  made.shape.radius = r, made.shape.length = l;
  made.radius = g.add(g.multiply(g.constant(0.5), l), r);
  made.height = g.multiply(g.constant(2), made.radius);
  const NodeId middle = text_.dimension == 2
                            ? g.multiply(g.constant(2), g.multiply(l, r))
                            : g.multiply(g.constant(std::numbers::pi), g.multiply(l, g.multiply(r, r)));
  made.volume = g.add(middle, ball_volume(r));
  return made;
}

/// A core of sides a, b, c and all that is within r of it: abc + 2r(ab + bc + ca) + pi r^2 (a + b + c) + 4/3 pi r^3; in
/// the plane ab + 2r(a + b) + pi r^2.
MadeShape BodyShapes::make_box(const ast::WorldAttributes& attributes, const ast::Expression& size,
                               Scope& scope) const {
  Graph& g = graph_;
  MadeShape made;
  made.shape.kind = ShapeDescription::Kind::box;
  const ast::Expression* rounding = attribute(attributes, "rounding");
  made.shape.size = numbers_.point(size, scope, work_.length, "the size of a box");
  made.shape.rounding =
      rounding ? numbers_.number(*rounding, scope, work_.length, "the rounding", Sort::not_negative) : g.constant(0);
  if (!made.shape.size[0].valid() || !made.shape.rounding.valid()) return made;
  const NodeId r = made.shape.rounding, two_r = g.multiply(g.constant(2), r);
  NodePoint side{g.constant(0), g.constant(0), g.constant(0)};
  for (std::size_t axis = 0; axis < text_.axes(); ++axis) {
    numbers_.expect(made.shape.size[axis], Sort::positive, size.span, "a side of a box");
    side[axis] = g.subtract(made.shape.size[axis], two_r);
    if (rounding)
      numbers_.expect(side[axis], Sort::positive, rounding->span, "what the rounding leaves of a side of the box");
  }
  const NodeId sum = g.add(g.add(side[0], side[1]), side[2]), ab = g.multiply(side[0], side[1]);
  const NodeId diagonal = g.apply(Op::hypotenuse, g.apply(Op::hypotenuse, side[0], side[1]), side[2]);
  made.radius = g.add(g.multiply(g.constant(0.5), diagonal), r);
  made.height = made.shape.size[text_.axes() - 1];
  if (text_.dimension == 2) {
    made.volume = g.add(g.add(ab, g.multiply(two_r, sum)), ball_volume(r));
    return made;
  }
  const NodeId faces = g.add(ab, g.multiply(side[2], g.add(side[0], side[1])));
  const NodeId edges = g.multiply(g.constant(std::numbers::pi), g.multiply(g.multiply(r, r), sum));
  made.volume = g.add(g.add(g.multiply(ab, side[2]), g.multiply(two_r, faces)), g.add(edges, ball_volume(r)));
  return made;
}

/// Its corners are numbers: the hull is made here.
MadeShape BodyShapes::make_hull(const ast::WorldAttributes& attributes, const ast::Expression& points,
                                const Scope& outer) const {
  Scope scope = outer;
  scope.constant = "a corner of a hull";
  MadeShape made;
  made.shape.kind = ShapeDescription::Kind::hull;
  for (const ast::Expression& point : std::get<ast::List>(points.node).items) {
    const NodePoint at = numbers_.point(point, scope, work_.length, "a corner of a hull");
    std::array<double, 3>& corner = made.shape.corners.emplace_back();
    for (std::size_t axis = 0; axis < text_.axes(); ++axis) {
      const auto value = at[axis].valid() ? graph_.value(at[axis]) : std::nullopt;
      if (!value) return made;
      corner[axis] = *value;
    }
  }
  scope.constant = "the rounding of a hull";
  const ast::Expression* rounding = attribute(attributes, "rounding");
  made.shape.rounding = rounding ? numbers_.number(*rounding, scope, work_.length, "the rounding", Sort::not_negative)
                                 : graph_.constant(0);
  const auto round = made.shape.rounding.valid() ? graph_.value(made.shape.rounding) : std::nullopt;
  if (!round || *round < 0) return made;
  return text_.dimension == 2 ? measured_hull<2>(points, std::move(made.shape), *round)
                              : measured_hull<3>(points, std::move(made.shape), *round);
}

template <int Dim>
MadeShape BodyShapes::measured_hull(const ast::Expression& points, ShapeDescription shape, double rounding) const {
  Hull<double, Dim> hull{.points = {}, .rounding = rounding};
  for (const std::array<double, 3>& corner : shape.corners) {
    Vector<double, Dim>& point = hull.points.emplace_back();
    for (std::size_t axis = 0; axis < point.size(); ++axis) point[axis] = corner[axis];
  }
  MadeShape made;
  made.shape = std::move(shape);
  const auto solid = continuo::solid<double, Dim>(hull);
  if (!solid) {
    report_.fail("E225", points.span, "these corners make no body", solid.status().message,
                 Dim == 2 ? "give three to 64 points that are not on one line, as in hull (0, 0) (1, 0) (0, 1)"
                          : "give four to 64 points that are not in one plane");
    return made;
  }
  made.radius = graph_.constant(solid->reach);
  made.volume = graph_.constant(solid->volume);
  for (std::size_t axis = 0; axis < solid->centre.size(); ++axis) made.centre[axis] = solid->centre[axis];
  return made;
}

}  // namespace continuo::model::detail
