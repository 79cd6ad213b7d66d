// Rays, regions and neighbours, answered by a tree over the bodies of a world: the bodies of the members of Queries.
// Included only by the sources that instantiate them.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <continuo/bodies/bounds/convex_bounds.hpp>
#include <continuo/bodies/meshes/mesh_rays.hpp>
#include <continuo/bodies/queries.hpp>
#include <continuo/bodies/support/thread_team.hpp>
#include <continuo/shapes/direction_of.hpp>
#include <continuo/shapes/ray_entry.hpp>

namespace continuo {

namespace query {

template <class Real>
bool is_number(const Real& value) {
  return value - value == Real(0);
}

/// The distance along the ray to the surface of a ball; infinity where the ray misses it. The formula uses the distance
/// of the centre from the line, which loses no digits however far away the ball is.
template <class Real, int Dim>
Real distance_along(const Ray<Real, Dim>& ray, const Vector<Real, Dim>& centre, const Real& radius) {
  using std::sqrt;
  constexpr Real never = std::numeric_limits<Real>::infinity();
  const Vector<Real, Dim> apart = centre - ray.origin;
  if (squared(apart) <= radius * radius) return Real(0);
  const Real along = dot(apart, ray.direction);
  if (!(along > Real(0))) return never;
  const Real room = radius * radius - squared(Vector<Real, Dim>(apart - ray.direction * along));
  if (!(room >= Real(0))) return never;
  const Real distance = std::max(Real(0), Real(along - sqrt(room)));
  return distance <= ray.reach ? distance : never;
}

/// Normalizes the direction. Fails where the ray is invalid.
template <class Real, int Dim>
Status prepare(Ray<Real, Dim>& ray) {
  if (!is_finite(ray.origin) || !is_finite(ray.direction))
    return invalid_input("origin and direction of a ray must be finite");
  if (!(ray.reach >= Real(0)))
    return invalid_input("the reach of a ray must be 0 or more; infinity for a ray without end");
  if (ray.direction == Vector<Real, Dim>{}) return invalid_input("the direction of a ray must not be 0");
  ray.direction = direction_of(ray.direction);
  return {};
}

/// Bounds that contain what a shape is taken for by arithmetic that rounds its places: turning it by three products and
/// sums and moving it are wrong by less than four units in the last place of its greatest coordinate, both here and
/// where a ray is moved to the frame of the shape.
template <class Real, int Dim>
Bounds<Real, Dim> with_rounding(const Bounds<Real, Dim>& bounds) {
  Real greatest(0);
  for (std::size_t axis = 0; axis < bounds.lower.size(); ++axis)
    greatest = std::max({greatest, Real(std::abs(bounds.lower[axis])), Real(std::abs(bounds.upper[axis]))});
  return grown(bounds, Real(8 * std::numeric_limits<Real>::epsilon() * greatest));
}
/// The cell of a point in a grid over bounds, along a curve through neighbouring cells (G. M. Morton, 1966).
template <class Real, int Dim>
std::uint16_t place_on_curve(const Vector<Real, Dim>& x, const Bounds<Real, Dim>& bounds) {
  constexpr unsigned bits = 16 / Dim;
  std::uint32_t place = 0;
  for (std::size_t axis = 0; axis < x.size(); ++axis) {
    const Real share = (x[axis] - bounds.lower[axis]) / (bounds.upper[axis] - bounds.lower[axis]);
    const auto cell =
        share > Real(0) ? static_cast<std::uint32_t>(std::min(share, Real(1)) * Real((1u << bits) - 1)) : 0;
    for (unsigned bit = 0; bit < bits; ++bit) place |= (cell >> bit & 1u) << (bit * Dim + axis);
  }
  return static_cast<std::uint16_t>(place);
}
/// The numbers of the rays in an order in which neighbours begin near each other, and so need the same memory.
template <class Real, int Dim>
std::vector<std::uint32_t> order_by_place(const std::vector<Ray<Real, Dim>>& rays, const Bounds<Real, Dim>& bounds) {
  std::vector<std::uint16_t> places;
  std::vector<std::uint32_t> order(rays.size()), sorted(rays.size());
  for (const Ray<Real, Dim>& ray : rays) places.push_back(place_on_curve(ray.origin, bounds));
  std::iota(order.begin(), order.end(), 0u);
  for (const unsigned shift : {0u, 8u}) {  // by counting, the lower byte first
    std::array<std::uint32_t, 257> begin{};
    for (const std::uint32_t i : order) ++begin[(places[i] >> shift & 255u) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (const std::uint32_t i : order) sorted[begin[places[i] >> shift & 255u]++] = i;
    std::swap(order, sorted);
  }
  return order;
}

}  // namespace query

template <class Real, int Dim>
Queries<Real, Dim>::Queries(const World<Real, Dim>& world)
    : walls_(world.walls().begin(), world.walls().end()), meshes_(world.meshes().begin(), world.meshes().end()) {
  items_.reserve(world.size());
  for (std::size_t i = 0; i < world.size(); ++i) {
    if (!is_finite(world.position[i]) || !query::is_number(world.radius[i])) continue;
    Item item{.pose = {world.position[i], rotation(world.orientation[i])},
              .radius = world.radius[i],
              .number = static_cast<std::uint32_t>(i),
              .group = world.group(i),
              .category = world.traits(i).category,
              .is_sensor = world.traits(i).is_sensor,
              .body = world.handle(i)};
    item.solid = world.shared_solid(i);
    if (!item.solid) items_.push_back(item);
    for (std::size_t k = 0; item.solid && k < item.solid->parts.size(); ++k) {
      const SolidPart<Real, Dim>& part = item.solid->parts[k];
      Item& made = items_.emplace_back(item);
      made.convex = &part.convex;
      made.pose = {item.pose.place(part.in_solid.centre), item.pose.axes * part.in_solid.axes};
    }
  }
  std::vector<Bounds<Real, Dim>> bounds;
  bounds.reserve(items_.size());
  for (const Item& item : items_) bounds.push_back(query::with_rounding(bounds_of_item(item)));
  tree_.build(bounds);
  prepare_for_rays();
}
template <class Real, int Dim>
void Queries<Real, Dim>::prepare_for_rays() {
  std::vector<Item> sorted;
  sorted.reserve(items_.size());
  for (const std::uint32_t before : tree_.renumber()) sorted.push_back(std::move(items_[before]));
  items_ = std::move(sorted);
  way_tree_ = WayTree<Real, Dim>(tree_);
  std::unordered_map<const Convex<Real, Dim>*, const Item*> first_of;  // items with a shape
  for (Item& item : items_) {
    if (!item.convex || item.convex->rounding != Real(0)) continue;
    const auto [at, is_new] = first_of.try_emplace(item.convex, &item);
    item.first_pack = is_new ? static_cast<std::uint32_t>(planes_.size()) : at->second->first_pack;
    item.packs = is_new ? append_planes(item.convex->core, planes_) : at->second->packs;
  }
}
template <class Real, int Dim>
Bounds<Real, Dim> Queries<Real, Dim>::bounds_of_item(const Item& item) {
  if (item.convex) return bounds_of(*item.convex, item.pose);
  return grown(Bounds<Real, Dim>{item.pose.centre, item.pose.centre}, item.radius);
}

template <class Real, int Dim>
template <class Take>
void Queries<Real, Dim>::wall_hits(const Ray<Real, Dim>& ray, Take&& take) const {
  for (std::uint32_t w = 0; w < walls_.size(); ++w) {
    const Wall<Real, Dim> wall = facing(walls_[w], ray.origin);
    const Real gap = dot(wall.normal, ray.origin) - wall.offset, approach = -dot(wall.normal, ray.direction);
    const Real distance = gap <= Real(0) ? Real(0) : gap / approach;
    if (gap > Real(0) && !(approach > Real(0))) continue;
    if (distance <= ray.reach && query::is_number(distance))
      take(RayHit<Real, Dim>{.wall = w,
                             .distance = distance,
                             .point = ray.origin + ray.direction * distance,
                             .normal = gap > Real(0) ? wall.normal : V(-ray.direction)});
  }
}

template <class Real, int Dim>
template <class Take>
void Queries<Real, Dim>::mesh_hits(const Ray<Real, Dim>& ray, const QueryFilter& filter, Take&& take) const {
  for (std::uint32_t m = 0; m < meshes_.size(); ++m) {
    if (!takes(filter, m)) continue;
    for_each_hit(*meshes_[m].geometry, ray.origin, ray.direction, ray.reach, [&](const FacetHit<Real, Dim>& hit) {
      return take(RayHit<Real, Dim>{.mesh = m,
                                    .facet = hit.facet,
                                    .distance = hit.distance,
                                    .point = ray.origin + ray.direction * hit.distance,
                                    .normal = hit.normal});
    });
  }
}

template <class Real, int Dim>
Real Queries<Real, Dim>::distance_to(const Item& item, const V& point) {
  if (!item.convex) return length(V(item.pose.centre - point)) - item.radius;
  return signed_distance(*item.convex, item.pose.local(point));
}

template <class Real, int Dim>
RayHit<Real, Dim> Queries<Real, Dim>::hit_of(const Ray<Real, Dim>& ray, const Item& item) const {
  RayHit<Real, Dim> hit{.body = item.body, .distance = std::numeric_limits<Real>::infinity()};
  V out;
  if (!item.convex) {
    hit.distance = query::distance_along(ray, item.pose.centre, item.radius);
    out = ray.origin + ray.direction * hit.distance - item.pose.centre;
  } else {
    const V origin = item.pose.local(ray.origin), direction = item.pose.local_direction(ray.direction);
    const auto entry = item.packs > 0 ? entry_of_packs(std::span(planes_).subspan(item.first_pack, item.packs), origin,
                                                       direction, ray.reach)
                                      : ray_entry(*item.convex, origin, direction, ray.reach);
    if (!entry) return hit;
    hit.distance = entry->distance;
    out = item.pose.axes * entry->normal;
  }
  if (!query::is_number(hit.distance)) return hit;
  hit.point = ray.origin + ray.direction * hit.distance;
  const Real size = length(out);
  hit.normal = hit.distance > Real(0) && size > Real(0) ? out * (1 / size) : V(-ray.direction);
  return hit;
}

template <class Real, int Dim>
std::optional<RayHit<Real, Dim>> Queries<Real, Dim>::nearest_hit(Ray<Real, Dim> ray, const QueryFilter& filter) const {
  std::optional<RayHit<Real, Dim>> nearest;  // ray.reach is its distance
  std::uint32_t number = 0;                  // of its body
  const BoxSweep<Real, Dim> sweep{.begin = {ray.origin, ray.origin}, .way = ray.direction, .end = ray.reach};
  way_tree_.for_each_on_way(sweep, [&](std::uint32_t k, const Real&) {
    const Item& item = items_[k];
    if (!takes(filter, item)) return ray.reach;
    const RayHit<Real, Dim> hit = hit_of(ray, item);
    if (!query::is_number(hit.distance) || (nearest && hit.distance == ray.reach && item.number >= number))
      return ray.reach;
    nearest = hit, number = item.number;
    return ray.reach = hit.distance;
  });
  const auto take = [&](const RayHit<Real, Dim>& hit) {
    const auto order = [](const RayHit<Real, Dim>& of) { return std::tuple(of.distance, of.wall, of.mesh, of.facet); };
    const bool is_nearer = nearest && (hit.distance < nearest->distance || nearest->is_mesh());
    if (!nearest || (is_nearer && order(hit) < order(*nearest))) nearest = hit, ray.reach = hit.distance;
    return ray.reach;
  };
  if (filter.walls) wall_hits(ray, take);
  mesh_hits(ray, filter, take);
  return nearest;
}

template <class Real, int Dim>
Result<std::vector<RayHit<Real, Dim>>> Queries<Real, Dim>::first_hit(const Ray<Real, Dim>& asked,
                                                                     const QueryFilter& filter) const {
  Ray<Real, Dim> ray = asked;
  if (Status fault = query::prepare(ray); !fault) return fault;
  std::vector<RayHit<Real, Dim>> hits;
  if (const auto hit = nearest_hit(ray, filter)) hits.push_back(*hit);
  return hits;
}

template <class Real, int Dim>
Result<std::vector<RayHit<Real, Dim>>> Queries<Real, Dim>::first_hits(std::span<const Ray<Real, Dim>> rays,
                                                                      const QueryFilter& filter, int threads) const {
  std::vector<Ray<Real, Dim>> prepared(rays.begin(), rays.end());
  for (std::size_t i = 0; i < prepared.size(); ++i)
    if (Status fault = query::prepare(prepared[i]); !fault)
      return invalid_input("ray " + std::to_string(i) + ": " + fault.message);
  if (threads < 1) return invalid_input("the number of threads must be 1 or more");
  const std::vector<std::uint32_t> order = query::order_by_place(prepared, tree_.bounds());
  std::vector<RayHit<Real, Dim>> hits(rays.size(), {.distance = std::numeric_limits<Real>::infinity()});
  ThreadTeam team(threads);
  team.run([&] {
    constexpr std::size_t block = 256;
    team.for_each(0, rays.size(), block, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k)
        if (const auto hit = nearest_hit(prepared[order[k]], filter)) hits[order[k]] = *hit;
    });
  });
  return hits;
}

