// Rays, regions and neighbours, answered by a tree over the bodies of a world.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

#include <continuo/bodies/queries.hpp>
#include <continuo/shapes/ray_entry.hpp>

namespace continuo {

namespace {

constexpr std::size_t leaf = 4;

template <class Real>
bool is_number(const Real& value) {
  return value - value == Real(0);
}

/// The distance along the ray (of unit direction) at which it enters the box; infinity where it misses the box. Where
/// rounding or overflow leaves this undecided the result is 0, so that no hit is lost.
template <class Real, int Dim>
Real entry(const Ray<Real, Dim>& ray, const Vector<Real, Dim>& lower, const Vector<Real, Dim>& upper) {
  Real from(0), to = ray.reach;
  for (std::size_t axis = 0; axis < lower.size(); ++axis) {
    if (ray.direction[axis] == Real(0)) {
      if (ray.origin[axis] < lower[axis] || ray.origin[axis] > upper[axis])
        return std::numeric_limits<Real>::infinity();
      continue;
    }
    Real near = (lower[axis] - ray.origin[axis]) / ray.direction[axis];
    Real far = (upper[axis] - ray.origin[axis]) / ray.direction[axis];
    if (near > far) std::swap(near, far);
    if (near > from) from = near;
    if (far < to) to = far;
  }
  // Both ends have a relative error of some units in the last place.
  return from > to + 8 * std::numeric_limits<Real>::epsilon() * to ? std::numeric_limits<Real>::infinity() : from;
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

template <class Real, int Dim>
Real distance_to_box(const Vector<Real, Dim>& x, const Vector<Real, Dim>& lower, const Vector<Real, Dim>& upper) {
  Vector<Real, Dim> out;
  for (std::size_t axis = 0; axis < x.size(); ++axis)
    out[axis] = std::max({Real(lower[axis] - x[axis]), Real(x[axis] - upper[axis]), Real(0)});
  return length(out);
}

/// Normalizes the direction. Fails where the ray is invalid.
template <class Real, int Dim>
Status prepare(Ray<Real, Dim>& ray) {
  if (!is_finite(ray.origin) || !is_finite(ray.direction))
    return invalid_input("origin and direction of a ray must be finite");
  if (!(ray.reach >= Real(0)))
    return invalid_input("the reach of a ray must be 0 or more; infinity for a ray without end");
  Real largest(0);
  for (std::size_t axis = 0; axis < ray.direction.size(); ++axis)
    largest = std::max(largest, std::abs(ray.direction[axis]));
  if (!(largest > Real(0))) return invalid_input("the direction of a ray must not be 0");
  for (std::size_t axis = 0; axis < ray.direction.size(); ++axis) ray.direction[axis] /= largest;
  ray.direction *= 1 / length(ray.direction);
  return {};
}

bool takes(const QueryFilter& filter, std::uint32_t group) {
  return (filter.groups >> group & 1u) != 0;
}

}  // namespace

template <class Real, int Dim>
Queries<Real, Dim>::Queries(const World<Real, Dim>& world) : walls_(world.walls().begin(), world.walls().end()) {
  items_.reserve(world.size());
  for (std::size_t i = 0; i < world.size(); ++i)
    if (is_finite(world.position[i]) && is_number(world.radius[i]))
      items_.push_back({world.position[i], world.radius[i], static_cast<std::uint32_t>(i), world.group(i),
                        world.handle(i), world.shared_solid(i),
                        Pose<Real, Dim>{world.position[i], rotation(world.orientation[i])}});
  std::size_t nodes = 1;
  for (std::size_t n = items_.size(); n > leaf; n = (n + 1) / 2) nodes = 2 * nodes + 1;
  boxes_.resize(nodes);
  build(0, 0, items_.size());
}

template <class Real, int Dim>
void Queries<Real, Dim>::build(std::size_t node, std::size_t first, std::size_t last) {
  if (first == last) return;
  const auto corners = [](const Item& item) {
    Box box{item.x, item.x};
    for (std::size_t axis = 0; axis < V::size(); ++axis) box.lower[axis] -= item.radius, box.upper[axis] += item.radius;
    return box;
  };
  Box all = corners(items_[first]), centres{items_[first].x, items_[first].x};
  for (std::size_t k = first + 1; k < last; ++k) {
    const Box one = corners(items_[k]);
    for (std::size_t axis = 0; axis < V::size(); ++axis) {
      all.lower[axis] = std::min(all.lower[axis], one.lower[axis]);
      all.upper[axis] = std::max(all.upper[axis], one.upper[axis]);
      centres.lower[axis] = std::min(centres.lower[axis], items_[k].x[axis]);
      centres.upper[axis] = std::max(centres.upper[axis], items_[k].x[axis]);
    }
  }
  boxes_[node] = all;
  if (last - first <= leaf) return;
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < V::size(); ++axis)
    if (centres.upper[axis] - centres.lower[axis] > centres.upper[longest] - centres.lower[longest]) longest = axis;
  const std::size_t middle = first + (last - first + 1) / 2;
  const auto at = [&](std::size_t k) { return items_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(first), at(middle), at(last), [&](const Item& a, const Item& b) {
    return std::pair(a.x[longest], a.number) < std::pair(b.x[longest], b.number);
  });
  build(2 * node + 1, first, middle);
  build(2 * node + 2, middle, last);
}

/// Calls visit(item) for the items of all boxes that enter(box) does not exclude. enter(box) gives the distance at
/// which the box begins, infinity to exclude it. The nearer half of a box comes first; the other half is tested again
/// after that, since a hit may have shortened the search.
template <class Real, int Dim>
template <class Enter, class Visit>
void Queries<Real, Dim>::walk(Enter&& enter, Visit&& visit, std::size_t node, std::size_t first,
                              std::size_t last) const {
  if (last - first <= leaf) {
    for (std::size_t k = first; k < last; ++k) visit(items_[k]);
    return;
  }
  constexpr Real never = std::numeric_limits<Real>::infinity();
  const std::size_t middle = first + (last - first + 1) / 2, lower = 2 * node + 1, upper = 2 * node + 2;
  const Real to_lower = enter(boxes_[lower]), to_upper = enter(boxes_[upper]);
  const auto go_lower = [&] {
    if (enter(boxes_[lower]) < never) walk(enter, visit, lower, first, middle);
  };
  const auto go_upper = [&] {
    if (enter(boxes_[upper]) < never) walk(enter, visit, upper, middle, last);
  };
  if (to_upper < to_lower) {
    go_upper();
    if (to_lower < never) go_lower();
  } else {
    if (to_lower < never) go_lower();
    if (to_upper < never) go_upper();
  }
}
template <class Real, int Dim>
template <class Enter, class Visit>
void Queries<Real, Dim>::walk(Enter&& enter, Visit&& visit) const {
  if (!items_.empty() && enter(boxes_[0]) < std::numeric_limits<Real>::infinity())
    walk(enter, visit, 0, 0, items_.size());
}

template <class Real, int Dim>
template <class Take>
void Queries<Real, Dim>::wall_hits(const Ray<Real, Dim>& ray, Take&& take) const {
  for (std::uint32_t w = 0; w < walls_.size(); ++w) {
    const Wall<Real, Dim> wall = facing(walls_[w], ray.origin);
    const Real gap = dot(wall.normal, ray.origin) - wall.offset, approach = -dot(wall.normal, ray.direction);
    const Real distance = gap <= Real(0) ? Real(0) : gap / approach;
    if (gap > Real(0) && !(approach > Real(0))) continue;
    if (distance <= ray.reach && is_number(distance))
      take(RayHit<Real, Dim>{.wall = w,
                             .distance = distance,
                             .point = ray.origin + ray.direction * distance,
                             .normal = gap > Real(0) ? wall.normal : V(-ray.direction)});
  }
}

template <class Real, int Dim>
Real Queries<Real, Dim>::distance_to(const Item& item, const V& point) {
  if (!item.solid) return length(V(item.x - point)) - item.radius;
  Real least = std::numeric_limits<Real>::infinity();
  const V local = item.pose.local(point);
  for (const SolidPart<Real, Dim>& part : item.solid->parts)
    least = std::min(least, signed_distance(part.convex, part.in_solid.local(local)));
  return least;
}

template <class Real, int Dim>
RayHit<Real, Dim> Queries<Real, Dim>::hit_of(const Ray<Real, Dim>& ray, const Item& item) {
  RayHit<Real, Dim> hit{.body = item.body, .distance = distance_along(ray, item.x, item.radius)};
  if (item.solid && is_number(hit.distance)) {
    hit.distance = std::numeric_limits<Real>::infinity();
    for (const SolidPart<Real, Dim>& part : item.solid->parts) {
      const Pose<Real, Dim> pose{item.pose.place(part.in_solid.centre), item.pose.axes * part.in_solid.axes};
      const auto entry = ray_entry(part.convex, pose.local(ray.origin), pose.local_direction(ray.direction), ray.reach);
      if (entry && entry->distance < hit.distance)
        hit.distance = entry->distance, hit.normal = pose.axes * entry->normal;
    }
  }
  if (!is_number(hit.distance)) return hit;
  hit.point = ray.origin + ray.direction * hit.distance;
  const V out = item.solid ? hit.normal : V(hit.point - item.x);
  const Real size = length(out);
  hit.normal = hit.distance > Real(0) && size > Real(0) ? out * (1 / size) : V(-ray.direction);
  return hit;
}

template <class Real, int Dim>
Result<std::vector<RayHit<Real, Dim>>> Queries<Real, Dim>::first_hit(const Ray<Real, Dim>& asked,
                                                                     const QueryFilter& filter) const {
  Ray<Real, Dim> ray = asked;
  if (Status fault = prepare(ray); !fault) return fault;
  const Item* nearest = nullptr;
  std::vector<RayHit<Real, Dim>> hits;
  Ray<Real, Dim> left = ray;  // ends at the nearest hit so far
  walk([&](const Box& box) { return entry(left, box.lower, box.upper); },
       [&](const Item& item) {
         if (!takes(filter, item.group)) return;
         const RayHit<Real, Dim> hit = hit_of(left, item);
         if (!is_number(hit.distance)) return;
         if (nearest && hit.distance == left.reach && item.number > nearest->number) return;
         nearest = &item;
         hits = {hit};
         left.reach = hit.distance;
       });
  if (filter.walls)
    wall_hits(left, [&](const RayHit<Real, Dim>& hit) {
      if (hits.empty() || hit.distance < hits[0].distance) hits = {hit};
    });
  return hits;
}

template <class Real, int Dim>
Result<std::vector<RayHit<Real, Dim>>> Queries<Real, Dim>::all_hits(const Ray<Real, Dim>& asked,
                                                                    const QueryFilter& filter) const {
  Ray<Real, Dim> ray = asked;
  if (Status fault = prepare(ray); !fault) return fault;
  std::vector<std::pair<std::uint32_t, RayHit<Real, Dim>>> found;
  walk([&](const Box& box) { return entry(ray, box.lower, box.upper); },
       [&](const Item& item) {
         if (!takes(filter, item.group)) return;
         const RayHit<Real, Dim> hit = hit_of(ray, item);
         if (is_number(hit.distance)) found.emplace_back(item.number, hit);
       });
  std::ranges::sort(found, {}, [](const auto& at) { return std::pair(at.second.distance, at.first); });
  std::vector<RayHit<Real, Dim>> bodies, walls;
  for (const auto& [number, hit] : found) bodies.push_back(hit);
  if (filter.walls) wall_hits(ray, [&](const RayHit<Real, Dim>& hit) { walls.push_back(hit); });
  std::ranges::sort(walls, {}, [](const auto& hit) { return std::pair(hit.distance, hit.wall); });
  std::vector<RayHit<Real, Dim>> hits;
  std::ranges::merge(bodies, walls, std::back_inserter(hits), {}, &RayHit<Real, Dim>::distance,
                     &RayHit<Real, Dim>::distance);
  return hits;
}

namespace {

/// Whether a solid has a point in common with a box with its faces along the axes.
template <class Real, int Dim>
bool touches_box(const Solid<Real, Dim>& solid, const Pose<Real, Dim>& pose, const Vector<Real, Dim>& lower,
                 const Vector<Real, Dim>& upper) {
  Polytope<Real, Dim> box;
  for (unsigned k = 0; k < 1u << Dim; ++k) {
    Vector<Real, Dim>& corner = box.corners.emplace_back();
    for (std::size_t axis = 0; axis < Dim; ++axis) corner[axis] = (k >> axis & 1u) != 0 ? upper[axis] : lower[axis];
  }
  return std::ranges::any_of(solid.parts, [&](const SolidPart<Real, Dim>& part) {
    const Pose<Real, Dim> of_part{pose.place(part.in_solid.centre), pose.axes * part.in_solid.axes};
    return closest_points(box, part.convex.core, of_part).distance <= part.convex.rounding;
  });
}

template <class Found>
std::vector<BodyHandle> in_order(Found& found) {
  std::ranges::sort(found, {}, [](const auto* item) { return item->number; });
  std::vector<BodyHandle> bodies;
  for (const auto* item : found) bodies.push_back(item->body);
  return bodies;
}

}  // namespace

template <class Real, int Dim>
Result<Overlap> Queries<Real, Dim>::in_sphere(const V& centre, const Real& radius, const QueryFilter& filter) const {
  if (!is_finite(centre) || !is_number(radius) || radius < Real(0))
    return invalid_input("centre and radius must be finite, the radius 0 or more");
  std::vector<const Item*> found;
  walk(
      [&](const Box& box) {
        return distance_to_box(centre, box.lower, box.upper) > radius * (1 + 8 * std::numeric_limits<Real>::epsilon())
                   ? std::numeric_limits<Real>::infinity()
                   : Real(0);
      },
      [&](const Item& item) {
        if (takes(filter, item.group) && distance_to(item, centre) <= radius) found.push_back(&item);
      });
  Overlap overlap{in_order(found), {}};
  for (std::uint32_t w = 0; filter.walls && w < walls_.size(); ++w) {
    const Wall<Real, Dim> wall = facing(walls_[w], centre);
    if (dot(wall.normal, centre) - wall.offset <= radius) overlap.walls.push_back(w);
  }
  return overlap;
}

template <class Real, int Dim>
Result<Overlap> Queries<Real, Dim>::in_box(const V& lower, const V& upper, const QueryFilter& filter) const {
  if (!is_finite(lower) || !is_finite(upper)) return invalid_input("the corners of a box must be finite");
  for (std::size_t axis = 0; axis < V::size(); ++axis)
    if (lower[axis] > upper[axis]) return invalid_input("the lower corner of a box must not be above the upper one");
  std::vector<const Item*> found;
  walk(
      [&](const Box& box) {
        for (std::size_t axis = 0; axis < V::size(); ++axis)
          if (box.lower[axis] > upper[axis] || box.upper[axis] < lower[axis])
            return std::numeric_limits<Real>::infinity();
        return Real(0);
      },
      [&](const Item& item) {
        if (!takes(filter, item.group) || distance_to_box(item.x, lower, upper) > item.radius) return;
        if (!item.solid || touches_box(*item.solid, item.pose, lower, upper)) found.push_back(&item);
      });
  Overlap overlap{in_order(found), {}};
  for (std::uint32_t w = 0; filter.walls && w < walls_.size(); ++w) {
    const Wall<Real, Dim> wall = facing(walls_[w], V((lower + upper) * Real(0.5)));
    Real deepest(0);  // the corner that the wall's normal points away from
    for (std::size_t axis = 0; axis < V::size(); ++axis)
      deepest += wall.normal[axis] * (wall.normal[axis] > Real(0) ? lower[axis] : upper[axis]);
    if (deepest <= wall.offset) overlap.walls.push_back(w);
  }
  return overlap;
}

template <class Real, int Dim>
Result<std::vector<Neighbour<Real>>> Queries<Real, Dim>::nearest(const V& point, std::size_t count,
                                                                 const QueryFilter& filter) const {
  if (!is_finite(point)) return invalid_input("the point must be finite");
  constexpr Real never = std::numeric_limits<Real>::infinity();
  using Found = std::tuple<Real, std::uint32_t, BodyHandle>;
  const auto nearer = [](const Found& a, const Found& b) {
    return std::pair(std::get<0>(a), std::get<1>(a)) < std::pair(std::get<0>(b), std::get<1>(b));
  };
  std::vector<Found> found;  // a heap, the farthest on top
  count = std::min(count, items_.size());
  if (count > 0)
    walk(
        [&](const Box& box) {
          const Real distance = distance_to_box(point, box.lower, box.upper);
          const bool is_full = found.size() == count;
          return is_full && distance > Real(0) &&
                         distance > std::get<0>(found.front()) * (1 + 8 * std::numeric_limits<Real>::epsilon())
                     ? never
                     : distance;
        },
        [&](const Item& item) {
          if (!takes(filter, item.group)) return;
          const Found one{distance_to(item, point), item.number, item.body};
          if (found.size() == count) {
            if (!nearer(one, found.front())) return;
            std::ranges::pop_heap(found, nearer);
            found.pop_back();
          }
          found.push_back(one);
          std::ranges::push_heap(found, nearer);
        });
  std::ranges::sort_heap(found, nearer);
  std::vector<Neighbour<Real>> neighbours;
  for (const auto& [distance, number, body] : found) neighbours.push_back({body, distance});
  return neighbours;
}

template class Queries<float, 2>;
template class Queries<float, 3>;
template class Queries<double, 2>;
template class Queries<double, 3>;

}  // namespace continuo
