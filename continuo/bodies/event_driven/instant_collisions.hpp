// The collisions at one instant of bodies that touch: in rounds, each with all pairs that approach each other at its
// beginning (collide_together.hpp).
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/contacts/collide_together.hpp>
#include <continuo/bodies/contacts/touching.hpp>
#include <continuo/bodies/event_driven/flights.hpp>

namespace continuo {

template <class Real, int Dim>
class InstantCollisions {
 public:
  using V = Vector<Real, Dim>;

  /// Gathers body i and what is connected with it at present by contacts, with gaps of at most rounding.
  void gather(const Flights<Real, Dim>& flights, std::uint32_t i) {
    is_member_.resize(flights.paths.size());
    for (const std::uint32_t k : members_) is_member_[k] = false;
    members_.clear(), contacts_.clear(), walls_.clear();
    add(i);
    for (std::size_t k = 0; k < members_.size() && members_.size() < most_members; ++k) {
      add_walls(flights, members_[k]);
      add_neighbours(flights, members_[k]);
    }
  }
  /// Marks the contacts whose bodies approach each other by more than rounding, where these have the velocities
  /// velocity_of(body). Returns their number.
  template <class VelocityOf>
  [[nodiscard]] std::size_t find_approaching(const Flights<Real, Dim>& flights, VelocityOf&& velocity_of) {
    std::size_t count = 0;
    for (Collision<Real, Dim>& one : contacts_) {
      const V a = velocity_of(one.a), b = one.b == Collision<Real, Dim>::wall ? V{} : velocity_of(one.b);
      const Real approach = -dot(V(b - a), one.normal);
      one.acts = approach > Real(0) && !flights.is_rounding(approach, Real(length(a) + length(b)));
      count += one.acts ? 1 : 0;
    }
    return count;
  }

  /// By places.
  [[nodiscard]] std::span<const std::uint32_t> members() const { return members_; }
  [[nodiscard]] std::span<Collision<Real, Dim>> contacts() { return contacts_; }
  /// The wall of a contact with one.
  [[nodiscard]] std::uint32_t wall_of(std::size_t contact) const { return walls_[contact]; }

 private:
  // A pile of more is not gathered at once: collisions one by one would end sooner than the search for all of it.
  static constexpr std::size_t most_members = 4096;

  void add(std::uint32_t i) {
    if (is_member_[i]) return;
    is_member_[i] = true;
    members_.push_back(i);
  }
  void add_walls(const Flights<Real, Dim>& flights, std::uint32_t a) {
    const V x = flights.place_now(a);
    const auto& walls = flights.world.walls();
    for (std::uint32_t w = 0; w < walls.size(); ++w) {
      const Wall<Real, Dim> wall = facing(walls[w], x);
      const Real radius = flights.paths[a].radius, gap = dot(wall.normal, x) - wall.offset - radius;
      if (!(gap <= rounding(x, Real(radius + std::abs(wall.offset))))) continue;
      contacts_.push_back({.a = a,
                           .normal = -wall.normal,
                           .material = combined(flights.world.combine_rule, flights.material(a), wall.material)});
      walls_.push_back(w);
    }
  }
  void add_neighbours(const Flights<Real, Dim>& flights, std::uint32_t a) {
    const V x = flights.place_now(a);
    flights.for_each_near(a, near_, [&](std::uint32_t b) {
      if (a == b || flights.acts[b] == Act::is_proxy) return;
      const V apart = flights.place_now(b) - x;
      const Real distance = length(apart), sum = flights.paths[a].radius + flights.paths[b].radius;
      if (!(distance <= sum + rounding(x, sum)) || !(distance > Real(0))) return;
      const std::uint32_t number = flights.plans[a].number, other = flights.plans[b].number;
      if (!flights.world.collide(number, other)) return;
      const bool is_fixed = flights.acts[b] == Act::is_fixed;
      if (!is_fixed) add(b);
      if (!is_fixed && other < number) return;  // found from the other one
      contacts_.push_back({.a = a,
                           .b = b,
                           .normal = apart * (1 / distance),
                           .material = combined(flights.world.combine_rule, flights.material(a), flights.material(b))});
      walls_.push_back(Touching::no_wall);
    });
  }
  [[nodiscard]] static Real rounding(const V& x, const Real& size) {
    return 64 * std::numeric_limits<Real>::epsilon() * (length(x) + size);
  }

  std::vector<std::uint32_t> members_, near_, walls_;
  std::vector<Collision<Real, Dim>> contacts_;
  std::vector<bool> is_member_;
};

}  // namespace continuo
