// The lists of the words of the language.
#include <algorithm>
#include <array>

#include <continuo/language/text/words.hpp>

namespace continuo::model {

namespace {

using Word = std::string_view;

constexpr std::array<Word, 20> statements = {"model",     "param", "let",  "output", "energy", "input", "table",
                                             "unknown",   "guess", "mode", "start",  "when",   "at",    "every",
                                             "initially", "for",   "run",  "plot",   "draw",   "check"};
constexpr std::array<Word, 5> actions = {"if", "go", "mark", "stop", "for"};
constexpr std::array<Word, 11> inside = {"if", "then", "else", "and", "or", "not", "in", "from", "go", "mark", "stop"};
constexpr std::array<Word, 32> functions = {"sin",  "cos",   "tan",   "asin",  "acos",  "atan",   "atan2",  "sinh",
                                            "cosh", "tanh",  "asinh", "acosh", "atanh", "exp",    "ln",     "log",
                                            "log2", "log10", "sqrt",  "cbrt",  "hypot", "abs",    "min",    "max",
                                            "sign", "floor", "ceil",  "round", "mod",   "smooth", "interp", "pow"};

}  // namespace

std::span<const std::string_view> statement_words() {
  return statements;
}
std::span<const std::string_view> action_words() {
  return actions;
}

bool is_reserved(std::string_view word) {
  return word == "sum" || std::find(statements.begin(), statements.end(), word) != statements.end() ||
         std::find(inside.begin(), inside.end(), word) != inside.end();
}

bool is_function(std::string_view name) {
  return std::find(functions.begin(), functions.end(), name) != functions.end();
}

}  // namespace continuo::model
