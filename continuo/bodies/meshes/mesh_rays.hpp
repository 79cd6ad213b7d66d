// Where a ray hits a facet of a static mesh.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <continuo/bodies/meshes/static_mesh.hpp>

namespace continuo {

/// The distance along a ray, whose direction has length 1, at which it hits a facet; none where it misses it. On which
/// side of a side it passes is the sign of a determinant. What is 0 but for rounding counts as a hit, so that no ray
/// passes between two facets; it may hit both.
/// @{
template <class Real>
[[nodiscard]] std::optional<Real> distance_to_facet(const std::array<Vector<Real, 2>, 2>& corners,
                                                    const Vector<Real, 2>& origin, const Vector<Real, 2>& direction) {
  const Vector<Real, 2> a = corners[0] - origin, b = corners[1] - origin;
  const Real of_a = moment(direction, a)[0], of_b = moment(direction, b)[0];
  const Real rounding = 4 * std::numeric_limits<Real>::epsilon() * std::max(length(a), length(b));
  if (std::min(of_a, of_b) > rounding || std::max(of_a, of_b) < -rounding) return std::nullopt;
  if (std::abs(of_a - of_b) <= 2 * rounding) return std::nullopt;  // it is seen from its end
  const Real share = std::clamp(of_a / (of_a - of_b), Real(0), Real(1));
  const Real distance = dot(direction, a + (b - a) * share);
  return distance >= Real(0) ? std::optional(distance) : std::nullopt;
}
template <class Real>
[[nodiscard]] std::optional<Real> distance_to_facet(const std::array<Vector<Real, 3>, 3>& corners,
                                                    const Vector<Real, 3>& origin, const Vector<Real, 3>& direction) {
  const Vector<Real, 3> a = corners[0] - origin, b = corners[1] - origin, c = corners[2] - origin;
  const Real of_a = dot(direction, moment(b, c)), of_b = dot(direction, moment(c, a));
  const Real of_c = dot(direction, moment(a, b)), sum = of_a + of_b + of_c;
  const Real rounding = 8 * std::numeric_limits<Real>::epsilon() * std::max({squared(a), squared(b), squared(c)});
  if (std::min({of_a, of_b, of_c}) < -rounding && std::max({of_a, of_b, of_c}) > rounding) return std::nullopt;
  if (std::abs(sum) <= 3 * rounding) return std::nullopt;  // it is seen from its side
  const Real distance = dot(direction, (a * of_a + b * of_b + c * of_c) * (1 / sum));
  return distance >= Real(0) ? std::optional(distance) : std::nullopt;
}
/// @}

/// A hit on a facet.
template <class Real, int Dim>
struct FacetHit {
  std::uint32_t facet = 0;
  Real distance{};             // along the ray
  Vector<Real, Dim> normal{};  // of length 1, against the ray
};

/// Calls take(hit) for facets that the ray hits within `reach`; it returns the reach from then on. The back of a
/// one-sided mesh is not hit.
template <class Real, int Dim, class Take>
void for_each_hit(const StaticMesh<Real, Dim>& mesh, const Vector<Real, Dim>& origin,
                  const Vector<Real, Dim>& direction, Real reach, Take&& take) {
  const BoxSweep<Real, Dim> sweep{.begin = {origin, origin}, .way = direction, .end = reach};
  mesh.for_each_on_way(sweep, [&](std::uint32_t number) {
    const auto corners = mesh.corners(number);
    const auto distance = distance_to_facet(corners, origin, direction);
    if (!distance || *distance > reach) return reach;
    Vector<Real, Dim> normal = facet_of<Real, Dim>(corners).normal;
    if (dot(normal, direction) > Real(0)) {
      if (!mesh.is_two_sided()) return reach;
      normal = -normal;
    }
    return reach = take(FacetHit<Real, Dim>{number, *distance, normal});
  });
}

}  // namespace continuo
