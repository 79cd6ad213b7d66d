// How deep the bodies of a world are in each other, or in its walls, by all pairs.
#pragma once
#include <algorithm>
#include <cstddef>

#include <continuo/bodies/world.hpp>

namespace continuo {

template <int Dim>
double deepest_overlap_of_bodies(const World<double, Dim>& world) {
  double deepest = 0;
  for (std::size_t i = 0; i < world.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      deepest = std::max(deepest, world.radius[i] + world.radius[j] - length(world.position[i] - world.position[j]));
  return deepest;
}
template <int Dim>
double deepest_overlap(const World<double, Dim>& world) {
  double deepest = deepest_overlap_of_bodies(world);
  for (std::size_t i = 0; i < world.size(); ++i)
    for (const auto& wall : world.walls())
      deepest = std::max(deepest, world.radius[i] + wall.offset - dot(wall.normal, world.position[i]));
  return deepest;
}

}  // namespace continuo
