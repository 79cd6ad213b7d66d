// Splits a line of a text file into cells and reads the numbers in them.
#include <algorithm>
#include <charconv>

#include <continuo/symbolic/graph/cells.hpp>

namespace continuo::model {

std::vector<std::string_view> split_cells(std::string_view line) {
  const bool blanks_only = line.find_first_of(",;") == std::string_view::npos;
  const std::string_view separators = blanks_only ? " \t" : ",;";
  std::vector<std::string_view> cells;
  while (!line.empty()) {
    const std::size_t end = std::min(line.find_first_of(separators), line.size());
    std::string_view cell = line.substr(0, end);
    line.remove_prefix(std::min(end + 1, line.size()));
    const std::size_t first = cell.find_first_not_of(" \t\"");
    const std::size_t last = cell.find_last_not_of(" \t\"");
    cell = first == std::string_view::npos ? std::string_view() : cell.substr(first, last - first + 1);
    if (!cell.empty() || !blanks_only) cells.push_back(cell);
  }
  return cells;
}

std::optional<double> cell_number(std::string_view cell) {
  if (cell.starts_with('+')) cell.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const bool whole = error == std::errc{} && end == cell.data() + cell.size();
  return whole ? std::optional(value) : std::nullopt;
}

}  // namespace continuo::model
