// continuo/shapes/matrix.hpp
// Square matrices of two and three dimensions, and the pose of a body: where its centre is, and how it is turned.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>

#include <continuo/numerics/vector.hpp>

namespace continuo {

/// A matrix by its columns: column j is the image of axis j.
template <class Real, int Dim>
struct Matrix {
  std::array<Vector<Real, Dim>, static_cast<std::size_t>(Dim)> columns{};  // 0 at first

  /// Column j.
  /// @{
  constexpr Vector<Real, Dim>& operator[](std::size_t j) { return columns[j]; }
  constexpr const Vector<Real, Dim>& operator[](std::size_t j) const { return columns[j]; }
  /// @}

  /// Sums, multiples and products.
  /// @{
  constexpr Matrix& operator+=(const Matrix& b) {
    for (std::size_t j = 0; j < columns.size(); ++j) columns[j] += b[j];
    return *this;
  }
  constexpr Matrix& operator*=(const Real& factor) {
    for (Vector<Real, Dim>& column : columns) column *= factor;
    return *this;
  }
  friend constexpr Matrix operator+(Matrix a, const Matrix& b) { return a += b; }
  friend constexpr Matrix operator*(Matrix a, const Real& factor) { return a *= factor; }
  friend constexpr Vector<Real, Dim> operator*(const Matrix& a, const Vector<Real, Dim>& x) {
    Vector<Real, Dim> sum = a[0] * x[0];
    for (std::size_t j = 1; j < a.columns.size(); ++j) sum += a[j] * x[j];
    return sum;
  }
  friend constexpr Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix product;
    for (std::size_t j = 0; j < b.columns.size(); ++j) product[j] = a * b[j];
    return product;
  }
  /// @}
  /// Whether all entries are equal.
  friend constexpr bool operator==(const Matrix&, const Matrix&) = default;
};

/// The identity.
template <class Real, int Dim>
[[nodiscard]] constexpr Matrix<Real, Dim> identity_matrix() {
  Matrix<Real, Dim> one;
  for (std::size_t j = 0; j < one.columns.size(); ++j) one[j][j] = Real(1);
  return one;
}
/// a b^T.
template <class Real, int Dim>
[[nodiscard]] constexpr Matrix<Real, Dim> outer(const Vector<Real, Dim>& a, const Vector<Real, Dim>& b) {
  Matrix<Real, Dim> product;
  for (std::size_t j = 0; j < b.size(); ++j) product[j] = a * b[j];
  return product;
}
/// a^T.
template <class Real, int Dim>
[[nodiscard]] constexpr Matrix<Real, Dim> transposed(const Matrix<Real, Dim>& a) {
  Matrix<Real, Dim> result;
  for (std::size_t i = 0; i < a.columns.size(); ++i)
    for (std::size_t j = 0; j < a.columns.size(); ++j) result[i][j] = a[j][i];
  return result;
}
/// a^T x, without the transposed matrix.
template <class Real, int Dim>
[[nodiscard]] constexpr Vector<Real, Dim> transposed_times(const Matrix<Real, Dim>& a, const Vector<Real, Dim>& x) {
  Vector<Real, Dim> result;
  for (std::size_t j = 0; j < x.size(); ++j) result[j] = dot(a[j], x);
  return result;
}

/// The rotation by an angle.
template <class Real>
[[nodiscard]] Matrix<Real, 2> rotation(const Vector<Real, 1>& angle) {
  using std::cos, std::sin;
  const Real c = cos(angle[0]), s = sin(angle[0]);
  return {{{{{c, s}}, {{-s, c}}}}};
}
/// The rotation by a unit quaternion (w, x, y, z).
template <class Real>
[[nodiscard]] constexpr Matrix<Real, 3> rotation(const Vector<Real, 4>& q) {
  const Real xx = 2 * q[1] * q[1], yy = 2 * q[2] * q[2], zz = 2 * q[3] * q[3];
  const Real xy = 2 * q[1] * q[2], yz = 2 * q[2] * q[3], zx = 2 * q[3] * q[1];
  const Real wx = 2 * q[0] * q[1], wy = 2 * q[0] * q[2], wz = 2 * q[0] * q[3];
  return {{{{{1 - yy - zz, xy + wz, zx - wy}}, {{xy - wz, 1 - zz - xx, yz + wx}}, {{zx + wy, yz - wx, 1 - xx - yy}}}}};
}

/// Where a body is: its centre, and the images of the axes of its frame.
template <class Real, int Dim>
struct Pose {
  Vector<Real, Dim> centre{};                             // the place of the origin of its frame
  Matrix<Real, Dim> axes = identity_matrix<Real, Dim>();  // the images of the axes

  /// The place in the world of a point of the body's frame.
  [[nodiscard]] constexpr Vector<Real, Dim> place(const Vector<Real, Dim>& point) const {
    return centre + axes * point;
  }
  /// The point of the body's frame that is at x.
  [[nodiscard]] constexpr Vector<Real, Dim> local(const Vector<Real, Dim>& x) const {
    return transposed_times(axes, x - centre);
  }
  /// A direction of the world in the body's frame.
  [[nodiscard]] constexpr Vector<Real, Dim> local_direction(const Vector<Real, Dim>& x) const {
    return transposed_times(axes, x);
  }
};

/// The pose of b as seen from a.
template <class Real, int Dim>
[[nodiscard]] constexpr Pose<Real, Dim> relative(const Pose<Real, Dim>& a, const Pose<Real, Dim>& b) {
  return {a.local(b.centre), transposed(a.axes) * b.axes};
}

}  // namespace continuo
