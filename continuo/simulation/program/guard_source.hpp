// The proof that a step of a Taylor series has no root of a guard in it, written as C: every guard by the ranges of
// what it is made of, the states by the terms of their series. The ranges hold what the rounding of the guard, of the
// dense output and of the end of the step may make of it.
//
//   const GuardSource source = guard_source(graph, guards, states_begin, states_end, 17);
//   if (source.text)     // the function `may_have_root`, for code around it that knows `N`, the number of states
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <continuo/symbolic/graph/expression.hpp>

namespace continuo::model {

struct GuardSource {
  std::optional<std::string> text{};  // none where a guard has an operation, or so many parts, that it is not written
  std::vector<NodeId> numbers{};      // what does not move, in the order in which the function gets the values
};

/// For steps of a series of this order, at least 4: states are the variables from `states_begin` on, variable
/// Layout::time is the time.
[[nodiscard]] GuardSource guard_source(const Graph& graph, std::span<const NodeId> guards, std::uint32_t states_begin,
                                       std::uint32_t states_end, std::size_t order);

}  // namespace continuo::model
