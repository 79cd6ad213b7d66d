// continuo/language/check/world/body_names.hpp
// Bodies by name.
#pragma once
#include <optional>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

/// E223 where there is no body of this name.
[[nodiscard]] std::optional<std::size_t> body_named(const ast::Name& name, Scope& scope, Expressions& expressions);

}  // namespace continuo::model::detail
