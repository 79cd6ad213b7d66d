// Queries by shapes: their first contact on a way, what they touch, and which surfaces are near them. The bodies of
// those members of Queries; included only by the sources that instantiate them.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <continuo/bodies/bounds/convex_bounds.hpp>
#include <continuo/bodies/meshes/mesh_manifolds.hpp>
#include <continuo/bodies/queries.hpp>
#include <continuo/shapes/cast.hpp>
#include <continuo/shapes/direction_of.hpp>
#include <continuo/shapes/plane_manifold.hpp>

namespace continuo {

/// A shape at its place, as convex parts, among the objects of the index.
template <class Real, int Dim>
class Queries<Real, Dim>::ShapeSearch {
 public:
  using Hit = RayHit<Real, Dim>;
  using Near = NearSurface<Real, Dim>;

  [[nodiscard]] static Result<ShapeSearch> of(const Queries& index, const PlacedShape<Real, Dim>& placed,
                                              const QueryFilter& filter) {
    auto made = continuo::solid<Real, Dim>(placed.shape);
    if (!made) return made.status();
    Orientation<Real, Dim> orientation = placed.orientation;
    if (!is_finite(placed.position) || !is_finite(orientation))
      return invalid_input("position and orientation of the shape must be finite");
    if constexpr (Dim == 3) {
      if (orientation == Orientation<Real, Dim>{})
        return invalid_input("the orientation must be a quaternion that is not 0");
      orientation = direction_of(orientation);
    }
    ShapeSearch search(index, filter);
    search.solid_ = std::move(*made);
    search.axes_ = rotation(orientation);
    search.centre_ = placed.position + search.axes_ * search.solid_.centre;
    Real size = length(search.centre_);
    for (const auto& part : search.solid_.parts)
      size = std::max(size, Real(length(part.in_solid.centre) + part.convex.reach));
    if (!std::isfinite(size * size))
      return invalid_input("the size of the shape and its place, and their squares, must be finite");
    return search;
  }

  [[nodiscard]] std::vector<Hit> first_contact(const V& way) {
    std::optional<Hit> first;
    Real end(1);  // of the way, as a fraction
    const auto take = [&](Hit hit, const Real& time) {
      end = time;
      hit.distance = time * length(way);
      first = hit;
    };
    for_each_part([&](const Convex<Real, Dim>& part, const Pose<Real, Dim>& pose) {
      const MovingBody<Real, Dim> moving{.shape = &part, .position = pose.centre, .velocity = way, .axes = pose.axes};
      cast_to_bodies(moving, end, take);
      cast_to_walls(moving, end, take);
      cast_to_meshes(moving, end, take);
    });
    return first ? std::vector<Hit>{*first} : std::vector<Hit>{};
  }

  [[nodiscard]] std::vector<Near> near(const Real& reach) {
    std::vector<Near> found;
    for_each_part([&](const Convex<Real, Dim>& part, const Pose<Real, Dim>& pose) {
      const auto add = [&](Near surface, const Manifold<Real, Dim>& manifold) {
        const auto points = manifold.all();
        const auto nearest = std::ranges::min_element(points, {}, &ManifoldPoint<Real, Dim>::separation);
        if (nearest == points.end() || nearest->separation > reach) return;
        surface.distance = nearest->separation;
        surface.point = pose.place(nearest->position);
        surface.normal = pose.axes * -manifold.normal;
        found.push_back(surface);
      };
      for_each_item(grown(bounds_of(part, pose), reach), [&](const Item& item, const Convex<Real, Dim>& other) {
        add({.body = item.body}, manifold(part, other, relative(pose, item.pose), reach));
      });
      for (std::uint32_t w = 0; filter_.walls && w < index_.walls_.size(); ++w) {
        const Wall<Real, Dim> wall = facing(index_.walls_[w], pose.centre);
        const Plane<Real, Dim> plane{pose.local_direction(wall.normal), wall.offset - dot(wall.normal, pose.centre)};
        add({.wall = w}, manifold(part, plane, reach));
      }
      for (std::uint32_t m = 0; m < index_.meshes_.size(); ++m)
        if (index_.takes(filter_, m))
          for_each_manifold(part, pose, *index_.meshes_[m].geometry, reach,
                            [&](const Manifold<Real, Dim>& manifold) { add({.mesh = m}, manifold); });
    });
    std::ranges::sort(found, {},
                      [](const Near& of) { return std::tuple(of.distance, of.wall, of.mesh, of.body.slot); });
    return found;
  }

