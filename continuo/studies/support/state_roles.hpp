// The roles of the states of a model in a study of neighbouring motions: directions in which these may lie,
// flags and counters that jump by whole steps, sums that nothing reads.
#pragma once
#include <cstddef>
#include <vector>

#include <continuo/simulation/program/model_program.hpp>

namespace continuo::studies {

/// A counter or a flag: only events change it, by whole steps or to set values, and conditions ask for its value.
[[nodiscard]] bool is_discrete(const model::ModelProgram& program, std::size_t state);
/// The states that are neither that nor unknowns of algebraic equations.
[[nodiscard]] std::vector<std::size_t> directions_of(const model::ModelProgram& program);
/// Nothing that moves or decides reads it, neither its own equation nor its own assignments, but for the increments of
/// a sum `n := n + ...`: the motion of all others is the same whatever it is.
[[nodiscard]] bool is_unread(const model::ModelProgram& program, std::size_t state);

}  // namespace continuo::studies
