// One line of a table in a text file: its cells, and the numbers in them.
#pragma once
#include <optional>
#include <string_view>
#include <vector>

namespace continuo::model {

/// Told apart by commas, semicolons or, where there are none, blanks; without blanks and quotes around them. An empty
/// cell at the very end is not there.
[[nodiscard]] std::vector<std::string_view> split_cells(std::string_view line);

/// The number that the whole cell is.
[[nodiscard]] std::optional<double> cell_number(std::string_view cell);

}  // namespace continuo::model
