// Writes a tape as C functions: single operations as expressions, batches as loops.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <continuo/symbolic/native/c_source.hpp>

namespace continuo::model {

namespace {

using tape::Batch, tape::Code, tape::Instruction, tape::Operand;

constexpr std::size_t longest_expression = 100;  // above, a result has a name of its own

std::string number_text(double value) {
  if (std::isnan(value)) return "NAN";
  if (std::isinf(value)) return value > 0 ? "INFINITY" : "(-INFINITY)";
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return std::signbit(value) ? "(" + text + ")" : text;
}

/// The expression of one operation; each operand is a name, a number or stands in brackets.
std::string_view pattern_of(Code code) {
  switch (code) {
    case Code::add:
      return "{0} + {1}";
    case Code::subtract:
      return "{0} - {1}";
    case Code::multiply:
      return "{0}*{1}";
    case Code::divide:
      return "{0}/{1}";
    case Code::multiply_add:
      return "{0}*{1} + {2}";
    case Code::multiply_subtract:
      return "{0}*{1} - {2}";
    case Code::subtract_product:
      return "{2} - {0}*{1}";
    case Code::negated_product:
      return "-({0}*{1})";
    case Code::negated_sum:
      return "-({0} + {1})";
    case Code::negated_multiply_add:
      return "-({0}*{1} + {2})";
    case Code::negated_sum_of_products:
      return "-({0}*{1} + {2}*{3})";
    case Code::sum_of_products:
      return "{0}*{1} + {2}*{3}";
    case Code::difference_of_products:
      return "{0}*{1} - {2}*{3}";
    case Code::sum_times:
      return "({0} + {1})*{2}";
    case Code::difference_times:
      return "({0} - {1})*{2}";
    case Code::multiply_twice:
      return "{0}*{1}*{2}";
    case Code::sum_less_product:
      return "{2} + {3} - {0}*{1}";
    case Code::less_product_plus:
      return "{2} - {0}*{1} + {3}";
    case Code::negate:
      return "-{0}";
    case Code::select_less:
      return "{0} < {1} ? {2} : {3}";
    case Code::select_less_equal:
      return "{0} <= {1} ? {2} : {3}";
    case Code::select:
      return "{0} != 0.0 ? {1} : {2}";
    case Code::less:
      return "{0} < {1} ? 1.0 : 0.0";
    case Code::less_equal:
      return "{0} <= {1} ? 1.0 : 0.0";
    case Code::equal:
      return "{0} == {1} ? 1.0 : 0.0";
    case Code::not_equal:
      return "{0} != {1} ? 1.0 : 0.0";
    case Code::logical_and:
      return "{0} != 0.0 && {1} != 0.0 ? 1.0 : 0.0";
    case Code::logical_or:
      return "{0} != 0.0 || {1} != 0.0 ? 1.0 : 0.0";
    case Code::logical_not:
      return "{0} == 0.0 ? 1.0 : 0.0";
    default:
      return {};
  }
}

std::string_view function_of(Code code) {
  switch (code) {
    case Code::square_root:
      return "sqrt";
    case Code::sine:
      return "sin";
    case Code::cosine:
      return "cos";
    case Code::minimum:
      return "minimum";
    case Code::maximum:
      return "maximum";
    case Code::absolute:
      return "fabs";
    case Code::exponential:
      return "exp";
    case Code::power:
      return "pow";
    case Code::hypotenuse:
      return "hypotenuse";
    case Code::arc_tangent2:
      return "atan2";
    case Code::modulo:
      return "modulo";
    case Code::tangent:
      return "tan";
    case Code::arc_sine:
      return "asin";
    case Code::arc_cosine:
      return "acos";
    case Code::arc_tangent:
      return "atan";
    case Code::hyperbolic_sine:
      return "sinh";
    case Code::hyperbolic_cosine:
      return "cosh";
    case Code::hyperbolic_tangent:
      return "tanh";
    case Code::logarithm:
      return "log";
    case Code::logarithm10:
      return "log10";
    case Code::sign:
      return "sign_of";
    case Code::floor:
      return "floor";
    case Code::ceiling:
      return "ceil";
    default:
      return {};
  }
}

/// Of the operations that C has for numbers and not for lanes.
std::string_view choice_of_lanes(Code code) {
  switch (code) {
    case Code::select_less:
      return "select_less";
    case Code::select_less_equal:
      return "select_less_equal";
    case Code::select:
      return "select_nonzero";
    case Code::less:
      return "is_less";
    case Code::less_equal:
      return "is_less_equal";
    case Code::equal:
      return "is_equal";
    case Code::not_equal:
      return "is_not_equal";
    case Code::logical_and:
      return "are_both";
    case Code::logical_or:
      return "is_either";
    case Code::logical_not:
      return "is_not";
    default:
      return {};
  }
}

std::string operation_text(Code code, const std::array<std::string, 4>& operand, bool in_lanes) {
  const std::string_view choice = in_lanes ? choice_of_lanes(code) : std::string_view();
  if (const std::string_view pattern = pattern_of(code); !pattern.empty() && choice.empty())
    return fmt::format(fmt::runtime(pattern), operand[0], operand[1], operand[2], operand[3]);
  std::string arguments = operand[0];
  for (std::size_t k = 1; k < tape::operands(code); ++k) arguments += ", " + operand[k];
  if (!choice.empty()) return fmt::format("{}({})", choice, arguments);
  return fmt::format("{}{}({})", in_lanes ? "each_" : "", function_of(code), arguments);
}

[[nodiscard]] bool is_primary(std::string_view text) {
  if (text.empty() || text.front() == '-') return false;
  int depth = 0;
  for (const char c : text) {
    if (c == '(' || c == '[') ++depth;
    if (c == ')' || c == ']') --depth;
    if (depth == 0 && (c == ' ' || c == '*' || c == '/')) return false;
  }
  return true;
}

std::string bracketed(const std::string& text) {
  return is_primary(text) ? text : "(" + text + ")";
}

/// `base + begin` as the start of an array that is read or written with an index behind it.
std::string element(std::string_view array, std::uint32_t begin, std::string_view index) {
  if (index.empty()) return fmt::format("{}[{}]", array, begin);
  return begin == 0 ? fmt::format("{}[{}]", array, index) : fmt::format("{}[{} + {}]", array, begin, index);
}

/// A series of batches that are one loop round one: the registers of each advance by the same numbers.
struct Series {
  std::size_t count = 1;
  std::uint32_t result_step = 0;
  std::array<std::uint32_t, 4> operand_step = {};
};

}  // namespace

/// Writes the body of a tape. Friend of Tape.
class TapeWriter {
 public:
  TapeWriter(const Tape& tape, const CFunctionOptions& options)
      : tape_(tape), options_(options), values_(tape.registers_) {}

