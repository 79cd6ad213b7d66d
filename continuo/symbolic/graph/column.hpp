// continuo/symbolic/graph/column.hpp
// One column of a table in a text file, by its name: samples of a quantity, in the order of the lines.
//
//   const Result<Column> column = parse_column("c,k\n0.5,3\n0.6,4\n", "samples.csv", "k");   // 3, 4
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include <continuo/status/result.hpp>

namespace continuo::model {

/// The numbers of a column, and the unit in its heading: `k [N/m]`; empty where there is none.
struct NamedColumn {
  std::vector<double> values;
  std::string unit;
};

/// The column of this name; of a file with one column that column, which needs no heading. Cells are told apart as in
/// every table (cells.hpp); `#` begins a comment. A failure is unreadable, its place "file:line".
[[nodiscard]] Result<NamedColumn> parse_column(std::string_view text, const std::string& file, std::string_view column);

}  // namespace continuo::model
