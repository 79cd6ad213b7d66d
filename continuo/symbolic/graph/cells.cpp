// Splits the lines of a text file into cells and reads the numbers in them.
#include <algorithm>
#include <charconv>
#include <string>

#include <continuo/symbolic/graph/cells.hpp>

namespace continuo::model {

namespace {

std::string_view without_quotes(std::string_view cell) {
  const std::size_t first = cell.find_first_not_of(" \t\"");
  const std::size_t last = cell.find_last_not_of(" \t\"");
  return first == std::string_view::npos ? std::string_view() : cell.substr(first, last - first + 1);
}

/// Where the cell at the beginning of the line ends: at the first of the separators that is not between quotes.
std::size_t end_of_cell(std::string_view line, std::string_view separators) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (!quoted && separators.find(line[i]) != std::string_view::npos) return i;
  }
  // A quote without its pair is a sign like any other.
  return quoted ? std::min(line.find_first_of(separators), line.size()) : line.size();
}

}  // namespace

CellFormat::CellFormat(std::string_view first_line) : separator_(' ') {
  for (const char c : {'\t', ',', ';'})
    if (end_of_cell(first_line, {&c, 1}) < first_line.size()) separator_ = c;
}

std::vector<std::string_view> CellFormat::split(std::string_view line) const {
  const bool blanks = separator_ == ' ';
  const std::string_view separators = blanks ? std::string_view(" \t") : std::string_view(&separator_, 1);
  std::vector<std::string_view> cells;
  while (!line.empty()) {
    const std::size_t end = end_of_cell(line, separators);
    const std::string_view cell = without_quotes(line.substr(0, end));
    line.remove_prefix(std::min(end + 1, line.size()));
    if (!cell.empty() || !blanks) cells.push_back(cell);
  }
  return cells;
}

std::optional<CellFormat::Number> CellFormat::number(std::string_view cell) const {
  const std::size_t comma = cell.find(',');
  const bool has_comma = comma != std::string_view::npos, has_point = cell.find('.') != std::string_view::npos;
  if (has_comma && (has_point || separator_ == ',')) return std::nullopt;
  std::string spelled(cell);
  if (has_comma) spelled[comma] = '.';
  const auto value = cell_number(spelled);
  return value ? std::optional(Number{*value, has_point, has_comma}) : std::nullopt;
}

bool DecimalSigns::add(const CellFormat::Number& number, std::size_t line) {
  if (number.has_point && point_ == 0) point_ = line;
  if (number.has_comma && comma_ == 0) comma_ = line;
  return point_ == 0 || comma_ == 0;
}

std::optional<double> cell_number(std::string_view cell) {
  if (cell.starts_with('+')) cell.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const bool whole = error == std::errc{} && end == cell.data() + cell.size();
  return whole ? std::optional(value) : std::nullopt;
}

}  // namespace continuo::model
