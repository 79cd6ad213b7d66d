// A tape written as C: the same operations in the same order, so that the compiled text computes the same bits.
//
//   const std::string function = c_function(tape, {.signature = "void rates(double *r, const double *x, double *y)",
//                                                  .arrays = states}).text;
//   const std::string text = "#include <math.h>\n" + c_helpers(function, tape.tables()) + function;
//
// The text is C11 and needs nothing but the mathematics. What is computed alike for many members of a family is a loop,
// whatever loops the tape has, and for the members of a grid loops in each other: a grid takes few lines. A number that
// a loop needs on its way has no place in memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include <continuo/symbolic/tape/tape.hpp>

namespace continuo::model {

/// Variables of the flat space, [begin, end), that the function reads from an array of their own.
struct CArray {
  std::string_view name;
  std::uint32_t begin = 0, end = 0;
};

struct CFunctionOptions {
  /// All up to the brace: `void spring_rates(double t, const double *restrict x, ...)`.
  std::string_view signature;
  /// Where variables are read from; all others, and what loops compute, are in the array `r`.
  std::span<const CArray> arrays = {};
  /// What stands for the time; empty: its register.
  std::string_view time = {};
  /// Whether the registers in `r` are those of the tape, with `prepare` done. Else the function puts there what it
  /// needs.
  bool prepared = true;
  /// Whether registers, variables and outputs have the type `lanes` of c_lane_helpers, a number for each of several
  /// runs. Then the registers are those of the tape.
  bool in_lanes = false;
  /// Whether a product and a sum in one operation of the tape are rounded once: other bits than those of the tape.
  bool fused = false;
  /// A comment behind the k-th output; null: none.
  std::function<std::string(std::size_t)> output_comment = {};
};

struct CFunction {
  std::string text;
  std::size_t registers = 0;  // numbers in `r`
};

/// A function that computes what Tape::evaluate does, and writes the outputs to the array `y`. Its cost is a few passes
/// over the tape.
[[nodiscard]] CFunction c_function(const Tape& tape, const CFunctionOptions& options);

/// Whether the body of a function of this tape has no loops.
[[nodiscard]] bool is_without_loops(const Tape& tape);

/// The helpers that functions of this text call (`minimum`, `table_3`, ...), with the tables of the tape. To be written
/// before the functions, once for all tapes of the same tables.
[[nodiscard]] std::string c_helpers(std::string_view functions, std::span<const Table> tables);

/// The helpers of functions in lanes: the type `lanes` of WIDTH doubles, as many as a register of the processor has,
/// and the operations that are done one lane after the other (`each_sin`, `each_table_3`, ...). Those of c_helpers come
/// before.
[[nodiscard]] std::string c_lane_helpers(std::string_view functions);

/// Whether the text stays of a size that a compiler takes in seconds: single operations and numbers of tables are few.
[[nodiscard]] bool is_worth_compiling(const Tape& tape);

}  // namespace continuo::model
