// Static meshes for tests.
#pragma once
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>

#include <continuo/bodies/mesh.hpp>

namespace continuo::test {

/// Triangles over the rectangle from (x, y) to (x + columns * spacing, y + rows * spacing), at places that are shifted
/// at random, each cell cut along one or the other diagonal, in heights that are a function of the place.
template <class Real>
[[nodiscard]] TriangleMesh<Real> irregular_mesh(unsigned columns, unsigned rows, double spacing, double x, double y,
                                                const std::function<double(double, double)>& height,
                                                unsigned seed = 1) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> shift(-0.17, 0.17);  // less than would turn a triangle over
  TriangleMesh<Real> mesh;
  for (unsigned j = 0; j <= rows; ++j)
    for (unsigned i = 0; i <= columns; ++i) {
      const double at_x = x + (i + shift(engine)) * spacing, at_y = y + (j + shift(engine)) * spacing;
      mesh.corners.push_back(
          {{static_cast<Real>(at_x), static_cast<Real>(at_y), static_cast<Real>(height(at_x, at_y))}});
    }
  for (unsigned j = 0; j < rows; ++j)
    for (unsigned i = 0; i < columns; ++i) {
      const std::uint32_t a = j * (columns + 1) + i, b = a + 1, c = b + columns + 1, d = c - 1;
      if (engine() % 2 == 0) {
        mesh.triangles.push_back({a, b, c}), mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d}), mesh.triangles.push_back({b, c, d});
      }
    }
  return mesh;
}

/// A flat chain along x from the right to the left, at height 0.
[[nodiscard]] inline Chain<double> flat_chain(int segments, double spacing, double x) {
  Chain<double> chain;
  for (int i = segments; i >= 0; --i) chain.points.push_back({{x + i * spacing, 0}});
  return chain;
}

}  // namespace continuo::test
