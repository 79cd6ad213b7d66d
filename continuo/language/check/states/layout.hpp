// continuo/language/check/states/layout.hpp
// The place of every variable in the flat space of the model, and the states in it.
#pragma once
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

/// When all orders are known; gives bases, unknowns, parameters and inputs their places.
[[nodiscard]] Layout lay_out(Declarations& declared);
/// Room for what is found out about each place.
void make_room(Workspace& workspace);
/// x, x', ... of each base with their units; E201 where the units of a chain do not fit.
[[nodiscard]] std::vector<State> name_states(Expressions& expressions);

}  // namespace continuo::model::detail
