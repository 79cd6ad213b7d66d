// What lies across the normal of a contact in space: two directions, and the velocity with which b slips against a.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>

#include <continuo/bodies/exact_rigid/contact_feature.hpp>

namespace continuo {

/// Two directions across a normal and each other, with their changes in time. They do not change with the time alone,
/// but jump where another axis of the world is the one most across the normal.
template <class Real>
[[nodiscard]] std::array<Moving<Real, 3>, 2> tangents(const Moving<Real, 3>& normal) {
  using V = Vector<Real, 3>;
  std::size_t least = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (std::abs(normal.value[i]) < std::abs(normal.value[least])) least = i;
  V axis{};
  axis[least] = Real(1);
  const Moving<Real, 3> first = unit(Moving<Real, 3>{moment(axis, normal.value), moment(axis, normal.change)});
  return {first, Moving<Real, 3>{moment(normal.value, first.value),
                                 moment(normal.change, first.value) + moment(normal.value, first.change)}};
}
/// The rows along the tangents of a contact.
template <class Real>
[[nodiscard]] std::array<MotionRow<Real, 3>, 2> tangent_rows(const ContactPlace<Real, 3>& at,
                                                             const ExactBody<Real, 3>& a, const ExactBody<Real, 3>& b) {
  const auto along = tangents(at.normal);
  return {row_along(a, b, along[0], at.place), row_along(a, b, along[1], at.place)};
}
/// The velocity of b against a across the normal, where they touch.
template <class Real>
[[nodiscard]] Vector<Real, 3> slip_velocity(const ContactPlace<Real, 3>& at, const ExactBody<Real, 3>& a,
                                            const ExactBody<Real, 3>& b) {
  using V = Vector<Real, 3>;
  const V between = b.velocity_at(at.place.value) - a.velocity_at(at.place.value);
  return between - at.normal.value * dot(at.normal.value, between);
}

}  // namespace continuo
