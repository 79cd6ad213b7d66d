// One persistent contact: the pair, the relative motion of its surfaces, and the limits of friction and rolling
// resistance.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <continuo/bodies/contacts/contact_matrix.hpp>
#include <continuo/bodies/contacts/touching.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

/// Coulomb's law for the relative motion of two surfaces, slip or rolling: the load against it is at most `most` times
/// the normal force. Where this suffices the contact sticks (`holds`); otherwise the load has this limit. Rates and
/// loads have the units of speeds and forces.
template <class Real, class W>
struct Grip {
  Real most{};
  bool holds = false, is_fast = false;  // is_fast: the surfaces moved at the start
  W way_at_start{};                     // the direction of the motion, or of impending motion
  // At an instant:
  W rate{}, way{}, load{};  // load: on b

  void start(const Real& slow) {
    const Real speed = length(rate);
    is_fast = most > Real(0) && speed > slow;
    holds = most > Real(0) && !is_fast;
    if (is_fast) way_at_start = way = rate * (1 / speed);
  }
  /// Updates the direction after impulses, which may have reversed the motion: a load along the motion would drive it,
  /// and the guard would not detect that.
  void look_again(const Real& slow) {
    const Real speed = length(rate), along = dot(rate, way);
    if (!(most > Real(0)) || holds || !(speed > Real(0)) || along > (is_fast ? slow / 2 : -slow / 16)) return;
    is_fast = speed > slow / 2;
    way_at_start = way = rate * (1 / speed);
  }
  /// Ends sticking: the motion begins against the load.
  void let_go() {
    const Real size = length(load);
    holds = false;
    way_at_start = way = size > Real(0) ? load * (-1 / size) : W{};
  }
  [[nodiscard]] bool is_too_weak(const Real& press, const Real& rounding) const {
    return holds && !(length(load) < most * press + rounding);
  }
  /// The direction against which the load acts: that of the motion, or, where the surfaces hardly move, that of the
  /// impending motion. It stays the same beyond the instant at which the motion stops, so that the load does not jump
  /// within a step that goes too far.
  [[nodiscard]] W direction(const Real& slow) const {
    const Real along = dot(rate, way), speed = length(rate);
    const W ahead = rate + way * (std::abs(along) - along);
    return speed > slow ? ahead * (1 / speed) : (ahead + way * (slow - speed)) * (1 / slow);
  }
  /// A guard that falls through 0 where sticking begins or ends.
  [[nodiscard]] Real guard(const Real& press, const Real& slow, const Real& rounding) const {
    if (!(most > Real(0))) return Real(1);
    if (holds) return most * press - length(load) + 2 * rounding;
    return is_fast ? dot(rate, way) - slow / 2 : dot(rate, way) + slow / 8;
  }
};

/// The directions across a normal: one or two.
template <class Real>
[[nodiscard]] std::vector<Vector<Real, 2>> across(const Vector<Real, 2>& normal) {
  return {Vector<Real, 2>{{-normal[1], normal[0]}}};
}
template <class Real>
[[nodiscard]] std::vector<Vector<Real, 3>> across(const Vector<Real, 3>& normal) {
  Vector<Real, 3> least{};  // the axis that is least along the normal
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(normal[k]) < std::abs(normal[axis])) axis = k;
  least[axis] = Real(1);
  Vector<Real, 3> first = turning(normal, least);
  first *= 1 / length(first);
  return {first, turning(normal, first)};
}

template <class Real, int Dim>
struct PersistentContact {
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;

  Touching pair{};
  Grip<Real, V> slip{};
  Grip<Real, S> roll{};  // its rate is the relative spin times `arm`, its load a torque over `arm`
  Real arm{};            // the smaller radius
  bool is_pressed = true;
  int changes = 0;
  // At an instant:
  V normal{}, bend{};  // normal: from a to b; bend: its rate of change
  Real parting{}, gap{}, press{};