template <class Real, int Dim>
Result<std::vector<RayHit<Real, Dim>>> Queries<Real, Dim>::all_hits(const Ray<Real, Dim>& asked,
                                                                    const QueryFilter& filter) const {
  Ray<Real, Dim> ray = asked;
  if (Status fault = query::prepare(ray); !fault) return fault;
  std::vector<std::pair<std::uint32_t, RayHit<Real, Dim>>> found;
  const BoxSweep<Real, Dim> sweep{.begin = {ray.origin, ray.origin}, .way = ray.direction, .end = ray.reach};
  way_tree_.for_each_on_way(sweep, [&](std::uint32_t k, const Real&) {
    if (!takes(filter, items_[k])) return ray.reach;
    const RayHit<Real, Dim> hit = hit_of(ray, items_[k]);
    if (query::is_number(hit.distance)) found.emplace_back(items_[k].number, hit);
    return ray.reach;
  });
  // Of several parts of a body the first one counts.
  std::ranges::sort(found, {}, [](const auto& at) { return std::pair(at.first, at.second.distance); });
  const auto later = std::ranges::unique(found, {}, &std::pair<std::uint32_t, RayHit<Real, Dim>>::first);
  found.erase(later.begin(), later.end());
  std::ranges::sort(found, {}, [](const auto& at) { return std::pair(at.second.distance, at.first); });
  std::vector<RayHit<Real, Dim>> bodies, others;
  for (const auto& [number, hit] : found) bodies.push_back(hit);
  if (filter.walls) wall_hits(ray, [&](const RayHit<Real, Dim>& hit) { others.push_back(hit); });
  mesh_hits(ray, filter, [&](const RayHit<Real, Dim>& hit) { return others.push_back(hit), ray.reach; });
  std::ranges::sort(others, {},
                    [](const auto& hit) { return std::tuple(hit.distance, hit.wall, hit.mesh, hit.facet); });
  std::vector<RayHit<Real, Dim>> hits;
  std::ranges::merge(bodies, others, std::back_inserter(hits), {}, &RayHit<Real, Dim>::distance,
                     &RayHit<Real, Dim>::distance);
  return hits;
}

