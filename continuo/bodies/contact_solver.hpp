// continuo/bodies/contact_solver.hpp
// One contact of two spheres, or of a sphere and a wall, as a soft constraint on velocities: E. Catto, "Soft
// constraints" (GDC 2011) and "Solver2D" (2024), sequential impulses with bias, relaxation and warm starting.
//
// With s the separation and v the normal velocity, a substep of h wants v = -s / h where the two are apart (they may
// close the gap and no more), and where they overlap the impulse of a spring of angular frequency w and damping ratio
// z,
//
//   lambda = -m (v + rate s) scale_of_mass - scale_of_impulse lambda_so_far,
//   a1 = 2 z + h w, a2 = h w a1, rate = w / a1, scale_of_mass = a2 / (1 + a2), scale_of_impulse = 1 / (1 + a2),
//
// which is stable at any stiffness. Between spheres the arms lie along the normal: a normal impulse turns nothing, and
// what resists across the normal is a number, 1/m1 + 1/m2 + r1^2/J1 + r2^2/J2.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <continuo/bodies/contact_list.hpp>

namespace continuo {

template <class Real>
struct Softness {
  Real rate = Real(0), of_mass = Real(1), of_impulse = Real(0);
};

/// `hertz` the frequency of the contact, `damping` its ratio z, `h` the substep.
template <class Real>
Softness<Real> softness(const Real& hertz, const Real& damping, const Real& h) {
  const Real w = 2 * std::numbers::pi_v<Real> * hertz, a1 = 2 * damping + h * w, a2 = h * w * a1;
  return {w / a1, a2 / (1 + a2), 1 / (1 + a2)};
}

/// How the contacts of a substep are solved.
template <class Real>
struct ContactStep {
  Real h{};
  Softness<Real> soft{};
  Real fastest_push{};    // with which an overlap is undone at most
  bool with_bias = true;  // false: relaxation, which takes out the velocity that undoing an overlap gave
};

/// The velocities of two that touch, in registers while impulses are added.
template <class Real, int Dim>
struct PairVelocities {
  Vector<Real, Dim> v_a, v_b;
  Spin<Real, Dim> spin_a, spin_b;

  [[gnu::always_inline]] void store(SolverBody<Real, Dim>& a, SolverBody<Real, Dim>& b) const {
    a.v = v_a;
    a.spin = spin_a;
    b.v = v_b;
    b.spin = spin_b;
  }
  [[gnu::always_inline]] void push(const SolverBody<Real, Dim>& a, const SolverBody<Real, Dim>& b,
                                   const Vector<Real, Dim>& impulse) {
    v_a -= impulse * a.inverse_mass;
    v_b += impulse * b.inverse_mass;
  }
  /// An impulse on b where it touches, its opposite on a.
  [[gnu::always_inline]] void rub(const SolverBody<Real, Dim>& a, const SolverBody<Real, Dim>& b,
                                  const Vector<Real, Dim>& normal, const Vector<Real, Dim>& impulse) {
    push(a, b, impulse);
    const Spin<Real, Dim> twist = moment(normal, impulse);
    spin_a -= twist * (a.radius * a.inverse_inertia);
    spin_b -= twist * (b.radius * b.inverse_inertia);
  }
  [[gnu::always_inline]] void roll(const SolverBody<Real, Dim>& a, const SolverBody<Real, Dim>& b,
                                   const Spin<Real, Dim>& impulse) {
    spin_a -= impulse * a.inverse_inertia;
    spin_b += impulse * b.inverse_inertia;
  }
};

/// `impulse` no longer than `most`.
template <class Real, int Size>
Vector<Real, Size> clamped(const Vector<Real, Size>& impulse, const Real& most) {
  using std::sqrt;
  const Real square = squared(impulse);
  return square > most * most ? impulse * (most / sqrt(square)) : impulse;
}

/// Begins with the impulses of the last substep: all contacts do before any is solved, for each must see what the
/// others carry. b is the wall's stand-in, at rest, where there is one. `normal` points from a to b.
template <class Real, int Dim>
[[gnu::always_inline]] inline void warm_start(Contact<Real, Dim>& contact, SolverBody<Real, Dim>& a,
                                              SolverBody<Real, Dim>& b, const Vector<Real, Dim>& normal) {
  PairVelocities<Real, Dim> pair{a.v, b.v, a.spin, b.spin};
  // What friction did along the normal of then is not along that of now.
  contact.friction_impulse -= normal * dot(contact.friction_impulse, normal);
  pair.push(a, b, normal * contact.normal_impulse);
  pair.rub(a, b, normal, contact.friction_impulse);
  if (contact.rolling_resistance > Real(0)) pair.roll(a, b, contact.rolling_impulse);
  pair.store(a, b);
}

template <class Real, int Dim>
[[gnu::always_inline]] inline void solve_contact(Contact<Real, Dim>& contact, SolverBody<Real, Dim>& a,
                                                 SolverBody<Real, Dim>& b, const Vector<Real, Dim>& normal,
                                                 const Real& separation, const ContactStep<Real>& step) {
  PairVelocities<Real, Dim> pair{a.v, b.v, a.spin, b.spin};
  if (contact.rolling_resistance > Real(0)) {
    const Real inertia = 1 / (a.inverse_inertia + b.inverse_inertia);
    const Spin<Real, Dim> before = contact.rolling_impulse;
    const Real radius = b.radius > Real(0) ? std::min(a.radius, b.radius) : a.radius;
    contact.rolling_impulse = clamped(Spin<Real, Dim>(before - (pair.spin_b - pair.spin_a) * inertia),
                                      Real(contact.rolling_resistance * radius * contact.normal_impulse));
    pair.roll(a, b, contact.rolling_impulse - before);
  }
  if (contact.friction > Real(0) && contact.normal_impulse > Real(0)) {
    const Vector<Real, Dim> rate =
        pair.v_b - turning(pair.spin_b, normal * b.radius) - pair.v_a - turning(pair.spin_a, normal * a.radius);
    const Vector<Real, Dim> slip = rate - normal * dot(rate, normal), before = contact.friction_impulse;
    contact.friction_impulse = clamped(Vector<Real, Dim>(before - slip * contact.tangent_mass),
                                       Real(contact.friction * contact.normal_impulse));
    pair.rub(a, b, normal, contact.friction_impulse - before);
  } else {
    contact.friction_impulse = {};
  }
  Softness<Real> soft{};
  Real bias(0);
  if (separation > Real(0)) {
    bias = separation / step.h;
  } else if (step.with_bias) {
    soft = step.soft;
    bias = std::max(Real(soft.rate * separation), Real(-step.fastest_push));
  }
  const Real speed = dot(pair.v_b - pair.v_a, normal), so_far = contact.normal_impulse;
  const Real wanted = so_far - contact.normal_mass * soft.of_mass * (speed + bias) - soft.of_impulse * so_far;
  contact.normal_impulse = std::max(wanted, Real(0));
  pair.push(a, b, normal * (contact.normal_impulse - so_far));
  pair.store(a, b);
}

}  // namespace continuo
