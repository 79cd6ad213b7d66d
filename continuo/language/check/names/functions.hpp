// continuo/language/check/names/functions.hpp
// The functions a model can call.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace continuo::model::detail {

struct Function {
  /// What the function asks of the units of its arguments, and what it gives.
  enum class Units {
    pure,   // pure numbers to a pure number
    same,   // arguments alike, result like them: abs, min, hypot
    root,   // sqrt, cbrt
    ratio,  // arguments alike, result a pure number: atan2
    sign,   // anything to a pure number
    power
  };
  std::string_view name;
  std::size_t least, most;  // arguments
  Units units;
};

/// Null where there is none of this name; `interp` is none of these.
const Function* find_function(std::string_view name);
bool is_function(std::string_view name);
/// All of them, for suggestions.
std::vector<std::string> function_names();
/// "one argument", "at least 2 arguments".
std::string arguments_of(const Function& function);
/// What is written here instead of a function, or of a number, that other languages have by this name; else nothing.
std::string_view function_from_elsewhere(std::string_view name);
std::string_view name_from_elsewhere(std::string_view name);
/// How a call of it looks: "sin(...)", "atan2(..., ...)".
std::string example_of_call(std::string_view function);

}  // namespace continuo::model::detail
