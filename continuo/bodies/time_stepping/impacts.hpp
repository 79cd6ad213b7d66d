// Collisions too fast for a soft contact, or with restitution, each at its instant within a substep: as in the exact
// motion, a queue has the collisions that are predicted on parabolic paths, here among the listed pairs. Both bodies
// advance to the place of the impact, change their velocities, and go back along their new paths to the beginning of
// the substep, from where the contact solver continues. Impacts of one instant that share bodies are solved together.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include <continuo/bodies/contact_events.hpp>
#include <continuo/bodies/contact_solver/contact_step.hpp>
#include <continuo/bodies/contacts/collide_together.hpp>
#include <continuo/bodies/contacts/collision_time.hpp>
#include <continuo/bodies/contacts/impulse.hpp>
#include <continuo/bodies/time_stepping/broad_phase.hpp>

namespace continuo {

/// Whether a body may be too fast for a soft contact in a substep of h. Without restitution, an impact is an approach
/// by half a radius in a substep. Two bodies that move by a fifth each do not reach that, even when gravity adds to it,
/// and most worlds at most times have neither restitution nor such speeds. With a tenth, and the `gain` of speed by
/// gravity in a step, no impact is to be expected within the whole step: without restitution nothing makes a body
/// faster than the fastest one.
template <class Real, int Dim>
[[nodiscard]] bool may_strike(const SolverBodies<Real, Dim>& bodies, const Real& h, const Real& part_of_radius,
                              const Real& gain) {
  using std::abs;
  const Real part = part_of_radius / h;
  int fast = 0;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Real slow = part * bodies.radius(k) - gain;
    fast |= static_cast<int>(squared(bodies.v(k)) > slow * abs(slow));
  }
  return fast != 0;
}

/// Makes the impacts of a substep, on the world, bodies and pairs of the stepper.
template <class Real, int Dim>
class Impacts {
 public:
  using V = Vector<Real, Dim>;

  /// Makes the impacts of the substep that begins at `begin`, and sets its greatest acceleration. A body that an impact
  /// has made faster searches for partners along its path in a whole `step`. Returns the number of impacts.
  [[nodiscard]] std::size_t make(const World<Real, Dim>& world, const BroadPhase<Real, Dim>& list,
                                 const ContactList<Real, Dim>& contacts, SolverBodies<Real, Dim>& bodies,
                                 ContactStep<Real>& substep, const Real& step, const Real& begin,
                                 ContactLog<Real, Dim>& log) {
    using std::sqrt;
    Real pull = squared(bodies.gravity);
    for (const V& acceleration : bodies.accelerations) pull = std::max(pull, squared(acceleration));
    substep.greatest_acceleration = sqrt(pull);
    bodies.impacts.assign(bodies.size(), 0);
    const Making making{world, list, bodies, substep, step, begin, log};
    for (std::uint32_t k = 0; k < bodies.size(); ++k) {
      for (const ContactEntry& entry : contacts.rows.row(k)) {
        if (entry.other < bodies.size()) {
          foresee(making, k, entry.other, Real(0));
        } else {
          foresee_wall(making, k, entry.other - static_cast<std::uint32_t>(bodies.size()), Real(0));
        }
      }
    }
    std::size_t struck = 0, left = 64 * bodies.size();  // a bound: the impacts of squeezed balls never end
    for (; !queue_.empty() && left > 0; --left) {
      take_instant(making);
      for (const Impact& impact : apart_) strike(making, impact);
      if (!shared_.empty()) strike_together(making);
      struck += apart_.size() + shared_.size();
    }
    queue_ = {};
    return struck;
  }

 private:
  struct Making {
    const World<Real, Dim>& world;
    const BroadPhase<Real, Dim>& list;
    SolverBodies<Real, Dim>& bodies;
    const ContactStep<Real>& substep;
    Real step, begin;  // begin: of the substep
    ContactLog<Real, Dim>& log;

    [[nodiscard]] const Material<Real>& material(std::uint32_t k) const { return world.material[list.order()[k]]; }
  };
  struct Impact {
    Real time;
    std::uint32_t a, b;  // b from the number of bodies on: walls
    std::uint32_t impacts_a, impacts_b;
    bool operator<(const Impact& other) const {  // for a queue whose top is the first
      if (time != other.time) return time > other.time;
      return a != other.a ? a > other.a : b > other.b;
    }
  };

