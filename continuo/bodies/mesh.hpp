// continuo/bodies/mesh.hpp
// The definition of a static mesh of a world: ground, walls and obstacles that never move.
//
//   HeightField<double, 3> hills{.counts = {100, 100}, .heights = heights};
//   const auto ground = world.add_mesh({.shape = hills, .material = {.friction = 0.8}});
#pragma once
#include <cstdint>
#include <memory>

#include <continuo/bodies/body.hpp>
#include <continuo/shapes/mesh_shape.hpp>

namespace continuo {

template <class Real, int Dim>
class StaticMesh;  // meshes/static_mesh.hpp

/// A static mesh to be added to a world. Its points are places in the world.
template <class Real, int Dim>
struct MeshDefinition {
  MeshShape<Real, Dim> shape{};            // of at least one facet
  Material<Real> material{};               // of its surface
  std::uint64_t category = 1;              // bits; a body collides with it where each has a bit of the other's mask
  std::uint64_t mask = ~std::uint64_t{0};  // of the categories of bodies
};

/// Identifies a static mesh until it is removed.
struct MeshHandle {
  std::uint32_t slot = 0;        // its number in World::meshes()
  std::uint32_t generation = 0;  // counts the meshes that were there, from 1; a handle of nothing has 0
  friend bool operator==(const MeshHandle&, const MeshHandle&) = default;
};

/// A static mesh of a world, or a place where there is none now.
template <class Real, int Dim>
struct WorldMesh {
  std::shared_ptr<const StaticMesh<Real, Dim>> geometry{};  // null: there is no mesh; copies of the world share it
  Material<Real> material{};                                // of its surface
  std::uint64_t category = 1;                               // see MeshDefinition
  std::uint64_t mask = ~std::uint64_t{0};                   // likewise
  std::uint32_t generation = 1;                             // of its handle

  /// Whether a body with these traits collides with it.
  [[nodiscard]] bool collides(const BodyTraits<Real>& traits) const {
    return geometry && (category & traits.mask) != 0 && (traits.category & mask) != 0;
  }
};

}  // namespace continuo
