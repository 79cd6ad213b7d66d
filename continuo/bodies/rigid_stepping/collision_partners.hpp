// Which bodies may collide with another one at all. Bodies that may not, as those of a net of joints that do not
// collide with each other, need no search for pairs.
#pragma once
#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <continuo/bodies/world.hpp>

namespace continuo {

/// What decides which bodies one collides with: all bodies of a class collide with the same ones.
struct CollisionClass {
  std::uint64_t category = 0, mask = 0;
  std::uint32_t group = 0;
  bool is_fixed = false;
  friend auto operator<=>(const CollisionClass&, const CollisionClass&) = default;
};

template <class Real, int Dim>
[[nodiscard]] CollisionClass collision_class(const World<Real, Dim>& world, std::size_t body) {
  const BodyTraits<Real> traits = world.traits(body);
  return {traits.category, traits.mask, world.group(body), world.is_fixed(body)};
}

/// For each body, 1 if some body, itself included, is of a class that its own class collides with, otherwise 0. Empty
/// where all have partners, or where there are too many classes to compare each with each.
template <class Real, int Dim>
[[nodiscard]] std::vector<std::uint8_t> bodies_with_partners(const World<Real, Dim>& world) {
  constexpr std::size_t most_classes = 64;
  if (!world.has_traits() && !world.has_ignored_groups()) return {};
  struct Known {
    CollisionClass of;
    std::size_t body = 0;  // one of this class
    bool has_partners = false;
  };
  std::vector<Known> classes;
  const auto find = [&](const CollisionClass& of) { return std::ranges::find(classes, of, &Known::of); };
  for (std::size_t i = 0; i < world.size(); ++i) {
    const CollisionClass of = collision_class(world, i);
    if (find(of) != classes.end()) continue;
    if (classes.size() == most_classes) return {};
    classes.push_back({of, i});
  }
  for (Known& a : classes)
    for (const Known& b : classes) a.has_partners |= world.collide(a.body, b.body);
  if (std::ranges::all_of(classes, &Known::has_partners)) return {};
  std::vector<std::uint8_t> have(world.size());
  for (std::size_t i = 0; i < world.size(); ++i) have[i] = find(collision_class(world, i))->has_partners ? 1 : 0;
  return have;
}

}  // namespace continuo