  /// The same criterion as in is_for_impacts of restitution.hpp.
  [[nodiscard]] static bool counts(const Making& making, const Real& speed, const Real& restitution,
                                   const Real& radius) {
    const ContactStep<Real>& substep = making.substep;
    return restitution > Real(0) ? speed > 4 * substep.greatest_acceleration * substep.h
                                 : speed * substep.h > radius / 2;
  }
  [[nodiscard]] static bool is_current(const Making& making, const Impact& impact) {
    const auto& bodies = making.bodies;
    return bodies.impacts[impact.a] == impact.impacts_a &&
           (impact.b >= bodies.size() || bodies.impacts[impact.b] == impact.impacts_b);
  }

  void foresee(const Making& making, std::uint32_t i, std::uint32_t j, const Real& from) {
    const auto& bodies = making.bodies;
    const Real h = making.substep.h, reach = bodies.radius(i) + bodies.radius(j);
    const V rate = bodies.v(j) - bodies.v(i), pull = bodies.acceleration(j) - bodies.acceleration(i);
    const Real speed = length(rate) + length(pull) * h;
    const V apart = bodies.x(j) - bodies.x(i) + rate * from + pull * (from * from / 2), rate_now = rate + pull * from;
    if (squared(apart) > (reach + speed * h) * (reach + speed * h)) return;
    const Real restitution =
        combined(making.world.combine_rule.restitution, making.material(i).restitution, making.material(j).restitution);
    const Real smaller = std::min(bodies.radius(i), bodies.radius(j));
    if (!counts(making, speed, restitution, smaller)) return;
    const Real wait = pull == V{} ? time_to_touch(apart, rate_now, reach)
                                  : time_to_touch(apart, rate_now, pull, reach, Real(h - from));
    if (!(from + wait < h)) return;
    const V then = apart + rate_now * wait + pull * (wait * wait / 2), v_then = rate_now + pull * wait;
    const Real approach = -dot(v_then, then) / reach;
    if (!counts(making, approach, restitution, smaller) || approach * h < rounding(bodies, i)) return;
    queue_.push({from + wait, i, j, bodies.impacts[i], bodies.impacts[j]});
  }
  void foresee_wall(const Making& making, std::uint32_t i, std::uint32_t w, const Real& from) {
    const auto& bodies = making.bodies;
    const V acceleration = bodies.acceleration(i);
    // The true position: a body that has had an impact is stored at the beginning of its new path, where it never was.
    const V x = bodies.x(i) + bodies.v(i) * from + acceleration * (from * from / 2);
    const Wall<Real, Dim> wall = facing(making.world.walls()[w], x);
    const Real pull = dot(acceleration, wall.normal), speed = dot(bodies.v(i), wall.normal) + pull * from;
    const Real wait = time_to_close(Real(dot(wall.normal, x) - wall.offset - bodies.radius(i)), speed, pull);
    if (!(from + wait < making.substep.h)) return;
    const Real restitution =
        combined(making.world.combine_rule.restitution, making.material(i).restitution, wall.material.restitution);
    if (!counts(making, Real(-(speed + pull * wait)), restitution, bodies.radius(i))) return;
    queue_.push({from + wait, i, bodies.wall(w), bodies.impacts[i], 0});
  }

