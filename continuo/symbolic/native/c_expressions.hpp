// Expressions of C that share what they have in common: what is read twice, or long, has a name of its own.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/symbolic/tape/tape_code.hpp>

namespace continuo::model {

class CExpressions {
 public:
  using Id = std::uint32_t;

  /// `fused`: a product and a sum in one operation of the tape are rounded once.
  CExpressions(bool in_lanes, bool fused) : in_lanes_(in_lanes), fused_(fused) {}

  /// A number, a name or an element of an array.
  [[nodiscard]] Id leaf(std::string text);
  /// `table`: of those who look up in one.
  [[nodiscard]] Id operation(tape::Code code, std::uint32_t table, std::array<Id, 4> operands);
  /// By a statement.
  void read(Id id) {
    ++nodes_[id].readers;
    nodes_[id].is_whole = true;
  }

  /// Calls name(text) for each part that needs a name, in order, which returns it. Then `text_of` is what is left.
  void name_parts(const std::function<std::string(const std::string&)>& name);
  [[nodiscard]] const std::string& text_of(Id id) const { return nodes_[id].text; }

 private:
  struct Node {
    std::string text;
    tape::Code code = tape::Code::stop;  // of leaves
    std::uint32_t table = 0;
    std::array<Id, 4> operands = {};
    std::uint32_t readers = 0;
    bool is_whole = false;  // what a statement reads: it needs no name because it is long
  };
  struct Key {
    tape::Code code;
    std::uint32_t table;
    std::array<Id, 4> operands;
    friend auto operator<=>(const Key&, const Key&) = default;
  };

  [[nodiscard]] std::string text_of(const Node& node) const;

  bool in_lanes_, fused_;
  std::vector<Node> nodes_;
  std::map<std::string, Id> leaves_;
  std::map<Key, Id> operations_;
};

}  // namespace continuo::model
