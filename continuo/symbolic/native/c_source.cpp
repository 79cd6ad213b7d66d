// Writes a tape as a C function: members of families that are computed alike as loops, all else as single statements.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <continuo/symbolic/native/c_expressions.hpp>
#include <continuo/symbolic/native/c_operations.hpp>
#include <continuo/symbolic/native/c_source.hpp>
#include <continuo/symbolic/native/loop_nests.hpp>
#include <continuo/symbolic/native/stored_values.hpp>
#include <continuo/symbolic/native/tape_values.hpp>

namespace continuo::model {

namespace {

using tape::Code;

constexpr std::size_t smallest_family = 12;  // fewer members are statements
constexpr std::size_t most_leaves_of_loop = 64;

}  // namespace

/// Writes the body of a tape. Friend of Tape.
class TapeWriter {
 public:
  TapeWriter(const Tape& tape, const CFunctionOptions& options)
      : options_(options), constants_(constants_of(tape)), values_(body_of(tape)), stored_(values_to_store(values_)) {
    find_registers();
    find_shapes();
  }

  CFunction function() {
    std::size_t first = 0;
    for (std::size_t n = 0; n < values_.instructions(); ++n) first = store(n, first);
    outputs();
    return {.text = fmt::format("{} {{\n{}{}}}\n", options_.signature, lists_, text_), .registers = registers_};
  }

 private:
  /// What says which array is read; from `named` on: a text.
  using Array = std::uint32_t;
  /// Equal for what differs in addresses alone.
  using Shape = std::uint32_t;
  struct ShapeKey {
    Code code;
    std::uint32_t table;
    std::array<Shape, 4> operands;
    friend auto operator<=>(const ShapeKey&, const ShapeKey&) = default;
  };
  /// A number to be computed, and the place in its array where it goes.
  struct Member {
    ValueRef value;
    std::int32_t to;
  };
  /// Members of one shape.
  using Family = std::vector<Member>;
  /// The text of one member's target and leaves, in order; in loops with their variables.
  struct Statement {
    ValueRef value;
    std::vector<std::string> elements;
    std::string comment = {};
  };
  struct Loop {
    std::vector<std::size_t> counts;  // innermost first
    std::vector<Statement> statements;
  };

  static TapeBody body_of(const Tape& tape) {
    return {.registers = tape.registers_,
            .instructions = std::span(tape.body_.instructions).first(tape.body_.instructions.size() - 1),
            .batches = tape.body_.batches,
            .gathered = tape.body_.gathered,
            .copies = tape.copies_,
            .copied_from = tape.copied_from_,
            .outputs = tape.outputs_};
  }
  static std::vector<std::pair<std::uint32_t, double>> constants_of(const Tape& tape) {
    std::vector<std::pair<std::uint32_t, double>> constants;
    for (const Tape::Constant& constant : tape.constants_) constants.emplace_back(constant.target, constant.value);
    std::ranges::sort(constants, {}, [](const auto& constant) { return constant.first; });
    return constants;
  }

  // -- what is read where ---------------------------------------------------------------------------------------------

  Array registers_array() const { return static_cast<Array>(options_.arrays.size()); }
  Array constants_array() const { return registers_array() + 1; }
  Array time_array() const { return constants_array() + 1; }
  Array named() const { return time_array() + 1; }

  /// Null: the register holds no constant.
  const double* constant_at(std::uint32_t place) const {
    if (constants_.empty() || place < constants_.front().first || place > constants_.back().first) return nullptr;
    const auto found = std::ranges::lower_bound(constants_, place, {}, [](const auto& c) { return c.first; });
    return found != constants_.end() && found->first == place ? &found->second : nullptr;
  }

  Array array_of(std::uint32_t place) const {
    if (place == 0 && !options_.time.empty()) return time_array();
    for (std::size_t a = 0; a < options_.arrays.size(); ++a)
      if (place >= options_.arrays[a].begin && place < options_.arrays[a].end) return static_cast<Array>(a);
    return constant_at(place) != nullptr ? constants_array() : registers_array();
  }