  std::string function() {
    // Whether variables must be in one array shows only where an operand of a loop lies across two of them.
    for (in_registers_ = false;; in_registers_ = true) {
      text_.clear();
      lists_.clear();
      names_ = 0;
      straddles_ = false;
      body();
      if (!straddles_) break;
    }
    return fmt::format("{} {{\n{}{}}}\n", options_.signature, lists_, text_);
  }

 private:
  /// What a register holds: a number in memory (an empty text), or an expression. `stable` where nothing that the
  /// expression reads can change before the function ends.
  struct Value {
    std::string text;
    bool stable = false;
  };
  /// How often the result of an instruction is read, and whether a loop reads it.
  struct Use {
    std::uint32_t count = 0;
    bool in_loop = false;
  };

  [[nodiscard]] std::string number(double value) const {
    return options_.in_lanes ? fmt::format("all_lanes({})", number_text(value)) : number_text(value);
  }

  void line(std::string_view what) { text_ += fmt::format("  {}\n", what); }
  void loop(std::size_t count, std::string_view statement) {
    line(fmt::format("for (int i = 0; i < {}; ++i) {}", count, statement));
  }

  /// The array that a variable is read from; none: it is among the registers.
  const CArray* array_of(std::uint32_t place) const {
    if (in_registers_) return nullptr;
    const auto found = std::ranges::find_if(
        options_.arrays, [&](const CArray& array) { return place >= array.begin && place < array.end; });
    return found == options_.arrays.end() ? nullptr : &*found;
  }
  /// Of all places of a loop's operand; notes where they are not in one array.
  const CArray* array_of(std::uint32_t begin, std::uint32_t end) {
    const CArray *first = array_of(begin), *last = array_of(end - 1);
    const bool around = first == nullptr && std::ranges::any_of(options_.arrays, [&](const CArray& array) {
                          return !in_registers_ && begin < array.end && end > array.begin;
                        });
    if (first != last || around) straddles_ = true;
    return first;
  }
  static std::string element_of(const CArray* array, std::uint32_t place, std::string_view index) {
    return array != nullptr ? element(array->name, place - array->begin, index) : element("r", place, index);
  }

