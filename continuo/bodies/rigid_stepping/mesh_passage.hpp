// No body passes through a static mesh: when a moving part has to stop.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <continuo/bodies/bounds/convex_bounds.hpp>
#include <continuo/bodies/meshes/static_mesh.hpp>
#include <continuo/bodies/rigid_stepping/time_of_depth.hpp>
#include <continuo/shapes/cast.hpp>

namespace continuo {

/// The part of a triangle that counts for a ball around the origin: moved towards a point of it that is near the ball,
/// without a change of the plane and of the sides that are near the ball. Beside a small body a triangle of hundreds of
/// metres would leave closest points, in single precision, without a correct digit.
template <class Real>
[[nodiscard]] std::array<Vector<Real, 3>, 3> part_near_origin(const std::array<Vector<Real, 3>, 3>& corners,
                                                              const Vector<Real, 3>& normal, const Real& radius) {
  using V = Vector<Real, 3>;
  const Real height = dot(normal, corners[0]);
  V centre = normal * height;  // of the homothety
  std::array<V, 3> inwards;
  for (std::size_t k = 0; k < 3; ++k) {
    const V along = corners[(k + 1) % 3] - corners[k];
    inwards[k] = moment(normal, along) * (1 / length(along));
  }
  const auto inside = [&](std::size_t k) { return dot(inwards[k], centre - corners[k]); };
  const auto is_near = [&](std::size_t k) { return inside(k) < 2 * radius; };
  for (std::size_t k = 0; k < 3; ++k)
    if (is_near(k)) centre -= inwards[k] * inside(k);
  for (std::size_t k = 0; k < 3; ++k)
    if (is_near(k) && is_near((k + 1) % 3)) centre = corners[(k + 1) % 3];  // which both sides share
  Real least = std::numeric_limits<Real>::infinity();
  std::size_t near_ones = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (is_near(k)) {
      ++near_ones;
    } else {
      least = std::min(least, inside(k));
    }
  }
  const V off = centre - normal * height;
  if (near_ones == 3 || length(off) > 3 * radius) return corners;
  const Real part = 4 * radius / least;
  if (!(part < Real(0.25))) return corners;  // it is not large
  std::array<V, 3> moved;
  for (std::size_t k = 0; k < 3; ++k) {
    moved[k] = centre + (corners[k] - centre) * part;
    moved[k] += normal * (height - dot(normal, moved[k]));
  }
  return moved;
}
template <class Real>
[[nodiscard]] std::array<Vector<Real, 2>, 2> part_near_origin(const std::array<Vector<Real, 2>, 2>& corners,
                                                              const Vector<Real, 2>&, const Real&) {
  return corners;
}

/// The time at which a moving part with a ball of `inner_radius` around its centre has to stop at the facets of a mesh;
/// `until` where it need not before. It stops at its first contact with a facet that it would enter by more than a
/// quarter of the radius: a part that slides over facets, or touches their borders in passing, does not.
template <class Real, int Dim>
class MeshPassage {
 public:
  using V = Vector<Real, Dim>;

  MeshPassage(const MovingBody<Real, Dim>& moving, const StaticMesh<Real, Dim>& mesh, const Real& inner_radius,
              const Real& step)
      : moving_(moving), mesh_(mesh), depth_(inner_radius / 4), tolerance_(inner_radius / 100) {
    origin_ = moving.position + moving.velocity * (step / 2);
    radius_ = moving.shape->reach + length(moving.velocity) * step / 2;
    moving_.position = moving.velocity * (-step / 2);
    end_ = moving_.at(step);
    facet_shape_.core.corners.resize(static_cast<std::size_t>(Dim));
  }

  [[nodiscard]] Real time_to_stop(std::uint32_t number, const Real& until) {
    auto corners = mesh_.corners(number);
    for (V& corner : corners) corner -= origin_;
    Facet<Real, Dim> facet = facet_of<Real, Dim>(corners);
    facet.corners = part_near_origin(corners, facet.normal, radius_);
    const bool is_behind = facet.height(moving_.position) < Real(0);
    if (is_behind && !mesh_.is_two_sided()) return until;
    const V into = is_behind ? facet.normal : V(-facet.normal);
    if (depth_along(into, end_, facet) <= depth_) return until;
    std::ranges::copy(facet.corners, facet_shape_.core.corners.begin());
    const MovingBody<Real, Dim> still{.shape = &facet_shape_};
    const auto contact = first_contact(moving_, still, until, tolerance_);
    if (!contact) return until;
    const MovingPair<Real, Dim> pair{moving_, still};
    if (contact->time == Real(0))
      // The solver pushes it out, for which it has to move.
      if (const Real start = depth_along(into, moving_.at(Real(0)), facet); start > depth_)
        return pair.time_of_overlap(into, start + depth_ / 4, depth_ / 100, Real(0), until);
    const V normal = contact->normal == V{} ? into : contact->normal;
    if (dot(normal, into) < Real(-0.1)) return until;
    // What is as deep from the beginning along another direction than the facet's has to move on, too.
    const Real most = contact->time > Real(0) ? depth_ : std::max(depth_, pair.overlap(normal, Real(0)) + depth_ / 4);
    const Real time_of_entry = pair.time_of_overlap(normal, most, depth_ / 100, Real(0), until);
    if (!(time_of_entry < until)) return until;
    return contact->time > Real(0) ? contact->time : time_of_entry;
  }

 private:
  /// How far the part is beyond the plane of a facet.
  [[nodiscard]] Real depth_along(const V& into, const Pose<Real, Dim>& pose, const Facet<Real, Dim>& facet) const {
    const auto& core = moving_.shape->core;
    const V deepest = pose.place(core.corners[support(core, pose.local_direction(into))]);
    return dot(into, deepest - facet.corners[0]) + moving_.shape->rounding;
  }

  MovingBody<Real, Dim> moving_;  // from the middle of its way, the origin
  const StaticMesh<Real, Dim>& mesh_;
  V origin_{};
  Real radius_{};  // of a ball that holds it all the way
  Real depth_, tolerance_;
  Pose<Real, Dim> end_;
  Convex<Real, Dim> facet_shape_;
};

/// The time up to which a part may move within a step without passing through the mesh; `until` if so long.
template <class Real, int Dim>
[[nodiscard]] Real time_before_passing(const MovingBody<Real, Dim>& moving, const StaticMesh<Real, Dim>& mesh,
                                       const Real& inner_radius, Real until, const Real& step) {
  MeshPassage<Real, Dim> passage(moving, mesh, inner_radius, step);
  const Real turn = std::min(length(moving.spin) * step, Real(2)) * moving.shape->reach;
  const BoxSweep<Real, Dim> sweep{.begin = grown(bounds_of(*moving.shape, moving.at(Real(0))), turn),
                                  .way = moving.velocity * step,
                                  .end = until / step};
  mesh.for_each_on_way(sweep, [&](std::uint32_t facet) {
    until = passage.time_to_stop(facet, until);
    return until / step;
  });
  return until;
}

}  // namespace continuo