  std::int32_t address_in(Array array, std::uint32_t place) const {
    const std::uint32_t begin = array < options_.arrays.size() ? options_.arrays[array].begin
                                : array == registers_array()   ? first_register_
                                                               : 0;
    return static_cast<std::int32_t>(place - begin);
  }

  bool is_stored(ValueRef ref) const { return stored_[values_.number(ref)] != 0; }
  bool is_leaf(ValueRef ref) const { return !values_.is_value(ref) || is_stored(ref); }
  bool is_named(std::size_t value) const {
    return stored_[value] != 0 && !values_.is_batch(values_.instruction(value));
  }
  std::uint32_t place_of(ValueRef ref) const {
    return values_.is_value(ref) ? values_.place(values_.number(ref)) : ref;
  }
  Array array_of_leaf(ValueRef ref) const { return values_.is_value(ref) ? registers_array() : array_of(ref); }

  /// Where nothing is prepared, `r` holds what is stored and nothing else.
  void find_registers() {
    std::uint32_t first = std::numeric_limits<std::uint32_t>::max(), end = 0;
    for (std::size_t v = 0; v < values_.size(); ++v) {
      if (stored_[v] == 0 || is_named(v)) continue;
      first = std::min(first, values_.place(v));
      end = std::max(end, values_.place(v) + 1);
    }
    first_register_ = options_.prepared || end == 0 ? 0 : first;
    registers_ = options_.prepared ? values_.registers() : end - first_register_;
  }

  // -- shapes ---------------------------------------------------------------------------------------------------------

  void find_shapes() {
    std::map<ShapeKey, Shape> known;
    Shape next = named();
    shape_.resize(values_.size());
    read_as_.resize(values_.size());
    ShapeKey last{};
    Shape shape_of_last = 0;
    for (std::size_t v = 0; v < values_.size(); ++v) {
      const Code code = values_.code(v);
      ShapeKey key{.code = code, .table = is_table(code) ? values_.table(v) : 0, .operands = {}};
      const std::span<const ValueRef> operands = values_.operands(v);
      for (std::size_t k = 0; k < operands.size(); ++k) key.operands[k] = read_as(operands[k]);
      if (v == 0 || key != last) {  // values of one kind follow each other
        const auto [place, is_new] = known.try_emplace(key, next);
        if (is_new) ++next;
        last = key;
        shape_of_last = place->second;
      }
      shape_[v] = shape_of_last;
      read_as_[v] = stored_[v] == 0 ? shape_[v] : is_named(v) ? next++ : registers_array();
    }
  }
  Shape read_as(ValueRef ref) const { return values_.is_value(ref) ? read_as_[values_.number(ref)] : array_of(ref); }

  /// Families in the order of their first members.
  std::vector<Family> families_of(const std::vector<Member>& members, bool to_be_stored) const {
    std::map<Shape, std::size_t> number;
    std::vector<Family> families;
    for (const Member& member : members) {
      const Shape shape = to_be_stored ? shape_[values_.number(member.value)] : read_as(member.value);
      const auto [place, is_new] = number.try_emplace(shape, families.size());
      if (is_new) families.emplace_back();
      families[place->second].push_back(member);
    }
    return families;
  }

  /// Calls leaf(ref) and operation(value) in one order for all members of a shape; operands come before operations.
  template <class Leaf, class Operation>
  void walk(ValueRef ref, bool expand, const Leaf& leaf, const Operation& operation) const {
    if (!expand && is_leaf(ref)) return leaf(ref);
    const std::size_t value = values_.number(ref);
    for (const ValueRef operand : values_.operands(value)) walk(operand, false, leaf, operation);
    operation(value);
  }

  /// The leaves that have addresses.
  template <class Visit>
  void for_each_element(ValueRef ref, bool expand, const Visit& visit) const {
    walk(
        ref, expand,
        [&](ValueRef leaf) {
          if (!values_.is_value(leaf) || !is_named(values_.number(leaf))) visit(leaf);
        },
        [](std::size_t) {});
  }