  void body() {
    std::ranges::fill(values_, Value{});
    for (const Tape::Constant& constant : tape_.constants_) values_[constant.target] = {number(constant.value), true};
    if (!options_.time.empty()) values_[0] = {std::string(options_.time), true};
    count_uses(tape_.body_);
    if (!options_.prepared) place_what_loops_read();
    if (in_registers_) {
      for (const CArray& array : options_.arrays) {
        if (array.end == array.begin) continue;
        loop(array.end - array.begin, fmt::format("{} = {}[i];", element("r", array.begin, "i"), array.name));
      }
    }
    copies(tape_.copies_);
    program(tape_.body_);
    outputs();
  }

  /// Constants and the time, where a loop reads them.
  void place_what_loops_read() {
    for (std::uint32_t place = 0; place < values_.size(); ++place)
      if (read_in_loops_[place] != 0 && !values_[place].text.empty())
        line(fmt::format("r[{}] = {};", place, values_[place].text));
  }

  /// The families that are brought to where they lie side by side.
  void copies(const tape::Copies& copies) {
    const auto from = [&](std::uint32_t place, std::string_view index) {
      return element_of(array_of(place + tape_.copied_from_), place + tape_.copied_from_, index);
    };
    const auto to = [](std::uint32_t place, std::string_view index) { return element("r", place, index); };
    for (const tape::Place& place : copies.alone) line(fmt::format("{} = {};", to(place.to, ""), from(place.from, "")));
    for (const tape::Copy& copy : copies.regular)
      loop(copy.count, fmt::format("{} = {};", to(copy.to_begin, times(copy.to_step)),
                                   from(copy.from_begin, times(copy.from_step))));
    for (const tape::Turns& turns : copies.joined) loop(turns.count, joined(turns, from, to));
    for (const tape::Turns& turns : copies.parted) loop(turns.count, parted(turns, from, to));
  }
  template <class From, class To>
  static std::string joined(const tape::Turns& turns, From&& from, To&& to) {
    return fmt::format("{{ {} = {}; {} = {}; }}", to(turns.together, "2*i"), from(turns.first, "i"),
                       to(turns.together + 1, "2*i"), from(turns.second, "i"));
  }
  template <class From, class To>
  static std::string parted(const tape::Turns& turns, From&& from, To&& to) {
    return fmt::format("{{ {} = {}; {} = {}; }}", to(turns.first, "i"), from(turns.together, "2*i"),
                       to(turns.second, "i"), from(turns.together + 1, "2*i"));
  }
  static std::string times(std::uint32_t step) { return step == 0 ? "" : step == 1 ? "i" : fmt::format("{}*i", step); }

  // -- what reads what ------------------------------------------------------------------------------------------------

