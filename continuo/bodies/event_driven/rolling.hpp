// continuo/bodies/event_driven/rolling.hpp
// The motion of a sphere that rests on one wall: it slips, under Coulomb's friction, until it rolls; it rolls, under
// rolling resistance, until it stops. Both follow one equation, w' = pull - resistance * w / |w|, of the slip or of the
// velocity: while w keeps its direction the path is a parabola, and the time at which w vanishes is known.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include <continuo/bodies/event_driven/flights.hpp>

namespace continuo {

/// The direction of w, and the time for which it is valid.
template <class Real, int Dim>
struct Course {
  Vector<Real, Dim> direction{};
  Real duration = std::numeric_limits<Real>::infinity();
};

/// The course for w' = pull - resistance * w / |w|, w not 0. Where the pull turns w (on a slope in space), the
/// direction is that at the middle of a time in which it turns by no more than a thousandth: this is of second order,
/// with errors of 1e-7 per radian.
template <class Real, int Dim>
[[nodiscard]] Course<Real, Dim> course_of(const Vector<Real, Dim>& w, const Vector<Real, Dim>& pull,
                                          const Real& resistance, const Real& shortest) {
  const Real size = length(w);
  Course<Real, Dim> course{.direction = w * (1 / size)};
  const Real along = dot(pull, course.direction), across = length(pull - course.direction * along);
  if (resistance > along) course.duration = size / (resistance - along);
  if (!(across > 8 * std::numeric_limits<Real>::epsilon() * (length(pull) + resistance))) return course;
  course.duration = std::min(course.duration, std::max(shortest, Real(size / (1000 * across))));
  const Vector<Real, Dim> middle = w + (pull - course.direction * resistance) * (course.duration / 2);
  const Real size_there = length(middle);
  if (size_there > Real(0)) course.direction = middle * (1 / size_there);
  return course;
}

/// Sets the acceleration and the spin rate of a resting sphere until `path_end`. `press` is the normal part of gravity,
/// which the wall supports, `pull` the tangential part. Rolling resistance is limited to the torque that friction can
/// transmit.
template <class Real, int Dim>
void move_along(Path<Real, Dim>& path, Plan<Real, Dim>& plan, Turning<Real, Dim>& rotation,
                const Vector<Real, Dim>& normal, const Material<Real>& material, const Vector<Real, Dim>& pull,
                const Real& press, const Real& now, const Real& shortest) {
  using V = Vector<Real, Dim>;
  plan.acceleration = pull;
  rotation.spin_rate = {};
  plan.path_end = Plan<Real, Dim>::never;
  if (!(material.friction > Real(0)) || !(rotation.inverse_inertia > Real(0))) return;
  const Real r = path.radius, shape = plan.inverse_mass / (rotation.inverse_inertia * r * r);  // J / (m r^2)
  const Real rub = material.friction * press;
  // Friction f changes the slip v + spin x (-r normal) by f (1 / m + r^2 / J).
  const Real rub_of_slip = rub * (1 + 1 / shape);
  V slip = path.v + turning(rotation.spin, V(normal * -r));
  slip -= normal * dot(slip, normal);
  const bool rolls = !(length(slip) > rub_of_slip * shortest);
  if (rolls) {
    rotation.spin += moment(normal, slip) * (1 / r);
    // Rolling, m v' = m pull + f and J v' / r = -r f - torque: both together carry the inertia 1 + J / (m r^2).
    const Real resistance = std::min(material.rolling_resistance, Real(material.friction * (1 + shape)));
    const Real drag = resistance * press / (1 + shape);
    const V drive = pull * (1 / (1 + shape));
    Course<Real, Dim> course;
    V acceleration = drive;
    if (length(path.v) > drag * shortest && drag > Real(0)) {
      course = course_of(path.v, drive, drag, shortest);
      acceleration -= course.direction * drag;
    } else if (length(drive) > drag) {
      acceleration -= drive * (drag / length(drive));
    } else if (drag > Real(0)) {
      path.v = acceleration = {};
      rotation.spin -= moment(normal, turning(rotation.spin, normal));  // the spin about the normal continues
    }
    // Resistance at that limit needs the greatest friction, to rounding; without a pull no sphere slips downhill.
    const Real most = rub * (1 + 16 * std::numeric_limits<Real>::epsilon());
    if (!(length(acceleration - pull) > most) || pull == V{}) {
      plan.acceleration = acceleration;
      rotation.spin_rate = moment(normal, acceleration) * (1 / r);
      plan.path_end = now + course.duration;
      return;
    }
  }
  // Where friction is too small for rolling, the sphere begins to slip downhill.
  const Course<Real, Dim> course = course_of(rolls ? pull : slip, pull, rub_of_slip, shortest);
  plan.acceleration = pull - course.direction * rub;
  rotation.spin_rate = moment(normal, course.direction) * (rub / (shape * r));
  plan.path_end = rolls ? Plan<Real, Dim>::never : Real(now + course.duration);
}

}  // namespace continuo