  // -- statements -----------------------------------------------------------------------------------------------------

  /// Stores the values of one instruction that are to be stored.
  std::size_t store(std::size_t instruction, std::size_t value) {
    const std::size_t end = values_.first(instruction + 1);
    if (!values_.is_batch(instruction)) {
      if (stored_[value] != 0) name_value(value);
      return end;
    }
    std::vector<Member> members;
    for (; value < end; ++value)
      if (stored_[value] != 0)
        members.push_back({values_.ref(value), address_in(registers_array(), values_.place(value))});
    write(members, "r", true);
    return end;
  }

  void outputs() {
    std::vector<Member> members;
    for (const ValueRef output : values_.outputs())
      members.push_back({output, static_cast<std::int32_t>(members.size())});
    write(members, "y", false);
  }

  void name_value(std::size_t value) {
    const ValueRef ref = values_.ref(value);
    CExpressions expressions(options_.in_lanes, options_.fused);
    const CExpressions::Id id = expression(expressions, {ref, elements_of(ref, true)}, 0, true);
    expressions.name_parts([&](const std::string& text) { return name(text, "  "); });
    names_of_values_[value] = name(expressions.text_of(id), "  ");
  }

  std::string name(const std::string& text, std::string_view indent) {
    std::string own = fmt::format("v{}", ++names_);
    text_ += fmt::format("{}const {} {} = {};\n", indent, options_.in_lanes ? "lanes" : "double", own, text);
    return own;
  }

  /// `elements` from `first` on are the leaves'.
  CExpressions::Id expression(CExpressions& expressions, const Statement& statement, std::size_t first,
                              bool expand) const {
    std::vector<CExpressions::Id> operands;  // a stack
    walk(
        statement.value, expand,
        [&](ValueRef leaf) {
          const bool has_name = values_.is_value(leaf) && is_named(values_.number(leaf));
          operands.push_back(
              expressions.leaf(has_name ? names_of_values_.at(values_.number(leaf)) : statement.elements[first++]));
        },
        [&](std::size_t value) {
          const Code code = values_.code(value);
          std::array<CExpressions::Id, 4> ids{};
          const std::size_t count = values_.operands(value).size();
          std::copy(operands.end() - static_cast<std::ptrdiff_t>(count), operands.end(), ids.begin());
          operands.resize(operands.size() - count);
          operands.push_back(expressions.operation(code, is_table(code) ? values_.table(value) : 0, ids));
        });
    expressions.read(operands.back());
    return operands.back();
  }

  std::vector<std::string> elements_of(ValueRef ref, bool expand) {
    std::vector<std::string> elements;
    for_each_element(ref, expand, [&](ValueRef leaf) { elements.push_back(element(leaf)); });
    return elements;
  }

  std::string number(double value) const {
    return options_.in_lanes ? fmt::format("all_lanes({})", number_text(value)) : number_text(value);
  }

  std::string element(ValueRef leaf) {
    const Array array = array_of_leaf(leaf);
    if (array == constants_array()) return number(*constant_at(leaf));
    return element(array, fmt::format("{}", address_in(array, place_of(leaf))));
  }
  std::string element(Array array, const std::string& index) {
    if (array == time_array()) return std::string(options_.time);
    const std::string_view own = array < options_.arrays.size()                     ? options_.arrays[array].name
                                 : array == constants_array() && !options_.prepared ? constants_table()
                                                                                    : "r";
    return fmt::format("{}[{}]", own, index);
  }

  /// Constants by register, for loops of a function that finds none in `r`.
  std::string_view constants_table() {
    if (!has_constants_table_) {
      has_constants_table_ = true;
      std::vector<std::string> all(constants_.back().first + 1 - constants_.front().first, "0");
      for (const auto& [place, value] : constants_) all[place - constants_.front().first] = number_text(value);
      lists_ += list_text("double", "constants", all);
    }
    return "constants";
  }