  void count_uses(const Tape::Program& program) {
    constexpr std::size_t nobody = static_cast<std::size_t>(-1);
    uses_.assign(program.instructions.size(), Use{});
    read_in_loops_.assign(tape_.registers_, 0);
    std::vector<std::size_t> writer(tape_.registers_, nobody);
    const auto reads = [&](std::uint32_t place, bool in_loop) {
      if (in_loop) read_in_loops_[place] = 1;
      if (writer[place] == nobody) return;
      Use& use = uses_[writer[place]];
      ++use.count;
      use.in_loop = use.in_loop || in_loop;
    };
    for (std::size_t n = 0; n + 1 < program.instructions.size(); ++n) {
      const Instruction& i = program.instructions[n];
      if (i.code == Code::batch) {
        const Batch& batch = program.batches[i.a];
        for (std::size_t k = 0; k < tape::operands(batch.code); ++k)
          for_each_place(program, batch, k, [&](std::uint32_t place) { reads(place, true); });
        for (std::uint32_t j = 0; j < batch.count; ++j) writer[batch.result + j] = nobody;
      } else {
        for (std::size_t k = 0; k < operand_count(i); ++k) reads(operands_of(i)[k], false);
        writer[i.result] = n;
      }
    }
    for (const std::uint32_t place : tape_.outputs_) reads(place, !tape_.many_outputs_.is_empty());
  }

  template <class Visit>
  static void for_each_place(const Tape::Program& program, const Batch& batch, std::size_t k, Visit&& visit) {
    const Operand& operand = batch.operand[k];
    if (operand.layout == Operand::Layout::one) return visit(operand.begin);
    const bool gathered = operand.layout == Operand::Layout::gathered;
    for (std::uint32_t j = 0; j < batch.count; ++j)
      visit(gathered ? program.gathered[operand.begin + j] : operand.begin + j);
  }

  static std::size_t operand_count(const Instruction& i) { return is_table(i) ? 1 : tape::operands(i.code); }
  static std::array<std::uint32_t, 4> operands_of(const Instruction& i) { return {i.a, i.b, i.c, i.d}; }
  static bool is_table(const Instruction& i) {
    return i.code == Code::interpolate || i.code == Code::interpolate_slope;
  }

  // -- operations -----------------------------------------------------------------------------------------------------

  void program(const Tape::Program& program) {
    for (std::size_t n = 0; n + 1 < program.instructions.size(); ++n) {
      const Instruction& i = program.instructions[n];
      if (i.code == Code::batch) {
        const Series series = series_at(program, n);
        batch(program, program.batches[i.a], series);
        n += series.count - 1;
      } else {
        single(i, uses_[n]);
      }
    }
  }

  Value read(std::uint32_t place) const {
    if (!values_[place].text.empty()) return values_[place];
    return {element_of(array_of(place), place, ""), array_of(place) != nullptr};
  }

  void single(const Instruction& i, const Use& use) {
    std::array<std::string, 4> operand;
    bool stable = true;
    for (std::size_t k = 0; k < operand_count(i); ++k) {
      Value value = read(operands_of(i)[k]);
      stable = stable && value.stable;
      operand[k] = function_of(i.code).empty() && !is_table(i) ? bracketed(value.text) : std::move(value.text);
    }
    std::string text = is_table(i)
                           ? fmt::format("{}{}{}({})", options_.in_lanes ? "each_" : "",
                                         i.code == Code::interpolate ? "table_" : "slope_of_table_", i.b, operand[0])
                           : operation_text(i.code, operand, options_.in_lanes);
    if (use.in_loop) {
      line(fmt::format("r[{}] = {};", i.result, text));
      values_[i.result] = {};
    } else if (stable && use.count == 1 && text.size() <= longest_expression) {
      values_[i.result] = {std::move(text), true};
    } else {
      std::string name = fmt::format("v{}", ++names_);
      line(fmt::format("const {} {} = {};", options_.in_lanes ? "lanes" : "double", name, text));
      values_[i.result] = {std::move(name), true};
    }
  }

