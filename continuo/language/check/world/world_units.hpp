// continuo/language/check/world/world_units.hpp
// The units of length and mass in a world, and those of its states.
#pragma once
#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/world/world_at_work.hpp>

namespace continuo::model::detail {

/// The length is that of the first position that has a unit; then masses are in kilograms. Before anything is made.
void measure_world(Expressions& expressions, WorldAtWork& work);

}  // namespace continuo::model::detail