  // -- loops ----------------------------------------------------------------------------------------------------------

  /// Addresses of all members, the target first.
  std::vector<std::int32_t> addresses_of(const Family& family, bool expand) const {
    std::vector<std::int32_t> addresses;
    for (const Member& member : family) {
      addresses.push_back(member.to);
      for_each_element(member.value, expand,
                       [&](ValueRef leaf) { addresses.push_back(address_in(array_of_leaf(leaf), place_of(leaf))); });
    }
    return addresses;
  }

  void write(const std::vector<Member>& members, std::string_view target, bool to_be_stored) {
    std::vector<Statement> alone;
    std::vector<Loop> loops;
    for (const Family& family : families_of(members, to_be_stored)) {
      if (family.size() < smallest_family) {
        for (const Member& member : family) alone.push_back(statement(member, target, to_be_stored));
        continue;
      }
      const std::vector<std::int32_t> addresses = addresses_of(family, to_be_stored);
      const Loops found = loops_of(addresses, addresses.size() / family.size());
      for (const LoopNest& nest : found.nests) add(loop(family, addresses, nest, target, to_be_stored), loops);
      if (found.alone.size() >= smallest_family) {
        add(list_loop(family, addresses, found.alone, target, to_be_stored), loops);
      } else {
        for (const std::size_t m : found.alone) alone.push_back(statement(family[m], target, to_be_stored));
      }
    }
    for (const Statement& single : alone) write({}, single, to_be_stored);
    for (const Loop& each : loops) write(each, to_be_stored);
  }

  Statement statement(const Member& member, std::string_view target, bool expand) {
    Statement made{.value = member.value, .elements = {fmt::format("{}[{}]", target, member.to)}};
    std::ranges::move(elements_of(member.value, expand), std::back_inserter(made.elements));
    if (!expand) made.comment = comment(member.to, member.to);
    return made;
  }
  std::string comment(std::int32_t first, std::int32_t last) const {
    if (!options_.output_comment) return "";
    const std::string of_first = options_.output_comment(static_cast<std::size_t>(first));
    if (first == last || of_first.empty()) return of_first;
    return fmt::format("{}, ..., {}", of_first, options_.output_comment(static_cast<std::size_t>(last)));
  }

  /// Loops over as many members go together: what both read is read once.
  static void add(Loop loop, std::vector<Loop>& loops) {
    const auto leaves = [](const Loop& l) {
      std::size_t count = 0;
      for (const Statement& s : l.statements) count += s.elements.size();
      return count;
    };
    const auto with = std::ranges::find_if(loops, [&](const Loop& other) {
      return other.counts == loop.counts && leaves(other) + leaves(loop) <= most_leaves_of_loop;
    });
    if (with == loops.end()) {
      loops.push_back(std::move(loop));
    } else {
      std::ranges::move(loop.statements, std::back_inserter(with->statements));
    }
  }

  Loop loop(const Family& family, std::span<const std::int32_t> addresses, const LoopNest& nest,
            std::string_view target, bool expand) {
    Loop made;
    std::size_t last = nest.member;
    for (const LoopNest::Dimension& dimension : nest.dimensions) {
      made.counts.push_back(dimension.count);
      last += (dimension.count - 1) * dimension.member_step;
    }
    const std::size_t width = addresses.size() / family.size();
    const std::span begin = addresses.subspan(nest.member * width, width);
    const auto index = [&](std::size_t column) { return index_text(begin[column], nest, column); };
    const Member& first = family[nest.member];
    Statement statement{.value = first.value, .elements = {fmt::format("{}[{}]", target, index(0))}};
    for_each_element(first.value, expand, [&](ValueRef leaf) {
      const std::size_t column = statement.elements.size();
      const bool stays = std::ranges::all_of(nest.dimensions, [&](const auto& d) { return d.steps[column] == 0; });
      statement.elements.push_back(stays ? element(leaf) : varied(leaf, begin[column], index(column), nest, column));
    });
    if (!expand) statement.comment = comment(first.to, family[last].to);
    made.statements.push_back(std::move(statement));
    return made;
  }

