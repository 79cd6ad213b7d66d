// continuo/language/check/world/body_names.cpp
// Bodies by name, with what may have been meant.
#include <fmt/format.h>

#include <continuo/language/check/world/body_names.hpp>
#include <continuo/language/syntax/format.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

std::optional<std::size_t> body_named(const ast::Name& name, Scope& scope, Expressions& expressions) {
  const auto indexed_name = expressions.indices.name_of(name, scope);
  if (!indexed_name) return std::nullopt;
  const std::string key = indexed_name->text();
  const Symbol* symbol = name.primes == 0 && name.member.empty()
                             ? expressions.workspace.declared.symbols.find(*indexed_name, Scope::no_mode)
                             : nullptr;
  if (symbol && symbol->kind == Symbol::Kind::body) return symbol->index;
  if (expressions.workspace.declared.symbols.is_family_of_bodies(name.text) && !symbol && name.member.empty()) {
    expressions.lookup.unknown_name(name, key);  // the index is wrong, or missing
    return std::nullopt;
  }
  if (expressions.workspace.declared.symbols.is_lost(name.text)) return std::nullopt;
  std::vector<std::string> names;
  for (const BodyText& body : expressions.workspace.declared.world.bodies) names.push_back(body.name);
  const std::string near = did_you_mean(key, names);
  expressions.report.fail("E223", name.span, fmt::format("there is no body `{}`", to_text(name)), {},
                          !near.empty() ? near
                          : names.empty()
                              ? fmt::format("the model has no world: world {{ body {} at (0, 0) }}", name.text)
                              : "the bodies are " + listed(names));
  return std::nullopt;
}

}  // namespace continuo::model::detail