  /// How many batches from here on are the same but for places that advance evenly.
  Series series_at(const Tape::Program& program, std::size_t n) const {
    const auto batch_at = [&](std::size_t m) -> const Batch* {
      if (program.instructions[m].code != Code::batch) return nullptr;
      return &program.batches[program.instructions[m].a];
    };
    Series series;
    const Batch* before = batch_at(n);
    for (const Batch* next = before; (next = batch_at(n + series.count)) != nullptr; before = next, ++series.count) {
      const std::optional<Series> step = step_between(*before, *next);
      if (!step) break;
      if (series.count == 1) {
        series = *step;
      } else if (step->result_step != series.result_step || step->operand_step != series.operand_step) {
        break;
      }
    }
    return series.count < 3 ? Series{} : series;
  }

  /// By how much the places of the second batch are ahead, if the two are the same otherwise.
  std::optional<Series> step_between(const Batch& first, const Batch& second) const {
    if (second.code != first.code || second.count != first.count || second.result < first.result) return std::nullopt;
    Series step{.result_step = second.result - first.result};
    for (std::size_t k = 0; k < tape::operands(first.code); ++k) {
      const Operand &a = first.operand[k], &b = second.operand[k];
      if (a.layout != b.layout || a.layout == Operand::Layout::gathered || b.begin < a.begin) return std::nullopt;
      step.operand_step[k] = b.begin - a.begin;
      const bool moves = a.layout == Operand::Layout::one && a.begin != b.begin;
      const auto is_named = [&](const Operand& o) { return !values_[o.begin].text.empty(); };
      if (moves && (is_named(a) || is_named(b) || array_of(a.begin) != array_of(b.begin))) return std::nullopt;
    }
    return step;
  }

  void batch(const Tape::Program& program, const Batch& batch, const Series& series) {
    std::array<std::string, 4> operand;
    for (std::size_t k = 0; k < tape::operands(batch.code); ++k) {
      operand[k] = operand_text(program, batch, k, series);
      if (function_of(batch.code).empty()) operand[k] = bracketed(operand[k]);
    }
    const auto further = static_cast<std::uint32_t>(series.count - 1);
    for (std::uint32_t j = 0; j < batch.count + further * series.result_step; ++j) values_[batch.result + j] = {};
    const std::string statement = fmt::format("{} = {};", element("r", batch.result, index_of(series.result_step)),
                                              operation_text(batch.code, operand, options_.in_lanes));
    if (series.count > 1) line(fmt::format("for (int j = 0; j < {}; ++j) {{", series.count));
    text_ += "#pragma GCC ivdep\n";
    loop(batch.count, statement);
    if (series.count > 1) line("}");
  }

  static std::string index_of(std::uint32_t step) { return step > 0 ? fmt::format("{}*j + i", step) : "i"; }

  std::string operand_text(const Tape::Program& program, const Batch& batch, std::size_t k, const Series& series) {
    const Operand& operand = batch.operand[k];
    const std::uint32_t step = series.operand_step[k];
    const std::uint32_t ahead = static_cast<std::uint32_t>(series.count - 1) * step;
    if (operand.layout == Operand::Layout::one) {
      if (step == 0) return read(operand.begin).text;
      return element_of(array_of(operand.begin, operand.begin + ahead + 1), operand.begin, fmt::format("{}*j", step));
    }
    if (operand.layout == Operand::Layout::contiguous)
      return element_of(array_of(operand.begin, operand.begin + batch.count + ahead), operand.begin, index_of(step));
    std::vector<std::uint32_t> places;
    for_each_place(program, batch, k, [&](std::uint32_t place) { places.push_back(place); });
    const CArray* array = array_of(places.front());
    for (std::uint32_t& place : places) {
      if (array_of(place) != array) straddles_ = true;
      place -= array != nullptr ? array->begin : 0;
    }
    return fmt::format("{}[{}[i]]", array != nullptr ? array->name : "r", list(places));
  }

  /// Places that are gathered, as an array of their own.
  std::string list(const std::vector<std::uint32_t>& places) {
    const std::string name = fmt::format("places{}", ++names_);
    lists_ += fmt::format("  static const int {}[{}] = {{{}", name, places.size(), places.size() > 16 ? "\n    " : "");
    for (std::size_t k = 0; k < places.size(); ++k)
      lists_ += fmt::format("{}{}", places[k], k + 1 == places.size() ? "" : k % 16 == 15 ? ",\n    " : ", ");
    lists_ += "};\n";
    return name;
  }

