// Adds the joints of a description to a world.
#pragma once
#include <span>
#include <vector>

#include <continuo/bodies/world.hpp>
#include <continuo/language/model.hpp>
#include <continuo/language/world.hpp>

namespace continuo::worlds {

/// The handles of the joints, in the order of the description. The bodies are where they are to be held. Fails for a
/// joint that makes no sense with these values.
template <int Dim>
[[nodiscard]] Result<std::vector<JointHandle>> add_joints(const model::Model& model, std::span<const double> variables,
                                                          World<double, Dim>& world);

extern template Result<std::vector<JointHandle>> add_joints(const model::Model&, std::span<const double>,
                                                            World<double, 2>&);
extern template Result<std::vector<JointHandle>> add_joints(const model::Model&, std::span<const double>,
                                                            World<double, 3>&);

}  // namespace continuo::worlds