  static std::string index_text(std::int32_t begin, const LoopNest& nest, std::size_t column) {
    std::vector<std::int64_t> steps;
    for (const LoopNest::Dimension& dimension : nest.dimensions) steps.push_back(dimension.steps[column]);
    return sum_text(begin, steps);
  }

  /// A leaf that is another one for each member of a loop.
  std::string varied(ValueRef leaf, std::int32_t begin, const std::string& index, const LoopNest& nest,
                     std::size_t column) {
    const Array array = array_of_leaf(leaf);
    if (array != constants_array()) return element(array, index);
    if (std::string counted = counted_constants(begin, nest, column); !counted.empty()) return counted;
    if (options_.prepared) return element(array, index);
    return element(array, index_text(begin - static_cast<std::int32_t>(constants_.front().first), nest, column));
  }

  /// Constants that are integers and advance evenly, such as the number of a member, as a sum of the loops' variables,
  /// which rounds nowhere. Empty: they are others.
  std::string counted_constants(std::int32_t begin, const LoopNest& nest, std::size_t column) const {
    constexpr double most = 1 << 30;
    const auto value_at = [&](std::int32_t place) { return *constant_at(static_cast<std::uint32_t>(place)); };
    const double first = value_at(begin);
    std::vector<std::int64_t> steps;
    for (const LoopNest::Dimension& d : nest.dimensions) {
      const double step = value_at(begin + d.steps[column]) - first;
      if (!(std::abs(step) <= most / static_cast<double>(d.count)) || step != std::floor(step)) return "";
      steps.push_back(static_cast<std::int64_t>(step));
    }
    if (!(std::abs(first) <= most) || first != std::floor(first)) return "";
    bool all = true;
    const auto visit = [&](auto&& self, std::size_t d, std::int32_t place, double expected) -> void {
      if (d == nest.dimensions.size()) {
        const double value = value_at(place);
        all = all && value == expected && !(value == 0 && std::signbit(value));
        return;
      }
      for (std::size_t k = 0; k < nest.dimensions[d].count && all; ++k)
        self(self, d + 1, place + static_cast<std::int32_t>(k) * nest.dimensions[d].steps[column],
             expected + static_cast<double>(k) * static_cast<double>(steps[d]));
    };
    visit(visit, 0, begin, first);
    if (!all) return "";
    const std::string text = fmt::format("(double)({})", sum_text(static_cast<std::int64_t>(first), steps));
    return options_.in_lanes ? fmt::format("all_lanes({})", text) : text;
  }

  /// Members whose addresses follow no rule, which are in lists.
  Loop list_loop(const Family& family, std::span<const std::int32_t> addresses, const std::vector<std::size_t>& members,
                 std::string_view target, bool expand) {
    const std::size_t width = addresses.size() / family.size();
    const auto column_of = [&](std::size_t column) {
      std::vector<std::int32_t> places;
      for (const std::size_t m : members) places.push_back(addresses[m * width + column]);
      return places;
    };
    const Member& first = family[members.front()];
    Statement statement{.value = first.value, .elements = {fmt::format("{}[{}]", target, list_index(column_of(0)))}};
    for_each_element(first.value, expand, [&](ValueRef leaf) {
      std::vector<std::int32_t> places = column_of(statement.elements.size());
      const bool stays = std::ranges::adjacent_find(places, std::not_equal_to()) == places.end();
      const Array array = array_of_leaf(leaf);
      if (!stays && array == constants_array() && !options_.prepared)
        for (std::int32_t& place : places) place -= static_cast<std::int32_t>(constants_.front().first);
      statement.elements.push_back(stays ? element(leaf) : element(array, list_index(places)));
    });
    if (!expand) statement.comment = comment(first.to, family[members.back()].to);
    return {.counts = {members.size()}, .statements = {std::move(statement)}};
  }

