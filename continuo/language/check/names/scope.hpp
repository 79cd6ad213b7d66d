// continuo/language/check/names/scope.hpp
// Where an expression stands, and what it comes to: the values that the passes hand to each other.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <continuo/language/model.hpp>
#include <continuo/language/syntax/ast.hpp>
#include <continuo/symbolic/units/unit_check.hpp>

namespace continuo::model::detail {

/// `for i in ...`: what i is at the moment, and the index of the family around this one.
struct Index {
  std::string_view name;
  long value;
  const Index* outer = nullptr;

  /// Nearly every index has one letter, and nearly every question is about one.
  [[nodiscard]] bool is_called(std::string_view text) const {
    return text.size() == name.size() && text.front() == name.front() && (text.size() == 1 || text == name);
  }
};

/// Which member of the families around it a statement is written out for, and in which mode it stands. It is kept for
/// every member, so it is small.
struct Instance {
  static constexpr int no_mode = -1;
  const Index* innermost = nullptr;
  int mode = no_mode;

  /// Null where no family around it has an index of this name.
  [[nodiscard]] const Index* find_index(std::string_view name) const {
    const Index* index = innermost;
    while (index && !index->is_called(name)) index = index->outer;
    return index;
  }
};

/// Where an expression stands. Whoever changes it for a part of the text changes a copy.
struct Scope : Instance {
  Scope() = default;
  Scope(const Instance& instance) : Instance(instance) {}  // NOLINT(google-explicit-constructor)

  std::string_view constant = {};           // what must be constant here: "an index"; empty: everything may stand here
  std::vector<Sample>* samples = nullptr;   // where h(1) may stand: in checks and conditions
  const ast::Expression* moment = nullptr;  // of a condition: what changes is named with its time, x(0)
  std::vector<std::uint32_t>* highest = nullptr;  // notes the bases whose highest derivatives stand in the expression
  std::size_t depth = 0;                          // of expressions and definitions inside each other
  bool ruled_out = false;  // by the indices: `if i > 1 then u[i-1] else 0` at i = 1, where u[0] is not looked for

  [[nodiscard]] bool is_constant() const { return !constant.empty(); }
};

/// A node with what it measures. `bad`: an error was reported, nothing more is said about it.
struct Value {
  NodeId node;
  Measured measured = Measured::unknown();
  bool condition = false;
  bool bad = false;
};

/// A value and the text it came from, for messages.
struct Term {
  const ast::Expression& text;
  Value value;
};

/// Which branch of `if` is taken, where that is known when the model is read.
enum class Choice : unsigned char { open, yes, no };

/// How far something is that is found when it is first asked for.
enum class Progress : unsigned char { untouched, busy, done };

/// Variables that stand for the highest derivatives while equations are solved for them.
inline constexpr std::uint32_t highest_begin = 1u << 30;

}  // namespace continuo::model::detail
