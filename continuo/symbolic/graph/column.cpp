// Reads one column of a table.
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <continuo/symbolic/graph/cells.hpp>
#include <continuo/symbolic/graph/column.hpp>

namespace continuo::model {

namespace {

/// "k [N/m]": the name, and the unit.
std::pair<std::string_view, std::string_view> name_and_unit(std::string_view heading) {
  const std::size_t open = heading.find(" [");
  if (open == std::string_view::npos || !heading.ends_with(']')) return {heading, {}};
  return {heading.substr(0, heading.find_last_not_of(' ', open) + 1),
          heading.substr(open + 2, heading.size() - open - 3)};
}

class ColumnReader {
 public:
  ColumnReader(const std::string& file, std::string_view name) : file_(file), name_(name) {}

  Result<NamedColumn> read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // the mark some spreadsheets put before UTF-8
    while (!text.empty() && status_) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      row(text.substr(0, std::min(text.find_first_of("#\r\n"), end)));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (status_ && made_.values.empty()) fail("no numbers here");
    if (!status_) return std::move(status_);
    return std::move(made_);
  }

 private:
  void fail(std::string what) {
    status_ = {.ending = Ending::unreadable,
               .message = std::move(what),
               .place = fmt::format("{}:{}", file_, std::max<std::size_t>(line_, 1))};
  }

  void row(std::string_view line) {
    if (line.find_first_not_of(" \t") == std::string_view::npos) return;
    if (!format_) {
      format_.emplace(line);
      if (!heading(format_->split(line))) return;
    }
    const auto cells = format_->split(line);
    if (cells.size() <= place_)
      return fail(fmt::format("{} columns, but column {} is needed", cells.size(), place_ + 1));
    const auto number = format_->number(cells[place_]);
    if (!number) return fail(fmt::format("`{}` is not a number", cells[place_]));
    if (!signs_.add(*number, line_))
      return fail(fmt::format("`{}` has another decimal sign than the numbers before it", cells[place_]));
    if (!std::isfinite(number->value)) return fail(fmt::format("`{}` is not finite", cells[place_]));
    made_.values.push_back(number->value);
  }

  /// Whether the first line has numbers, and is the first row.
  bool heading(const std::vector<std::string_view>& cells) {
    const bool has_numbers =
        std::ranges::any_of(cells, [&](std::string_view cell) { return format_->number(cell).has_value(); });
    for (std::size_t i = 0; i < cells.size() && !has_numbers; ++i) {
      const auto [name, unit] = name_and_unit(cells[i]);
      if (name != name_) continue;
      place_ = i;
      made_.unit = unit;
      return false;
    }
    if (cells.size() == 1) {
      if (!has_numbers && !cells.empty()) made_.unit = name_and_unit(cells.front()).second;
      return has_numbers;
    }
    std::string names;
    for (const std::string_view cell : cells) names += (names.empty() ? "" : ", ") + std::string(cell);
    fail(has_numbers ? fmt::format("{} columns without names: the first line names them", cells.size())
                     : fmt::format("no column `{}`; there are: {}", name_, names));
    return false;
  }

  const std::string& file_;
  std::string_view name_;
  std::size_t line_ = 0, place_ = 0;
  std::optional<CellFormat> format_;
  DecimalSigns signs_;
  NamedColumn made_;
  Status status_;
};

}  // namespace

Result<NamedColumn> parse_column(std::string_view text, const std::string& file, std::string_view column) {
  return ColumnReader(file, column).read(text);
}

}  // namespace continuo::model