  std::string list_index(const std::vector<std::int32_t>& places) {
    const std::int64_t step = places[1] - places[0];
    const auto is_even = [&](std::int32_t a, std::int32_t b) { return b - a != step; };
    if (std::ranges::adjacent_find(places, is_even) == places.end()) return sum_text(places.front(), std::array{step});
    std::string& known = names_of_lists_[places];
    if (known.empty()) {
      known = fmt::format("places{}", names_of_lists_.size());
      lists_ += list_text("int", known, places);
    }
    return fmt::format("{}[i]", known);
  }

  template <class Number>
  static std::string list_text(std::string_view type, std::string_view name, const std::vector<Number>& numbers) {
    std::string text =
        fmt::format("  static const {} {}[{}] = {{{}", type, name, numbers.size(), numbers.size() > 16 ? "\n    " : "");
    for (std::size_t k = 0; k < numbers.size(); ++k)
      text += fmt::format("{}{}", numbers[k], k + 1 == numbers.size() ? "" : k % 16 == 15 ? ",\n    " : ", ");
    return text + "};\n";
  }

  void write(const Loop& loop, bool expand) {
    std::string indent = "  ";
    for (std::size_t d = loop.counts.size(); d-- > 0;) {
      // No value that is stored lies where others of the same loop are read.
      if (d == 0 && expand) text_ += "#pragma GCC ivdep\n";
      text_ += fmt::format("{0}for (int {1} = 0; {1} < {2}; ++{1}) {{\n", indent, loop_variables[d], loop.counts[d]);
      indent += "  ";
    }
    write(indent, loop.statements, expand);
    for (std::size_t d = 0; d < loop.counts.size(); ++d) {
      indent.resize(indent.size() - 2);
      text_ += indent + "}\n";
    }
  }
  void write(const std::string& indent, const Statement& statement, bool expand) {
    write(indent.empty() ? "  " : indent, std::span(&statement, 1), expand);
  }
  void write(const std::string& indent, std::span<const Statement> statements, bool expand) {
    CExpressions expressions(options_.in_lanes, options_.fused);
    std::vector<CExpressions::Id> ids;
    for (const Statement& s : statements) ids.push_back(expression(expressions, s, 1, expand));
    expressions.name_parts([&](const std::string& text) { return name(text, indent); });
    for (std::size_t k = 0; k < ids.size(); ++k)
      text_ += fmt::format("{}{} = {};{}\n", indent, statements[k].elements[0], expressions.text_of(ids[k]),
                           statements[k].comment.empty() ? "" : "  /* " + statements[k].comment + " */");
  }

  const CFunctionOptions& options_;
  std::vector<std::pair<std::uint32_t, double>> constants_;  // by register
  TapeValues values_;
  std::vector<char> stored_;                            // by value
  std::map<std::size_t, std::string> names_of_values_;  // of those alone that are stored
  std::vector<Shape> shape_, read_as_;                  // by value: as it is computed, and where it is read
  std::map<std::vector<std::int32_t>, std::string> names_of_lists_;
  std::string text_, lists_;
  std::size_t names_ = 0, registers_ = 0;
  std::uint32_t first_register_ = 0;
  bool has_constants_table_ = false;
};

CFunction c_function(const Tape& tape, const CFunctionOptions& options) {
  return TapeWriter(tape, options).function();
}

bool is_without_loops(const Tape& tape) {
  return c_function(tape, {.signature = ""}).text.find(" for (int ") == std::string::npos;
}

bool is_worth_compiling(const Tape& tape) {
  constexpr std::size_t most_single = 20'000, most_numbers = 100'000;
  const Tape::Size size = tape.size();
  std::size_t numbers = size.gathered;
  for (const Table& table : tape.tables()) numbers += 3 * table.x().size();
  return size.single + size.batches > 0 && size.single + size.batches <= most_single && numbers <= most_numbers;
}

}  // namespace continuo::model
