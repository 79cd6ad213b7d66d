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

/// How many components there are: 2 of `(1, 2)` and `(1, 2) [m]`, 1 of what is no point.
[[nodiscard]] inline std::size_t size_of_point(const ast::Expression& expression) {
  const auto* quantity = std::get_if<ast::Quantity>(&expression.node);
  const auto* list = std::get_if<ast::List>(quantity ? &quantity->value->node : &expression.node);
  return list ? list->items.size() : 1;
}

/// `(1, 2)`, `(1, 2) [m]`.
[[nodiscard]] inline bool is_point(const ast::Expression& expression) {
  return size_of_point(expression) > 1;
}

}  // namespace continuo::model::detail
