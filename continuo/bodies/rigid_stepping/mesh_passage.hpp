// No body passes through a static mesh: when a moving part has to stop.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <continuo/bodies/bounds/convex_bounds.hpp>
#include <continuo/bodies/meshes/static_mesh.hpp>
#include <continuo/bodies/rigid_stepping/time_of_depth.hpp>
#include <continuo/shapes/cast.hpp>

namespace continuo {

/// The time at which a moving part with a ball of `inner_radius` around its centre has to stop at the facets of a mesh;
/// `until` where it need not before. It stops at its first contact with a facet that it would enter by more than a
/// quarter of the radius: a part that slides over facets, or touches their borders in passing, does not.
template <class Real, int Dim>
class MeshPassage {
 public:
  using V = Vector<Real, Dim>;

  MeshPassage(const MovingBody<Real, Dim>& moving, const StaticMesh<Real, Dim>& mesh, const Real& inner_radius,
              const Real& step)
      : moving_(moving), mesh_(mesh), depth_(inner_radius / 4), tolerance_(inner_radius / 100), end_(moving.at(step)) {
    facet_shape_.core.corners.resize(static_cast<std::size_t>(Dim));
  }

  [[nodiscard]] Real time_to_stop(std::uint32_t number, const Real& until) {
    const Facet<Real, Dim> facet = facet_of<Real, Dim>(mesh_.corners(number));
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
    const Real time_of_entry = pair.time_of_overlap(normal, depth_, depth_ / 100, Real(0), until);
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

  const MovingBody<Real, Dim>& moving_;
  const StaticMesh<Real, Dim>& mesh_;
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
