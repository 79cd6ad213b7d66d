// continuo/language/check/equations/reduction.hpp
// From solved equations to the system of first order: h' = h', (h')' = ..., and the pairs of position and velocity.
#pragma once
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

/// The derivatives of all states from the highest derivatives of all bases.
[[nodiscard]] std::vector<NodeId> reduce(const std::vector<NodeId>& highest, Workspace& workspace);

struct PairedStates {
  std::vector<PositionVelocity> all;
  bool is_everything = false;                       // every state is in one pair
  bool accelerations_depend_on_velocities = false;  // then methods for x'' = a(t, x) lose their order
};
/// x and v are a pair where x' is v in every mode, written as x'' = ... or as x' = v.
[[nodiscard]] PairedStates pair_up(const Model& model);

}  // namespace continuo::model::detail