  /// Takes the next impact from the queue, with those of the same instant, up to rounding: those that share no moving
  /// body with another one apart from the others.
  void take_instant(const Making& making) {
    const auto& bodies = making.bodies;
    apart_.clear(), shared_.clear();
    Real until = queue_.top().time;
    bool is_first = true;
    while (!queue_.empty() && queue_.top().time <= until) {
      const Impact impact = queue_.top();
      queue_.pop();
      if (!is_current(making, impact)) continue;
      shared_.push_back(impact);
      if (std::exchange(is_first, false)) until = impact.time + instant_of(making, impact);
    }
    if (shared_.size() < 2) return apart_.swap(shared_);
    const auto pair_of = [](const Impact& impact) { return std::pair(impact.a, impact.b); };
    std::ranges::sort(shared_, {}, [](const Impact& impact) { return std::tuple(impact.a, impact.b, impact.time); });
    const auto same = std::ranges::unique(shared_, {}, pair_of);  // both bodies may have foreseen it
    shared_.erase(same.begin(), same.end());
    std::vector<std::uint32_t> movers;
    for (const Impact& impact : shared_)
      for (const std::uint32_t k : {impact.a, impact.b})
        if (k < bodies.size() && bodies.moves(k)) movers.push_back(k);
    std::ranges::sort(movers);
    const auto is_shared = [&](const Impact& impact) {
      return std::ranges::equal_range(movers, impact.a).size() > 1 ||
             std::ranges::equal_range(movers, impact.b).size() > 1;
    };
    std::ranges::copy_if(shared_, std::back_inserter(apart_), std::not_fn(is_shared));
    std::erase_if(shared_, std::not_fn(is_shared));
    std::ranges::sort(apart_, {}, [](const Impact& impact) { return std::tuple(impact.time, impact.a, impact.b); });
  }
  /// Up to how much later others are at the same instant: bodies that touch at rest drift apart by rounding, a
  /// millionth of a radius is much more than that, and much less than what soft contacts yield.
  [[nodiscard]] static Real instant_of(const Making& making, const Impact& impact) {
    const auto& bodies = making.bodies;
    V rate = bodies.v(impact.a);
    if (impact.b < bodies.size()) rate -= bodies.v(impact.b);
    const Real speed = length(rate), way = Real(1e-6) * bodies.radius(impact.a) + rounding(bodies, impact.a);
    return speed > Real(0) ? way / speed : Real(0);
  }
  /// Of the place of a body that has gone to and fro.
  [[nodiscard]] static Real rounding(const SolverBodies<Real, Dim>& bodies, std::uint32_t i) {
    return 16 * std::numeric_limits<Real>::epsilon() * (length(bodies.x(i)) + bodies.radius(i));
  }
  void strike_together(const Making& making) {
    auto& bodies = making.bodies;
    const Real time = shared_.front().time;
    std::vector<std::uint32_t> struck;
    for (const Impact& impact : shared_) {
      struck.push_back(impact.a);
      if (impact.b < bodies.size()) struck.push_back(impact.b);
    }
    std::ranges::sort(struck);
    struck.erase(std::ranges::unique(struck).begin(), struck.end());
    std::vector<State> states;
    for (const std::uint32_t k : struck) {
      go(bodies, k, time);
      states.push_back(state(bodies, k));
    }
    const auto place_of = [&](std::uint32_t k) {
      return static_cast<std::uint32_t>(std::ranges::lower_bound(struck, k) - struck.begin());
    };
    std::vector<Collision<Real, Dim>> collisions;
    for (const Impact& impact : shared_) {
      const auto [normal, material] = meeting(making, impact);
      Collision<Real, Dim>& one = collisions.emplace_back();
      one.a = place_of(impact.a), one.normal = normal, one.material = material;
      V rate = -states[one.a].v;
      if (impact.b < bodies.size()) {
        one.b = place_of(impact.b);
        rate += states[one.b].v;
      }
      one.acts = dot(rate, normal) < Real(0);
    }
    // Impulses that were not found are near to those: what still approaches meets in soft contacts.
    static_cast<void>(round_.collide(collisions, [&](std::uint32_t k) { return states[k].mover(); }));
    for (std::size_t k = 0; k < shared_.size(); ++k)
      if (collisions[k].acts) note(making, shared_[k], collisions[k].normal, collisions[k].impulse);
    for (std::size_t k = 0; k < struck.size(); ++k) put_back(bodies, struck[k], states[k], time);
    for (const std::uint32_t k : struck) foresee_all(making, k, time);
  }
  /// The normal from a to b or into the wall, and the material of both, where they touch.
  [[nodiscard]] static std::pair<V, Material<Real>> meeting(const Making& making, const Impact& impact) {
    const auto& bodies = making.bodies;
    if (impact.b >= bodies.size()) {
      const Wall<Real, Dim> wall = facing(making.world.walls()[impact.b - bodies.size()], bodies.x(impact.a));
      return {-wall.normal, combined(making.world.combine_rule, making.material(impact.a), wall.material)};
    }
    const V apart = bodies.x(impact.b) - bodies.x(impact.a);
    const Real distance = length(apart);
    V normal = apart * (distance > Real(0) ? 1 / distance : Real(0));
    if (!(distance > Real(0))) normal[0] = Real(1);
    return {normal, combined(making.world.combine_rule, making.material(impact.a), making.material(impact.b))};
  }

