// Where two convex parts of bodies touch, by the features of their cores that meet there: the gap, the normal and the
// place of the contact, with their changes in time.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include <continuo/bodies/exact_rigid/motion_row.hpp>
#include <continuo/shapes/convex.hpp>

namespace continuo {

/// The features, in the frames of the bodies.
template <class Real, int Dim>
struct ContactFeature {
  enum class Kind : std::uint8_t { face_of_a, face_of_b, points, line_of_a, line_of_b, lines };
  Kind kind = Kind::points;
  Vector<Real, Dim> point_a{}, point_b{};  // of the cores: a corner, or any point of the face or line
  Vector<Real, Dim> along_a{}, along_b{};  // the normal of the face, or the direction of the line; of length 1
  Real rounding_a{}, rounding_b{};         // of the surfaces beyond the cores
  Real side = Real(1);                     // of lines: the sign of the normal against along_a x along_b
};

/// The contact in the present state of the bodies.
template <class Real, int Dim>
struct ContactPlace {
  Real gap{};
  Moving<Real, Dim> normal{};  // from a to b, of length 1
  Moving<Real, Dim> place{};   // where the surfaces touch
};

/// Crossing lines: the normal is across both.
template <class Real>
[[nodiscard]] ContactPlace<Real, 3> place_of_lines(const ContactFeature<Real, 3>& of, const ExactBody<Real, 3>& a,
                                                   const ExactBody<Real, 3>& b) {
  using V = Vector<Real, 3>;
  const Moving<Real, 3> p = moving_point(a, of.point_a), q = moving_point(b, of.point_b);
  const Moving<Real, 3> e = moving_direction(a, a.axes * of.along_a), f = moving_direction(b, b.axes * of.along_b);
  const V between = q.value - p.value, between_change = q.change - p.change;
  const Moving<Real, 3> across{moment(e.value, f.value), moment(e.change, f.value) + moment(e.value, f.change)};
  Moving<Real, 3> normal = unit(across);
  normal.value *= of.side, normal.change *= of.side;
  // On the line of a, where that of b is above it: between + u f - s e is parallel to the normal.
  const V turned = moment(between, f.value);
  const V turned_change = moment(between_change, f.value) + moment(between, f.change);
  const Real size = squared(across.value), s = dot(turned, across.value) / size;
  const Real s_change =
      (dot(turned_change, across.value) + dot(turned, across.change) - 2 * s * dot(across.value, across.change)) / size;
  const Real r = of.rounding_a;
  return {dot(normal.value, between) - r - of.rounding_b,
          normal,
          {p.value + e.value * s + normal.value * r, p.change + e.value * s_change + e.change * s + normal.change * r}};
}
template <class Real>
[[nodiscard]] ContactPlace<Real, 2> place_of_lines(const ContactFeature<Real, 2>&, const ExactBody<Real, 2>&,
                                                   const ExactBody<Real, 2>&) {
  return {};  // lines of the plane do not cross above each other
}

template <class Real, int Dim>
[[nodiscard]] ContactPlace<Real, Dim> place_of(const ContactFeature<Real, Dim>& of, const ExactBody<Real, Dim>& a,
                                               const ExactBody<Real, Dim>& b) {
  using V = Vector<Real, Dim>;
  using Kind = typename ContactFeature<Real, Dim>::Kind;
  const Moving<Real, Dim> p = moving_point(a, of.point_a), q = moving_point(b, of.point_b);
  const V between = q.value - p.value, between_change = q.change - p.change;
  const Real roundings = of.rounding_a + of.rounding_b;
  const auto at_a = [&](const Real& gap, const Moving<Real, Dim>& n) {
    return ContactPlace<Real, Dim>{gap, n, {p.value + n.value * of.rounding_a, p.change + n.change * of.rounding_a}};
  };
  const auto at_b = [&](const Real& gap, const Moving<Real, Dim>& n) {
    return ContactPlace<Real, Dim>{gap, n, {q.value - n.value * of.rounding_b, q.change - n.change * of.rounding_b}};
  };
  const auto beside = [&](const Moving<Real, Dim>& line) {
    const Real s = dot(line.value, between), s_change = dot(line.change, between) + dot(line.value, between_change);
    return Moving<Real, Dim>{between - line.value * s, between_change - line.change * s - line.value * s_change};
  };
  switch (of.kind) {
    case Kind::face_of_a: {
      const Moving<Real, Dim> n = moving_direction(a, a.axes * of.along_a);
      return at_b(dot(n.value, between) - roundings, n);
    }
    case Kind::face_of_b: {
      const Moving<Real, Dim> n = moving_direction(b, b.axes * -of.along_b);
      return at_a(dot(n.value, between) - roundings, n);
    }
    case Kind::points:
      return at_a(length(between) - roundings, unit(Moving<Real, Dim>{between, between_change}));
    case Kind::line_of_a: {
      const Moving<Real, Dim> across = beside(moving_direction(a, a.axes * of.along_a));
      return at_b(length(across.value) - roundings, unit(across));
    }
    case Kind::line_of_b: {
      const Moving<Real, Dim> across = beside(moving_direction(b, b.axes * of.along_b));
      return at_a(length(across.value) - roundings, unit(across));
    }
    case Kind::lines:
      break;
  }
  return place_of_lines(of, a, b);
}

/// The row of a contact along its normal, and in the plane that across it.
template <class Real, int Dim>
[[nodiscard]] MotionRow<Real, Dim> normal_row(const ContactPlace<Real, Dim>& at, const ExactBody<Real, Dim>& a,
                                              const ExactBody<Real, Dim>& b) {
  MotionRow<Real, Dim> row = row_along(a, b, at.normal, at.place);
  row.error = at.gap;
  return row;
}
template <class Real>
[[nodiscard]] MotionRow<Real, 2> across_row(const ContactPlace<Real, 2>& at, const ExactBody<Real, 2>& a,
                                            const ExactBody<Real, 2>& b) {
  const auto across = [](const Vector<Real, 2>& n) { return Vector<Real, 2>{{-n[1], n[0]}}; };
  return row_along(a, b, Moving<Real, 2>{across(at.normal.value), across(at.normal.change)}, at.place);
}

/// The features of a convex core near a contact: the corner there, the edge through it, and the face whose normal is
/// that of the contact. Frames and places are those of the body.
template <class Real, int Dim>
struct NearFeatures {
  std::optional<Vector<Real, Dim>> corner, face, edge;  // edge: its direction
  Vector<Real, Dim> on_edge{}, on_face{};
};
/// `normal` points out of the body, `place` is on its core.
template <class Real, int Dim>
[[nodiscard]] NearFeatures<Real, Dim> features_near(const Convex<Real, Dim>& convex, const Pose<Real, Dim>& in_body,
                                                    const Vector<Real, Dim>& place, const Vector<Real, Dim>& normal) {
  using V = Vector<Real, Dim>;
  constexpr Real rounding = 64 * std::numeric_limits<Real>::epsilon();
  const Real near = std::max(Real(1e-6), rounding) * convex.reach;
  const Real parallel = 1 - std::max(Real(1e-12), rounding);
  const auto& core = convex.core;
  NearFeatures<Real, Dim> found;
  Real nearest = near;
  for (const V& corner : core.corners) {
    const V at = in_body.place(corner);
    if (const Real distance = length(V(at - place)); distance <= nearest) nearest = distance, found.corner = at;
  }
  for (std::size_t i = 0; i < core.faces.size(); ++i) {
    const V n = in_body.axes * core.faces[i].normal;
    if (dot(n, normal) < parallel) continue;
    found.face = n, found.on_face = in_body.place(core.faces[i].normal * core.faces[i].offset);
  }
  const auto consider_edge = [&](const V& from, const V& to) {
    const V begin = in_body.place(from), along = in_body.axes * V(to - from) * (1 / length(V(to - from)));
    const V beside = place - begin - along * dot(along, V(place - begin));
    if (length(beside) <= nearest && std::abs(dot(along, normal)) < Real(1e-3))
      nearest = length(beside), found.edge = along, found.on_edge = begin;
  };
  if (core.faces.empty() && core.corners.size() == 2) consider_edge(core.corners[0], core.corners[1]);
  if constexpr (Dim == 3) {
    if (!found.corner)
      for (const Edge& edge : core.edges) consider_edge(core.corners[edge.from], core.corners[edge.to]);
  }
  return found;
}

/// The contact of two parts at a point, with the normal from a to b; nothing where their features are not of a kind
/// that the motion knows. The place is in the world.
template <class Real, int Dim>
[[nodiscard]] std::optional<ContactFeature<Real, Dim>> feature_at(
    const Convex<Real, Dim>& convex_a, const Pose<Real, Dim>& part_a, const ExactBody<Real, Dim>& a,
    const Convex<Real, Dim>& convex_b, const Pose<Real, Dim>& part_b, const ExactBody<Real, Dim>& b,
    const Vector<Real, Dim>& normal, const Vector<Real, Dim>& place) {
  using V = Vector<Real, Dim>;
  using Kind = typename ContactFeature<Real, Dim>::Kind;
  ContactFeature<Real, Dim> of{.rounding_a = convex_a.rounding, .rounding_b = convex_b.rounding};
  const auto of_a = features_near(convex_a, part_a, a.pose().local(V(place - normal * convex_a.rounding)),
                                  a.pose().local_direction(normal));
  const auto of_b = features_near(convex_b, part_b, b.pose().local(V(place + normal * convex_b.rounding)),
                                  b.pose().local_direction(-normal));
  const auto set = [&](Kind kind, const V& point_a, const V& along_a, const V& point_b, const V& along_b) {
    of.kind = kind, of.point_a = point_a, of.along_a = along_a, of.point_b = point_b, of.along_b = along_b;
    return of;
  };
  if (of_a.face && of_b.corner) return set(Kind::face_of_a, of_a.on_face, *of_a.face, *of_b.corner, {});
  if (of_b.face && of_a.corner) return set(Kind::face_of_b, *of_a.corner, {}, of_b.on_face, *of_b.face);
  if (of_a.edge && of_b.edge) {
    if constexpr (Dim == 3) {
      const V across = moment(V(a.axes * *of_a.edge), V(b.axes * *of_b.edge));
      of.side = dot(across, normal) < Real(0) ? Real(-1) : Real(1);
      if (length(across) < Real(1e-3)) return {};
      return set(Kind::lines, of_a.on_edge, *of_a.edge, of_b.on_edge, *of_b.edge);
    }
  }
  if (!(convex_a.rounding + convex_b.rounding > Real(0))) return {};  // sharp ones have no normal of their own
  if (of_a.edge && of_b.corner) return set(Kind::line_of_a, of_a.on_edge, *of_a.edge, *of_b.corner, {});
  if (of_b.edge && of_a.corner) return set(Kind::line_of_b, *of_a.corner, {}, of_b.on_edge, *of_b.edge);
  if (of_a.corner && of_b.corner) return set(Kind::points, *of_a.corner, {}, *of_b.corner, {});
  return {};
}

}  // namespace continuo
