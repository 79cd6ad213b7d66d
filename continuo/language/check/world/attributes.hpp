// continuo/language/check/world/attributes.hpp
// The attributes of bodies, walls and springs by name.
#pragma once
#include <algorithm>
#include <string_view>

#include <continuo/language/syntax/ast_world.hpp>

namespace continuo::model::detail {

/// Null where it is not given.
[[nodiscard]] inline const ast::Expression* attribute(const ast::WorldAttributes& attributes, std::string_view name) {
  const auto found = std::ranges::find(attributes, name, [](const auto& one) { return one.name.text; });
  return found == attributes.end() ? nullptr : &found->value;
}

/// `(1, 2)`, `(1, 2) [m]`.
[[nodiscard]] inline bool is_point(const ast::Expression& expression) {
  const auto* quantity = std::get_if<ast::Quantity>(&expression.node);
  return std::holds_alternative<ast::List>(quantity ? quantity->value->node : expression.node);
}

}  // namespace continuo::model::detail