  void strike(const Making& making, const Impact& impact) {
    auto& bodies = making.bodies;
    go(bodies, impact.a, impact.time);
    State a = state(bodies, impact.a);
    if (impact.b < bodies.size()) {
      go(bodies, impact.b, impact.time);
      State b = state(bodies, impact.b);
      const auto [normal, both] = meeting(making, impact);
      if (dot(b.v - a.v, normal) < Real(0)) note(making, impact, normal, collide(a.mover(), b.mover(), normal, both));
      put_back(bodies, impact.b, b, impact.time);
    } else {
      State stand_in{};
      const auto [normal, both] = meeting(making, impact);
      if (dot(a.v, normal) > Real(0)) note(making, impact, normal, collide(a.mover(), stand_in.mover(), normal, both));
    }
    put_back(bodies, impact.a, a, impact.time);
    foresee_all(making, impact.a, impact.time);
    if (impact.b < bodies.size()) foresee_all(making, impact.b, impact.time);
  }
  static void note(const Making& making, const Impact& impact, const V& normal, const Real& impulse) {
    if (!making.log.is_kept()) return;
    const auto& bodies = making.bodies;
    const auto handle = [&](std::uint32_t k) { return making.world.handle(making.list.order()[k]); };
    ContactEvent<Real, Dim> event{.a = handle(impact.a),
                                  .point = bodies.x(impact.a) + normal * bodies.radius(impact.a),
                                  .normal = normal,
                                  .impulse = impulse,
                                  .time = making.begin + impact.time};
    if (impact.b < bodies.size()) {
      event.b = handle(impact.b);
    } else {
      event.wall = static_cast<std::uint32_t>(impact.b - bodies.size());
    }
    making.log.add(event);
  }
  /// A body that an impact has made faster may move beyond its reach in the list of pairs: so it searches for partners
  /// itself.
  void foresee_all(const Making& making, std::uint32_t i, const Real& from) {
    making.list.for_each_neighbour(making.world, making.bodies, i, Real(length(making.bodies.v(i)) * making.step),
                                   [&](std::uint32_t j) { foresee(making, std::min(i, j), std::max(i, j), from); });
    if (making.bodies.moves(i))
      for (std::uint32_t w = 0; w < making.world.walls().size(); ++w) foresee_wall(making, i, w, from);
  }

  struct State {
    V v{};
    Spin<Real, Dim> spin{};
    Real radius{}, inverse_mass{}, inverse_inertia{};
    [[nodiscard]] Mover<Real, Dim> mover() { return {v, spin, radius, inverse_mass, inverse_inertia}; }
  };
  [[nodiscard]] static State state(const SolverBodies<Real, Dim>& bodies, std::uint32_t i) {
    const Real radius = bodies.radius(i);
    const Quad<Real>& rim = bodies.motion[i].rim;
    return {bodies.v(i), vector_of<Spin<Real, Dim>::size()>(rim) * (1 / radius), radius, bodies.inverse_mass(i),
            rim[3] / (radius * radius)};
  }
  static void put_back(SolverBodies<Real, Dim>& bodies, std::uint32_t i, const State& state, const Real& time) {
    put(state.v, bodies.motion[i].linear);
    put(Spin<Real, Dim>(state.spin * state.radius), bodies.motion[i].rim);
    go(bodies, i, Real(-time));
    ++bodies.impacts[i];
  }
  static void go(SolverBodies<Real, Dim>& bodies, std::uint32_t i, const Real& duration) {
    const V pull = bodies.acceleration(i), v = bodies.v(i);
    put(V(bodies.x(i) + v * duration + pull * (duration * duration / 2)), bodies.place[i].x_and_radius);
    put(V(v + pull * duration), bodies.motion[i].linear);
  }

  std::priority_queue<Impact> queue_;
  std::vector<Impact> apart_, shared_;  // those of an instant
  CollisionRound<Real, Dim> round_;
};

}  // namespace continuo
