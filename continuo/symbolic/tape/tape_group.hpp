// Which operations of a tape stand together, and in which order. Internal to the tape.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/symbolic/graph/expression.hpp>
#include <continuo/symbolic/tape/tape_select.hpp>

namespace continuo::model::tape {

/// From this many equal operations on, a loop over them is cheaper than as many instructions (measured by
/// bench/tape: a loop costs about as much as eight of them to begin).
inline constexpr std::size_t smallest_batch = 12;

/// What comes about in the same way has the same.
using Colour = std::uint64_t;

/// Numbers of operations.
using Group = std::vector<std::size_t>;

/// Operations that do not wait for each other and do the same, in an order in which all can be computed. Those that
/// come about in the same way, from members of the same families, have a group of their own: the equations of one
/// family for all its inner points. `colour` is that of what is not computed here (a family, say), by node; it becomes
/// that of the results too.
[[nodiscard]] std::vector<Group> groups_of(std::span<const Selected> selected, std::vector<Colour>& colour);

/// The registers an operation reads.
using Places = std::array<std::uint32_t, 4>;

/// Consecutive members of a group.
struct Stretch {
  std::size_t begin, end;
};

/// Cuts a sequence of operations so that within a stretch each operand stays where it is or goes on by one register,
/// where that pays.
[[nodiscard]] std::vector<Stretch> stretches(std::span<const Places> sequence);

/// How often such a sequence breaks.
[[nodiscard]] std::size_t breaks(std::span<const Places> sequence);

}  // namespace continuo::model::tape
