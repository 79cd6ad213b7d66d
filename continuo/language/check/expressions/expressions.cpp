// continuo/language/check/expressions/expressions.cpp
// Variables by name while the model is made.
#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

std::string name_of_variable(const Workspace& workspace, std::uint32_t variable) {
  const Declarations& declared = workspace.declared;
  const Layout& layout = workspace.layout;
  if (variable == Layout::time) return "t";
  if (variable >= highest_begin) {
    const Base& base = declared.bases[variable - highest_begin];
    return with_primes(base.name, base.order);
  }
  if (variable >= layout.states && variable < layout.unknowns) {
    const std::size_t state = variable - layout.states;
    const Base& base = declared.base_of_state(state);
    return with_primes(base.name, static_cast<int>(state - base.first));
  }
  for (const Definition& definition : declared.definitions) {
    if (definition.variable == variable) return definition.name;
  }
  for (const UnknownText& unknown : declared.unknowns) {
    if (unknown.variable == variable) return unknown.name;
  }
  return "sample " + std::to_string(variable - layout.samples);
}

}  // namespace continuo::model::detail
