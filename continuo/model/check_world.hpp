// continuo/model/check_world.hpp
// Only check_world*.cpp read this.
#pragma once
#include <algorithm>
#include <string_view>

#include <continuo/model/ast_world.hpp>

namespace continuo::model::detail {

/// Null where it is not given.
inline const ast::Expression* attribute(const ast::WorldAttributes& attributes, std::string_view name) {
  const auto found = std::ranges::find(attributes, name, [](const auto& one) { return one.name.text; });
  return found == attributes.end() ? nullptr : &found->value;
}

}  // namespace continuo::model::detail
