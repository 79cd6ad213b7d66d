// Makes solids of shapes: the polytope of each part, and the centre of mass and the inertia of all together.
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include <continuo/shapes/hull.hpp>
#include <continuo/shapes/solid.hpp>
#include <continuo/shapes/turned_inertia.hpp>

namespace continuo {
namespace {

template <class Real>
Status check_length(const Real& length, const char* what) {
  if (length > Real(0) && std::isfinite(length)) return {};
  return invalid_input(std::string(what) + " must be greater than 0, and finite, not " + std::to_string(length));
}

template <class Real, int Dim>
Result<Convex<Real, Dim>> convex_of(const Sphere<Real>& sphere) {
  if (Status fault = check_length(sphere.radius, "the radius"); !fault) return fault;
  return convex_body<Real, Dim>({.corners = {{}}}, static_cast<double>(sphere.radius));
}
template <class Real, int Dim>
Result<Convex<Real, Dim>> convex_of(const Capsule<Real>& capsule) {
  if (Status fault = check_length(capsule.radius, "the radius of a capsule"); !fault) return fault;
  if (Status fault = check_length(capsule.length, "the length of a capsule"); !fault) return fault;
  Vector<double, Dim> end{};
  end[Dim - 1] = static_cast<double>(capsule.length) / 2;
  return convex_body<Real, Dim>({.corners = {-end, end}}, static_cast<double>(capsule.radius));
}
template <class Real, int Dim>
Result<Convex<Real, Dim>> convex_of(const Box<Real, Dim>& of) {
  Vector<double, Dim> core;
  for (std::size_t i = 0; i < core.size(); ++i) {
    if (Status fault = check_length(of.size[i], "a side of a box"); !fault) return fault;
    core[i] = static_cast<double>(of.size[i]) - 2 * static_cast<double>(of.rounding);
    if (!(core[i] > 0)) return invalid_input("the rounding of a box must be less than half of its shortest side");
  }
  Result<Polytope<double, Dim>> polytope = box<Dim>(core);
  if (!polytope) return polytope.status();
  return convex_body<Real, Dim>(*polytope, static_cast<double>(of.rounding));
}
template <class Real, int Dim>
Result<Convex<Real, Dim>> convex_of(const Hull<Real, Dim>& of) {
  std::vector<Vector<double, Dim>> points;
  for (const Vector<Real, Dim>& point : of.points) {
    Vector<double, Dim>& x = points.emplace_back();
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(point[i]);
  }
  Result<Polytope<double, Dim>> polytope = convex_hull(std::span<const Vector<double, Dim>>(points));
  if (!polytope) return polytope.status();
  return convex_body<Real, Dim>(*polytope, static_cast<double>(of.rounding));
}

template <class Real, int Dim>
Vector<Real, Dim> rounded(const Vector<double, Dim>& x) {
  Vector<Real, Dim> result;
  for (std::size_t i = 0; i < x.size(); ++i) result[i] = static_cast<Real>(x[i]);
  return result;
}

template <class Real, int Dim>
Result<SolidPart<Real, Dim>> part_of(const ShapePart<Real, Dim>& part) {
  auto convex = std::visit([](const auto& shape) { return convex_of<Real, Dim>(shape); }, part.shape);
  if (!convex) return convex.status();
  Orientation<Real, Dim> orientation = part.orientation;
  if (!is_finite(part.position) || !is_finite(orientation))
    return invalid_input("the place of a part of a compound must be finite");
  if constexpr (Dim == 3) {
    if (!(length(orientation) > Real(0)))
      return invalid_input("the orientation of a part of a compound must be a quaternion that is not 0");
    orientation *= 1 / length(orientation);
  }
  SolidPart<Real, Dim> result{.convex = std::move(*convex)};
  result.in_solid.axes = rotation(orientation);
  result.in_solid.centre = part.position + result.in_solid.axes * rounded<Real>(result.convex.centre);
  return result;
}

/// The inertia of a mass of 1 at x, about the origin.
template <class Real>
Matrix<Real, 1> inertia_of_point(const Vector<Real, 2>& x) {
  return {{{{{squared(x)}}}}};
}
template <class Real>
Matrix<Real, 3> inertia_of_point(const Vector<Real, 3>& x) {
  return identity_matrix<Real, 3>() * squared(x) + outer(x, x) * Real(-1);
}
/// Moves the origin to the common centre of mass, and sums up the inertia.
template <class Real, int Dim>
void join(Solid<Real, Dim>& of) {
  for (const auto& part : of.parts) {
    of.volume += part.convex.volume;
    of.centre += part.in_solid.centre * part.convex.volume;
  }
  of.centre *= 1 / of.volume;
  for (auto& part : of.parts) {
    part.in_solid.centre -= of.centre;
    const Real share = part.convex.volume / of.volume;
    of.inertia +=
        (turned_inertia(part.in_solid.axes, part.convex.inertia) + inertia_of_point(part.in_solid.centre)) * share;
    of.reach = std::max(of.reach, Real(length(part.in_solid.centre) + part.convex.reach));
  }
}

template <class Real, int Dim>
std::vector<ShapePart<Real, Dim>> parts_of(const Shape<Real, Dim>& shape) {
  if (const auto* const compound = std::get_if<Compound<Real, Dim>>(&shape)) return compound->parts;
  ShapePart<Real, Dim> part;
  std::visit(
      [&part](const auto& of) {
        if constexpr (requires { part.shape = of; }) part.shape = of;
      },
      shape);
  return {part};
}

}  // namespace

template <class Real, int Dim>
Result<Solid<Real, Dim>> solid(const Shape<Real, Dim>& shape) {
  Solid<Real, Dim> result{.shape = shape};
  for (const ShapePart<Real, Dim>& part : parts_of(shape)) {
    auto made = part_of(part);
    if (!made) return made.status();
    result.parts.push_back(std::move(*made));
  }
  if (result.parts.empty()) return invalid_input("a compound needs at least one part");
  join(result);
  return result;
}

template Result<Solid<float, 2>> solid(const Shape<float, 2>&);
template Result<Solid<float, 3>> solid(const Shape<float, 3>&);
template Result<Solid<double, 2>> solid(const Shape<double, 2>&);
template Result<Solid<double, 3>> solid(const Shape<double, 3>&);

}  // namespace continuo
