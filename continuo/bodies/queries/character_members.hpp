// Moves characters: casts of their capsule along the way, around steps, and down to the ground. Included only by the
// sources that instantiate it for a precision.
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <continuo/bodies/character.hpp>

namespace continuo {
namespace detail {

template <class Real, int Dim>
class Mover {
 public:
  using V = Vector<Real, Dim>;
  using Hit = RayHit<Real, Dim>;

  Mover(const World<Real, Dim>& world, const Queries<Real, Dim>& queries, const CharacterOptions<Real>& options)
      : world_(world), queries_(queries), options_(options), least_up_(std::cos(options.steepest)) {
    up_[Dim - 1] = Real(1);
    options_.filter.sensors = false;  // they push nothing
    shape_.shape = Capsule<Real>{options.height - 2 * options.radius, options.radius};
  }

  [[nodiscard]] Character<Real, Dim> moved(Character<Real, Dim> of, const V& velocity, const Real& duration) {
    V x = of.position + up_ * (options_.height / 2);
    if (of.is_on_ground && world_.contains(of.ground)) x += place(of.ground, of.local_foot) - of.foot;
    x = pushed_out(x);
    V way = horizontal(velocity) * duration;
    if (of.is_on_ground && !(of.rise > Real(0))) {
      if (way != V{}) x = slide(x, along(of.normal, way), true);
      of.rise = Real(0);
      stand(of, x);
    } else {
      // The mean of the speeds at the beginning and the end of a constant acceleration.
      const Real rise = of.rise - options_.fall_acceleration * duration;
      way += up_ * ((of.rise + rise) / 2 * duration);
      of.rise = rise;
      of.is_on_ground = false, of.ground = {};
      x = slide(x, way, false);
      if (hits_ceiling_) of.rise = std::min(of.rise, Real(0));
      if (of.rise <= Real(0) && hits_ground_) stand(of, x);
      if (of.is_on_ground) of.rise = Real(0);
    }
    of.position = x - up_ * (options_.height / 2);
    return of;
  }

 private:
  [[nodiscard]] V horizontal(V way) const {
    way[Dim - 1] = Real(0);
    return way;
  }
  /// The way along ground with a normal that has the same horizontal part.
  [[nodiscard]] V along(const V& normal, const V& way) const {
    const V flat = horizontal(way);
    if (normal[Dim - 1] < least_up_) return flat;
    return flat - up_ * (dot(normal, flat) / normal[Dim - 1]);
  }
  [[nodiscard]] V place(BodyHandle body, const V& local) const {
    const std::size_t i = world_.index(body);
    return world_.position[i] + rotation(world_.orientation[i]) * local;
  }
  /// The first contact on a way from x.
  [[nodiscard]] std::optional<Hit> cast(const V& x, const V& way) {
    shape_.position = x;
    const auto hits = queries_.first_contact(shape_, way, options_.filter);
    return hits && !hits->empty() ? std::optional(hits->front()) : std::nullopt;
  }
  /// How far the capsule may go on a way to a contact, so that the skin remains.
  [[nodiscard]] Real free_way(const Hit& hit, const V& direction) const {
    const Real approach = std::max(Real(-dot(hit.normal, direction)), Real(0.01));
    return std::max(Real(hit.distance - options_.skin / approach), Real(0));
  }
  /// Out of what overlaps the capsule.
  [[nodiscard]] V pushed_out(V x) {
    constexpr int most_rounds = 4;
    for (int round = 0; round < most_rounds; ++round) {
      shape_.position = x;
      const auto near = queries_.near_shape(shape_, Real(0), options_.filter);
      if (!near || near->empty() || !(near->front().distance < Real(0))) return x;
      x += near->front().normal * (options_.skin - near->front().distance);
    }
    return x;
  }
  /// Whether the character could stand on what it hits: by the normal of the contact, or, at the edge of a step, by
  /// that of the surface beside the edge.
  [[nodiscard]] bool is_ground(const Hit& hit) const {
    if (hit.normal[Dim - 1] >= least_up_) return true;
    const V aside = horizontal(hit.normal);
    const Real size = length(aside), near = 4 * options_.skin;
    if (!(hit.normal[Dim - 1] > Real(0)) || size == Real(0)) return false;
    const Ray<Real, Dim> down{
        .origin = hit.point - aside * (options_.skin / size) + up_ * near, .direction = -up_, .reach = 2 * near};
    const auto below = queries_.first_hit(down, options_.filter);
    return below && !below->empty() && below->front().distance > Real(0) && below->front().normal[Dim - 1] >= least_up_;
  }

