// continuo/numerics/vector.hpp
// Vectors of two and three dimensions, spins and orientations. A spin is one number in the plane, three in space.
// Formulas that are valid in both dimensions are written once.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>

namespace continuo {

/// A vector of Size components.
template <class Real, int Size>
struct Vector {
  std::array<Real, static_cast<std::size_t>(Size)> components{};  // 0 at first

  /// Component i.
  /// @{
  constexpr Real& operator[](std::size_t i) { return components[i]; }
  constexpr const Real& operator[](std::size_t i) const { return components[i]; }
  /// @}
  /// The number of components.
  [[nodiscard]] static constexpr std::size_t size() { return static_cast<std::size_t>(Size); }

  /// Sums, differences and multiples, component by component.
  /// @{
  constexpr Vector& operator+=(const Vector& b) {
    for (std::size_t i = 0; i < size(); ++i) components[i] += b[i];
    return *this;
  }
  constexpr Vector& operator-=(const Vector& b) {
    for (std::size_t i = 0; i < size(); ++i) components[i] -= b[i];
    return *this;
  }
  constexpr Vector& operator*=(const Real& factor) {
    for (std::size_t i = 0; i < size(); ++i) components[i] *= factor;
    return *this;
  }
  friend constexpr Vector operator+(Vector a, const Vector& b) { return a += b; }
  friend constexpr Vector operator-(Vector a, const Vector& b) { return a -= b; }
  friend constexpr Vector operator-(Vector a) { return a *= Real(-1); }
  friend constexpr Vector operator*(Vector a, const Real& factor) { return a *= factor; }
  friend constexpr Vector operator*(const Real& factor, Vector a) { return a *= factor; }
  /// @}
  /// Whether all components are equal.
  friend constexpr bool operator==(const Vector&, const Vector&) = default;
};

/// The scalar product.
template <class Real, int Size>
[[nodiscard]] constexpr Real dot(const Vector<Real, Size>& a, const Vector<Real, Size>& b) {
  Real sum(0);
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}
/// The square of the length.
template <class Real, int Size>
[[nodiscard]] constexpr Real squared(const Vector<Real, Size>& a) {
  return dot(a, a);
}
/// The length.
template <class Real, int Size>
[[nodiscard]] Real length(const Vector<Real, Size>& a) {
  using std::abs, std::sqrt;
  if constexpr (Size == 1) return abs(a[0]);
  return sqrt(squared(a));
}
/// Whether all components are.
template <class Real, int Size>
[[nodiscard]] bool is_finite(const Vector<Real, Size>& a) {
  Real sum(0);
  for (std::size_t i = 0; i < a.size(); ++i) sum += Real(0) * a[i];
  return sum == Real(0);
}

/// An angular velocity, an angular momentum or a torque: one number about the axis out of the plane, or a vector in
/// space.
template <class Real, int Dim>
using Spin = Vector<Real, Dim == 2 ? 1 : 3>;

/// The velocity of a point at `arm` from the centre of a rotating body: spin x arm.
template <class Real>
[[nodiscard]] constexpr Vector<Real, 2> turning(const Vector<Real, 1>& spin, const Vector<Real, 2>& arm) {
  return {{-spin[0] * arm[1], spin[0] * arm[0]}};
}
/// Likewise in space: the cross product.
template <class Real>
[[nodiscard]] constexpr Vector<Real, 3> turning(const Vector<Real, 3>& a, const Vector<Real, 3>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
/// Moment of a force or impulse: arm x force.
template <class Real>
[[nodiscard]] constexpr Vector<Real, 1> moment(const Vector<Real, 2>& arm, const Vector<Real, 2>& force) {
  return {{arm[0] * force[1] - arm[1] * force[0]}};
}
/// Likewise in space: the cross product.
template <class Real>
[[nodiscard]] constexpr Vector<Real, 3> moment(const Vector<Real, 3>& arm, const Vector<Real, 3>& force) {
  return turning(arm, force);
}

/// An angle in the plane; a unit quaternion (w, x, y, z) in space.
template <class Real, int Dim>
using Orientation = Vector<Real, Dim == 2 ? 1 : 4>;

/// The orientation of a body that is not turned.
template <class Real, int Dim>
[[nodiscard]] constexpr Orientation<Real, Dim> upright() {
  if constexpr (Dim == 2) {
    return {};
  } else {
    return {{Real(1), Real(0), Real(0), Real(0)}};
  }
}

/// The orientation after `duration` at a constant spin: exact, by the exponential map.
template <class Real>
[[nodiscard]] Vector<Real, 1> turned(const Vector<Real, 1>& orientation, const Vector<Real, 1>& spin,
                                     const Real& duration) {
  return orientation + spin * duration;
}
/// Likewise of a quaternion.
template <class Real>
[[nodiscard]] Vector<Real, 4> turned(const Vector<Real, 4>& q, const Vector<Real, 3>& spin, const Real& duration) {
  using std::cos, std::sin;
  const Real rate = length(spin), half = rate * duration / 2;
  const Real along = rate > Real(0) ? Real(sin(half) / rate) : Real(0);
  const Vector<Real, 4> r{{cos(half), spin[0] * along, spin[1] * along, spin[2] * along}};
  Vector<Real, 4> product{
      {r[0] * q[0] - r[1] * q[1] - r[2] * q[2] - r[3] * q[3], r[0] * q[1] + r[1] * q[0] + r[2] * q[3] - r[3] * q[2],
       r[0] * q[2] - r[1] * q[3] + r[2] * q[0] + r[3] * q[1], r[0] * q[3] + r[1] * q[2] - r[2] * q[1] + r[3] * q[0]}};
  return product * (Real(1) / length(product));
}

}  // namespace continuo
