// continuo/bodies/body.hpp
// The definition of a body: shape (shapes/shape.hpp), initial state, mass and material, with defaults that make a ball.
#pragma once
#include <cstdint>
#include <numbers>
#include <optional>
#include <variant>

#include <continuo/numerics/vector.hpp>
#include <continuo/shapes/shape.hpp>

namespace continuo {

/// The contact parameters of a surface. The `CombineRule` of the world combines those of two surfaces in contact.
template <class Real>
struct Material {
  Real restitution = Real(0);         // e: speed of parting over speed of approach, 0 to 1
  Real friction = Real(0.5);          // Coulomb's: greatest tangential over normal impulse
  Real rolling_resistance = Real(0);  // torque over normal force, a length in units of the radius
  friend bool operator==(const Material&, const Material&) = default;
};

/// How the value for a contact follows from the values of its two surfaces.
enum class Combine : std::uint8_t { average, minimum, maximum, product, geometric_mean };

/// The rules that combine the materials of two surfaces. By default: the geometric mean of the frictions (one
/// frictionless surface makes a frictionless contact), the greater restitution (a ball that bounces does so on any
/// floor) and the greater rolling resistance, as in Box2D and most engines.
struct CombineRule {
  Combine restitution = Combine::maximum;         // of Material::restitution
  Combine friction = Combine::geometric_mean;     // of Material::friction
  Combine rolling_resistance = Combine::maximum;  // of Material::rolling_resistance
  friend bool operator==(const CombineRule&, const CombineRule&) = default;
};

/// The value for a contact, from the values a and b of its two surfaces; for materials, each parameter by its own rule.
template <class Real>
[[nodiscard]] Real combined(Combine how, const Real& a, const Real& b) {
  using std::sqrt;
  switch (how) {
    case Combine::average:
      return (a + b) / 2;
    case Combine::minimum:
      return a < b ? a : b;
    case Combine::maximum:
      return a > b ? a : b;
    case Combine::product:
      return a * b;
    case Combine::geometric_mean:
      break;
  }
  return sqrt(a * b);
}
template <class Real>
[[nodiscard]] Material<Real> combined(const CombineRule& combine_rule, const Material<Real>& a,
                                      const Material<Real>& b) {
  return {combined(combine_rule.restitution, a.restitution, b.restitution),
          combined(combine_rule.friction, a.friction, b.friction),
          combined(combine_rule.rolling_resistance, a.rolling_resistance, b.rolling_resistance)};
}

/// The directions in which a body is held, whatever pushes it: bits, joined by `both`. In the plane, z is of no
/// meaning but for turns, which are about z.
enum class Locked : std::uint8_t { none = 0, x = 1, y = 2, z = 4, turn_x = 8, turn_y = 16, turn_z = 32 };
/// The directions of a and of b.
[[nodiscard]] constexpr Locked both(Locked a, Locked b) {
  return static_cast<Locked>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
/// Whether all of b are among a.
[[nodiscard]] constexpr bool has(Locked a, Locked b) {
  return (static_cast<unsigned>(a) & static_cast<unsigned>(b)) == static_cast<unsigned>(b);
}

/// What few bodies need. The fast motion knows all of it, the exact motion all but `is_sensor`.
template <class Real>
struct BodyTraits {
  bool is_driven = false;                  // of a fixed body: moves with its velocity and spin, whatever meets it
  bool is_sensor = false;                  // pushes nothing, but has contact events, with an impulse of 0
  Locked locked = Locked::none;            // directions in which it is held
  Real gravity_scale = Real(1);            // times the gravity of the world
  Real damping = Real(0);                  // of the velocity, per time: dv/dt = -damping v
  Real spin_damping = Real(0);             // of the spin, likewise
  std::uint64_t category = 1;              // bits; two bodies collide where each has a bit of the other's mask,
  std::uint64_t mask = ~std::uint64_t{0};  // and the rules for their groups allow it
  std::uint64_t user_data = 0;             // of your own
  /// Whether all are equal.
  friend bool operator==(const BodyTraits&, const BodyTraits&) = default;
};

/// A body to be added to a world. Lengths, masses and times are in the units of the world.
template <class Real, int Dim>
struct BodyDefinition {
  Shape<Real, Dim> shape = Sphere<Real>{};                    // by default a radius of 0.5
  Vector<Real, Dim> position{};                               // of the origin of the shape, of balls the centre
  Vector<Real, Dim> velocity{};                               // of the centre of mass
  Orientation<Real, Dim> orientation = upright<Real, Dim>();  // an angle in the plane, a unit quaternion in space
  Spin<Real, Dim> spin{};                                     // the angular velocity, in radians per time
  std::optional<Real> mass{};                                 // default: density times volume (area in the plane)
  Real density = Real(1);                                     // mass per volume (area in the plane)
  bool fixed = false;                                         // never moves, whatever meets it
  Material<Real> material{};                                  // of its surface
  std::uint32_t group = 0;                                    // below 32; see World::ignore
  BodyTraits<Real> traits{};                                  // what few bodies need
};

/// Identifies a body until it is removed. The generation tells the handle of a removed body from that of a later body
/// in the same slot.
struct BodyHandle {
  std::uint32_t slot = 0;        // a place, used again after its body is removed
  std::uint32_t generation = 0;  // counts the bodies that were there, from 1; a handle of nothing has 0
  friend bool operator==(const BodyHandle&, const BodyHandle&) = default;
};

/// Volume of a ball, area of a disc.
template <class Real, int Dim>
[[nodiscard]] Real volume(const Sphere<Real>& sphere) {
  const Real r = sphere.radius, pi = Real(std::numbers::pi_v<long double>);
  return Dim == 2 ? pi * r * r : Real(4) / Real(3) * pi * r * r * r;
}
/// Moment of inertia about the centre: 2/5 m r^2 of a ball, 1/2 m r^2 of a disc.
template <class Real, int Dim>
[[nodiscard]] Real inertia(const Sphere<Real>& sphere, const Real& mass) {
  return (Dim == 2 ? Real(1) / Real(2) : Real(2) / Real(5)) * mass * sphere.radius * sphere.radius;
}

}  // namespace continuo
