// Which unknowns of algebraic equations an expression depends on, and by which equations:
//
//   const UnknownCoupling coupling(program, program.model.modes[mode].derivatives);
//   coupling.block(program.model.events[0].guard)      // its unknowns, and those that they are determined together
//   with
//
// Each unknown is assigned an equation that contains it. The unknowns that an expression needs are those it reads,
// those in their equations, and so on: they are as many as these equations, which determine them without the others.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <continuo/simulation/program/model_program.hpp>
#include <continuo/symbolic/graph/assignment.hpp>

namespace continuo::model {

/// Unknowns by their components of the state, ascending, and as many residuals.
struct UnknownBlock {
  std::vector<std::uint32_t> components;
  std::vector<NodeId> residuals;

  [[nodiscard]] bool empty() const { return components.empty(); }
};

/// Unknowns that are enclosed together. The time grows with the third power.
inline constexpr std::size_t most_enclosed_unknowns = 20;

class UnknownCoupling {
 public:
  /// `equations`: those of a mode, by component of the state.
  UnknownCoupling(const ModelProgram& program, std::span<const NodeId> equations);

  /// Empty for an expression without unknowns; nothing where there are more than `most_enclosed_unknowns` of them.
  [[nodiscard]] std::optional<UnknownBlock> block(NodeId expression) const;

 private:
  const ModelProgram* program_;
  std::vector<std::uint32_t> components_;  // of the unknowns
  std::vector<NodeId> residuals_;
  Assignment assignment_;
};

}  // namespace continuo::model
