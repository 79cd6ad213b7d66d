// Adds static meshes to a world, and removes them.
#include <algorithm>
#include <memory>
#include <utility>

#include <continuo/bodies/meshes/static_mesh.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

template <class Real, int Dim>
Result<MeshHandle> World<Real, Dim>::add_mesh(const MeshDefinition<Real, Dim>& definition) {
  if (Status fault = check(definition.material); !fault) return fault;
  auto made = StaticMesh<Real, Dim>::of(definition.shape);
  if (!made) return made.status();
  auto at = std::ranges::find(meshes_, nullptr, &WorldMesh<Real, Dim>::geometry);
  if (at == meshes_.end()) at = meshes_.insert(at, WorldMesh<Real, Dim>{});
  at->geometry = std::make_shared<const StaticMesh<Real, Dim>>(std::move(*made));
  at->material = definition.material;
  at->category = definition.category, at->mask = definition.mask;
  return MeshHandle{static_cast<std::uint32_t>(at - meshes_.begin()), at->generation};
}

template <class Real, int Dim>
bool World<Real, Dim>::remove_mesh(MeshHandle handle) {
  if (!has_mesh(handle)) return false;
  const std::uint32_t generation = meshes_[handle.slot].generation + 1;
  meshes_[handle.slot] = {};
  meshes_[handle.slot].generation = generation;
  return true;
}

template <class Real, int Dim>
bool World<Real, Dim>::has_meshes() const {
  return std::ranges::any_of(meshes_, [](const WorldMesh<Real, Dim>& mesh) { return mesh.geometry != nullptr; });
}

template Result<MeshHandle> World<float, 2>::add_mesh(const MeshDefinition<float, 2>&);
template Result<MeshHandle> World<float, 3>::add_mesh(const MeshDefinition<float, 3>&);
template Result<MeshHandle> World<double, 2>::add_mesh(const MeshDefinition<double, 2>&);
template Result<MeshHandle> World<double, 3>::add_mesh(const MeshDefinition<double, 3>&);
template bool World<float, 2>::remove_mesh(MeshHandle);
template bool World<float, 3>::remove_mesh(MeshHandle);
template bool World<double, 2>::remove_mesh(MeshHandle);
template bool World<double, 3>::remove_mesh(MeshHandle);
template bool World<float, 2>::has_meshes() const;
template bool World<float, 3>::has_meshes() const;
template bool World<double, 2>::has_meshes() const;
template bool World<double, 3>::has_meshes() const;

}  // namespace continuo
