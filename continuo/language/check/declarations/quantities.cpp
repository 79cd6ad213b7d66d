// continuo/language/check/declarations/quantities.cpp
// Lets, outputs and energies as nodes; guesses of unknowns.
#include <continuo/language/check/declarations/quantities.hpp>

namespace continuo::model::detail {

void look_at_definitions(Expressions& expressions) {
  const std::vector<Definition>& definitions = expressions.workspace.declared.definitions;
  for (std::size_t i = 0; i < definitions.size(); ++i)
    expressions.workspace.definitions.value(i, definitions[i].text->name, {});
}

/// Lets of a mode stand only in its equations and are not named outside.
Quantities make_quantities(Expressions& expressions) {
  const Declarations& declared = expressions.workspace.declared;
  Quantities made;
  for (std::size_t i = 0; i < declared.definitions.size(); ++i) {
    const Definition& d = declared.definitions[i];
    if (d.kind == Definition::Kind::parameter || d.kind == Definition::Kind::input) continue;
    std::vector<std::uint32_t> highest;
    Scope scope;
    scope.highest = &highest;
    Value value = expressions.workspace.definitions.value(i, d.text->name, scope);
    const bool let = d.kind == Definition::Kind::let;
    if (let && (value.condition || d.scope.mode != Scope::no_mode)) continue;
    if (let && !highest.empty() && declared.has_modes()) continue;
    value = expressions.values.settle(std::move(value), d.value->span, highest);
    if (value.bad) continue;
    auto& list = let ? made.lets : d.kind == Definition::Kind::output ? made.outputs : made.energies;
    list.push_back({d.name, value.node, unit_or_nothing(value.measured), d.text->name.span});
  }
  std::vector<std::uint32_t> highest;
  Scope scope;
  scope.highest = &highest;
  const Span span = made.energies.empty() ? Span{} : made.energies.front().span;
  Value total = expressions.lookup.total_energy(span, scope);
  for (const Quantity& energy : made.energies) made.energy_terms.push_back(energy.node);
  for (const NodeId energy : expressions.lookup.world_energies()) made.energy_terms.push_back(energy);
  total = expressions.values.settle(std::move(total), span, highest);
  made.total_energy = total.node;
  made.total_energy_unit = unit_or_nothing(total.measured);
  return made;
}

std::vector<Unknown> make_unknowns(Expressions& expressions) {
  const std::vector<UnknownText>& unknowns = expressions.workspace.declared.unknowns;
  std::vector<Unknown> made;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const UnknownText& unknown = unknowns[i];
    Scope scope = unknown.scope;
    const Value guess = expressions.values.number_of(unknown.text->guess, scope);
    if (guess.measured.is_known()) expressions.workspace.unknown_units[i] = guess.measured;
    if (!guess.bad) expressions.values.only_parameters(guess.node, unknown.text->guess.span, "a guess");
    made.push_back({unknown.name, unknown.variable, guess.node, unit_or_nothing(guess.measured), unknown.span});
  }
  return made;
}

}  // namespace continuo::model::detail