  PersistentContact(const World<Real, Dim>& world, const Touching& touching) : pair(touching) {
    const auto [a, b, w] = pair;
    const Material<Real> both = combined(world.combine_rule, world.material[a],
                                         pair.with_wall() ? world.walls()[w].material : world.material[b]);
    slip.most = both.friction;
    arm = world.radius[a];
    Real mobility = world.radius[a] * world.inverse_inertia[a], odd = mobility;
    Real compliance = world.inverse_mass[a] + mobility * world.radius[a];
    if (!pair.with_wall()) {
      arm = std::min(arm, world.radius[b]);
      mobility = world.radius[b] * world.inverse_inertia[b];
      compliance += world.inverse_mass[b] + mobility * world.radius[b];
      odd -= mobility;
    }
    if (!(both.friction > Real(0))) return;
    // Under a torque `arm` times q against rolling, the surfaces slip unless friction is q arm |odd| / compliance. So a
    // resistance that would need more than the greatest friction is reduced to that limit, see rolling.hpp, and
    // slightly below it.
    const Real limit = both.friction * compliance * Real(1 - 1e-8), asked = arm * std::abs(odd);
    roll.most = both.rolling_resistance * asked > limit ? limit / asked : both.rolling_resistance;
  }

  void place(const World<Real, Dim>& world, std::span<const V> x, std::span<const V> v, std::span<const S> spin) {
    const auto [a, b, w] = pair;
    bend = {};
    if (pair.with_wall()) {
      const Wall<Real, Dim> wall = facing(world.walls()[w], world.position[a]);
      normal = -wall.normal;
      gap = dot(wall.normal, x[a]) - wall.offset - world.radius[a];
    } else {
      const V apart = x[b] - x[a];
      const Real distance = length(apart);
      normal = apart * (1 / distance);
      gap = distance - world.radius[a] - world.radius[b];
      const V rate = v[b] - v[a];
      bend = (rate - normal * dot(rate, normal)) * (1 / distance);
    }
    slip.way = carried(slip.way_at_start);
    if constexpr (Dim == 3) {
      roll.way = carried(roll.way_at_start);
    } else {
      roll.way = roll.way_at_start;
    }
    move(world, v, spin);
  }
  /// Updates the rates for other velocities at the positions of the last `place`.
  void move(const World<Real, Dim>& world, std::span<const V> v, std::span<const S> spin) {
    const auto [a, b, w] = pair;
    V rate = pair.with_wall() ? -v[a] : V(v[b] - v[a]);
    parting = dot(rate, normal);
    if (!(slip.most > Real(0))) return;
    rate -= normal * parting + turning(spin[a], V(normal * world.radius[a]));
    if (!pair.with_wall()) rate -= turning(spin[b], V(normal * world.radius[b]));
    slip.rate = rate;
    if (!(roll.most > Real(0))) return;
    roll.rate = (pair.with_wall() ? -spin[a] : S(spin[b] - spin[a])) * arm;
    if constexpr (Dim == 3) roll.rate -= normal * dot(roll.rate, normal);
  }

  [[nodiscard]] bool can_roll() const { return slip.holds && roll.most > Real(0); }

  /// The forces and torques on both bodies that belong to a force on b and a torque over `arm`.
  [[nodiscard]] ContactDirection<Real, Dim> ends(const World<Real, Dim>& world, const V& force, const S& couple) const {
    ContactDirection<Real, Dim> all;
    const S twist = moment(normal, force);
    all.add({pair.a, -force, S(twist * -world.radius[pair.a] - couple * arm)});
    if (!pair.with_wall()) all.add({pair.b, force, S(twist * -world.radius[pair.b] + couple * arm)});
    return all;
  }
  [[nodiscard]] V force() const { return normal * press + slip.load; }

 private:
  /// A tangential direction, projected to be across the present normal.
  [[nodiscard]] V carried(const V& way) const {
    const V flat = way - normal * dot(way, normal);
    const Real size = length(flat);
    return size > Real(0) ? flat * (1 / size) : flat;
  }
};

}  // namespace continuo
