// From the description of a shape in a model to the shape: which expressions it needs, and what their values make.
//
//   const std::vector<double> values = evaluate(model, shape_nodes(body.shape, 2), variables);
//   const Shape<double, 2> shape = described_shape<2>(body.shape, values);
#pragma once
#include <cstddef>
#include <span>
#include <type_traits>
#include <variant>
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
    case ShapeDescription::Kind::compound: {
      std::vector<NodeId> nodes;
      for (const PartDescription& part : shape.parts)
        for (const NodeId node : shape_nodes(part.shape, dimension)) nodes.push_back(node);
      return nodes;
    }
    case ShapeDescription::Kind::ball:
      break;
  }
  return {shape.radius};
}

/// The shape, from the values of its expressions in that order.
template <int Dim>
[[nodiscard]] continuo::Shape<double, Dim> described_shape(const ShapeDescription& shape,
                                                           std::span<const double> values);

/// A part of a compound with this shape, which is none.
template <int Dim>
[[nodiscard]] ShapePart<double, Dim> described_part(const PartDescription& of,
                                                    const continuo::Shape<double, Dim>& shape) {
  ShapePart<double, Dim> part;
  std::visit(
      [&](const auto& convex) {
        if constexpr (!std::is_same_v<decltype(convex), const Compound<double, Dim>&>) part.shape = convex;
      },
      shape);
  for (std::size_t axis = 0; axis < part.position.size(); ++axis) part.position[axis] = of.position[axis];
  for (std::size_t k = 0; k < part.orientation.size(); ++k) part.orientation[k] = of.orientation[k];
  return part;
}

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
    case ShapeDescription::Kind::compound: {
      continuo::Compound<double, Dim> compound;
      for (const PartDescription& part : shape.parts) {
        const std::size_t count = shape_nodes(part.shape, Dim).size();
        compound.parts.push_back(described_part<Dim>(part, described_shape<Dim>(part.shape, values.first(count))));
        values = values.subspan(count);
      }
      return compound;
    }
    case ShapeDescription::Kind::ball:
      break;
  }
  return continuo::Sphere<double>{values[0]};
}

}  // namespace continuo::model
