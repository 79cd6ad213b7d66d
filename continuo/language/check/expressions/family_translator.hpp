// Translates a text that stands in a family for one member after the other. What the members have in common is found
// once: the operations, the names without index, and that units fit. A member then takes its own names and numbers.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/language/check/names/scope.hpp>

namespace continuo::model::detail {

class Expressions;
class Members;

class FamilyTranslator {
 public:
  /// What expressions.translator.translate gives. Texts that follow each other should be the same.
  [[nodiscard]] Value translate(const Expressions& expressions, const ast::Expression& text, Scope& scope);

 private:
  static constexpr std::size_t most_indices = 8, most_choices = 64;
  using Part = std::uint32_t;

  /// number + the sum of factors[d]*(the index d families out) over the bits d of `depends`.
  struct Sum {
    double number = 0;
    std::uint32_t depends = 0;
    std::array<double, most_indices> factors{};
  };
  struct Node {
    enum class Kind : unsigned char { fixed, index, name, negation, operation, function, choice };
    Kind kind = Kind::fixed;
    bool is_of_numbers = false;  // it has neither names with indices nor choices
    bool is_by_value = false;    // and one index decides it
    Op op{};
    ast::BinaryOperator comparison{};  // of `choice`
    std::uint32_t depends = 0;         // on indices: bit d is that of the index d families out
    std::uint64_t stamp = 0;           // when `node` was made; not of what the innermost index decides
    std::uint64_t choices = 0;         // made on the way
    NodeId node{};
    std::array<Part, 2> parts{};
    std::size_t number = 0;  // of an index, of a choice, of the states of a name
    const ast::Name* name = nullptr;
    std::optional<Measured> measured{};  // of a name
    std::string_view function{};
    std::size_t arguments = 0;
    std::array<Sum, 2> sides{};  // of `choice`
    std::vector<Sum> places{};   // the indices of a name, where each is a sum
    const Members* members = nullptr;
    std::vector<NodeId> by_value{};  // of what one index decides: from `first_value` on
    long first_value = 0;
  };
  /// The states of a family that names have asked for, by the number of the member; all of one unit.
  struct States {
    const Members* members;
    int primes;
    std::optional<Measured> measured{};
    std::vector<NodeId> nodes{};
  };
  /// Which branches a member takes, and the unit of what comes out; checked against the translator once.
  struct Path {
    std::uint64_t choices;
    Measured measured;
  };

  [[nodiscard]] Value translate_member(const Expressions& expressions, const ast::Expression& text, Scope& scope);
  void begin(const ast::Expression& text, const Scope& scope);
  [[nodiscard]] Value translate_path(const Expressions& expressions, const ast::Expression& text, Scope& scope);
  void note_indices(const Scope& scope);
  [[nodiscard]] std::uint64_t stamp_of(std::uint32_t depends) const;

  // Reading the text: nothing where it has what is not provided for.
  [[nodiscard]] std::optional<Part> read(const Expressions& expressions, const ast::Expression& text, Scope& scope);
  [[nodiscard]] std::optional<Part> read(const Expressions& expressions, const ast::Name& name, Scope& scope);
  [[nodiscard]] std::vector<Sum> read_places(const Expressions& expressions, const ast::Name& name, Scope& scope);
  [[nodiscard]] std::optional<Part> read(const Expressions& expressions, const ast::Binary& text, Scope& scope);
  [[nodiscard]] std::optional<Part> read(const Expressions& expressions, const ast::Call& text, Scope& scope);
  [[nodiscard]] std::optional<Part> read(const Expressions& expressions, const ast::Conditional& text, Scope& scope);
  [[nodiscard]] std::optional<Sum> read_sum(const Expressions& expressions, const ast::Expression& text, Scope& scope);
  [[nodiscard]] std::optional<std::size_t> index_called(const ast::Name& name) const;
  [[nodiscard]] Part add(Node node);

  // One member: an invalid node where it is another case than the members before.
  [[nodiscard]] NodeId make(const Expressions& expressions, Part part, Scope& scope);
  [[nodiscard]] NodeId make_anew(const Expressions& expressions, Node& node, Scope& scope);
  [[nodiscard]] NodeId make_by_value(const Expressions& expressions, Node& node, Scope& scope);
  [[nodiscard]] NodeId make_name(const Expressions& expressions, Node& node, Scope& scope);
  [[nodiscard]] NodeId find_state(const Expressions& expressions, Node& node, Scope& scope);
  [[nodiscard]] NodeId new_state(const Expressions& expressions, const Node& node, std::uint32_t number, Scope& scope);
  [[nodiscard]] std::size_t states_of(const Members& members, int primes);
  [[nodiscard]] bool holds(const Node& choice) const;
  [[nodiscard]] double value_of(const Sum& sum) const;

  const ast::Expression* text_ = nullptr;
  int mode_ = 0;
  std::size_t members_ = 0;
  bool is_given_up_ = false, is_busy_ = false;  // busy: a text that asks for another one
  std::vector<std::string_view> names_;         // of indices, the innermost first
  std::array<double, most_indices> values_{};
  std::array<std::uint64_t, most_indices> changes_{};  // of each value so far
  std::vector<Node> nodes_;
  std::vector<States> states_;
  Part root_ = 0;
  std::size_t choice_count_ = 0;
  std::uint64_t choices_ = 0;  // of the member at hand
  std::vector<Path> paths_;
  std::size_t recent_path_ = 0;  // of the member before
};

}  // namespace continuo::model::detail
