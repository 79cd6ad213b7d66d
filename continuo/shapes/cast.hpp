// continuo/shapes/cast.hpp
// When two moving convex bodies first touch, by conservative advancement (B. V. Mirtich, "Impulse-based dynamic
// simulation of rigid body systems", 1996, sec. 2.3): until a time that their distance and their speeds allow they
// cannot touch, so that time goes there, and so on. No contact is missed, however fast or thin the bodies are.
#pragma once
#include <cmath>
#include <limits>
#include <optional>

#include <continuo/shapes/closest_points.hpp>
#include <continuo/shapes/convex.hpp>

namespace continuo {

/// A body that moves at a constant velocity and turns at a constant spin about its centre.
template <class Real, int Dim>
struct MovingBody {
  const Convex<Real, Dim>* shape = nullptr;                   // lives as long as this
  Vector<Real, Dim> position{};                               // of the centre, at time 0
  Orientation<Real, Dim> orientation = upright<Real, Dim>();  // at time 0
  Vector<Real, Dim> velocity{};                               // of the centre
  Spin<Real, Dim> spin{};                                     // in radians per time
  Matrix<Real, Dim> axes = identity_matrix<Real, Dim>();      // of the shape, in the frame that has the orientation

  /// Where it is at a time.
  [[nodiscard]] Pose<Real, Dim> at(const Real& time) const {
    return {position + velocity * time, rotation(turned(orientation, spin, time)) * axes};
  }
};

/// A first contact.
template <class Real, int Dim>
struct FirstContact {
  Real time{};                 // of it
  Vector<Real, Dim> point{};   // in the middle between the surfaces
  Vector<Real, Dim> normal{};  // from the first body to the second; 0 where they overlap at the beginning
};

/// The first time from 0 to `duration` at which the surfaces are no farther apart than `tolerance`, which must be above
/// 0: to a tenth of that, and never later than the contact itself. None where they stay apart. O(log(1 / tolerance))
/// distances, more where the bodies pass each other closely; should they need more than 1000, the contact is where the
/// search stands, before any real one.
template <class Real, int Dim>
[[nodiscard]] std::optional<FirstContact<Real, Dim>> first_contact(const MovingBody<Real, Dim>& a,
                                                                   const MovingBody<Real, Dim>& b, const Real& duration,
                                                                   const Real& tolerance) {
  constexpr int most_distances = 1000;
  const Real roundings = a.shape->rounding + b.shape->rounding;
  // No point moves against its centre faster than this.
  const Real turning_speed =
      length(a.spin) * (a.shape->reach - a.shape->rounding) + length(b.spin) * (b.shape->reach - b.shape->rounding);
  Real time(0);
  for (int k = 1;; ++k) {
    const Pose<Real, Dim> at_a = a.at(time), at_b = b.at(time);
    const auto closest = closest_points(a.shape->core, b.shape->core, relative(at_a, at_b));
    const Vector<Real, Dim> normal = at_a.axes * closest.normal;
    const Real distance = closest.distance - roundings;
    if (distance <= tolerance || k == most_distances) {
      const Vector<Real, Dim> on_a = at_a.place(closest.on_a) + normal * a.shape->rounding;
      return FirstContact<Real, Dim>{time, on_a + normal * (distance / 2), normal};
    }
    // The plane between them, which moves with neither, is reached by one of them no sooner than this.
    const Real approach = dot(normal, a.velocity - b.velocity) + turning_speed;
    if (!(approach > Real(0))) return std::nullopt;
    time += (distance - Real(0.9) * tolerance) / approach;
    if (!(time <= duration)) return std::nullopt;
  }
}

}  // namespace continuo
