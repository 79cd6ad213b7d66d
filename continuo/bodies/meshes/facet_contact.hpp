// Where a convex body touches a facet of a static mesh: along a normal of the surface, so that seams between facets are
// not felt, with the points of both that lie above each other.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include <continuo/bodies/meshes/surface_normals.hpp>
#include <continuo/shapes/closest_points.hpp>
#include <continuo/shapes/convex.hpp>
#include <continuo/shapes/support/clipped_features.hpp>
#include <continuo/shapes/support/separating_axis.hpp>

namespace continuo {

/// A contact of the core of a body with a facet, in the frame of the body.
template <class Real, int Dim>
struct FacetContact {
  Vector<Real, Dim> normal{};  // from the body into the mesh, of length 1
  CommonPoints<Real, Dim> points;
};

/// Finds the contacts of one body with the facets of one mesh. Everything is in the frame of the body.
template <class Real, int Dim>
class FacetContacts {
 public:
  using V = Vector<Real, Dim>;

  FacetContacts(const Convex<Real, Dim>& body, const Pose<Real, Dim>& pose, const StaticMesh<Real, Dim>& mesh,
                const Real& margin)
      : body_(body), pose_(pose), mesh_(mesh), farthest_(margin + body.rounding) {
    core_of_facet_.corners.resize(static_cast<std::size_t>(Dim));
  }

  /// Whether the body touches a facet, or is within the margin of it; `contact` then is their contact.
  [[nodiscard]] bool find(std::uint32_t number, FacetContact<Real, Dim>& contact) {
    number_ = number, is_turned_ = false;
    facet_ = local(pose_, facet_of<Real, Dim>(mesh_.corners(number)));
    if (facet_.height(V{}) < Real(0)) {  // the body is behind it
      if (!mesh_.is_two_sided()) return false;
      facet_ = turned_over(facet_), is_turned_ = true;
    }
    const V& lowest = body_.core.corners[support(body_.core, V(-facet_.normal))];
    const Axis of_facet{-facet_.normal, facet_.height(lowest), lowest};
    if (of_facet.separation > farthest_) return false;
    contact.normal = of_facet.normal;
    // Beside the facet, there are no points above it.
    const bool is_beside = inside_facet(V{}) < -body_.reach;
    if (is_beside && mesh_.is_smooth(number)) return false;
    contact.points = is_beside ? CommonPoints<Real, Dim>{} : points_of_face();
    if (contact.points.empty() && mesh_.is_smooth(number)) {
      if (!is_on_seam(of_facet)) return false;
      contact.points.add({lowest, of_facet.separation, 0});
    }
    if (!is_certain(contact.points, of_facet.separation) && !find_axis(of_facet, contact)) return false;
    contact.points.drop_beyond(farthest_);
    return !contact.points.empty();
  }

 private:
  using Axis = SeparatingAxis<Real, Dim>;

