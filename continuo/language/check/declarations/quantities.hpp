// continuo/language/check/declarations/quantities.hpp
// Named expressions: lets, outputs, energies; and the guesses of unknowns.
#pragma once
#include <string>
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

struct Quantities {
  std::vector<Quantity> lets, outputs, energies;
  NodeId total_energy;
  std::string total_energy_unit;
  std::vector<NodeId> energy_terms;
};

/// Every definition is looked at once, named or not, so that its mistakes are reported.
void look_at_definitions(Expressions& expressions);
/// When the equations are solved: highest derivatives may stand in them.
[[nodiscard]] Quantities make_quantities(Expressions& expressions);
/// Their units go to the workspace.
[[nodiscard]] std::vector<Unknown> make_unknowns(Expressions& expressions);

}  // namespace continuo::model::detail
