// How the contacts of a substep are solved: a contact as a spring and a damper, solved implicitly over the substep,
// which is stable at any stiffness. E. Catto, "Soft constraints" (GDC 2011) and "Solver2D" (2024), from where the names
// are.
//
// With the overlap -s and the normal velocity v = s', a mass m between the two, the angular frequency w and the damping
// ratio z, the impulse of implicit Euler over h is
//
//   lambda = -m h (w^2 (s + h v1) + 2 z w v1),   v1 = v + lambda / m.
//
// Solved for lambda, where lambda_so_far has acted already and v is the velocity after it,
//
//   lambda - lambda_so_far = -m (v + rate s) of_mass - of_impulse lambda_so_far,
//   a1 = 2 z + h w,  a2 = h w a1,  rate = w / a1,  of_mass = a2 / (1 + a2),  of_impulse = 1 / (1 + a2).
#pragma once
#include <cstdint>
#include <numbers>

namespace continuo {

template <class Real>
struct Softness {
  Real rate = Real(0), of_mass = Real(1), of_impulse = Real(0);
};

/// `hertz` the frequency of the contact, `damping` its ratio z, `h` the substep.
template <class Real>
[[nodiscard]] Softness<Real> softness(const Real& hertz, const Real& damping, const Real& h) {
  const Real w = 2 * std::numbers::pi_v<Real> * hertz, a1 = 2 * damping + h * w, a2 = h * w * a1;
  return {w / a1, a2 / (1 + a2), 1 / (1 + a2)};
}

/// A sweep corrects a contact by this multiple of what would solve it alone (successive over-relaxation: D. M. Young,
/// 1954; with impulses that only push, O. L. Mangasarian, 1977, for factors below 2). With 1, one sweep in a substep
/// lets a tall column at a third of the rate of substeps vibrate for ever: the map of a substep, linear while all
/// contacts press, has for 80 balls an eigenvalue of 1.0004, with 1.4 of 0.997, and for 20 of 0.996 and 0.986. What it
/// multiplies is taken out again when contacts relax, so that no lasting velocity comes of it.
template <class Real>
constexpr Real over_relaxation = Real(1.4);

template <class Real>
[[nodiscard]] Softness<Real> over_relaxed(const Softness<Real>& soft) {
  return {soft.rate, soft.of_mass * over_relaxation<Real>, soft.of_impulse * over_relaxation<Real>};
}

template <class Real>
struct ContactStep {
  Real h{};
  Softness<Real> soft{};
  Real fastest_push{};           // greatest speed at which an overlap is undone
  bool may_strike = false;       // impacts are located in this substep, see restitution.hpp
  Real greatest_acceleration{};  // by forces, where impacts are located
  Real friction{};               // where all have the same
  Real disturbance{};            // a change of velocity beyond this way per substep disturbs a body,
  Real disturbance_of_radius{};  // and beyond this part of the larger radius
  std::uint8_t sweep = 1;        // number of a pushing sweep; those after the first solve only disturbed contacts
};

/// push undoes overlaps, push_again does so again for disturbed contacts, and relax removes the velocity that this
/// gave.
enum class ContactPass { push, push_again, relax };

/// The kinds of contacts: b is a moving body, a fixed body, or a wall, whose normal is constant.
enum class ContactKind { between_movers, with_fixed, with_wall };

}  // namespace continuo
