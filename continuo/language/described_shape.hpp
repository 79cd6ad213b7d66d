// From the description of a shape in a model to the shape: which expressions it needs, and what their values make.
//
//   const std::vector<double> values = evaluate(model, shape_nodes(body.shape, 2), variables);
//   const Shape<double, 2> shape = described_shape<2>(body.shape, values);
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include <continuo/language/world.hpp>
#include <continuo/shapes/shape.hpp>

namespace continuo::model {

/// The expressions of a shape in a world of so many dimensions.
[[nodiscard]] inline std::vector<NodeId> shape_nodes(const ShapeDescription& shape, int dimension) {
  switch (shape.kind) {
    case ShapeDescription::Kind::capsule:
      return {shape.length, shape.radius};
    case ShapeDescription::Kind::box: {
      std::vector<NodeId> nodes(shape.size.begin(), shape.size.begin() + dimension);
      nodes.push_back(shape.rounding);
      return nodes;
    }
    case ShapeDescription::Kind::hull:
      return {shape.rounding};
    case ShapeDescription::Kind::ball:
      break;
  }
  return {shape.radius};
}

/// The shape, from the values of its expressions in that order.
template <int Dim>
[[nodiscard]] continuo::Shape<double, Dim> described_shape(const ShapeDescription& shape,
                                                           std::span<const double> values) {
  switch (shape.kind) {
    case ShapeDescription::Kind::capsule:
      return continuo::Capsule<double>{.length = values[0], .radius = values[1]};
    case ShapeDescription::Kind::box: {
      continuo::Box<double, Dim> box;
      for (std::size_t axis = 0; axis < box.size.size(); ++axis) box.size[axis] = values[axis];
      box.rounding = values[box.size.size()];
      return box;
    }
    case ShapeDescription::Kind::hull: {
      continuo::Hull<double, Dim> hull{.points = {}, .rounding = values[0]};
      for (const auto& corner : shape.corners) {
        Vector<double, Dim>& point = hull.points.emplace_back();
        for (std::size_t axis = 0; axis < point.size(); ++axis) point[axis] = corner[axis];
      }
      return hull;
    }
    case ShapeDescription::Kind::ball:
      break;
  }
  return continuo::Sphere<double>{values[0]};
}

}  // namespace continuo::model
