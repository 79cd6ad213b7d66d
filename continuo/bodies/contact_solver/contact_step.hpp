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

template <class Real>
struct ContactStep {
  Real h{};
  Softness<Real> soft{};
  Real fastest_push{};           // with which an overlap is undone at most
  bool may_strike = false;       // impacts are located in this substep: restitution.hpp leaves them their contacts
  Real greatest_acceleration{};  // by forces, where impacts are located
  Real friction{};               // where all have the same
  Real disturbance{};            // a change of velocity is one that makes so long a way in a substep
  std::uint8_t sweep = 1;        // of those that push; after the first only what was disturbed is pushed again
};

/// Undo overlaps; do so again where neighbours disturbed it; take out the velocity that this gave.
enum class ContactPass { push, push_again, relax };

/// What a contact may do: b a body that moves, one that is fixed, or a wall, whose normal stands.
enum class ContactKind { between_movers, with_fixed, with_wall };

}  // namespace continuo