  /// The place after a way, along what is in the way.
  [[nodiscard]] V slide(V x, V way, bool may_step) {
    constexpr int most_turns = 5;
    std::vector<V> met;  // normals of walls
    hits_ground_ = hits_ceiling_ = false;
    for (int turn = 0; turn < most_turns && way != V{}; ++turn) {
      const Real size = length(way);
      const V direction = way * (1 / size);
      const auto hit = cast(x, direction * (size + 2 * options_.skin));
      const Real room = hit ? free_way(*hit, direction) : size;
      x += direction * std::min(room, size);
      if (room >= size) return x;
      way = direction * (size - room);
      if (hit->normal[Dim - 1] < Real(0)) hits_ceiling_ = true;
      if (is_ground(*hit) && hit->normal[Dim - 1] >= least_up_) {
        hits_ground_ = true;
        way = along(hit->normal, way);
        continue;
      }
      if (const auto stepped = may_step ? step_up(x, way) : std::nullopt) return *stepped;
      hits_ground_ = hits_ground_ || is_ground(*hit);
      // Who walks takes steep slopes for walls, who falls slides down on them.
      V normal = may_step && hit->normal[Dim - 1] > Real(0) ? horizontal(hit->normal) : hit->normal;
      const Real of_normal = length(normal);
      if (!(of_normal > Real(0))) return x;
      normal *= 1 / of_normal;
      way -= normal * dot(normal, way);
      for (const V& other : met)
        if (dot(other, way) < Real(0)) return x;  // a corner
      met.push_back(normal);
    }
    return x;
  }
  /// The place on a step in the way: up, forwards and down.
  [[nodiscard]] std::optional<V> step_up(const V& x, const V& way) {
    const V flat = horizontal(way);
    const Real size = length(flat);
    if (!(size > Real(0)) || !(options_.highest_step > Real(0))) return std::nullopt;
    const V direction = flat * (1 / size);
    const auto above = cast(x, up_ * (options_.highest_step + options_.skin));
    const Real height = above ? std::min(free_way(*above, up_), options_.highest_step) : options_.highest_step;
    const V raised = x + up_ * height;
    const auto ahead = cast(raised, direction * (size + 2 * options_.skin));
    const Real room = ahead ? std::min(free_way(*ahead, direction), size) : size;
    if (!(room > size / 10)) return std::nullopt;
    const V over = raised + direction * room;
    const auto ground = cast(over, up_ * (-height - options_.skin));
    if (!ground || !is_ground(*ground)) return std::nullopt;
    const Real foot = x[Dim - 1] - options_.height / 2;  // an edge that the round foot touches is higher than it
    if (ground->point[Dim - 1] - foot > options_.highest_step) return std::nullopt;
    return V(over - up_ * (ground->distance - options_.skin));
  }
  /// Puts a character at x on the ground below it, if there is any within a step.
  void stand(Character<Real, Dim>& of, V& x) {
    const auto hit = cast(x, up_ * (-options_.highest_step - 2 * options_.skin));
    of.is_on_ground = hit && is_ground(*hit);
    of.ground = {};
    if (!of.is_on_ground) return;
    of.normal = hit->normal;
    // Within one half of the skin it stays where it is: casts are exact to less than that only.
    const Real gap = hit->distance * of.normal[Dim - 1];
    if (std::abs(gap - options_.skin) > options_.skin / 2)
      x -= up_ * (hit->distance - options_.skin / std::max(of.normal[Dim - 1], Real(0.1)));
    if (!world_.contains(hit->body)) return;
    const std::size_t i = world_.index(hit->body);
    of.ground = hit->body;
    of.local_foot = transposed_times(rotation(world_.orientation[i]), V(hit->point - world_.position[i]));
    of.foot = place(of.ground, of.local_foot);
  }

  const World<Real, Dim>& world_;
  const Queries<Real, Dim>& queries_;
  CharacterOptions<Real> options_;
  Real least_up_;  // part upwards of the normals of ground
  V up_{};
  PlacedShape<Real, Dim> shape_;
  bool hits_ground_ = false, hits_ceiling_ = false;  // of the last slide
};

}  // namespace detail

template <class Real>
Status check(const CharacterOptions<Real>& options) {
  const auto is_size = [](const Real& value) { return value > Real(0) && std::isfinite(value); };
  if (!is_size(options.radius) || !is_size(options.height) || !(options.height > 2 * options.radius))
    return invalid_input("a character's radius must be greater than 0, and its height more than two radii");
  if (!(options.steepest >= Real(0) && options.steepest < Real(1.57)))
    return invalid_input("the steepest slope must be between 0 and a right angle");
  if (!(options.highest_step >= Real(0)) || !std::isfinite(options.highest_step))
    return invalid_input("the highest step must be 0 or more, and finite");
  if (!is_size(options.skin) || !(options.skin <= options.radius / 10))
    return invalid_input("the skin must be greater than 0, and at most a tenth of the radius");
  if (!std::isfinite(options.fall_acceleration)) return invalid_input("the acceleration of falling must be finite");
  return {};
}

template <class Real, int Dim>
Result<Character<Real, Dim>> walk(const World<Real, Dim>& world, const Queries<Real, Dim>& queries,
                                  const Character<Real, Dim>& character, const Vector<Real, Dim>& velocity,
                                  const Real& duration, const CharacterOptions<Real>& options) {
  if (Status fault = check(options); !fault) return fault;
  if (!is_finite(character.position) || !is_finite(velocity) || !std::isfinite(character.rise))
    return invalid_input("position and velocity of a character must be finite");
  if (!(duration >= Real(0)) || !std::isfinite(duration)) return invalid_input("the duration must be 0 or more");
  return detail::Mover<Real, Dim>(world, queries, options).moved(character, velocity, duration);
}

}  // namespace continuo
