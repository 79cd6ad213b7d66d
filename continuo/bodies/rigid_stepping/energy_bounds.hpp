// Bounds on the kinetic energy of islands. Impulses of contacts take energy away, and the solvers keep to that as they
// see it: with the moments of inertia in the directions in which the bodies were when the step began, and with impacts
// one restitution at a time. Two things break it. A slender body that turns by a radian and more in a step has, along
// an axis that was that of its least moment, a moment thousands of times as large. And where friction acts in an
// impact, Newton's law of restitution may give more than came in (T. R. Kane, D. A. Levinson, "Dynamics", 1985).
#pragma once
#include <algorithm>
#include <cmath>

#include <continuo/bodies/rigid_stepping/rigid_body.hpp>

namespace continuo {

/// The velocities of a body.
template <class Real, int Dim>
struct BodyVelocity {
  Vector<Real, Dim> v{};
  Spin<Real, Dim> spin{};
};

template <class Real>
[[nodiscard]] Spin<Real, 2> in_frame(const Matrix<Real, 2>&, const Spin<Real, 2>& spin) {
  return spin;
}
template <class Real>
[[nodiscard]] Spin<Real, 3> in_frame(const Matrix<Real, 3>& axes, const Spin<Real, 3>& spin) {
  return transposed_times(axes, spin);
}
/// Of two velocities of a body that moves: a . M b, where it is now. Twice the energy for a = b.
template <class Real, int Dim>
[[nodiscard]] Real kinetic_product(const RigidBody<Real, Dim>& body, const BodyVelocity<Real, Dim>& a,
                                   const BodyVelocity<Real, Dim>& b) {
  return dot(a.v, b.v) / body.inverse_mass +
         dot(in_frame(body.axes, a.spin), body.inertia * in_frame(body.axes, b.spin));
}
template <class Real, int Dim>
[[nodiscard]] Real spin_energy(const RigidBody<Real, Dim>& body) {
  const BodyVelocity<Real, Dim> turning{{}, body.spin};
  return kinetic_product(body, turning, turning) / 2;
}
/// Twice the kinetic energy of bodies, where they are now, whose velocities change: at_start + 2 s along + s^2
/// of_change after a part s of the change, which has the same momentum for any s where impulses between the bodies made
/// it.
template <class Real>
struct EnergyOfChange {
  Real at_start{}, along{}, of_change{};

  template <int Dim>
  void add(const RigidBody<Real, Dim>& body, const BodyVelocity<Real, Dim>& before) {
    const BodyVelocity<Real, Dim> change{body.v - before.v, body.spin - before.spin};
    at_start += kinetic_product(body, before, before);
    along += kinetic_product(body, before, change), of_change += kinetic_product(body, change, change);
  }
  [[nodiscard]] Real at(const Real& part) const { return at_start + part * (2 * along + part * of_change); }
  /// The largest part, up to 1, that ends with at most `most`; where none does, that which ends with the least.
  [[nodiscard]] Real part_within(const Real& most) const {
    return at(Real(1)) > most ? std::min(part_to(most), Real(1)) : Real(1);
  }
  /// The part, from 0 to 2, that ends with `wanted`, or as near to it as can be.
  [[nodiscard]] Real part_to(const Real& wanted) const {
    if (!(of_change > Real(0))) return Real(1);
    const Real square = along * along + of_change * (wanted - at_start);
    const Real root = square > Real(0) ? std::sqrt(square) : Real(0);
    return std::clamp((root - along) / of_change, Real(0), Real(2));
  }
};
/// Leaves a part of the change of the velocities of a body.
template <class Real, int Dim>
void take_part(RigidBody<Real, Dim>& body, const BodyVelocity<Real, Dim>& before, const Real& part) {
  body.v = before.v + (body.v - before.v) * part;
  body.spin = before.spin + (body.spin - before.spin) * part;
}

}  // namespace continuo
