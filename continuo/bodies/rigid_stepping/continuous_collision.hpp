// No body passes through another one: what moves farther in a step than a part of its own size is stopped where it
// first touches something. It keeps its velocity, and the next step begins with the contact.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/bodies/rigid_stepping/mesh_passage.hpp>
#include <continuo/bodies/rigid_stepping/rigid_contacts.hpp>
#include <continuo/bodies/rigid_stepping/time_of_depth.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/shapes/cast.hpp>

namespace continuo {

/// The constant spin that turns one orientation into another within a time.
template <class Real>
[[nodiscard]] Vector<Real, 1> spin_between(const Vector<Real, 1>& from, const Vector<Real, 1>& to, const Real& time) {
  return (to - from) * (1 / time);
}
template <class Real>
[[nodiscard]] Vector<Real, 3> spin_between(const Vector<Real, 4>& p, const Vector<Real, 4>& q, const Real& time) {
  // The vector part of q p^-1, whose length is the sine of half the angle.
  const Vector<Real, 3> from{{p[1], p[2], p[3]}}, to{{q[1], q[2], q[3]}};
  const Real cosine = dot(p, q);
  const Vector<Real, 3> axis = (to * p[0] - from * q[0] - moment(to, from)) * (cosine < Real(0) ? Real(-1) : Real(1));
  const Real sine = length(axis);
  if (!(sine > Real(0))) return {};
  return axis * (2 * std::atan2(sine, std::abs(cosine)) / (sine * time));
}

/// The motion of a part of a body in the last step.
template <class Real, int Dim>
[[nodiscard]] MovingBody<Real, Dim> motion_of(const RigidPart<Real, Dim>& part, const RigidBody<Real, Dim>& body,
                                              const Real& step) {
  MovingBody<Real, Dim> moving{.shape = part.convex};
  RigidBody<Real, Dim> before = body;
  before.x = body.x_before, before.axes = rotation(body.orientation_before);
  const Pose<Real, Dim> first = part.pose(before), last = part.pose(body);
  moving.position = first.centre;
  moving.velocity = (last.centre - first.centre) * (1 / step);
  moving.orientation = body.orientation_before, moving.axes = part.in_body.axes;
  moving.spin = spin_between(body.orientation_before, body.orientation, step);
  return moving;
}

/// The time of the step after which each body stops.
template <class Real, int Dim>
class StoppingTimes {
 public:
  StoppingTimes(const World<Real, Dim>& world, const RigidPairs<Real, Dim>& pairs,
                std::span<const PartContact<Real, Dim>> contacts, const Real& step,
                std::span<const RigidBody<Real, Dim>> bodies)
      : world_(world),
        pairs_(pairs),
        contacts_(contacts),
        step_(step),
        bodies_(bodies),
        until_(world.size(), step),
        is_fast_(pairs.parts().size()) {
    for (std::size_t i = 0; i < is_fast_.size(); ++i) is_fast_[i] = moves_far(pairs.parts()[i]);
  }

  [[nodiscard]] const std::vector<Real>& times() const { return until_; }
  /// Whether a part moves so far that it might pass through something.
  [[nodiscard]] bool is_fast(const RigidPart<Real, Dim>& part) const {
    return is_fast_[static_cast<std::size_t>(&part - pairs_.parts().data())];
  }
  /// Stops at the first contact of a part with what it does not touch yet.
  void find_first_contact(const RigidPart<Real, Dim>& part) {
    const RigidBody<Real, Dim>& body = bodies_[part.body];
    const MovingBody<Real, Dim> moving = motion_of(part, body, step_);
    const Bounds<Real, Dim> swept =
        grown(united(bounds_of(*part.convex, moving.at(Real(0))), bounds_of(*part.convex, part.pose(body))),
              std::min(way(part), part.convex->reach));
    pairs_.tree().for_each_overlap(swept, [&](std::uint32_t j) {
      const RigidPart<Real, Dim>& other = pairs_.parts()[j];
      if (other.body == part.body || !world_.collide(part.body, other.body)) return;
      if (world_.traits(other.body).is_sensor || !may_pass(part, other) || has_contact(part, other)) return;
      const auto contact = first_contact(moving, motion_of(other, bodies_[other.body], step_), until_[part.body],
                                         part.inner_radius / 100);
      if (contact && contact->time > Real(0)) stop(part.body, contact->time);
    });
    for (const WorldMesh<Real, Dim>& mesh : world_.meshes())
      if (mesh.collides(world_.traits(part.body)))
        stop(part.body, time_before_passing(moving, *mesh.geometry, part.inner_radius, until_[part.body], step_));
  }
  /// Stops where a contact of the beginning of the step becomes deep: the body turns about its first point into the
  /// other one.
  void find_depth(const PartContact<Real, Dim>& found) {
    const auto parts = pairs_.parts();
    const bool is_wall = found.parts.b >= parts.size();
    const RigidPart<Real, Dim>& a = parts[found.parts.a];
    const bool is_a_fast = is_fast(a), is_b_fast = !is_wall && is_fast(parts[found.parts.b]);
    if (!is_a_fast && !is_b_fast) return;
    if (!is_wall && !may_pass(a, parts[found.parts.b])) return;
    MovingBody<Real, Dim> of_wall;
    const Convex<Real, Dim> point = {.core = {.corners = {{}}}};
    if (is_wall) {
      const auto& first = found.contact.points[0];
      of_wall.shape = &point;
      of_wall.position = bodies_[found.a].x_before + first.arm_a + found.contact.normal * (first.separation / 2);
    }
    const Real inner = is_wall ? a.inner_radius : std::min(a.inner_radius, parts[found.parts.b].inner_radius);
    const Real time = time_of_depth(motion_of(a, bodies_[found.a], step_),
                                    is_wall ? of_wall : motion_of(parts[found.parts.b], bodies_[found.b], step_),
                                    found.contact.normal, inner / 4, step_);
    if (is_a_fast) stop(found.a, time);
    if (is_b_fast) stop(found.b, time);
  }

