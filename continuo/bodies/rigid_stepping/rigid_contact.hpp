// A contact of two rigid bodies from step to step: the points of its manifold with their impulses, and the rows that
// hold them apart.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <continuo/bodies/contact_solver/contact_step.hpp>
#include <continuo/bodies/rigid_stepping/constraint_rows.hpp>
#include <continuo/shapes/manifold.hpp>

namespace continuo {

/// Unit vectors across a normal.
template <class Real>
[[nodiscard]] std::array<Vector<Real, 2>, 1> directions_across(const Vector<Real, 2>& normal) {
  return {perpendicular(normal)};
}
/// T. Duff et al., "Building an orthonormal basis, revisited", JCGT 6 (2017), 1-8.
template <class Real>
[[nodiscard]] std::array<Vector<Real, 3>, 2> directions_across(const Vector<Real, 3>& n) {
  const Real sign = std::copysign(Real(1), n[2]), p = -1 / (sign + n[2]), q = n[0] * n[1] * p;
  const Vector<Real, 3> across{{1 + sign * n[0] * n[0] * p, sign * q, -sign * n[0]}};
  return {across, moment(n, across)};
}

template <class Real, int Dim>
struct RigidContactPoint {
  Vector<Real, Dim> arm_a{}, arm_b{};      // from the centres to the point, in the world, when the step began
  Vector<Real, Dim> local_a{}, local_b{};  // where it was when it was found, in the frames of the bodies
  Real separation{};                       // when the step began
  Real separation_when_found{};            // where local_a and local_b were the same point
  Real local_apart{};                      // how far both were apart along the normal when the step began
  Real approach{};                         // normal velocity then
  Real impulse{};                          // along the normal, of the last substep
  Vector<Real, Dim - 1> friction{};        // impulses along the directions across the normal of the held frame
  Real greatest_impulse{};                 // along the normal, of the substeps of this step
  std::uint32_t feature = 0;
};

template <class Real, int Dim>
struct RigidContact {
  static constexpr std::size_t most_points = Manifold<Real, Dim>::most_points;
  std::size_t size = 0;  // of the points: at the beginning, where the bodies are, for those who need no more
  Real friction{}, restitution{};
  Real rounding_a{}, rounding_b{};  // of the parts that touch
  Vector<Real, Dim> normal{};       // from a to b, in the world
  Vector<Real, Dim> normal_in_a{};  // the same, in the frame of a
  Pose<Real, Dim> found_at{};       // of b in the frame of a, when the points were found
  Matrix<Real, Dim> held_axes{};    // of a, see HeldFrame
  Real margin{};                    // then
  std::array<RigidContactPoint<Real, Dim>, most_points> points{};

  [[nodiscard]] auto all() { return std::span(points).first(size); }
  [[nodiscard]] auto all() const { return std::span(points).first(size); }
};

/// The frame in which sweeps hold a contact: its normal and its arms as they were when its points were found, turned
/// with body a only where that has turned far since.
///
/// A tall wall of soft contacts buckles as a column does that bears itself: the arms of what leans let it lean further,
/// and a few sweeps cannot hold against that what they hold otherwise. With arms and normals that do not follow small
/// turns, a pyramid of 100 rows stands that else falls after five seconds. Box3D keeps the anchors of contacts for the
/// same reason. The direction of a normal is wrong by no more than the turn that is allowed for.
template <class Real, int Dim>
struct HeldFrame {
  static constexpr Real most_turn = Real(0.005);  // radians; with 0.003 the pyramid falls after 15 s
  Matrix<Real, Dim> axes{};                       // of a
  Vector<Real, Dim> normal{};
  Vector<Real, Dim> from_b_to_a{};  // between the centres

