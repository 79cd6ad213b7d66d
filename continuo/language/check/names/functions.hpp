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
[[nodiscard]] const Function* find_function(std::string_view name);
[[nodiscard]] bool is_function(std::string_view name);
/// All of them, for suggestions.
[[nodiscard]] std::vector<std::string> function_names();
/// "one argument", "at least 2 arguments".
[[nodiscard]] std::string arguments_of(const Function& function);
/// What is written here instead of a function, or of a number, that other languages have by this name; else nothing.
[[nodiscard]] std::string_view function_from_elsewhere(std::string_view name);
[[nodiscard]] std::string_view name_from_elsewhere(std::string_view name);
/// How a call of it looks: "sin(...)", "atan2(..., ...)".
[[nodiscard]] std::string example_of_call(std::string_view function);

}  // namespace continuo::model::detail
