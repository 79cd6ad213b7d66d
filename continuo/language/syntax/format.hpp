// continuo/language/syntax/format.hpp
// Parsed text back to text, one spelling for every tree: names of events, labels of columns.
//
//   to_text(expression)   // "-e*h'", "1/2*h'^2", "3 [m/s]"
//   event_name(when)      // "h falls through 0", "h < 0", and " in flight" where the event names a mode
#pragma once
#include <string>

#include <continuo/language/syntax/ast.hpp>

namespace continuo::model {

[[nodiscard]] std::string to_text(const ast::Expression& expression);
[[nodiscard]] std::string to_text(const ast::Name& name);
[[nodiscard]] std::string to_text(const ast::Range& range);
[[nodiscard]] std::string to_text(const ast::Equation& equation);

/// Made of numbers, `pi` and functions of these, and no unit.
[[nodiscard]] bool is_plain_number(const ast::Expression& expression);

[[nodiscard]] std::string event_name(const ast::When& event);
[[nodiscard]] std::string event_name(const ast::At& event);
[[nodiscard]] std::string event_name(const ast::Every& event);
[[nodiscard]] std::string event_name(const ast::Initially& event);

}  // namespace continuo::model