  [[nodiscard]] Overlap touched() {
    std::vector<const Item*> found;
    std::vector<bool> walls(index_.walls_.size()), meshes(index_.meshes_.size());
    for_each_part([&](const Convex<Real, Dim>& part, const Pose<Real, Dim>& pose) {
      for_each_item(bounds_of(part, pose), [&](const Item& item, const Convex<Real, Dim>& other) {
        if (distance(part, other, relative(pose, item.pose)) <= Real(0)) found.push_back(&item);
      });
      for (std::uint32_t w = 0; filter_.walls && w < walls.size(); ++w)
        if (height(part, pose, facing(index_.walls_[w], pose.centre)) <= Real(0)) walls[w] = true;
      for (std::uint32_t m = 0; m < meshes.size(); ++m) {
        if (meshes[m] || !index_.takes(filter_, m)) continue;
        const auto& mesh = *index_.meshes_[m].geometry;
        mesh.for_each_overlap(bounds_of(part, pose), [&](std::uint32_t facet) {
          meshes[m] = meshes[m] || distance(part, shape_of(mesh.corners(facet)), relative(pose, {})) <= Real(0);
        });
      }
    });
    Overlap overlap = index_.overlap_of(found);
    for (std::uint32_t w = 0; w < walls.size(); ++w)
      if (walls[w]) overlap.walls.push_back(w);
    for (std::uint32_t m = 0; m < meshes.size(); ++m)
      if (meshes[m]) overlap.meshes.push_back(m);
    return overlap;
  }

 private:
  ShapeSearch(const Queries& index, const QueryFilter& filter) : index_(index), filter_(filter) {
    ball_.core.corners.resize(1);
  }

  template <class Act>
  void for_each_part(Act&& act) const {
    for (const SolidPart<Real, Dim>& part : solid_.parts)
      act(part.convex, Pose<Real, Dim>{centre_ + axes_ * part.in_solid.centre, axes_ * part.in_solid.axes});
  }
  /// Calls act(item, its shape) for the parts of bodies whose bounds overlap.
  template <class Act>
  void for_each_item(const Bounds<Real, Dim>& bounds, Act&& act) {
    index_.tree_.for_each_overlap(bounds, [&](std::uint32_t k) {
      if (takes(filter_, index_.items_[k])) act(index_.items_[k], shape_of(index_.items_[k]));
    });
  }
  [[nodiscard]] const Convex<Real, Dim>& shape_of(const Item& item) {
    if (item.convex) return *item.convex;
    ball_.core.corners[0] = {};
    ball_.rounding = ball_.reach = item.radius;
    return ball_;
  }
  [[nodiscard]] const Convex<Real, Dim>& shape_of(const typename StaticMesh<Real, Dim>::Corners& corners) {
    facet_.core.corners.assign(corners.begin(), corners.end());
    return facet_;
  }
  [[nodiscard]] static Real distance(const Convex<Real, Dim>& a, const Convex<Real, Dim>& b,
                                     const Pose<Real, Dim>& b_in_a) {
    return closest_points(a.core, b.core, b_in_a).distance - a.rounding - b.rounding;
  }
  /// Of the lowest point of a part above a wall.
  [[nodiscard]] static Real height(const Convex<Real, Dim>& part, const Pose<Real, Dim>& pose,
                                   const Wall<Real, Dim>& wall) {
    const V& lowest = part.core.corners[support(part.core, pose.local_direction(-wall.normal))];
    return dot(wall.normal, pose.place(lowest)) - wall.offset - part.rounding;
  }
  [[nodiscard]] static Real tolerance(const MovingBody<Real, Dim>& moving) { return moving.shape->reach / 100000; }
  /// The first contact with a still shape before `end`, which the part must approach.
  [[nodiscard]] static std::optional<FirstContact<Real, Dim>> contact_with(const MovingBody<Real, Dim>& moving,
                                                                           const MovingBody<Real, Dim>& still,
                                                                           const Real& end) {
    const auto contact = continuo::first_contact(moving, still, end, tolerance(moving));
    if (contact && contact->normal != V{} && !(dot(contact->normal, moving.velocity) > Real(0))) return std::nullopt;
    return contact;
  }
  [[nodiscard]] static V against(const V& way) {
    const Real size = length(way);
    return size > Real(0) ? way * (-1 / size) : V{};
  }

