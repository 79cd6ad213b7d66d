// continuo/worlds/build_world.hpp
// Builds the bodies of a world from its description and the present values of its parameters.
#pragma once
#include <span>
#include <vector>

#include <continuo/bodies/world.hpp>
#include <continuo/language/model.hpp>
#include <continuo/language/world.hpp>

namespace continuo::worlds {

/// A world of bodies, or the reason why there is none.
template <int Dim>
struct BuiltWorld {
  World<double, Dim> world;
  std::vector<JointHandle> joints{};  // in the order of the description
  Status status{};                    // fails where a body, a wall or a joint is invalid
};

/// The positions and velocities of bodies come from the states in `variables`, which are those of the start: there
/// joints hold them. Bodies have the order of the description.
template <int Dim>
[[nodiscard]] BuiltWorld<Dim> build_world(const model::Model& model, std::span<const double> variables);

extern template BuiltWorld<2> build_world(const model::Model&, std::span<const double>);
extern template BuiltWorld<3> build_world(const model::Model&, std::span<const double>);

}  // namespace continuo::worlds
