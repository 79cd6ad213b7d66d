// continuo/language/check/states/layout.cpp
// Places are given in the order t, states, unknowns, parameters, inputs.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/check/states/layout.hpp>

namespace continuo::model::detail {

namespace {

/// The unit written beside x'(0) must be that of x by that of t, up to a factor.
void hold_to_chain(Expressions& expressions, std::size_t index, int primes) {
  Workspace& workspace = expressions.workspace;
  const Declarations& declared = workspace.declared;
  const Base& base = declared.bases[index];
  const Measured below = workspace.units.of(index, primes - 1), own = workspace.units.of(index, primes),
                 rate = workspace.time.per_time(below);
  if (factor_between(own, rate)) return;
  const std::string name = with_primes(base.name, primes);
  for (const std::size_t i : base.conditions) {
    if (declared.conditions[i].text->name.primes != primes) continue;
    expressions.report.fail("E201", declared.conditions[i].span, "units do not match",
                            fmt::format("`{}` is {}, so `{}` is {}, not {}", with_primes(base.name, primes - 1),
                                        unit_text(below), name, unit_text(rate), unit_text(own)));
    workspace.conditions.of(i).value.bad = true;
  }
  workspace.units.set(base.first + static_cast<std::size_t>(primes), rate);
}

}  // namespace

Layout lay_out(Declarations& declared) {
  Layout layout;
  std::size_t states = 0;
  for (Base& base : declared.bases) {
    base.first = states;
    states += static_cast<std::size_t>(base.order);
  }
  std::vector<Definition>& definitions = declared.definitions;
  for (std::size_t i = 0; i < definitions.size(); ++i) {
    if (definitions[i].kind == Definition::Kind::parameter) declared.parameters.push_back(i);
  }
  // Unknowns lie behind the states: together they are what a solver solves for.
  std::uint32_t next = layout.unknowns = layout.states + static_cast<std::uint32_t>(states);
  for (UnknownText& unknown : declared.unknowns) unknown.variable = next++;
  layout.parameters = next;
  std::ranges::sort(declared.parameters, {},
                    [&](std::size_t i) { return std::pair(definitions[i].text->span.begin, i); });
  for (const std::size_t i : declared.parameters) definitions[i].variable = next++;
  layout.inputs = next;
  for (Definition& definition : definitions) {
    if (definition.kind == Definition::Kind::input) definition.variable = next++;
  }
  layout.samples = layout.size = next;
  return layout;
}

void make_room(Workspace& workspace) {
  const Layout& layout = workspace.layout;
  workspace.registers.assign(layout.size, 0.0);
  workspace.units.reserve(layout.unknowns - layout.states);
  workspace.unknown_units.resize(workspace.declared.unknowns.size(), Measured::unknown());
}

std::vector<State> name_states(Expressions& expressions) {
  Workspace& workspace = expressions.workspace;
  std::vector<State> states;
  states.reserve(workspace.layout.unknowns - workspace.layout.states);
  for (std::size_t b = 0; b < workspace.declared.bases.size(); ++b) {
    const Base& base = workspace.declared.bases[b];
    for (int k = 0; k < base.order; ++k) {
      const auto variable = workspace.layout.states + static_cast<std::uint32_t>(states.size());
      if (k > 0) hold_to_chain(expressions, b, k);
      State& state = states.emplace_back();
      state.base = base.name;
      state.primes = k;
      state.column = k == 0 ? base.name : with_primes(base.name, k);
      state.variable = variable;
      state.unit = unit_or_nothing(workspace.units.of(b, k));
      state.span = base.span;
      state.in_world = base.in_world;
    }
  }
  return states;
}

}  // namespace continuo::model::detail
