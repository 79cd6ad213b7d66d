// A body as the exact motion of rigid bodies sees it at an instant. What is integrated is the angular momentum in the
// world, which stays the same to the last bit where nothing turns the body; the spin follows from it.
#pragma once
#include <cstddef>
#include <optional>

#include <continuo/bodies/rigid_stepping/rigid_body.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

template <class Real, int Dim>
struct ExactBody {
  Vector<Real, Dim> x{}, v{};  // of the centre of mass
  Orientation<Real, Dim> orientation = upright<Real, Dim>();
  Spin<Real, Dim> spin{}, momentum{};                     // of a body that never moves, the momentum is 0
  Matrix<Real, Dim> axes = identity_matrix<Real, Dim>();  // of the orientation
  Inertia<Real, Dim> inverse_inertia_now{};               // in the world
  std::optional<Real> energy{};                           // twice that of rotation, kept while nothing turns the body
  Real inverse_mass{};                                    // 0: never moved by what it meets
  Inertia<Real, Dim> inertia{}, inverse_inertia{};  // in the frame of the shape; the inverse of what never moves: 0

  [[nodiscard]] bool is_fixed() const { return inverse_mass == Real(0); }
  [[nodiscard]] Pose<Real, Dim> pose() const { return {x, axes}; }
  /// The velocity of the point of the body that is at `place` in the world.
  [[nodiscard]] Vector<Real, Dim> velocity_at(const Vector<Real, Dim>& place) const {
    return v + turning(spin, Vector<Real, Dim>(place - x));
  }
  /// After the orientation has changed: the spin by the momentum.
  void turn_with_momentum() {
    axes = rotation(orientation);
    if (is_fixed()) return;
    inverse_inertia_now = turned_inertia(axes, inverse_inertia);
    spin = inverse_inertia_now * momentum;
  }
  /// After orientation and spin have changed: the momentum by the spin.
  void turn_with_spin() {
    axes = rotation(orientation);
    if (is_fixed()) return;
    inverse_inertia_now = turned_inertia(axes, inverse_inertia);
    momentum = turned_inertia(axes, inertia) * spin;
  }
  /// Applies an impulse.
  void push(const Vector<Real, Dim>& impulse, const Spin<Real, Dim>& twist) {
    v += impulse * inverse_mass;
    if (is_fixed()) return;
    momentum += twist;
    energy.reset();
    spin += inverse_inertia_now * twist;
  }
};

/// The change of the spin by the turning body itself, without torques: I^-1 (L x w).
template <class Real>
[[nodiscard]] Vector<Real, 1> free_turning(const ExactBody<Real, 2>&) {
  return {};
}
template <class Real>
[[nodiscard]] Vector<Real, 3> free_turning(const ExactBody<Real, 3>& body) {
  return body.inverse_inertia_now * moment(body.momentum, body.spin);
}

/// Body i of a world, as it is there. A fixed body that is not driven has no velocity.
template <class Real, int Dim>
[[nodiscard]] ExactBody<Real, Dim> exact_body(const World<Real, Dim>& world, std::size_t i) {
  ExactBody<Real, Dim> body{.x = world.position[i], .v = world.velocity[i], .orientation = world.orientation[i]};
  body.spin = world.spin[i];
  body.inverse_mass = world.inverse_mass[i];
  body.inertia = world.inertia(i);
  if (!body.is_fixed()) {
    body.inverse_inertia = inverse(body.inertia);
  } else if (!world.traits(i).is_driven) {
    body.v = {}, body.spin = {};
  }
  body.orientation = turned(body.orientation, Spin<Real, Dim>{}, Real(0));  // of length 1
  body.turn_with_spin();
  return body;
}

}  // namespace continuo