  // -- outputs --------------------------------------------------------------------------------------------------------

  void outputs() {
    const tape::Copies& many = tape_.many_outputs_;
    if (many.is_empty()) {
      for (std::size_t k = 0; k < tape_.outputs_.size(); ++k) output(tape_.outputs_[k], k);
      return;
    }
    const auto from = [&](std::uint32_t place, std::string_view index) {
      return element_of(array_of(place), place, index);
    };
    const auto to = [](std::uint32_t place, std::string_view index) { return element("y", place, index); };
    for (const tape::Place& place : many.alone) output(place.from, place.to);
    for (std::size_t n = 0; n < many.regular.size();) {
      const tape::Copy& copy = many.regular[n];
      const Rows rows = rows_at(std::span(many.regular).subspan(n));
      const auto last = static_cast<std::uint32_t>(rows.count - 1);
      note_range(copy.from_begin, copy.from_begin + (copy.count - 1) * copy.from_step + last * rows.from_step + 1);
      if (rows.count > 1) line(fmt::format("for (int j = 0; j < {}; ++j) {{", rows.count));
      loop(copy.count, fmt::format("{} = {};", to(copy.to_begin, in_row(copy.to_step, rows.to_step)),
                                   from(copy.from_begin, in_row(copy.from_step, rows.from_step))));
      if (rows.count > 1) line("}");
      n += rows.count;
    }
    for (const tape::Turns& turns : many.joined) {
      note_range(turns.first, turns.first + turns.count);
      note_range(turns.second, turns.second + turns.count);
      loop(turns.count, joined(turns, from, to));
    }
    for (const tape::Turns& turns : many.parted) {
      note_range(turns.together, turns.together + 2 * turns.count);
      loop(turns.count, parted(turns, from, to));
    }
  }
  /// The rows of a grid: copies that are one loop round one.
  struct Rows {
    std::size_t count = 1;
    std::uint32_t from_step = 0, to_step = 0;
  };
  static Rows rows_at(std::span<const tape::Copy> copies) {
    Rows rows;
    for (; rows.count < copies.size(); ++rows.count) {
      const tape::Copy &row = copies[rows.count - 1], &next = copies[rows.count];
      if (next.count != row.count || next.from_step != row.from_step || next.to_step != row.to_step) break;
      if (next.from_begin < row.from_begin || next.to_begin < row.to_begin) break;
      const std::uint32_t from_step = next.from_begin - row.from_begin, to_step = next.to_begin - row.to_begin;
      if (rows.count > 1 && (from_step != rows.from_step || to_step != rows.to_step)) break;
      rows.from_step = from_step;
      rows.to_step = to_step;
    }
    return rows.count < 3 ? Rows{} : rows;
  }
  static std::string in_row(std::uint32_t step, std::uint32_t row_step) {
    const std::string place = times(step);
    if (row_step == 0) return place;
    return place.empty() ? fmt::format("{}*j", row_step) : fmt::format("{}*j + {}", row_step, place);
  }
  void note_range(std::uint32_t begin, std::uint32_t end) { static_cast<void>(array_of(begin, end)); }

  void output(std::uint32_t place, std::size_t k) {
    const std::string comment = options_.output_comment ? options_.output_comment(k) : "";
    line(fmt::format("y[{}] = {};{}", k, read(place).text, comment.empty() ? "" : "  /* " + comment + " */"));
  }

