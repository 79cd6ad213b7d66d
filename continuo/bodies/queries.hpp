// continuo/bodies/queries.hpp
// Spatial queries: ray casts, regions and nearest neighbours. The index is built from the present state of the world in
// O(N log N); a query then costs O(log N) where few bodies match it.
//
//   const Queries queries(world);
//   const auto hit = queries.first_hit({.origin = {{0, 0, 10}}, .direction = {{0, 0, -1}}});
//   if (!hit) std::cerr << describe(hit.status());  // the question made no sense
//   else if (!hit.value.empty()) use(hit.value.front().body, hit.value.front().distance)
//
// The index is a tree of bounding boxes, each divided at the median body along its longest edge, so that bodies of very
// different size, or far away from all others, cost nothing extra. Bodies whose position is not finite are left out.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <continuo/bodies/world.hpp>
#include <continuo/status/result.hpp>

namespace continuo {

/// A half line, or a segment of length `reach`.
template <class Real, int Dim>
struct Ray {
  Vector<Real, Dim> origin{};                          // where it begins
  Vector<Real, Dim> direction{};                       // of any length but 0
  Real reach = std::numeric_limits<Real>::infinity();  // its length
};

/// Selects the objects of a query: bodies of the groups whose bit is set, and walls.
struct QueryFilter {
  std::uint32_t groups = ~std::uint32_t{0};  // bit i: the bodies of group i; by default all
  bool walls = true;                         // walls too
};

/// A hit on a body, or on a wall, whose number in world.walls() is `wall`.
template <class Real, int Dim>
struct RayHit {
  static constexpr std::uint32_t no_wall = std::numeric_limits<std::uint32_t>::max();  // `wall` of a hit on a body
  BodyHandle body{};                                                                   // that was hit
  std::uint32_t wall = no_wall;                                                        // that was hit
  Real distance{};             // along the ray; 0 where it starts inside the body or behind the wall
  Vector<Real, Dim> point{};   // where it is
  Vector<Real, Dim> normal{};  // of the surface; against the ray where it starts inside
  /// Whether it is a wall that was hit.
  [[nodiscard]] bool is_wall() const { return wall != no_wall; }
};

/// A body near a point.
template <class Real>
struct Neighbour {
  BodyHandle body{};  // the body
  Real distance{};    // to its surface, below 0 inside
};

/// What a region touches.
struct Overlap {
  std::vector<BodyHandle> bodies{};    // the bodies
  std::vector<std::uint32_t> walls{};  // the walls, by their numbers in world.walls()
};

/// An index of the bodies of a world at one instant. It does not follow the world: build another after a change.
template <class Real, int Dim>
class Queries {
 public:
  using V = Vector<Real, Dim>;

  /// Copies places and shapes, and sorts them in O(N log N). The world may change or end afterwards.
  explicit Queries(const World<Real, Dim>& world);

  // All queries fail for invalid arguments: numbers that are not finite, a direction of 0, a negative radius or reach,
  // or a box whose lower corner is above its upper one.

  /// The nearest hit, if any: one element or none. Of equal distances bodies come before walls, lower numbers first.
  [[nodiscard]] Result<std::vector<RayHit<Real, Dim>>> first_hit(const Ray<Real, Dim>& ray,
                                                                 const QueryFilter& filter = {}) const;
  /// All of them, the nearest first.
  [[nodiscard]] Result<std::vector<RayHit<Real, Dim>>> all_hits(const Ray<Real, Dim>& ray,
                                                                const QueryFilter& filter = {}) const;
  /// The bodies and walls that a ball, or a box with its faces along the axes, touches, in the order of the world.
  [[nodiscard]] Result<Overlap> in_sphere(const V& centre, const Real& radius, const QueryFilter& filter = {}) const;
  /// The bodies and walls that a box with its faces along the axes touches, in the order of the world.
  [[nodiscard]] Result<Overlap> in_box(const V& lower, const V& upper, const QueryFilter& filter = {}) const;
  /// The `count` bodies whose surfaces are nearest, or as many as there are; the nearest first.
  [[nodiscard]] Result<std::vector<Neighbour<Real>>> nearest(const V& point, std::size_t count,
                                                             const QueryFilter& filter = {}) const;

 private:
  struct Item {
    V x{};
    Real radius{};
    std::uint32_t number = 0, group = 0;
    BodyHandle body{};
    std::shared_ptr<const Solid<Real, Dim>> solid{};  // null of a ball
    Pose<Real, Dim> pose{};                           // of the solid
  };
  struct Box {
    V lower{}, upper{};  // of whole bodies
  };

  /// The distance of a point to the surface of a body, below 0 inside.
  [[nodiscard]] static Real distance_to(const Item& item, const V& point);
  /// Where a ray hits a body; the distance is not a number where it does not.
  [[nodiscard]] static RayHit<Real, Dim> hit_of(const Ray<Real, Dim>& ray, const Item& item);
  void build(std::size_t node, std::size_t first, std::size_t last);
  template <class Enter, class Visit>
  void walk(Enter&& enter, Visit&& visit, std::size_t node, std::size_t first, std::size_t last) const;
  template <class Enter, class Visit>
  void walk(Enter&& enter, Visit&& visit) const;
  template <class Take>
  void wall_hits(const Ray<Real, Dim>& ray, Take&& take) const;

  std::vector<Item> items_;
  std::vector<Box> boxes_;  // the halves of node k are nodes 2 k + 1 and 2 k + 2
  std::vector<Wall<Real, Dim>> walls_;
};

extern template class Queries<float, 2>;
extern template class Queries<float, 3>;
extern template class Queries<double, 2>;
extern template class Queries<double, 3>;

}  // namespace continuo
