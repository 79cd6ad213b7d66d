// Simultaneous strikes of bodies on straight paths that are in contact with one another, where collisions between them
// would pile up without end.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/contacts/joint_impacts.hpp>
#include <continuo/bodies/contacts/touching.hpp>
#include <continuo/bodies/event_driven/flights.hpp>
#include <continuo/bodies/event_driven/inelastic_collapse.hpp>

namespace continuo {

template <class Real, int Dim>
class SimultaneousImpacts {
 public:
  using V = Vector<Real, Dim>;

  /// Gathers body i and all bodies that are connected with it at present by contacts, with gaps of at most `reach`, or
  /// rounding. Pairs that lose no energy in a collision are left out, since their collisions end by themselves.
  void gather(const Flights<Real, Dim>& flights, std::uint32_t i, const Real& reach) {
    is_member_.resize(flights.paths.size());
    for (const std::uint32_t k : members_) is_member_[k] = false;
    members_.clear(), pairs_.clear();
    add(i);
    for (std::size_t k = 0; k < members_.size(); ++k) {
      const std::uint32_t a = members_[k];
      const std::uint32_t number = flights.plans[a].number;
      const V x = flights.place_now(a);
      for (std::uint32_t w = 0; w < flights.world.walls().size(); ++w) {
        const Wall<Real, Dim> wall = facing(flights.world.walls()[w], x);
        const Real radius = flights.paths[a].radius, gap = dot(wall.normal, x) - wall.offset - radius;
        if (gap <= reach + rounding(x, radius) &&
            loses(combined(flights.world.combine_rule, flights.material(a), wall.material)))
          pairs_.push_back({.a = number, .b = number, .wall = w});
      }
      flights.for_each_near(a, near_, [&](std::uint32_t b) {
        const V apart = flights.place_now(b) - x;
        const Real distance = length(apart), sum = flights.paths[a].radius + flights.paths[b].radius;
        const std::uint32_t other = flights.plans[b].number;
        if (a == b || !(distance <= sum + reach + rounding(x, sum)) || !(distance > Real(0))) return;
        if (!flights.world.collide(number, other)) return;
        if (!loses(combined(flights.world.combine_rule, flights.material(a), flights.material(b)))) return;
        const bool is_fixed = flights.acts[b] == Act::is_fixed;
        if (is_fixed || number < other) pairs_.push_back({.a = number, .b = other});
        if (!is_fixed) add(b);
      });
    }
    std::ranges::sort(pairs_);
  }

  /// Applies impulses after which no two bodies approach each other by more than `least`, if they are found. The
  /// members must be at the present time.
  [[nodiscard]] JointImpulses<Real> strike(World<Real, Dim>& world, Flights<Real, Dim>& flights, const Real& least) {
    for (const std::uint32_t k : members_) {
      const std::uint32_t number = flights.plans[k].number;
      world.position[number] = flights.paths[k].x, world.velocity[number] = flights.paths[k].v;
      world.spin[number] = flights.turnings[k].spin;
    }
    JointImpulses<Real> impulses = strike_together<Real, Dim>(world, pairs_, least);
    struck_.clear();
    for (const std::uint32_t k : members_) {
      const std::uint32_t number = flights.plans[k].number;
      auto& v = flights.paths[k].v;
      auto& spin = flights.turnings[k].spin;
      if (world.velocity[number] == v && world.spin[number] == spin) continue;
      v = world.velocity[number], spin = world.spin[number];
      struck_.push_back(k);
    }
    return impulses;
  }

  /// The members, by places.
  [[nodiscard]] std::span<const std::uint32_t> members() const { return members_; }
  /// The members whose motion the last strike has changed.
  [[nodiscard]] std::span<const std::uint32_t> struck() const { return struck_; }
  /// The pairs, by numbers, sorted.
  [[nodiscard]] std::span<const Touching> pairs() const { return pairs_; }

 private:
  [[nodiscard]] static Real rounding(const V& x, const Real& radius) {
    return 64 * std::numeric_limits<Real>::epsilon() * (length(x) + radius);
  }
  void add(std::uint32_t i) {
    if (is_member_[i]) return;
    is_member_[i] = true;
    members_.push_back(i);
  }

  std::vector<std::uint32_t> members_, struck_, near_;
  std::vector<Touching> pairs_;
  std::vector<bool> is_member_;
};

}  // namespace continuo