  const Tape& tape_;
  const CFunctionOptions& options_;
  std::vector<Value> values_;        // by register
  std::vector<Use> uses_;            // by instruction
  std::vector<char> read_in_loops_;  // by register
  std::string text_, lists_;
  std::size_t names_ = 0;
  bool in_registers_ = false, straddles_ = false;
};

std::string c_function(const Tape& tape, const CFunctionOptions& options) {
  return TapeWriter(tape, options).function();
}

namespace {

struct Helper {
  std::string_view name, text;
};
constexpr Helper helpers[] = {
    {"minimum", "static inline double minimum(double a, double b) { return b < a ? b : a; }\n"},
    {"maximum", "static inline double maximum(double a, double b) { return a < b ? b : a; }\n"},
    {"hypotenuse", "static inline double hypotenuse(double a, double b) { return sqrt(a*a + b*b); }\n"},
    {"modulo", "static inline double modulo(double a, double b) { return a - b*floor(a/b); }\n"},
    {"sign_of", "static inline double sign_of(double a) { return a > 0.0 ? 1.0 : a < 0.0 ? -1.0 : a; }\n"},
};

std::string numbers_of(std::span<const double> numbers) {
  std::string text;
  for (std::size_t k = 0; k < numbers.size(); ++k)
    text += fmt::format("{}{}", number_text(numbers[k]), k + 1 == numbers.size() ? "" : k % 8 == 7 ? ",\n  " : ", ");
  return text;
}

/// The piece is found as std::upper_bound does, so that a table at NaN gives what a tape gives.
std::string table_text(const Table& table, std::size_t number, bool value, bool slope) {
  const std::span<const Table::Piece> pieces = table.all_pieces();
  std::vector<double> start, height, slopes;
  for (const Table::Piece& piece : pieces) {
    start.push_back(piece.x);
    height.push_back(piece.y);
    slopes.push_back(piece.slope);
  }
  std::string text = fmt::format(
      "static const double table_{0}_x[{1}] = {{\n  {2}}};\n"
      "static const double table_{0}_y[{1}] = {{\n  {3}}};\n"
      "static const double table_{0}_slope[{1}] = {{\n  {4}}};\n"
      "static inline int piece_of_table_{0}(double x) {{\n"
      "  int low = 0, high = {5};\n"
      "  while (low < high) {{\n"
      "    const int middle = low + (high - low)/2;\n"
      "    if (x < table_{0}_x[middle + 1]) high = middle; else low = middle + 1;\n"
      "  }}\n"
      "  return low;\n"
      "}}\n",
      number, pieces.size(), numbers_of(start), numbers_of(height), numbers_of(slopes), pieces.size() - 1);
  if (value) {
    text += fmt::format(
        "static inline double table_{0}(double x) {{\n"
        "  const int i = piece_of_table_{0}(x);\n"
        "  return table_{0}_y[i] + table_{0}_slope[i]*(x - table_{0}_x[i]);\n"
        "}}\n",
        number);
  }
  if (slope) {
    text += fmt::format(
        "static inline double slope_of_table_{0}(double x) {{ return table_{0}_slope[piece_of_table_{0}(x)]; }}\n",
        number);
  }
  return text;
}

/// Whether the text calls the function, and not one whose name ends the same.
bool calls(std::string_view text, const std::string& function) {
  const std::string call = function + "(";
  for (std::size_t at = text.find(call); at != std::string_view::npos; at = text.find(call, at + 1))
    if (at == 0 || (std::isalnum(static_cast<unsigned char>(text[at - 1])) == 0 && text[at - 1] != '_')) return true;
  return false;
}

}  // namespace

std::string c_helpers(std::string_view functions, std::span<const Table> tables) {
  std::string text;
  for (const Helper& helper : helpers)
    if (calls(functions, std::string(helper.name))) text += helper.text;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const bool value = calls(functions, fmt::format("table_{}", i));
    const bool slope = calls(functions, fmt::format("slope_of_table_{}", i));
    if (value || slope) text += table_text(tables[i], i, value, slope);
  }
  return text;
}

