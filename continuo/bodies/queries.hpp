// continuo/bodies/queries.hpp
// Spatial queries: rays, regions, nearest neighbours, and shapes that move or that lie somewhere. The index is built
// from the present state of the world in O(N log N); a query then costs O(log N) where few objects match it.
//
//   const Queries queries(world);
//   const auto hit = queries.first_hit({.origin = {{0, 0, 10}}, .direction = {{0, 0, -1}}});
//   if (!hit) std::cerr << describe(hit.status());  // the question made no sense
//   else if (!hit.value.empty()) use(hit.value.front().body, hit.value.front().distance)
//
// The index is a tree of the bounds of the parts of bodies, beside the trees of the meshes, so that bodies of very
// different size, or far away from all others, cost nothing extra. Bodies whose position is not finite are left out.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <continuo/bodies/bounds/bounds_tree.hpp>
#include <continuo/bodies/bounds/way_tree.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/shapes/plane_packs.hpp>
#include <continuo/status/result.hpp>

namespace continuo {

/// A half line, or a segment of length `reach`.
template <class Real, int Dim>
struct Ray {
  Vector<Real, Dim> origin{};                          // where it begins
  Vector<Real, Dim> direction{};                       // of any length but 0
  Real reach = std::numeric_limits<Real>::infinity();  // its length
};

/// A shape at a place.
template <class Real, int Dim>
struct PlacedShape {
  Shape<Real, Dim> shape = Sphere<Real>{};                    // of any kind
  Vector<Real, Dim> position{};                               // of its origin
  Orientation<Real, Dim> orientation = upright<Real, Dim>();  // an angle in the plane, a quaternion in space
};

/// Selects the objects of a query: bodies of the groups whose bit is set, walls, and meshes; of bodies and meshes those
/// that have one of the categories; and not `without`.
struct QueryFilter {
  std::uint32_t groups = ~std::uint32_t{0};      // bit i: the bodies of group i; by default all
  bool walls = true;                             // walls too
  bool meshes = true;                            // static meshes too
  bool sensors = true;                           // bodies that are sensors too
  std::uint64_t categories = ~std::uint64_t{0};  // bits of BodyTraits::category and MeshDefinition::category
  BodyHandle without{};                          // a body that is left out, as the one that asks; by default none
};

/// A hit on a body, on a wall, whose number in world.walls() is `wall`, or on a facet of a static mesh, whose number in
/// world.meshes() is `mesh`.
template <class Real, int Dim>
struct RayHit {
  static constexpr std::uint32_t no_wall = std::numeric_limits<std::uint32_t>::max();  // `wall` of a hit on another
  static constexpr std::uint32_t no_mesh = no_wall;                                    // `mesh`, likewise
  BodyHandle body{};                                                                   // that was hit
  std::uint32_t wall = no_wall;                                                        // that was hit
  std::uint32_t mesh = no_mesh;                                                        // that was hit
  std::uint32_t facet = 0;                                                             // of the mesh
  Real distance{};             // along the ray; 0 where it starts inside the body or behind the wall
  Vector<Real, Dim> point{};   // where it is
  Vector<Real, Dim> normal{};  // of the surface; against the ray where it starts inside
  /// Whether it is a wall that was hit.
  [[nodiscard]] bool is_wall() const { return wall != no_wall; }
  /// Whether it is a static mesh that was hit.
  [[nodiscard]] bool is_mesh() const { return mesh != no_mesh; }
};

/// A body near a point.
template <class Real>
struct Neighbour {
  BodyHandle body{};  // the body
  Real distance{};    // to its surface, below 0 inside
};

/// What a region touches.
struct Overlap {
  std::vector<BodyHandle> bodies{};     // the bodies
  std::vector<std::uint32_t> walls{};   // the walls, by their numbers in world.walls()
  std::vector<std::uint32_t> meshes{};  // the static meshes, by their numbers in world.meshes()
};

/// What is near a shape: a part of a body, a wall, or facets of a static mesh with nearly the same normal.
template <class Real, int Dim>
struct NearSurface {
  static constexpr std::uint32_t no_wall = std::numeric_limits<std::uint32_t>::max();  // `wall` of another
  static constexpr std::uint32_t no_mesh = no_wall;                                    // `mesh`, likewise
  BodyHandle body{};                                                                   // whose surface it is
  std::uint32_t wall = no_wall;  // whose surface it is, by its number in world.walls()
  std::uint32_t mesh = no_mesh;  // whose surface it is, by its number in world.meshes()
  Real distance{};               // of both surfaces, below 0 where they overlap
  Vector<Real, Dim> point{};     // in the middle between both surfaces
  Vector<Real, Dim> normal{};    // of the other surface, towards the shape, of length 1
};

/// An index of the bodies of a world at one instant. It does not follow the world: build another after a change.
template <class Real, int Dim>
class Queries {
 public:
  using V = Vector<Real, Dim>;

  /// Copies places and shapes, and sorts them in O(N log N). The world may change or end afterwards.
  explicit Queries(const World<Real, Dim>& world);

  // All queries fail for invalid arguments: numbers that are not finite, a direction of 0, a negative radius or reach,
  // a shape that no body can have, or a box whose lower corner is above its upper one.

