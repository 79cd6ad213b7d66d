// From the description of a mesh in a model to the surface: which expressions it needs, and what their values make.
//
//   const std::vector<double> values = evaluate(model, mesh_nodes(mesh, 2), variables);
//   const MeshShape<double, 2> shape = described_mesh<2>(mesh, values);
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <continuo/language/world.hpp>
#include <continuo/shapes/matrix.hpp>
#include <continuo/shapes/mesh_shape.hpp>

namespace continuo::model {

/// The expressions of a mesh in a world of so many dimensions.
[[nodiscard]] inline std::vector<NodeId> mesh_nodes(const MeshDescription& mesh, int dimension) {
  std::vector<NodeId> nodes(mesh.position.begin(), mesh.position.begin() + dimension);
  nodes.insert(nodes.end(), mesh.orientation.begin(), mesh.orientation.begin() + (dimension == 2 ? 1 : 4));
  nodes.push_back(mesh.scale);
  for (const NodePoint& point : mesh.points) nodes.insert(nodes.end(), point.begin(), point.begin() + dimension);
  return nodes;
}

/// The surface, from the values of its expressions in that order. A chain of the text is free on the left of its way,
/// one of shapes/ on the right: its points are turned round.
template <int Dim>
[[nodiscard]] MeshShape<double, Dim> described_mesh(const MeshDescription& mesh, std::span<const double> values) {
  using V = Vector<double, Dim>;
  const auto next = [&](auto& numbers) {
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = values[k];
    values = values.subspan(numbers.size());
  };
  V position;
  Vector<double, Dim == 2 ? 1 : 4> orientation;
  next(position), next(orientation);
  const auto turn = rotation(orientation);
  const double scale = values[0];
  values = values.subspan(1);
  std::vector<V> corners(mesh.points.empty() ? mesh.corners.size() : mesh.points.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!mesh.points.empty()) {
      next(corners[i]);
    } else {
      std::copy_n(mesh.corners[i].begin(), Dim, corners[i].components.begin());
    }
    corners[i] = position + turn * V(corners[i] * scale);
  }
  if constexpr (Dim == 2) {
    std::ranges::reverse(corners);
    return Chain<double>{.points = std::move(corners), .is_loop = mesh.is_closed, .is_two_sided = mesh.thin};
  } else {
    return TriangleMesh<double>{.corners = std::move(corners), .triangles = mesh.triangles, .is_two_sided = mesh.thin};
  }
}

}  // namespace continuo::model