  template <class Take>
  void cast_to_bodies(const MovingBody<Real, Dim>& moving, Real& end, Take&& take) {
    const BoxSweep<Real, Dim> sweep{.begin = grown(bounds_of(*moving.shape, moving.at(Real(0))), tolerance(moving)),
                                    .way = moving.velocity,
                                    .end = end};
    std::optional<std::uint32_t> number;  // of the body that is hit
    index_.way_tree_.for_each_on_way(sweep, [&](std::uint32_t k, const Real&) {
      const Item& item = index_.items_[k];
      if (!takes(filter_, item)) return end;
      const MovingBody<Real, Dim> still{.shape = &shape_of(item), .position = item.pose.centre, .axes = item.pose.axes};
      const auto contact = contact_with(moving, still, end);
      if (!contact || (number && contact->time == end && item.number >= *number)) return end;
      number = item.number;
      const V normal = contact->normal == V{} ? against(moving.velocity) : V(-contact->normal);
      take({.body = item.body, .point = contact->point, .normal = normal}, contact->time);
      return end;
    });
  }
  template <class Take>
  void cast_to_walls(const MovingBody<Real, Dim>& moving, Real& end, Take&& take) {
    for (std::uint32_t w = 0; filter_.walls && w < index_.walls_.size(); ++w) {
      const Wall<Real, Dim> wall = facing(index_.walls_[w], moving.position);
      const Real gap = height(*moving.shape, moving.at(Real(0)), wall) - tolerance(moving) / 2;
      const Real rate = -dot(wall.normal, moving.velocity);
      if (!(rate > Real(0))) continue;
      const Real time = std::max(gap, Real(0)) / rate;
      if (!(time < end)) continue;
      const Pose<Real, Dim> pose = moving.at(time);
      const auto& core = moving.shape->core;
      const V lowest = pose.place(core.corners[support(core, pose.local_direction(-wall.normal))]);
      take({.wall = w, .point = lowest - wall.normal * moving.shape->rounding, .normal = wall.normal}, time);
    }
  }
  template <class Take>
  void cast_to_meshes(const MovingBody<Real, Dim>& moving, Real& end, Take&& take) {
    const auto box = grown(bounds_of(*moving.shape, moving.at(Real(0))), tolerance(moving));
    for (std::uint32_t m = 0; m < index_.meshes_.size(); ++m) {
      if (!index_.takes(filter_, m)) continue;
      const StaticMesh<Real, Dim>& mesh = *index_.meshes_[m].geometry;
      mesh.for_each_on_way({.begin = box, .way = moving.velocity, .end = end}, [&](std::uint32_t number) {
        V normal = facet_of<Real, Dim>(mesh.corners(number)).normal;
        if (dot(normal, moving.position - mesh.corners(number)[0]) < Real(0)) {
          if (!mesh.is_two_sided()) return end;
          normal = -normal;
        }
        if (!(dot(normal, moving.velocity) < Real(0))) return end;
        const MovingBody<Real, Dim> still{.shape = &shape_of(mesh.corners(number))};
        const auto contact = contact_with(moving, still, end);
        if (!contact || (contact->time == end && end < Real(1))) return end;
        // What touches a seam touches the surface.
        if (is_surface_normal(mesh, number, normal, V(-contact->normal))) normal = -contact->normal;
        take({.mesh = m, .facet = number, .point = contact->point, .normal = normal}, contact->time);
        return end;
      });
    }
  }

  const Queries& index_;
  QueryFilter filter_;
  Solid<Real, Dim> solid_;
  V centre_{};
  Matrix<Real, Dim> axes_{};
  Convex<Real, Dim> ball_, facet_;  // of what is compared now
};

template <class Real, int Dim>
Result<std::vector<RayHit<Real, Dim>>> Queries<Real, Dim>::first_contact(const PlacedShape<Real, Dim>& shape,
                                                                         const V& way,
                                                                         const QueryFilter& filter) const {
  if (!std::isfinite(length(way))) return invalid_input("the way of the shape, and its square, must be finite");
  auto search = ShapeSearch::of(*this, shape, filter);
  if (!search) return search.status();
  return search->first_contact(way);
}

template <class Real, int Dim>
Result<Overlap> Queries<Real, Dim>::in_shape(const PlacedShape<Real, Dim>& shape, const QueryFilter& filter) const {
  auto search = ShapeSearch::of(*this, shape, filter);
  if (!search) return search.status();
  return search->touched();
}

template <class Real, int Dim>
Result<std::vector<NearSurface<Real, Dim>>> Queries<Real, Dim>::near_shape(const PlacedShape<Real, Dim>& shape,
                                                                           const Real& reach,
                                                                           const QueryFilter& filter) const {
  if (!(reach >= Real(0)) || !std::isfinite(reach)) return invalid_input("the reach must be 0 or more, and finite");
  auto search = ShapeSearch::of(*this, shape, filter);
  if (!search) return search.status();
  return search->near(reach);
}

}  // namespace continuo