  /// The nearest hit, if any: one element or none. Of equal distances bodies come before walls and meshes, lower
  /// numbers first.
  [[nodiscard]] Result<std::vector<RayHit<Real, Dim>>> first_hit(const Ray<Real, Dim>& ray,
                                                                 const QueryFilter& filter = {}) const;
  /// The nearest hit of each ray; where there is none, the distance is infinite. At most so many threads
  /// take part.
  [[nodiscard]] Result<std::vector<RayHit<Real, Dim>>> first_hits(std::span<const Ray<Real, Dim>> rays,
                                                                  const QueryFilter& filter = {},
                                                                  int threads = 1) const;
  /// All of them, the nearest first.
  [[nodiscard]] Result<std::vector<RayHit<Real, Dim>>> all_hits(const Ray<Real, Dim>& ray,
                                                                const QueryFilter& filter = {}) const;
  /// The first contact of a shape that moves straight by `way`: one element or none. Its distance is that along the
  /// way, at which the surfaces are no farther apart than 1e-5 of the size of the shape; the contact is never passed.
  /// What the shape touches without approaching it is no contact; where it overlaps a body, the distance is 0. The back
  /// of a one-sided mesh is open.
  [[nodiscard]] Result<std::vector<RayHit<Real, Dim>>> first_contact(const PlacedShape<Real, Dim>& shape, const V& way,
                                                                     const QueryFilter& filter = {}) const;
  /// The bodies, walls and meshes that a ball, a box with its faces along the axes, or any shape touches, in the order
  /// of the world.
  [[nodiscard]] Result<Overlap> in_sphere(const V& centre, const Real& radius, const QueryFilter& filter = {}) const;
  /// The same of a box with its faces along the axes.
  [[nodiscard]] Result<Overlap> in_box(const V& lower, const V& upper, const QueryFilter& filter = {}) const;
  /// The same of any shape.
  [[nodiscard]] Result<Overlap> in_shape(const PlacedShape<Real, Dim>& shape, const QueryFilter& filter = {}) const;
  /// The surfaces that are not farther from a shape than `reach`, the nearest first. Behind a one-sided mesh there is
  /// no surface.
  [[nodiscard]] Result<std::vector<NearSurface<Real, Dim>>> near_shape(const PlacedShape<Real, Dim>& shape,
                                                                       const Real& reach,
                                                                       const QueryFilter& filter = {}) const;
  /// The `count` bodies whose surfaces are nearest, or as many as there are; the nearest first.
  [[nodiscard]] Result<std::vector<Neighbour<Real>>> nearest(const V& point, std::size_t count,
                                                             const QueryFilter& filter = {}) const;

 private:
  /// A convex part of a body.
  struct Item {
    Pose<Real, Dim> pose{};                           // of the part
    std::shared_ptr<const Solid<Real, Dim>> solid{};  // keeps the part alive; null of a ball
    const Convex<Real, Dim>* convex = nullptr;        // null of a ball
    std::uint32_t first_pack = 0, packs = 0;          // of planes; none of a ball, or of what is rounded
    Real radius{};                                    // of a ball
    std::uint32_t number = 0, group = 0;              // of the body
    std::uint64_t category = 1;
    bool is_sensor = false;
    BodyHandle body{};
  };
  class ShapeSearch;

  [[nodiscard]] static bool takes(const QueryFilter& filter, const Item& item) {
    return (filter.groups >> item.group & 1u) != 0 && (filter.categories & item.category) != 0 &&
           (filter.sensors || !item.is_sensor) && item.body != filter.without;
  }
  [[nodiscard]] bool takes(const QueryFilter& filter, std::uint32_t mesh) const {
    return filter.meshes && meshes_[mesh].geometry && (filter.categories & meshes_[mesh].category) != 0;
  }
  [[nodiscard]] static Bounds<Real, Dim> bounds_of_item(const Item& item);
  /// The distance of a point to the surface of a part, below 0 inside.
  [[nodiscard]] static Real distance_to(const Item& item, const V& point);
  /// Where a ray hits a part; the distance is not a number where it does not.
  [[nodiscard]] RayHit<Real, Dim> hit_of(const Ray<Real, Dim>& ray, const Item& item) const;
  [[nodiscard]] std::optional<RayHit<Real, Dim>> nearest_hit(Ray<Real, Dim> ray, const QueryFilter& filter) const;
  [[nodiscard]] Overlap overlap_of(std::vector<const Item*>& found) const;
  template <class Take>
  void wall_hits(const Ray<Real, Dim>& ray, Take&& take) const;
  template <class Take>
  void mesh_hits(const Ray<Real, Dim>& ray, const QueryFilter& filter, Take&& take) const;

  /// Sorts the items, which are near each other in memory where they are so in space, and copies their planes.
  void prepare_for_rays();

  std::vector<Item> items_;
  std::vector<PlanePack<Real, Dim>> planes_;
  BoundsTree<Real, Dim> tree_;   // of the items
  WayTree<Real, Dim> way_tree_;  // likewise
  std::vector<Wall<Real, Dim>> walls_;
  std::vector<WorldMesh<Real, Dim>> meshes_;
};

extern template class Queries<float, 2>;
extern template class Queries<float, 3>;
extern template class Queries<double, 2>;
extern template class Queries<double, 3>;

}  // namespace continuo
