// A rigid body as the solver of contacts and joints sees it.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <continuo/shapes/convex.hpp>
#include <continuo/shapes/matrix.hpp>
#include <continuo/shapes/turned_inertia.hpp>

namespace continuo {

template <class Real, int Dim>
struct RigidBody {
  Vector<Real, Dim> x{}, v{};                                        // of the centre of mass
  Spin<Real, Dim> spin{};                                            // the angular velocity
  Orientation<Real, Dim> orientation = upright<Real, Dim>();         // of the frame of the shape
  Matrix<Real, Dim> axes = identity_matrix<Real, Dim>();             // the same, as a rotation
  Vector<Real, Dim> moved{};                                         // of the centre since the step began
  Vector<Real, Dim> x_before{};                                      // when the step began
  Orientation<Real, Dim> orientation_before = upright<Real, Dim>();  // then
  Spin<Real, Dim> lag{};                            // of the spin that turns the body behind `spin`, see turn_freely
  Real inverse_mass{};                              // 0: never moves
  bool is_ball = false;                             // the same moment of inertia about all axes
  Inertia<Real, Dim> inertia{}, inverse_inertia{};  // in the frame of the shape
  Inertia<Real, Dim> inverse_inertia_now{};         // in the world

  Inertia<Real, Dim> stiffening{};  // by forces of joints, see add_stiffening

  [[nodiscard]] bool is_fixed() const { return inverse_mass == Real(0); }
  [[nodiscard]] Pose<Real, Dim> pose() const { return {x, axes}; }
  [[nodiscard]] Vector<Real, Dim> velocity_at(const Vector<Real, Dim>& arm) const { return v + turning(spin, arm); }

  /// After the orientation has changed.
  void update_axes() {
    axes = rotation(orientation);
    inverse_inertia_now = is_ball ? inverse_inertia : turned_inertia(axes, inverse_inertia);
  }
  void move(const Real& h) {
    x += v * h;
    moved += v * h;
    orientation = turned(orientation, Spin<Real, Dim>(spin + lag), h);
  }
};

/// The numbers of a moment of inertia, which is symmetric, in the order in which lanes have them (manifold_layout.hpp).
template <class Real>
[[nodiscard]] std::array<Real, 1> lane_numbers(const Matrix<Real, 1>& inertia) {
  return {inertia[0][0]};
}
template <class Real>
[[nodiscard]] std::array<Real, 6> lane_numbers(const Matrix<Real, 3>& i) {
  return {i[0][0], i[1][1], i[2][2], i[0][1], i[1][2], i[2][0]};
}

/// The inverse of a moment of inertia, which is symmetric and positive definite.
template <class Real>
[[nodiscard]] Matrix<Real, 1> inverse(const Matrix<Real, 1>& a) {
  return {{{{{1 / a[0][0]}}}}};
}
template <class Real>
[[nodiscard]] Matrix<Real, 3> inverse(const Matrix<Real, 3>& whole) {
  // The determinant of the moment of inertia of a small part, or that of the inverse, is not among the numbers of
  // single precision. A power of two changes no digit.
  int exponent = 0;
  static_cast<void>(std::frexp(std::max({whole[0][0], whole[1][1], whole[2][2]}), &exponent));
  const Real unit = std::ldexp(Real(1), -exponent);
  const Matrix<Real, 3> a = whole * unit;
  const Vector<Real, 3> x = moment(a[1], a[2]), y = moment(a[2], a[0]), z = moment(a[0], a[1]);
  return transposed(Matrix<Real, 3>{{{x, y, z}}}) * (unit / dot(a[0], x));
}

/// Whether a moment of inertia is the same about all axes, up to rounding: such a body turns at a constant spin.
template <class Real>
[[nodiscard]] bool is_isotropic(const Matrix<Real, 1>&) {
  return true;
}
template <class Real>
[[nodiscard]] bool is_isotropic(const Matrix<Real, 3>& inertia) {
  const Real most = 16 * std::numeric_limits<Real>::epsilon() * inertia[0][0];
  return std::abs(inertia[1][1] - inertia[0][0]) <= most && std::abs(inertia[2][2] - inertia[0][0]) <= most &&
         std::abs(inertia[0][1]) <= most && std::abs(inertia[1][2]) <= most && std::abs(inertia[2][0]) <= most;
}

/// The spin of a body of space after h without torques, by the midpoint rule: its angular momentum L stays the same to
/// rounding, so that w = I^-1 L remains bounded whatever h. The body is to be turned with the spin in the middle of h,
/// which is behind that at the end by `lag`. Where a slender body turns so fast that the rule does not converge, its
/// energy would grow: there the spin stays as it is, and so do energy and spin in the frame of the body.
template <class Real>
void turn_freely(RigidBody<Real, 3>& body, const Real& h) {
  body.lag = {};
  if (body.is_ball) return;
  const Vector<Real, 3> momentum = body.axes * (body.inertia * transposed_times(body.axes, body.spin));
  const auto spin_at = [&](const Vector<Real, 3>& spin, const Real& duration) {
    const Matrix<Real, 3> axes = rotation(turned(body.orientation, spin, duration));
    return axes * (body.inverse_inertia * transposed_times(axes, momentum));
  };
  Vector<Real, 3> middle = spin_at(body.spin, h / 2);
  middle = spin_at(middle, h / 2);
  const Vector<Real, 3> end = spin_at(middle, h);
  const Real energy = dot(momentum, body.spin);
  if (dot(momentum, middle) > energy * Real(1.1) || dot(momentum, end) > energy * Real(1.01)) return;
  body.spin = end;
  body.lag = middle - end;
}
template <class Real>
void turn_freely(RigidBody<Real, 2>&, const Real&) {}

}  // namespace continuo