namespace {

constexpr std::string_view lane_type =
    "typedef double lanes __attribute__((vector_size(64), aligned(8)));\n"
    "typedef long long lane_masks __attribute__((vector_size(64), aligned(8)));\n"
    "static inline lanes all_lanes(double a) { return (lanes){a, a, a, a, a, a, a, a}; }\n"
    "static inline lanes choose(lane_masks m, lanes a, lanes b) {\n"
    "  return (lanes)(((lane_masks)a & m) | ((lane_masks)b & ~m));\n"
    "}\n"
    "static inline lanes truth(lane_masks m) { return choose(m, all_lanes(1.0), all_lanes(0.0)); }\n";

constexpr Helper lane_choices[] = {
    {"select_less", "(lanes a, lanes b, lanes c, lanes d) { return choose(a < b, c, d); }"},
    {"select_less_equal", "(lanes a, lanes b, lanes c, lanes d) { return choose(a <= b, c, d); }"},
    {"select_nonzero", "(lanes a, lanes b, lanes c) { return choose(a != all_lanes(0.0), b, c); }"},
    {"is_less", "(lanes a, lanes b) { return truth(a < b); }"},
    {"is_less_equal", "(lanes a, lanes b) { return truth(a <= b); }"},
    {"is_equal", "(lanes a, lanes b) { return truth(a == b); }"},
    {"is_not_equal", "(lanes a, lanes b) { return truth(a != b); }"},
    {"are_both", "(lanes a, lanes b) { return truth((a != all_lanes(0.0)) & (b != all_lanes(0.0))); }"},
    {"is_either", "(lanes a, lanes b) { return truth((a != all_lanes(0.0)) | (b != all_lanes(0.0))); }"},
    {"is_not", "(lanes a) { return truth(a == all_lanes(0.0)); }"},
    {"each_minimum", "(lanes a, lanes b) { return choose(b < a, b, a); }"},
    {"each_maximum", "(lanes a, lanes b) { return choose(a < b, b, a); }"},
    {"each_fabs", "(lanes a) { return (lanes)((lane_masks)a & ~(lane_masks)all_lanes(-0.0)); }"},
    {"each_sign_of",
     "(lanes a) {\n"
     "  return choose(a > all_lanes(0.0), all_lanes(1.0), choose(a < all_lanes(0.0), all_lanes(-1.0), a));\n}"},
};

/// `NAME(` of the calls of each_NAME in the text that are no choices, each once.
std::vector<std::string> calls_for_each(std::string_view text) {
  constexpr std::string_view prefix = "each_";
  std::vector<std::string> names;
  for (std::size_t at = text.find(prefix); at != std::string_view::npos; at = text.find(prefix, at + 1)) {
    const std::string name(text.substr(at + prefix.size(), text.find('(', at) - at - prefix.size()));
    if (std::ranges::find(names, name) == names.end() &&
        std::ranges::find(lane_choices, "each_" + name, &Helper::name) == std::end(lane_choices))
      names.push_back(name);
  }
  return names;
}

bool takes_two(std::string_view function) {
  constexpr std::array two = {"pow", "atan2", "hypotenuse", "modulo"};
  return std::ranges::find(two, function) != two.end();
}

}  // namespace

std::string c_lane_helpers(std::string_view functions) {
  std::string text(lane_type);
  for (const Helper& helper : lane_choices)
    if (calls(functions, std::string(helper.name)))
      text += fmt::format("static inline lanes {}{}\n", helper.name, helper.text);
  for (const std::string& name : calls_for_each(functions)) {
    const bool two = takes_two(name);
    text += fmt::format(
        "static inline lanes each_{0}(lanes a{1}) {{\n"
        "  lanes y;\n"
        "  for (int i = 0; i < 8; ++i) y[i] = {0}(a[i]{2});\n"
        "  return y;\n"
        "}}\n",
        name, two ? ", lanes b" : "", two ? ", b[i]" : "");
  }
  return text;
}

bool is_worth_compiling(const Tape& tape) {
  constexpr std::size_t most_single = 20'000, most_numbers = 100'000;
  const Tape::Size size = tape.size();
  std::size_t numbers = size.gathered;
  for (const Table& table : tape.tables()) numbers += 3 * table.x().size();
  return size.single + size.batches > 0 && size.single + size.batches <= most_single && numbers <= most_numbers;
}

}  // namespace continuo::model
