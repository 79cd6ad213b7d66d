// The surfaces of solids as polygons and polyhedra.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <continuo/worlds/build_world.hpp>
#include <continuo/worlds/world_shapes.hpp>

namespace continuo::worlds {

namespace {

constexpr double step = std::numbers::pi / 12;  // of arcs

double angle_of(const Vector<double, 2>& v) {
  return std::atan2(v[1], v[0]);
}

/// Around each corner the arc from the normal of the side before it to that of the side after it.
std::vector<Vector<double, 2>> outline(const Convex<double, 2>& of) {
  const std::vector<Vector<double, 2>>& corners = of.core.corners;
  if (of.rounding == 0) return corners;
  std::vector<Vector<double, 2>> points;
  const auto normal = [&](std::size_t side) {
    const Vector<double, 2> along = corners[(side + 1) % corners.size()] - corners[side];
    return Vector<double, 2>{{along[1], -along[0]}};
  };
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double from = corners.size() > 1 ? angle_of(normal((i + corners.size() - 1) % corners.size())) : 0;
    double turn = corners.size() > 1 ? angle_of(normal(i)) - from : 2 * std::numbers::pi;
    if (turn <= 0) turn += 2 * std::numbers::pi;
    const double count = std::max(1.0, std::ceil(turn / step - 1e-9));
    for (double k = 0; k <= count; ++k) {
      const double angle = from + turn * k / count;
      points.push_back(corners[i] + Vector<double, 2>{{std::cos(angle), std::sin(angle)}} * of.rounding);
    }
  }
  return points;
}

/// The corners moved out to where the faces are that lie `rounding` further out.
std::vector<Vector<double, 3>> widened(const Convex<double, 3>& of) {
  std::vector<Vector<double, 3>> corners = of.core.corners;
  for (std::size_t i = 0; i < corners.size() && of.rounding > 0; ++i) {
    Vector<double, 3> out{};
    double least = 1;
    const auto for_faces = [&](auto&& act) {
      for (std::size_t f = 0; f < of.core.faces.size(); ++f)
        if (std::ranges::find(of.core.loop(f), i) != of.core.loop(f).end()) act(of.core.faces[f].normal);
    };
    for_faces([&](const Vector<double, 3>& normal) { out += normal; });
    if (!(length(out) > 0)) continue;
    out *= 1 / length(out);
    for_faces([&](const Vector<double, 3>& normal) { least = std::min(least, dot(out, normal)); });
    corners[i] += out * (of.rounding / std::max(least, 0.5));
  }
  return corners;
}

/// Rings around the segment from a to b, from pole to pole.
void append_capsule(const Vector<double, 3>& a, const Vector<double, 3>& b, double radius, const auto& place,
                    BodyForm& form) {
  constexpr int around = 24, rings = 6;  // of each end
  const Vector<double, 3> axis = (b - a) * (1 / length(b - a));
  Vector<double, 3> other{};
  other[std::abs(axis[0]) < 0.5 ? 0 : 1] = 1;
  Vector<double, 3> u = moment(axis, other);
  u *= 1 / length(u);
  const Vector<double, 3> v = moment(axis, u);
  const auto first = static_cast<std::uint32_t>(form.corners.size());
  for (int ring = 0; ring < 2 * rings; ++ring) {
    const bool upper = ring >= rings;
    const double height = -std::numbers::pi / 2 + std::numbers::pi / 2 * (upper ? ring - rings : ring) / (rings - 1) +
                          (upper ? std::numbers::pi / 2 : 0);
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      form.corners.push_back(place((upper ? b : a) + axis * (radius * std::sin(height)) +
                                   (u * std::cos(angle) + v * std::sin(angle)) * (radius * std::cos(height))));
    }
  }
  const auto corner = [&](int ring, int k) { return first + static_cast<std::uint32_t>(ring * around + k % around); };
  for (int ring = 0; ring + 1 < 2 * rings; ++ring)
    for (int k = 0; k < around; ++k)
      form.faces.push_back({corner(ring, k), corner(ring, k + 1), corner(ring + 1, k + 1), corner(ring + 1, k)});
}

template <int Dim>
Shapes built_shapes(const model::Model& model, std::span<const double> variables) {
  const BuiltWorld<Dim> built = build_world<Dim>(model, variables);
  return built.status ? shapes_of(built.world, built.joints, *model.world) : Shapes{};
}

}  // namespace

BodyForm form_of(const Solid<double, 2>& solid) {
  BodyForm form;
  for (const SolidPart<double, 2>& part : solid.parts) {
    std::vector<std::uint32_t>& face = form.faces.emplace_back();
    for (const Vector<double, 2>& point : outline(part.convex)) {
      face.push_back(static_cast<std::uint32_t>(form.corners.size()));
      form.corners.push_back(point_of<2>(part.in_solid.place(point)));
    }
  }
  return form;
}

BodyForm form_of(const Solid<double, 3>& solid) {
  BodyForm form;
  for (const SolidPart<double, 3>& part : solid.parts) {
    const Polytope<double, 3>& core = part.convex.core;
    const auto place = [&](const Vector<double, 3>& point) { return point_of<3>(part.in_solid.place(point)); };
    if (core.corners.size() == 2) {
      append_capsule(core.corners[0], core.corners[1], part.convex.rounding, place, form);
      continue;
    }
    const auto first = static_cast<std::uint32_t>(form.corners.size());
    for (const Vector<double, 3>& corner : widened(part.convex)) form.corners.push_back(place(corner));
    for (std::size_t f = 0; f < core.faces.size(); ++f) {
      std::vector<std::uint32_t>& face = form.faces.emplace_back();
      for (const std::uint8_t corner : core.loop(f)) face.push_back(first + corner);
    }
  }
  return form;
}

Shapes shapes_of(const model::Model& model, std::span<const double> variables) {
  return model.world->dimension == 2 ? built_shapes<2>(model, variables) : built_shapes<3>(model, variables);
}

}  // namespace continuo::worlds