  explicit HeldFrame(const RigidContact<Real, Dim>& contact)
      : axes(contact.held_axes), normal(axes * contact.normal_in_a), from_b_to_a(-(axes * contact.found_at.centre)) {}
  /// From the centre of a to a point. That from the centre of b is longer by from_b_to_a.
  [[nodiscard]] Vector<Real, Dim> arm_a(const RigidContactPoint<Real, Dim>& point) const {
    return axes * point.local_a;
  }
};
/// Impulses of friction, along the directions across a normal, in the world; and back.
/// @{
template <class Real, int Dim>
[[nodiscard]] Vector<Real, Dim> in_world(const Vector<Real, Dim - 1>& friction, const Vector<Real, Dim>& normal) {
  const auto across = directions_across(normal);
  Vector<Real, Dim> sum;
  for (std::size_t i = 0; i < friction.size(); ++i) sum += across[i] * friction[i];
  return sum;
}
template <class Real, int Dim>
[[nodiscard]] Vector<Real, Dim - 1> across_normal(const Vector<Real, Dim>& friction, const Vector<Real, Dim>& normal) {
  const auto across = directions_across(normal);
  Vector<Real, Dim - 1> parts;
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = dot(friction, across[i]);
  return parts;
}
/// @}
/// The same impulses where a normal has turned. In the plane they turn with it; in space the directions across it may
/// be others altogether.
/// @{
template <class Real>
[[nodiscard]] Vector<Real, 1> turned_friction(const Vector<Real, 1>& friction, const Vector<Real, 2>&,
                                              const Vector<Real, 2>&) {
  return friction;
}
template <class Real>
[[nodiscard]] Vector<Real, 2> turned_friction(const Vector<Real, 2>& friction, const Vector<Real, 3>& before,
                                              const Vector<Real, 3>& now) {
  return across_normal(in_world(friction, before), now);
}
/// @}
/// Whether the frame of a contact should follow body a, which has turned far.
template <class Real, int Dim>
[[nodiscard]] bool has_turned_far(const RigidContact<Real, Dim>& contact, const RigidBody<Real, Dim>& a) {
  constexpr Real most = HeldFrame<Real, Dim>::most_turn;
  for (std::size_t axis = 0; axis < Dim; ++axis)
    if (!(squared(a.axes[axis] - contact.held_axes[axis]) <= most * most)) return true;
  return false;
}
/// Lets it do so.
template <class Real, int Dim>
void turn_held_frame(RigidContact<Real, Dim>& contact, const RigidBody<Real, Dim>& a) {
  const Vector<Real, Dim> before = HeldFrame(contact).normal;
  contact.held_axes = a.axes;
  const Vector<Real, Dim> now = HeldFrame(contact).normal;
  for (auto& point : contact.all()) point.friction = turned_friction(point.friction, before, now);
}

/// Gives a contact of bodies a and b a manifold whose points are in the frame `of_a`. Points with the features of
/// points of before keep their impulses.
template <class Real, int Dim>
[[gnu::flatten]] void renew(RigidContact<Real, Dim>& contact, const Manifold<Real, Dim>& manifold,
                            const Pose<Real, Dim>& of_a, const Real& margin, const RigidBody<Real, Dim>& a,
                            const RigidBody<Real, Dim>& b) {
  struct Kept {
    std::uint32_t feature = 0;
    Real impulse{};
    Vector<Real, Dim - 1> friction{};
  };
  std::array<Kept, RigidContact<Real, Dim>::most_points> kept;
  const std::size_t points_before = contact.size;
  const Vector<Real, Dim> normal_before = HeldFrame(contact).normal;
  for (std::size_t k = 0; k < points_before; ++k)
    kept[k] = {contact.points[k].feature, contact.points[k].impulse, contact.points[k].friction};
  contact.size = manifold.size;
  contact.margin = margin;
  if (manifold.size == 0) return;
  contact.normal = of_a.axes * manifold.normal;
  contact.normal_in_a = a.pose().local_direction(contact.normal);
  contact.found_at = relative(a.pose(), b.pose());
  contact.held_axes = a.axes;
  const Vector<Real, Dim> normal = HeldFrame(contact).normal;
  for (std::size_t i = 0; i < manifold.size; ++i) {
    const ManifoldPoint<Real, Dim>& found = manifold.points[i];
    RigidContactPoint<Real, Dim>& point = contact.points[i];
    point.feature = found.feature;
    point.impulse = point.greatest_impulse = Real(0), point.friction = {};
    for (std::size_t k = 0; k < points_before; ++k)
      if (kept[k].feature == found.feature)
        point.impulse = kept[k].impulse, point.friction = turned_friction(kept[k].friction, normal_before, normal);
    const Vector<Real, Dim> x = of_a.place(found.position);
    point.arm_a = x - a.x, point.arm_b = x - b.x;
    point.local_a = a.pose().local(x), point.local_b = b.pose().local(x);
    point.local_apart = Real(0);
    point.separation = point.separation_when_found = found.separation;
    point.approach = dot(contact.normal, b.velocity_at(point.arm_b) - a.velocity_at(point.arm_a));
  }
}

/// Whether two bodies are against each other nearly as they were when the points of their contact were found: whatever
/// is near the smaller one, of this size, has moved by less than a fiftieth of it, and less than the margin of a
/// contact is.
template <class Real, int Dim>
[[nodiscard]] bool are_as_found(const RigidContact<Real, Dim>& contact, const Real& size, bool is_a_smaller,
                                const RigidBody<Real, Dim>& a, const RigidBody<Real, Dim>& b) {
  const Pose<Real, Dim> now = relative(a.pose(), b.pose());
  const Pose<Real, Dim>& found = contact.found_at;
  const Real most = size / 100;
  const Vector<Real, Dim> shift =
      is_a_smaller ? transposed_times(now.axes, now.centre) - transposed_times(found.axes, found.centre)
                   : now.centre - found.centre;
  if (!(squared(shift) <= most * most)) return false;
  // The part of a large body that touches may be far from its centre.
  const Vector<Real, Dim>& arm = is_a_smaller ? contact.points[0].local_a : contact.points[0].local_b;
  const Real reach2 = std::max(size * size, squared(arm));
  for (std::size_t axis = 0; axis < Dim; ++axis)
    if (!(squared(now.axes[axis] - found.axes[axis]) * reach2 <= most * most)) return false;
  return true;
}
/// Takes a contact along with two bodies that have hardly moved against each other since its points were found: the
/// normal is fixed to a, and what was the point to both bodies, so that the separation is right up to the square of the
/// rotation; both act on each other in the middle. `size` is that of the smaller body. Returns false where they have
/// moved, where points farther apart count now, or where none is near enough to count any more: then points are to be
/// found anew, which costs ten times as much. So what has a contact is always near, and a pair, also in a run that goes
/// on from a snapshot. Neither of them is rounded: where such a body rolls, neither the normal nor the points turn with
/// it.
template <class Real, int Dim>
[[nodiscard, gnu::flatten]] bool follow(RigidContact<Real, Dim>& contact, const Real& margin, const Real& size,
                                        bool is_a_smaller, const RigidBody<Real, Dim>& a,
                                        const RigidBody<Real, Dim>& b) {
  if (contact.size == 0 || margin > contact.margin + size / 1000) return false;
  if (!are_as_found(contact, size, is_a_smaller, a, b)) return false;
  contact.normal = a.axes * contact.normal_in_a;
  const Vector<Real, Dim> between = b.x - a.x;
  Real nearest = std::numeric_limits<Real>::infinity();
  for (auto& point : contact.all()) {
    const Vector<Real, Dim> arm_a = a.axes * point.local_a, arm_b = b.axes * point.local_b;
    const Vector<Real, Dim> apart = between + (arm_b - arm_a);
    point.arm_a = arm_a + apart * Real(0.5), point.arm_b = arm_b - apart * Real(0.5);
    point.local_apart = dot(contact.normal, (arm_b - point.arm_b) - (arm_a - point.arm_a));
    point.separation = point.separation_when_found + dot(contact.normal, apart);
    point.approach = dot(contact.normal, b.velocity_at(point.arm_b) - a.velocity_at(point.arm_a));
    point.greatest_impulse = Real(0);
    nearest = std::min(nearest, point.separation);
  }
  return nearest <= margin;
}

/// How far the turn of a rounded body since the step began moves its surface less than its points: what is along the
/// normal from the core stays there. With the turn R, that is rounding n . (R n - n).
template <class Real, int Dim>
[[nodiscard]] Real turn_of_rounding(const Real& rounding, const Vector<Real, Dim>& normal,
                                    const RigidBody<Real, Dim>& body) {
  if (rounding == Real(0)) return Real(0);
  const Pose<Real, Dim> before{{}, rotation(body.orientation_before)};
  return rounding * (dot(normal, body.axes * before.local_direction(normal)) - 1);
}

/// How far apart the surfaces are now at a point of a contact.
template <class Real, int Dim>
[[nodiscard]] Real separation(const RigidContact<Real, Dim>& contact, const RigidContactPoint<Real, Dim>& point,
                              const RigidBody<Real, Dim>& a, const RigidBody<Real, Dim>& b) {
  // An arm may be long, as to the centre of a mesh, and is the same until the body turns.
  const Vector<Real, Dim> shifted =
      (b.moved - a.moved) + ((b.axes * point.local_b - point.arm_b) - (a.axes * point.local_a - point.arm_a));
  return point.separation + (dot(shifted, contact.normal) - point.local_apart) +
         turn_of_rounding(contact.rounding_a, contact.normal, a) +
         turn_of_rounding(contact.rounding_b, contact.normal, b);
}

/// How the contacts of a step are to be held apart.
template <class Real>
struct ContactHardness {
  Real h{};             // of the substep
  Real rate{};          // of undoing overlaps, per time
  Real softness{};      // velocity per impulse, times the mass; 0 is rigid
  Real fastest_push{};  // of undoing overlaps
};

/// Adds the rows of a contact of bodies a and b. Returns their block.
template <class Real, int Dim>
[[nodiscard]] RowBlock add_rows(const RigidContact<Real, Dim>& contact, std::uint32_t number_a, std::uint32_t number_b,
                                const RigidBody<Real, Dim>& a, const RigidBody<Real, Dim>& b,
                                std::vector<ConstraintRow<Real, Dim>>& rows) {
  const RowBlock block{.a = number_a,
                       .b = number_b,
                       .first = static_cast<std::uint32_t>(rows.size()),
                       .rows = static_cast<std::uint16_t>(contact.size * Dim),
                       .points = static_cast<std::uint16_t>(contact.size),
                       .friction = static_cast<float>(contact.friction)};
  const auto add = [&](const Vector<Real, Dim>& direction, const RigidContactPoint<Real, Dim>& point) -> auto& {
    ConstraintRow<Real, Dim>& row = rows.emplace_back();
    row.direction = direction;
    row.lever_a = moment(point.arm_a, direction), row.lever_b = moment(point.arm_b, direction);
    set_mass(row, a, b);
    return row;
  };
  for (const auto& point : contact.all()) {
    ConstraintRow<Real, Dim>& row = add(contact.normal, point);
    row.least = Real(0);
    row.impulse = point.impulse;
  }
  const auto across = directions_across(contact.normal);
  const Vector<Real, Dim> held = HeldFrame(contact).normal;
  for (const auto& point : contact.all()) {
    const Vector<Real, Dim> friction = in_world(point.friction, held);
    for (const Vector<Real, Dim>& direction : across) add(direction, point).impulse = dot(friction, direction);
  }
  return block;
}

/// The arm of a point of a contact after the turn of its body since the step began: the core turns, and what is round
/// about it reaches farthest `outwards` as before.
template <class Real, int Dim>
[[nodiscard]] Vector<Real, Dim> turned_arm(const Vector<Real, Dim>& local, const Real& rounding,
                                           const Vector<Real, Dim>& outwards, const RigidBody<Real, Dim>& body) {
  if (rounding == Real(0)) return body.axes * local;
  const Pose<Real, Dim> before{{}, rotation(body.orientation_before)};
  return body.axes * Vector<Real, Dim>(local - before.local_direction(outwards * rounding)) + outwards * rounding;
}
/// Turns the levers of the rows of a contact along with its bodies. With those of the beginning of the step, a body
/// that turns far in it would sink in where it touches by then, and gain the energy with which it is pushed out. Two
/// that move push each other at one point, in the middle: else a push would turn them together.
template <class Real, int Dim>
void turn_levers(const RigidContact<Real, Dim>& contact, std::span<ConstraintRow<Real, Dim>> rows,
                 const RigidBody<Real, Dim>& a, const RigidBody<Real, Dim>& b) {
  for (std::size_t i = 0; i < contact.size; ++i) {
    const auto& point = contact.points[i];
    Vector<Real, Dim> arm_a = turned_arm(point.local_a, contact.rounding_a, contact.normal, a);
    Vector<Real, Dim> arm_b = turned_arm(point.local_b, contact.rounding_b, Vector<Real, Dim>(-contact.normal), b);
    if (!a.is_fixed() && !b.is_fixed()) {
      const Vector<Real, Dim> apart = (b.x + arm_b) - (a.x + arm_a);
      arm_a += apart * Real(0.5), arm_b -= apart * Real(0.5);
    }
    const auto turn = [&](ConstraintRow<Real, Dim>& row) {
      row.lever_a = moment(arm_a, row.direction), row.lever_b = moment(arm_b, row.direction);
      set_mass(row, a, b);
    };
    turn(rows[i]);
    for (std::size_t k = 0; k < Dim - 1; ++k) turn(rows[contact.size + i * (Dim - 1) + k]);
  }
}

/// Sets the velocities that the rows of a contact ask for, from where the bodies are now.
template <class Real, int Dim>
void aim(const RigidContact<Real, Dim>& contact, std::span<ConstraintRow<Real, Dim>> rows,
         const RigidBody<Real, Dim>& a, const RigidBody<Real, Dim>& b, const ContactHardness<Real>& hardness) {
  for (std::size_t i = 0; i < contact.size; ++i) {
    const Real apart = separation(contact, contact.points[i], a, b);
    ConstraintRow<Real, Dim>& row = rows[i];
    const bool is_apart = apart > Real(0);  // then it may close within the substep
    row.bias = is_apart ? apart / hardness.h : std::max(hardness.rate * apart, -hardness.fastest_push);
    row.bias_at_end = is_apart ? apart / hardness.h : Real(0);
    row.softness = is_apart || row.mass == Real(0) ? Real(0) : hardness.softness / row.mass;
  }
}

/// Keeps the impulses of a substep.
template <class Real, int Dim>
void keep_impulses(RigidContact<Real, Dim>& contact, std::span<const ConstraintRow<Real, Dim>> rows) {
  const Vector<Real, Dim> held = HeldFrame(contact).normal;
  for (std::size_t i = 0; i < contact.size; ++i) {
    auto& point = contact.points[i];
    point.impulse = rows[i].impulse;
    Vector<Real, Dim> friction;
    for (std::size_t k = 0; k < Dim - 1; ++k) {
      const auto& row = rows[contact.size + i * (Dim - 1) + k];
      friction += row.direction * row.impulse;
    }
    point.friction = across_normal(friction, held);
  }
}

}  // namespace continuo
