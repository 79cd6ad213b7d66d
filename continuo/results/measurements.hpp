// Columns over time read from a CSV file: measurements to fit, the guess of a boundary-value problem.
//
//   const Result<Measurements> read = read_measurements("spring.csv");
//   if (!read) fmt::print("{}\n", read.status().message);   // "spring.csv:7: `abc` in column `x` is no number"
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/status/result.hpp>

namespace continuo::results {

/// A table of measurements: a column of times, and columns of values.
struct Measurements {
  std::string file;
  std::vector<std::string> columns;         // without the time's
  std::vector<double> times;                // ascending
  std::vector<std::size_t> lines;           // of each row, in the file
  std::vector<std::vector<double>> values;  // by column, one per time; NaN where nothing was measured
  std::vector<std::string> units{};         // by column; empty where the heading gives none
  std::string time_unit{};
  bool has_decimal_commas = false;  // 1,5 was read as 1.5
};

/// The first line names the columns; one of them is `t`, else the first is the time. Where it has semicolons they are
/// between the cells, and numbers may have decimal commas. Empty cells, `nan` and `NA` are missing values. Rows may
/// come in any order. A name may have its unit behind it, after a blank: `x [cm]`. The message of a failure begins with
/// "file:line: ".
[[nodiscard]] Result<Measurements> read_measurements(const std::string& file);
/// The same from text, `name` being what messages call it.
[[nodiscard]] Result<Measurements> parse_measurements(std::string_view text, const std::string& name);

}  // namespace continuo::results
