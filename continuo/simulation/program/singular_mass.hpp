// continuo/simulation/program/singular_mass.hpp
// Equations that were solved for their highest derivatives by a division: whether they could be.
#pragma once
#include <optional>
#include <span>

#include <continuo/language/model.hpp>
#include <continuo/language/text/diagnostic.hpp>

namespace continuo::model {

/// E335: what stands before the highest derivatives in the start mode is singular with these variables, a register file
/// as `start_values` makes it. What depends on unknowns, or of conditions at several times on states, is not looked at,
/// nor is anything where an event acts at the start.
[[nodiscard]] std::optional<Diagnostic> singular_mass(const Model& model, std::span<const double> variables);

}  // namespace continuo::model