/// The bodies of the parts found, in the order of the world.
template <class Real, int Dim>
Overlap Queries<Real, Dim>::overlap_of(std::vector<const Item*>& found) const {
  std::ranges::sort(found, {}, &Item::number);
  const auto later = std::ranges::unique(found, {}, &Item::number);
  found.erase(later.begin(), later.end());
  Overlap overlap;
  for (const Item* const item : found) overlap.bodies.push_back(item->body);
  return overlap;
}

namespace query {

template <class Real, int Dim>
Polytope<Real, Dim> corners_of_box(const Vector<Real, Dim>& lower, const Vector<Real, Dim>& upper) {
  Polytope<Real, Dim> box;
  for (unsigned k = 0; k < 1u << Dim; ++k) {
    Vector<Real, Dim>& corner = box.corners.emplace_back();
    for (std::size_t axis = 0; axis < Dim; ++axis) corner[axis] = (k >> axis & 1u) != 0 ? upper[axis] : lower[axis];
  }
  return box;
}
/// Whether a mesh has a facet that is not farther than `reach` from a polytope.
template <class Real, int Dim>
bool is_near(const StaticMesh<Real, Dim>& mesh, const Polytope<Real, Dim>& shape, const Bounds<Real, Dim>& bounds,
             const Real& reach) {
  bool found = false;
  Polytope<Real, Dim> facet;
  mesh.for_each_overlap(grown(bounds, reach), [&](std::uint32_t number) {
    const auto corners = mesh.corners(number);
    facet.corners.assign(corners.begin(), corners.end());
    found = found || closest_points(shape, facet, Pose<Real, Dim>{}).distance <= reach;
  });
  return found;
}

}  // namespace query

