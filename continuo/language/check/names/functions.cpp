// continuo/language/check/names/functions.cpp
// The table of functions: how many arguments each takes, and what it asks of their units.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <continuo/language/check/names/functions.hpp>

namespace continuo::model::detail {

namespace {

using enum Function::Units;
constexpr std::size_t many = 1000;

constexpr std::array<Function, 34> functions = {{
    {"sin", 1, 1, pure},    {"cos", 1, 1, pure},    {"tan", 1, 1, pure},      {"asin", 1, 1, pure},
    {"acos", 1, 1, pure},   {"atan", 1, 1, pure},   {"sinh", 1, 1, pure},     {"cosh", 1, 1, pure},
    {"tanh", 1, 1, pure},   {"asinh", 1, 1, pure},  {"acosh", 1, 1, pure},    {"atanh", 1, 1, pure},
    {"exp", 1, 1, pure},    {"log", 1, 1, pure},    {"ln", 1, 1, pure},       {"log2", 1, 1, pure},
    {"log10", 1, 1, pure},  {"floor", 1, 1, pure},  {"ceil", 1, 1, pure},     {"round", 1, 1, pure},
    {"sqrt", 1, 1, root},   {"cbrt", 1, 1, root},   {"abs", 1, 1, same},      {"min", 2, many, same},
    {"max", 2, many, same}, {"mod", 2, 2, same},    {"hypot", 2, many, same}, {"atan2", 2, 2, ratio},
    {"sign", 1, 1, sign},   {"pow", 2, 2, power},   {"if", 0, 0, pure},       {"not", 0, 0, pure},
    {"interp", 2, 2, pure}, {"smooth", 1, 1, same},
}};

}  // namespace

const Function* find_function(std::string_view name) {
  const auto* found = std::ranges::find(functions, name, &Function::name);
  return found == functions.end() || found->most == 0 || name == "interp" ? nullptr : found;
}

bool is_function(std::string_view name) {
  return name == "interp" || find_function(name) != nullptr;
}

std::string arguments_of(const Function& function) {
  if (function.most == many) return fmt::format("at least {} arguments", function.least);
  return function.least == 1 ? "one argument" : fmt::format("{} arguments", function.least);
}

std::string example_of_call(std::string_view name) {
  if (name == "interp") return "interp(TABLE, x)";
  const Function* function = find_function(name);
  return fmt::format("{}({})", name, function && function->least > 1 ? "..., ..." : "...");
}

std::vector<std::string> function_names() {
  std::vector<std::string> names;
  for (const Function& known : functions) names.emplace_back(known.name);
  return names;
}

}  // namespace continuo::model::detail