 private:
  /// Two bodies that both move may overlap for a while, and are pushed apart: to stop one of them where the other one
  /// goes on does harm. Only what would pass right through has to be stopped.
  [[nodiscard]] bool may_pass(const RigidPart<Real, Dim>& a, const RigidPart<Real, Dim>& b) const {
    if (bodies_[a.body].is_fixed() || bodies_[b.body].is_fixed()) return true;
    const Vector<Real, Dim> of_a = bodies_[a.body].x - bodies_[a.body].x_before;
    const Vector<Real, Dim> of_b = bodies_[b.body].x - bodies_[b.body].x_before;
    return length(Vector<Real, Dim>(of_a - of_b)) > a.inner_radius + b.inner_radius;
  }
  /// The solver has taken care of those.
  [[nodiscard]] bool has_contact(const RigidPart<Real, Dim>& a, const RigidPart<Real, Dim>& b) const {
    const auto* const first = pairs_.parts().data();
    const auto i = static_cast<std::uint32_t>(&a - first), j = static_cast<std::uint32_t>(&b - first);
    const PartPair pair{std::min(i, j), std::max(i, j)};
    const auto at = std::ranges::lower_bound(contacts_, pair, {}, &PartContact<Real, Dim>::parts);
    return at != contacts_.end() && at->parts == pair && at->contact.size > 0;
  }
  [[nodiscard]] Real way(const RigidPart<Real, Dim>& part) const {
    const RigidBody<Real, Dim>& body = bodies_[part.body];
    return length(Vector<Real, Dim>(body.x - body.x_before)) +
           length(spin_between(body.orientation_before, body.orientation, step_)) * step_ * part.convex->reach;
  }
  [[nodiscard]] bool moves_far(const RigidPart<Real, Dim>& part) const {
    const RigidBody<Real, Dim>& body = bodies_[part.body];
    return !body.is_fixed() && way(part) > part.inner_radius / 2 && !world_.traits(part.body).is_sensor;
  }
  void stop(std::uint32_t body, const Real& time) { until_[body] = std::min(until_[body], time); }

  const World<Real, Dim>& world_;
  const RigidPairs<Real, Dim>& pairs_;
  std::span<const PartContact<Real, Dim>> contacts_;
  Real step_;
  std::span<const RigidBody<Real, Dim>> bodies_;
  std::vector<Real> until_;
  std::vector<bool> is_fast_;  // of each part
};

/// Stops fast bodies. Returns how many. `bodies` have the world's bodies first.
template <class Real, int Dim>
std::size_t stop_fast_bodies(const World<Real, Dim>& world, const RigidPairs<Real, Dim>& pairs,
                             std::span<const PartContact<Real, Dim>> contacts, const Real& step,
                             std::span<RigidBody<Real, Dim>> bodies) {
  StoppingTimes<Real, Dim> times(world, pairs, contacts, step, bodies);
  for (const RigidPart<Real, Dim>& part : pairs.parts())
    if (times.is_fast(part)) times.find_first_contact(part);
  for (const PartContact<Real, Dim>& found : contacts)
    if (found.contact.size > 0) times.find_depth(found);
  std::size_t stopped = 0;
  for (std::size_t i = 0; i < world.size(); ++i) {
    const Real until = times.times()[i];
    if (!(until < step)) continue;
    RigidBody<Real, Dim>& body = bodies[i];
    const Spin<Real, Dim> spin = spin_between(body.orientation_before, body.orientation, step);
    body.x = body.x_before + (body.x - body.x_before) * (until / step);
    body.orientation = turned(body.orientation_before, spin, until);
    body.update_axes();
    ++stopped;
  }
  return stopped;
}

}  // namespace continuo
