// continuo/worlds/build_world.hpp
// A description with its parameters as they are, made into bodies.
#pragma once
#include <span>
#include <string>

#include <continuo/bodies/world.hpp>
#include <continuo/language/model.hpp>
#include <continuo/language/world.hpp>

namespace continuo::worlds {

template <int Dim>
struct BuiltWorld {
  World<double, Dim> world;
  Status status{};  // fails where a body or wall cannot be
};

/// Where bodies are and how they move comes from the states in `variables`. Bodies stand in the description's order.
template <int Dim>
[[nodiscard]] BuiltWorld<Dim> build_world(const model::Model& model, std::span<const double> variables);

extern template BuiltWorld<2> build_world(const model::Model&, std::span<const double>);
extern template BuiltWorld<3> build_world(const model::Model&, std::span<const double>);

}  // namespace continuo::worlds