  [[nodiscard]] bool is_surface_normal(const V& normal) const {
    return continuo::is_surface_normal(mesh_, number_, V(pose_.axes * facet_.normal), V(pose_.axes * -normal));
  }
  [[nodiscard]] Feature<Real, Dim> whole() const {
    Feature<Real, Dim> feature;
    for (std::size_t k = 0; k < facet_.corners.size(); ++k) feature.add(facet_.corners[k], k);
    feature.normal = facet_.normal;
    return feature;
  }
  /// The points of the body's lowest feature that are above the facet.
  [[nodiscard]] CommonPoints<Real, Dim> points_of_face() const {
    const Feature<Real, Dim> lowest = facing_feature(body_.core, V(-facet_.normal));
    if constexpr (Dim == 3) {
      CommonPoints<Real, 3> common;
      add_common_with_face(whole(), lowest, V(-facet_.normal), false, common);
      return common;
    } else {
      return common_points(lowest, whole(), V(-facet_.normal));
    }
  }
  /// How far a point above the facet is from its sides.
  [[nodiscard]] Real inside_facet(const V& x) const {
    Real least = std::numeric_limits<Real>::infinity();
    for (std::size_t k = 0; k < facet_.corners.size(); ++k) {
      const V &from = facet_.corners[k], along = facet_.corners[(k + 1) % facet_.corners.size()] - from;
      if constexpr (Dim == 3) {
        least = std::min(least, dot(V(x - from), moment(facet_.normal, along)) / length(along));
      } else {
        least = std::min(least, dot(V(x - from), along) / length(along));
      }
    }
    return least;
  }
  /// Whether the lowest point of a core in front of the facet is above one of its sides, up to rounding: the facets on
  /// either side of a seam may both find a ball just beside themselves.
  [[nodiscard]] bool is_on_seam(const Axis& of_facet) const {
    Real farthest(0);
    for (const V& corner : facet_.corners) farthest = std::max(farthest, length(corner));
    const Real rounding = 4 * std::numeric_limits<Real>::epsilon() * (length(pose_.centre) + farthest);
    return of_facet.separation >= Real(0) && inside_facet(of_facet.on_a) >= -rounding;
  }
  /// How far a point of the body's lowest face is from its other faces.
  [[nodiscard]] Real inside_body(const V& x) const {
    const auto& faces = body_.core.faces;
    if (faces.empty()) return -std::numeric_limits<Real>::infinity();
    std::size_t lowest = 0;
    Real least = std::numeric_limits<Real>::infinity();
    for (std::size_t k = 1; k < faces.size(); ++k)
      if (dot(faces[k].normal, facet_.normal) < dot(faces[lowest].normal, facet_.normal)) lowest = k;
    for (std::size_t k = 0; k < faces.size(); ++k)
      if (k != lowest) least = std::min(least, faces[k].offset - dot(faces[k].normal, x));
    return least;
  }
  /// Whether the normal of the facet is the direction of least overlap, without a search. So it is if a point that is
  /// about as deep as any is at least as far from the sides of the facet, or of the body's lowest face, as it is deep:
  /// along any other direction m, of which m_t is the part in the plane, the overlap there is at least depth * (m . n +
  /// |m_t|) >= depth. Where the cores are apart, any such point will do.
  [[nodiscard]] bool is_certain(const CommonPoints<Real, Dim>& points, const Real& least) const {
    const Real slack = body_.reach / 1000, depth = std::max(Real(0), Real(-least));
    V sum;
    Real count(0);
    for (const CommonPoint<Real, Dim>& point : points) {
      if (point.separation > least + slack) continue;
      if (depth == Real(0) || inside_facet(point.on_a) >= depth) return true;
      sum += point.on_a, count += Real(1);
    }
    if (count == Real(0)) return false;
    const V middle = sum * (1 / count);
    return inside_facet(middle) >= depth || inside_body(middle) >= depth;
  }