template <class Real, int Dim>
Result<Overlap> Queries<Real, Dim>::in_sphere(const V& centre, const Real& radius, const QueryFilter& filter) const {
  if (!is_finite(centre) || !query::is_number(radius) || radius < Real(0))
    return invalid_input("centre and radius must be finite, the radius 0 or more");
  std::vector<const Item*> found;
  tree_.for_each_near(centre, radius, [&](std::uint32_t k) {
    if (takes(filter, items_[k]) && distance_to(items_[k], centre) <= radius) found.push_back(&items_[k]);
    return radius;
  });
  Overlap overlap = overlap_of(found);
  for (std::uint32_t w = 0; filter.walls && w < walls_.size(); ++w) {
    const Wall<Real, Dim> wall = facing(walls_[w], centre);
    if (dot(wall.normal, centre) - wall.offset <= radius) overlap.walls.push_back(w);
  }
  const Polytope<Real, Dim> point{.corners = {centre}};
  for (std::uint32_t m = 0; m < meshes_.size(); ++m)
    if (takes(filter, m) && query::is_near(*meshes_[m].geometry, point, Bounds<Real, Dim>{centre, centre}, radius))
      overlap.meshes.push_back(m);
  return overlap;
}

template <class Real, int Dim>
Result<Overlap> Queries<Real, Dim>::in_box(const V& lower, const V& upper, const QueryFilter& filter) const {
  if (!is_finite(lower) || !is_finite(upper)) return invalid_input("the corners of a box must be finite");
  for (std::size_t axis = 0; axis < V::size(); ++axis)
    if (lower[axis] > upper[axis]) return invalid_input("the lower corner of a box must not be above the upper one");
  const Bounds<Real, Dim> bounds{lower, upper};
  const Polytope<Real, Dim> box = query::corners_of_box(lower, upper);
  std::vector<const Item*> found;
  tree_.for_each_overlap(bounds, [&](std::uint32_t k) {
    const Item& item = items_[k];
    if (!takes(filter, item)) return;
    const bool is_found = item.convex
                              ? closest_points(box, item.convex->core, item.pose).distance <= item.convex->rounding
                              : distance(item.pose.centre, bounds) <= item.radius;
    if (is_found) found.push_back(&item);
  });
  Overlap overlap = overlap_of(found);
  for (std::uint32_t w = 0; filter.walls && w < walls_.size(); ++w) {
    const Wall<Real, Dim> wall = facing(walls_[w], V((lower + upper) * Real(0.5)));
    Real deepest(0);  // the corner that the wall's normal points away from
    for (std::size_t axis = 0; axis < V::size(); ++axis)
      deepest += wall.normal[axis] * (wall.normal[axis] > Real(0) ? lower[axis] : upper[axis]);
    if (deepest <= wall.offset) overlap.walls.push_back(w);
  }
  for (std::uint32_t m = 0; m < meshes_.size(); ++m)
    if (takes(filter, m) && query::is_near(*meshes_[m].geometry, box, bounds, Real(0))) overlap.meshes.push_back(m);
  return overlap;
}

