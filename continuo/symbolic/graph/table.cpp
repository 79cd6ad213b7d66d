// continuo/symbolic/graph/table.cpp
// Tables: the pieces of their interpolation, and the reader of CSV files with its messages.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <continuo/symbolic/graph/cells.hpp>
#include <continuo/symbolic/graph/table.hpp>

namespace continuo::model {

Table::Table(std::vector<double> x, std::vector<double> y, Between between) : between_(between), x_(std::move(x)) {
  pieces_.reserve(x_.size() + 1);
  pieces_.push_back({x_.front(), y.front(), 0});
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const bool slanted = between == Between::linear && i + 1 < x_.size();
    pieces_.push_back({x_[i], y[i], slanted ? (y[i + 1] - y[i]) / (x_[i + 1] - x_[i]) : 0});
  }
}

const Table::Piece& Table::at(double x) const {
  return pieces_[static_cast<std::size_t>(std::upper_bound(x_.begin(), x_.end(), x) - x_.begin())];
}

std::span<const Table::Piece> Table::pieces(double from, double to) const {
  const Piece *first = &at(from), *last = &at(to);
  return {first, last + 1};
}

namespace {

Status unreadable(std::string what, const std::string& file, std::size_t line) {
  return {.ending = Ending::unreadable, .message = std::move(what), .place = fmt::format("{}:{}", file, line)};
}

class Reader {
 public:
  Reader(const std::string& name, std::string_view x, std::string_view y) : name_(name), x_name_(x), y_name_(y) {}

  Result<Table> read(std::string_view text, Table::Between between) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // the mark some spreadsheets put before UTF-8
    while (!text.empty() && status_) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      row(text.substr(0, std::min(text.find_first_of("#\r\n"), end)));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (status_ && xs_.empty()) fail("no numbers here");
    if (!status_) return std::move(status_);
    return Table(std::move(xs_), std::move(ys_), between);
  }

 private:
  void fail(std::string_view what) { status_ = unreadable(std::string(what), name_, std::max<std::size_t>(line_, 1)); }

  void row(std::string_view line) {
    if (line.find_first_not_of(" \t") == std::string_view::npos) return;
    if (!format_) format_.emplace(line);
    const auto cells = format_->split(line);
    if (cells.empty()) return;
    if (!started_) {
      started_ = true;
      const bool is_heading = std::ranges::none_of(cells, [&](auto cell) { return format_->number(cell).has_value(); });
      if (!choose_columns(cells, is_heading) || is_heading) return;
    }
    if (cells.size() <= std::max(x_column_, y_column_)) {
      return fail(fmt::format("{} columns, but column {} is needed", cells.size(), std::max(x_column_, y_column_) + 1));
    }
    const auto x = number_in(cells[x_column_]);
    const auto y = x ? number_in(cells[y_column_]) : std::nullopt;  // one message is enough
    if (!x || !y) return;
    if (!std::isfinite(*x) || !std::isfinite(*y)) return fail("a number is not finite");
    if (!xs_.empty() && !(*x > xs_.back())) {
      return fail(fmt::format("{} comes after {}: {} must increase", *x, xs_.back(), x_title_));
    }
    xs_.push_back(*x);
    ys_.push_back(*y);
  }

  /// Says what is wrong.
  std::optional<double> number_in(std::string_view cell) {
    const auto number = format_->number(cell);
    if (!number) {
      fail(fmt::format("`{}` is not a number", cell));
    } else if (!signs_.add(*number, line_)) {
      fail(fmt::format("`{}` and line {} have different decimal signs, a point and a comma", cell,
                       number->has_comma ? signs_.first_point() : signs_.first_comma()));
    } else {
      return number->value;
    }
    return std::nullopt;
  }

  bool choose_columns(const std::vector<std::string_view>& cells, bool is_heading) {
    if (is_heading) x_title_ = cells.front();
    if (x_name_.empty() && y_name_.empty()) {
      if (cells.size() <= 2) return true;
      return fail(fmt::format("{} columns, but a table has two: which ones are meant, nobody knows", cells.size())),
             false;
    }
    if (!is_heading) return fail("columns are asked for by name, but the first line has no names"), false;
    const auto find = [&](std::string_view name, std::size_t& column) {
      const auto found = std::ranges::find(cells, name);
      if (name.empty()) return true;
      if (found == cells.end()) {
        fail(fmt::format("no column `{}`; there are: {}", name, fmt::join(cells, ", ")));
        return false;
      }
      column = static_cast<std::size_t>(found - cells.begin());
      return true;
    };
    if (!find(x_name_, x_column_) || !find(y_name_, y_column_)) return false;
    x_title_ = cells[x_column_];
    return true;
  }

  const std::string& name_;
  std::string_view x_name_, y_name_;
  std::size_t x_column_ = 0, y_column_ = 1, line_ = 0;
  bool started_ = false;
  std::optional<CellFormat> format_;
  DecimalSigns signs_;
  std::string x_title_ = "the first column";
  std::vector<double> xs_, ys_;
  Status status_;
};

}  // namespace

Result<Table> parse_table(std::string_view text, const std::string& name, Table::Between between, std::string_view x,
                          std::string_view y) {
  return Reader(name, x, y).read(text, between);
}

Result<Table> read_table(const std::filesystem::path& file, Table::Between between, std::string_view x,
                         std::string_view y) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return unreadable("the file cannot be read", file.string(), 1);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return parse_table(text, file.string(), between, x, y);
}

}  // namespace continuo::model
