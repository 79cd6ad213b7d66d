// Pairs that touch or may touch: two bodies, or a body and a wall, with their gap and speed of approach in the present
// state of a world.
#pragma once
#include <algorithm>
#include <compare>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include <continuo/bodies/contact_events.hpp>
#include <continuo/bodies/queries.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

/// A pair. Pairs are ordered by their first body, with walls before bodies.
struct Touching {
  static constexpr std::uint32_t no_wall = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t a = 0, b = 0, wall = no_wall;
  [[nodiscard]] bool with_wall() const { return wall != no_wall; }
  friend bool operator==(const Touching&, const Touching&) = default;
  friend std::strong_ordering operator<=>(const Touching& one, const Touching& other) {
    return std::tuple(one.a, one.wall, one.b) <=> std::tuple(other.a, other.wall, other.b);
  }
  /// The pair with the body numbers `to`; nothing where a body has none.
  std::optional<Touching> moved(std::span<const std::uint32_t> to) const {
    constexpr auto removed = std::numeric_limits<std::uint32_t>::max();
    if (to[a] == removed || to[b] == removed) return {};
    return Touching{.a = to[a], .b = to[b], .wall = wall};
  }
  template <class Archive>
  void transfer(Archive& archive) {
    archive(a), archive(b), archive(wall);
  }
  template <class Real, int Dim>
  bool is_of(const World<Real, Dim>& world) const {
    return a < world.size() && b < world.size() && (!with_wall() || wall < world.walls().size());
  }
};

template <class Real, int Dim>
[[nodiscard]] Real gap_of(const World<Real, Dim>& world, const Touching& at) {
  if (at.with_wall()) {
    const Wall<Real, Dim> wall = facing(world.walls()[at.wall], world.position[at.a]);
    return dot(wall.normal, world.position[at.a]) - wall.offset - world.radius[at.a];
  }
  return length(world.position[at.b] - world.position[at.a]) - world.radius[at.a] - world.radius[at.b];
}
/// The normal from a to b, or into the wall; along the first axis where two centres coincide.
template <class Real, int Dim>
[[nodiscard]] Vector<Real, Dim> normal_of(const World<Real, Dim>& world, const Touching& at) {
  if (at.with_wall()) return -facing(world.walls()[at.wall], world.position[at.a]).normal;
  Vector<Real, Dim> n = world.position[at.b] - world.position[at.a];
  const Real distance = length(n);
  if (distance > Real(0)) return n * (1 / distance);
  n[0] = Real(1);
  return n;
}
template <class Real, int Dim>
[[nodiscard]] Real approach_of(const World<Real, Dim>& world, const Touching& at) {
  const Vector<Real, Dim> of_b = at.with_wall() ? Vector<Real, Dim>{} : world.velocity[at.b];
  return -dot(Vector<Real, Dim>(of_b - world.velocity[at.a]), normal_of(world, at));
}

/// A contact event of the pair, for the log of contacts.
template <class Real, int Dim>
[[nodiscard]] ContactEvent<Real, Dim> event_of(const World<Real, Dim>& world, const Touching& at, const Real& time,
                                               ContactChange change, const Real& impulse) {
  const Vector<Real, Dim> n = normal_of(world, at);
  return {.change = change,
          .a = world.handle(at.a),
          .b = at.with_wall() ? BodyHandle{} : world.handle(at.b),
          .wall = at.wall,
          .point = world.position[at.a] + n * world.radius[at.a],
          .normal = n,
          .impulse = impulse,
          .time = time};
}

/// All pairs, sorted, with a gap below 2 `reach`: those that can touch before a body has moved by `reach`.
template <class Real, int Dim>
[[nodiscard]] std::vector<Touching> pairs_within(const World<Real, Dim>& world, const Real& reach) {
  std::vector<Touching> pairs;
  const Queries<Real, Dim> queries(world);
  for (std::uint32_t i = 0; i < world.size(); ++i) {
    if (world.is_fixed(i)) continue;
    const auto near = queries.in_sphere(world.position[i], world.radius[i] + 2 * reach);
    if (!near) continue;  // a body without a finite position touches nothing; the motion fails
    for (const std::uint32_t w : near->walls) pairs.push_back({.a = i, .b = i, .wall = w});
    for (const BodyHandle& body : near->bodies) {
      const auto j = static_cast<std::uint32_t>(world.index(body));
      if ((j > i || world.is_fixed(j)) && j != i && world.collide(i, j)) pairs.push_back({.a = i, .b = j});
    }
  }
  std::ranges::sort(pairs);
  return pairs;
}

}  // namespace continuo
