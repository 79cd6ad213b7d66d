// continuo/language/check/expressions/repair.cpp
// Tries primes silently; the first change that fits is the proposal.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/expressions/repair.hpp>
#include <continuo/language/syntax/format.hpp>

namespace continuo::model::detail {

namespace {

/// The names of an expression in the order of the text, to be changed in place.
void collect_names(ast::Expression& expression, std::vector<ast::Name*>& names) {
  std::visit(
      [&](auto& node) {
        using T = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<T, ast::Name>) {
          names.push_back(&node);
        } else if constexpr (std::is_same_v<T, ast::Unary>) {
          collect_names(*node.operand, names);
        } else if constexpr (std::is_same_v<T, ast::Binary>) {
          collect_names(*node.left, names);
          collect_names(*node.right, names);
        } else if constexpr (std::is_same_v<T, ast::Call>) {
          for (ast::Expression& argument : node.arguments) collect_names(argument, names);
        }
      },
      expression.node);
}

}  // namespace

std::string repair(Expressions& expressions, const Term& term, const Measured& wanted, const Scope& scope) {
  constexpr std::size_t most_tried = 12;
  if (expressions.report.is_silent() || scope.is_constant()) return {};
  Report silent = expressions.report.silent();
  const Expressions trial(expressions.workspace, silent);
  Scope inner = scope;
  inner.highest = nullptr;
  const Declarations& declared = expressions.workspace.declared;
  ast::Expression copy = term.text;
  std::vector<ast::Name*> names;
  collect_names(copy, names);
  for (std::size_t i = 0; i < std::min(names.size(), most_tried); ++i) {
    const auto key = trial.indices.name_of(*names[i], inner);
    const Symbol* symbol = key ? declared.symbols.find(*key, inner.mode) : nullptr;
    if (!symbol || symbol->kind != Symbol::Kind::base) continue;
    const int written = names[i]->primes;
    for (const int primes : {written + 1, written - 1}) {
      if (primes < 0 || primes > declared.bases[symbol->index].order) continue;
      names[i]->primes = primes;
      const Value value = trial.translator.translate(copy, inner);
      if (value.bad || !value.measured.is_known() || !factor_between(value.measured, wanted)) continue;
      return fmt::format("did you mean {} ?", to_text(copy));
    }
    names[i]->primes = written;
  }
  return {};
}

}  // namespace continuo::model::detail
