// Where a convex body touches a static mesh: one manifold for all facets with nearly the same normal.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <continuo/bodies/bounds/convex_bounds.hpp>
#include <continuo/bodies/meshes/facet_contact.hpp>
#include <continuo/shapes/manifold.hpp>

namespace continuo {

/// Facets whose contacts have nearly the same normal, with their points.
template <class Real, int Dim>
struct FacetGroup {
  Vector<Real, Dim> normal{};  // of the deepest contact
  std::vector<CommonPoint<Real, Dim>> points{};
};

/// Joins the contacts of a body with facets to groups: those of a box on a floor of a hundred triangles are one.
template <class Real, int Dim>
[[nodiscard]] std::vector<FacetGroup<Real, Dim>> facet_groups(const Convex<Real, Dim>& body,
                                                              const Pose<Real, Dim>& pose,
                                                              const StaticMesh<Real, Dim>& mesh, const Real& margin) {
  constexpr Real least_cosine = Real(0.999);
  struct Found {
    Real least;  // separation
    std::uint32_t facet;
    FacetGroup<Real, Dim> contact;
  };
  std::vector<Found> found;
  FacetContacts<Real, Dim> contacts(body, pose, mesh, margin);
  FacetContact<Real, Dim> contact;
  mesh.for_each_overlap(grown(bounds_of(body, pose), margin), [&](std::uint32_t facet) {
    if (!contacts.find(facet, contact)) return;
    Found& one = found.emplace_back(Found{std::numeric_limits<Real>::infinity(), facet, {contact.normal, {}}});
    for (CommonPoint<Real, Dim> point : contact.points) {
      one.least = std::min(one.least, point.separation);
      // What sides of facets have cut is another point for each of them; corners of the body stay the same.
      if ((point.feature & 0xff00u) != 0) point.feature ^= facet << 17;
      one.contact.points.push_back(point);
    }
  });
  std::ranges::sort(found, {}, [](const Found& one) { return std::pair(one.least, one.facet); });
  std::vector<FacetGroup<Real, Dim>> groups;
  for (Found& one : found) {
    const auto at = std::ranges::find_if(
        groups, [&](const auto& group) { return dot(group.normal, one.contact.normal) > least_cosine; });
    if (at == groups.end()) {
      groups.push_back(std::move(one.contact));
    } else {
      at->points.insert(at->points.end(), one.contact.points.begin(), one.contact.points.end());
    }
  }
  return groups;
}

/// Leaves so many points as a manifold has, which hold the body as all do: a deep one, and those far from it. Of points
/// that are equally deep but for rounding, always the same corner of the body comes first.
template <class Real, int Dim>
void keep_outermost(const Vector<Real, Dim>& normal, const Real& size, std::vector<CommonPoint<Real, Dim>>& points) {
  std::size_t kept = 0;
  const auto keep_best = [&](const Real& least, auto&& value) {
    std::size_t best = kept;
    for (std::size_t i = kept; i < points.size(); ++i)
      if (value(points[i]) > value(points[best])) best = i;
    if (best < points.size() && value(points[best]) > least) std::swap(points[kept++], points[best]);
  };
  const Vector<Real, Dim> u = perpendicular(normal);
  Vector<Real, Dim> across = u;
  if constexpr (Dim == 3) across = u * Real(0.8) + moment(normal, u) * Real(0.6);
  keep_best(-std::numeric_limits<Real>::infinity(),
            [&](const auto& point) { return Real(0.01) * dot(point.on_a, across) - point.separation; });
  const Vector<Real, Dim> first = points[0].on_a;
  const Real near = size / 1000;
  keep_best(near * near, [&](const auto& point) { return squared(Vector<Real, Dim>(point.on_a - first)); });
  if constexpr (Dim == 3) {
    if (kept == 2) {
      const Vector<Real, 3> along = points[1].on_a - first, beside = moment(normal, along);
      const Real least = near * length(beside);
      keep_best(least, [&](const auto& point) { return dot(Vector<Real, 3>(point.on_a - first), beside); });
      keep_best(least, [&](const auto& point) { return -dot(Vector<Real, 3>(point.on_a - first), beside); });
    }
  }
  points.resize(kept);
}

/// Calls act(manifold) for the manifolds of a body in a pose with a mesh, in the frame of the body: with all facets
/// that are not farther away than `margin`.
template <class Real, int Dim, class Act>
void for_each_manifold(const Convex<Real, Dim>& body, const Pose<Real, Dim>& pose, const StaticMesh<Real, Dim>& mesh,
                       const Real& margin, Act&& act) {
  for (FacetGroup<Real, Dim>& group : facet_groups(body, pose, mesh, margin)) {
    keep_outermost(group.normal, body.reach, group.points);
    Manifold<Real, Dim> manifold;
    manifold.normal = group.normal;
    for (const CommonPoint<Real, Dim>& point : group.points)
      manifold.points[manifold.size++] = {point.on_a + group.normal * ((body.rounding + point.separation) / 2),
                                          point.separation - body.rounding, point.feature};
    act(manifold);
  }
}

}  // namespace continuo