  /// The contact along the normal of the surface that fits best; false where the body is not in front of the facet.
  /// `contact` has that along the facet's own normal.
  [[nodiscard]] bool find_axis(const Axis& of_facet, FacetContact<Real, Dim>& contact) {
    std::ranges::copy(facet_.corners, core_of_facet_.corners.begin());
    const auto closest = closest_points(body_.core, core_of_facet_, Pose<Real, Dim>{});
    if (closest.distance > farthest_) return false;
    if (closest.distance > 4 * least_angle<Real> * body_.reach) {
      if (is_surface_normal(closest.normal)) return take({closest.normal, closest.distance, closest.on_a}, contact);
      return dot(closest.normal, facet_.normal) < Real(0);
    }
    const auto axis = least_overlap(of_facet, body_.reach / 1000);
    if (!axis) return false;
    if (axis->normal != of_facet.normal) return take(*axis, contact);
    if (has_near(contact.points, of_facet.separation)) return true;
    const auto strictly = least_overlap(of_facet, Real(0));
    return !strictly || strictly->normal == of_facet.normal || take(*strictly, contact);
  }
  [[nodiscard]] bool has_near(const CommonPoints<Real, Dim>& points, const Real& separation) const {
    return std::any_of(points.begin(), points.end(), [&](const CommonPoint<Real, Dim>& point) {
      return point.separation <= separation + body_.reach / 100;
    });
  }
  /// Of all normals of the surface, the one along which the body overlaps least; none where it overlaps less from
  /// behind. Others than that of the facet must be better by the bias.
  [[nodiscard]] std::optional<Axis> least_overlap(const Axis& of_facet, const Real& bias) const {
    Axis best = of_facet, behind;
    const auto consider = [&](const Axis& axis, bool is_known) {
      if (!(axis.separation > best.separation + bias)) return;
      if (dot(axis.normal, facet_.normal) > Real(0.1)) {
        if (axis.separation > behind.separation) behind = axis;
      } else if (is_known || is_surface_normal(axis.normal)) {
        best = axis;
      }
    };
    const auto consider_face = [&](const V& normal, const Real& offset) {
      const V* nearest = &facet_.corners[0];
      for (const V& corner : facet_.corners)
        if (dot(normal, corner) < dot(normal, *nearest)) nearest = &corner;
      const Real separation = dot(normal, *nearest) - offset;
      consider({normal, separation, *nearest - normal * separation}, false);
    };
    for (const Face<Real, Dim>& face : body_.core.faces) consider_face(face.normal, face.offset);
    if constexpr (Dim == 3) {
      for_each_convex_side(mesh_, number_, is_turned_, [&](const EdgeNormals<Real>& side) {
        const EdgeNormals<Real> here{pose_.local(side.from), pose_.local_direction(side.along),
                                     pose_.local_direction(side.left), pose_.local_direction(side.right)};
        for_each_edge(body_.core, [&](const EdgeNormals<Real>& edge) {
          if (const auto axis = separation_of_edges(edge, here, V(here.from))) consider(*axis, true);
        });
      });
    }
    if (behind.separation > best.separation) return std::nullopt;
    return best;
  }
  /// The feature of the facet that is farthest along the direction: itself, a side or a corner.
  [[nodiscard]] Feature<Real, Dim> highest(const V& direction) const {
    constexpr Real steep = Real(0.05);  // as of the features of bodies
    const auto& corners = facet_.corners;
    std::size_t top = 0;
    for (std::size_t k = 1; k < corners.size(); ++k)
      if (dot(direction, corners[k] - corners[top]) > Real(0)) top = k;
    Feature<Real, Dim> feature;
    if constexpr (Dim == 2) {
      const V along = corners[1] - corners[0];
      if (std::abs(dot(direction, along)) < steep * length(along)) return whole();
    } else {
      if (dot(direction, facet_.normal) >= steep) return whole();
      for (const std::size_t next : {(top + 1) % 3, (top + 2) % 3}) {
        const V along = corners[next] - corners[top];
        if (std::abs(dot(direction, along)) >= steep * length(along)) continue;
        feature.add(corners[top], top), feature.add(corners[next], next);
        return feature;
      }
    }
    feature.add(corners[top], top);
    return feature;
  }
  bool take(const Axis& axis, FacetContact<Real, Dim>& contact) const {
    contact.normal = axis.normal;
    contact.points = common_points(facing_feature(body_.core, axis.normal), highest(-axis.normal), axis.normal);
    if (!has_near(contact.points, axis.separation))
      contact.points.add({axis.on_a, axis.separation, CommonPoint<Real, Dim>::closest});
    return true;
  }

  const Convex<Real, Dim>& body_;
  const Pose<Real, Dim>& pose_;
  const StaticMesh<Real, Dim>& mesh_;
  Real farthest_;  // of the core from a facet
  std::uint32_t number_ = 0;
  bool is_turned_ = false;
  Facet<Real, Dim> facet_;
  Polytope<Real, Dim> core_of_facet_;
};

}  // namespace continuo
