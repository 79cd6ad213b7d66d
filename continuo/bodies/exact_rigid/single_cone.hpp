// The force of one contact in space with Coulomb friction, with all other forces given.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>

#include <continuo/numerics/root_bracketing.hpp>

namespace continuo {

/// What a contact does: it parts, holds without slip, or slips with friction against the slip.
enum class ConeMode : std::uint8_t { open, sticks, slips };

/// A contact with Coulomb's friction, and the direction of its slip where it slips already: then it cannot stick.
template <class Real>
struct ConeContact {
  Real friction{};
  std::optional<std::array<Real, 2>> slip{};  // of length 1, by the tangents
};

/// The force along the normal and both tangents.
template <class Real>
struct ConeForce {
  std::array<Real, 3> force{};
  ConeMode mode = ConeMode::open;
};

/// The normal force f of a contact that slips along `slip` with friction against it, so that the rate along the normal
/// is 0, with the rates across that follow. `response` row by row; rates along the normal and both tangents.
template <class Real>
struct SlidingForce {
  Real normal{};
  std::array<Real, 2> across{};  // rates
  bool presses = false;          // false where friction jams the contact, or nothing presses it

  SlidingForce(const std::array<std::array<Real, 3>, 3>& response, const std::array<Real, 3>& rate,
               const Real& friction, const std::array<Real, 2>& slip) {
    const auto change = [&](std::size_t row) {
      return response[row][0] - friction * (response[row][1] * slip[0] + response[row][2] * slip[1]);
    };
    if (!(change(0) > Real(0))) return;
    normal = -rate[0] / change(0);
    presses = normal >= Real(0);
    across = {rate[1] + change(1) * normal, rate[2] + change(2) * normal};
  }
};

/// The direction in which a contact begins to slip: with friction against it, the rates across are along it. Of a
/// friction that turns the slip there, not away from it, as Coulomb's law would for any small slip. Nothing where there
/// is none.
template <class Real>
[[nodiscard]] std::optional<Real> direction_of_slip(const std::array<std::array<Real, 3>, 3>& response,
                                                    const std::array<Real, 3>& rate, const Real& friction) {
  constexpr int samples = 32;  // the equation is one of fourth degree in the tangent of half the angle
  const auto aside = [&](const Real& angle) -> std::optional<Real> {
    const std::array<Real, 2> slip{std::cos(angle), std::sin(angle)};
    const SlidingForce<Real> force(response, rate, friction, slip);
    if (!force.presses) return {};
    return slip[0] * force.across[1] - slip[1] * force.across[0];
  };
  const auto along = [&](const Real& angle) {
    const std::array<Real, 2> slip{std::cos(angle), std::sin(angle)};
    const SlidingForce<Real> force(response, rate, friction, slip);
    return slip[0] * force.across[0] + slip[1] * force.across[1];
  };
  std::optional<Real> best;
  Real before(0);
  std::optional<Real> value_before = aside(before);
  for (int sample = 1; sample <= samples; ++sample) {
    const Real angle = 2 * std::numbers::pi_v<Real> * static_cast<Real>(sample) / samples;
    const std::optional<Real> value = aside(angle);
    if (value && value_before && *value_before > Real(0) && *value <= Real(0)) {
      const Real root = enclose_root<Real>([&](const Real& at) { return -aside(at).value_or(Real(0)); }, before, angle,
                                           -*value_before, -*value)
                            .far;
      if (along(root) >= Real(0) && (!best || along(root) > along(*best))) best = root;
    }
    before = angle, value_before = value;
  }
  return best;
}

/// The force of the contact; it parts where it can. Nothing where no force belongs to the rates.
template <class Real>
[[nodiscard]] std::optional<ConeForce<Real>> single_cone(const std::array<std::array<Real, 3>, 3>& response,
                                                         const std::array<Real, 3>& rate,
                                                         const ConeContact<Real>& contact) {
  if (rate[0] >= Real(0)) return ConeForce<Real>{};
  const auto sliding = [&](const std::array<Real, 2>& slip) -> std::optional<ConeForce<Real>> {
    const SlidingForce<Real> force(response, rate, contact.friction, slip);
    if (!force.presses) return {};
    const Real across = -contact.friction * force.normal;
    return ConeForce<Real>{{force.normal, across * slip[0], across * slip[1]}, ConeMode::slips};
  };
  if (!(contact.friction > Real(0))) return sliding({Real(1), Real(0)});
  if (contact.slip) return sliding(*contact.slip);
  // Cramer's rule.
  const auto& w = response;
  const auto minor = [&](std::size_t i, std::size_t j) {
    const std::size_t r = (i + 1) % 3, s = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
    return w[r][c] * w[s][d] - w[r][d] * w[s][c];
  };
  const Real whole = w[0][0] * minor(0, 0) + w[0][1] * minor(0, 1) + w[0][2] * minor(0, 2);
  if (whole > Real(0)) {
    ConeForce<Real> held{{}, ConeMode::sticks};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) held.force[i] -= minor(j, i) / whole * rate[j];
    if (std::hypot(held.force[1], held.force[2]) <= contact.friction * held.force[0]) return held;
  }
  const auto angle = direction_of_slip(response, rate, contact.friction);
  if (!angle) return {};
  return sliding({std::cos(*angle), std::sin(*angle)});
}

}  // namespace continuo
