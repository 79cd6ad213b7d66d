// How a body turns without torques, at any rate and of any shape: by rotations about its angular momentum and about its
// principal axes one after the other, each of which is a part of Euler's equations and exact for itself (A. Dullweber,
// B. Leimkuhler, R. McLachlan, J. Chem. Phys. 107, 1997). The angular momentum stays the same to rounding. What has two
// equal moments of inertia, as capsules, long or flat, turns exactly.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <continuo/bodies/rigid_stepping/rigid_body.hpp>

namespace continuo {

/// Axes in the frame of the shape about which the moment of inertia is diagonal, with the middle moment first, and then
/// the one that differs from it more by its inverse.
template <class Real, int Dim>
struct PrincipalAxes {
  Matrix<Real, 3> axes = identity_matrix<Real, 3>();
  std::array<Real, 3> inverse_moments{};
};

/// Turns two axes so that the moment between them vanishes (C. G. J. Jacobi, 1846).
template <class Real>
void diagonalize(Matrix<Real, 3>& inertia, Matrix<Real, 3>& axes, std::size_t p, std::size_t q) {
  if (inertia[p][q] == Real(0)) return;
  const Real ratio = (inertia[q][q] - inertia[p][p]) / (2 * inertia[p][q]);
  const Real tangent = std::copysign(1 / (std::abs(ratio) + std::sqrt(1 + ratio * ratio)), ratio);
  const Real cosine = 1 / std::sqrt(1 + tangent * tangent), sine = tangent * cosine;
  const auto turn = [&](Matrix<Real, 3>& columns) {
    const Vector<Real, 3> first = columns[p], second = columns[q];
    columns[p] = first * cosine - second * sine, columns[q] = first * sine + second * cosine;
  };
  turn(axes), turn(inertia);
  inertia = transposed(inertia);
  turn(inertia);
  inertia[p][q] = inertia[q][p] = Real(0);
}
template <class Real>
[[nodiscard]] PrincipalAxes<Real, 3> principal_axes(Matrix<Real, 3> inertia) {
  PrincipalAxes<Real, 3> principal;
  const Real least = std::numeric_limits<Real>::epsilon() * std::min({inertia[0][0], inertia[1][1], inertia[2][2]});
  for (int sweep = 0; sweep < 10; ++sweep) {
    if (std::max({std::abs(inertia[0][1]), std::abs(inertia[1][2]), std::abs(inertia[2][0])}) <= least) break;
    diagonalize(inertia, principal.axes, 0, 1), diagonalize(inertia, principal.axes, 1, 2);
    diagonalize(inertia, principal.axes, 0, 2);
  }
  std::array<std::pair<Real, std::size_t>, 3> order;
  for (std::size_t i = 0; i < 3; ++i) order[i] = {1 / inertia[i][i], i};
  std::ranges::sort(order);
  std::swap(order[0], order[1]);
  if (order[2].first - order[0].first > order[0].first - order[1].first) std::swap(order[1], order[2]);
  const Matrix<Real, 3> axes = principal.axes;
  for (std::size_t i = 0; i < 3; ++i)
    principal.inverse_moments[i] = order[i].first, principal.axes[i] = axes[order[i].second];
  return principal;
}
template <class Real>
[[nodiscard]] PrincipalAxes<Real, 2> principal_axes(const Matrix<Real, 1>&) {
  return {};
}

/// Moves a body for h without forces.
template <class Real>
void move_freely(RigidBody<Real, 2>& body, const PrincipalAxes<Real, 2>&, const Real& h) {
  body.move(h);
  body.update_axes();
}
template <class Real>
void move_freely(RigidBody<Real, 3>& body, const PrincipalAxes<Real, 3>& own, const Real& h) {
  if (body.is_ball) {
    body.move(h);
    return body.update_axes();
  }
  body.x += body.v * h, body.moved += body.v * h;
  const Vector<Real, 3> momentum = body.axes * (body.inertia * transposed_times(body.axes, body.spin));
  const auto turn = [&](std::size_t i, const Real& duration) {
    const Real rate = own.inverse_moments[i] - own.inverse_moments[0];
    if (std::abs(rate) <= 16 * std::numeric_limits<Real>::epsilon() * own.inverse_moments[0]) return;
    const Vector<Real, 3> axis = rotation(body.orientation) * own.axes[i];
    body.orientation = turned(body.orientation, Vector<Real, 3>(axis * (rate * dot(axis, momentum))), duration);
  };
  turn(2, h / 2), turn(1, h), turn(2, h / 2);
  body.orientation = turned(body.orientation, Vector<Real, 3>(momentum * own.inverse_moments[0]), h);
  body.update_axes();
  body.spin = body.inverse_inertia_now * momentum;
}

}  // namespace continuo
