// continuo/language/check/names/symbol.hpp
// What a declared name stands for.
#pragma once
#include <cstddef>

#include <continuo/language/text/source.hpp>

namespace continuo::model::detail {

struct Symbol {
  enum class Kind : unsigned char { definition, base, unknown, table, body, joint };
  Kind kind;
  std::size_t index;  // in the list of its kind: Declarations
  Span span;
};

}  // namespace continuo::model::detail