template <class Real, int Dim>
Result<std::vector<Neighbour<Real>>> Queries<Real, Dim>::nearest(const V& point, std::size_t count,
                                                                 const QueryFilter& filter) const {
  if (!is_finite(point)) return invalid_input("the point must be finite");
  using Found = std::tuple<Real, std::uint32_t, BodyHandle>;
  const auto nearer = [](const Found& a, const Found& b) {
    return std::pair(std::get<0>(a), std::get<1>(a)) < std::pair(std::get<0>(b), std::get<1>(b));
  };
  std::set<Found, decltype(nearer)> found(nearer);  // each body once
  const auto take = [&](const Found& one, bool has_parts) {
    if (has_parts) {
      const auto same = std::ranges::find(found, std::get<1>(one), [](const Found& at) { return std::get<1>(at); });
      if (same != found.end() && !nearer(one, *same)) return;
      if (same != found.end()) found.erase(same);
    }
    found.insert(one);
    if (found.size() > count) found.erase(std::prev(found.end()));
  };
  constexpr Real endless = std::numeric_limits<Real>::infinity();
  if (count > 0)
    tree_.for_each_near(point, endless, [&](std::uint32_t k) {
      const Item& item = items_[k];
      const bool has_parts = item.solid && item.solid->parts.size() > 1;
      if (takes(filter, item)) take({distance_to(item, point), item.number, item.body}, has_parts);
      return found.size() == count ? std::max(std::get<0>(*std::prev(found.end())), Real(0)) : endless;
    });
  std::vector<Neighbour<Real>> neighbours;
  for (const auto& [distance, number, body] : found) neighbours.push_back({body, distance});
  return neighbours;
}

}  // namespace continuo
