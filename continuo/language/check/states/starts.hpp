// continuo/language/check/states/starts.hpp
// Starts by other starts: S(0) = 1 - I(0) - R(0), m(0) = am/(am + bm) with lets of states.
#pragma once
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

/// Of conditions that all stand at the start: each state in an initial value is replaced by what it starts from, so
/// that what remains are parameters, inputs and t. Samples in them are no numbers of the run: they are released.
void solve_starts(Expressions& expressions, std::vector<State>& states, double start_time);

}  // namespace continuo::model::detail
