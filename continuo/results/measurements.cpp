// Reads measurements from CSV, with a message for each fault.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <continuo/results/measurements.hpp>
#include <continuo/symbolic/graph/cells.hpp>

namespace continuo::results {

namespace {

class Reader {
 public:
  explicit Reader(const std::string& name) { data_.file = name; }

  Result<Measurements> read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // the mark some spreadsheets put before UTF-8
    while (!text.empty() && status_) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      row(text.substr(0, std::min(text.find_first_of("#\r\n"), end)));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    tell_bad_cells();
    if (status_ && headings_.empty()) fail("the file is empty");
    if (status_ && data_.times.empty()) fail("no rows of numbers below the names of the columns");
    data_.has_decimal_commas = signs_.are_commas();
    if (status_) sort();
    if (!status_) return std::move(status_);
    return std::move(data_);
  }

 private:
  void fail(std::string_view what) {
    status_ = {.ending = Ending::unreadable,
               .message = fmt::format("{}:{}: {}", data_.file, std::max<std::size_t>(line_, 1), what)};
  }

  /// All cells that are no numbers, by their places; of many the first ones.
  void tell_bad_cells() {
    constexpr std::size_t most_told = 10;
    if (!status_ || bad_cells_.empty()) return;
    const std::size_t told = std::min(bad_cells_.size(), most_told);
    std::string text =
        fmt::format("{}", fmt::join(bad_cells_.begin(), bad_cells_.begin() + static_cast<std::ptrdiff_t>(told), "\n"));
    if (told < bad_cells_.size()) text += fmt::format("\nand {} more cells", bad_cells_.size() - told);
    status_ = {.ending = Ending::unreadable, .message = std::move(text)};
  }

  /// Nothing, and noted, where the cell is no number. A missing value is not a number, NaN.
  std::optional<double> number_in(std::string_view cell, const std::string& heading) {
    if (cell.empty() || cell == "NA" || cell == "nan" || cell == "NaN") return std::nan("");
    const auto number = format_->number(cell);
    std::string problem;
    if (!number || std::isinf(number->value)) {
      problem = fmt::format("`{}` in column `{}` is no number", cell, heading);
    } else if (!signs_.add(*number, line_)) {
      problem = fmt::format("`{}` in column `{}` has a decimal {}, but line {} has a decimal {}", cell, heading,
                            number->has_comma ? "comma" : "point",
                            number->has_comma ? signs_.first_point() : signs_.first_comma(),
                            number->has_comma ? "point" : "comma");
    } else {
      return number->value;
    }
    bad_cells_.push_back(fmt::format("{}:{}: {}", data_.file, line_, problem));
    return std::nullopt;
  }

  void row(std::string_view line) {
    if (!format_ && line.find_first_not_of(" \t") != std::string_view::npos) format_.emplace(line);
    const auto cells = format_ ? format_->split(line) : std::vector<std::string_view>();
    if (cells.empty() || std::ranges::all_of(cells, [](auto cell) { return cell.empty(); })) return;
    if (headings_.empty()) return head(cells);
    if (cells.size() > headings_.size())
      return fail(fmt::format("{} cells under {} names of columns{}", cells.size(), headings_.size(),
                              format_->has_commas_between_cells()
                                  ? "; numbers with decimal commas need semicolons between the cells"
                                  : ""));
    for (std::size_t c = 0; c < headings_.size() && status_; ++c) {
      const std::string_view cell = c < cells.size() ? cells[c] : std::string_view();
      const auto number = number_in(cell, headings_[c]);
      if (!number) continue;
      if (c != time_) {
        data_.values[c - (c > time_ ? 1 : 0)].push_back(*number);
      } else if (std::isnan(*number)) {
        fail(fmt::format("no time in column `{}`", headings_[c]));
      } else {
        data_.times.push_back(*number);
        data_.lines.push_back(line_);
      }
    }
  }

  /// `x [cm]` as x and cm. Without the blank it is a name with an index, as of families.
  static std::pair<std::string_view, std::string_view> named(std::string_view heading) {
    const std::size_t bracket = heading.rfind(" [");
    if (bracket == std::string_view::npos || !heading.ends_with(']')) return {heading, {}};
    std::string_view name = heading.substr(0, bracket);
    while (name.ends_with(' ')) name.remove_suffix(1);
    return {name, heading.substr(bracket + 2, heading.size() - bracket - 3)};
  }

  void head(const std::vector<std::string_view>& cells) {
    if (std::ranges::any_of(cells, [&](auto cell) { return format_->number(cell).has_value(); }))
      return fail("the first line must name the columns, like `t,x`");
    std::vector<std::string> units;
    for (const std::string_view cell : cells) {
      const auto [name, unit] = named(cell);
      headings_.emplace_back(name);
      units.emplace_back(unit);
    }
    for (std::size_t c = 0; c < headings_.size(); ++c) {
      if (std::count(headings_.begin(), headings_.end(), headings_[c]) > 1)
        return fail(fmt::format("two columns are called `{}`", headings_[c]));
    }
    if (headings_.size() < 2) return fail("one column only; a time and at least one quantity are needed");
    const auto t = std::ranges::find(headings_, "t");
    time_ = t == headings_.end() ? 0 : static_cast<std::size_t>(t - headings_.begin());
    for (std::size_t c = 0; c < headings_.size(); ++c)
      if (c != time_) data_.columns.push_back(headings_[c]), data_.units.push_back(units[c]);
    data_.time_unit = units[time_];
    data_.values.resize(data_.columns.size());
  }

  void sort() {
    std::vector<std::size_t> order(data_.times.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(data_.times[i], i); });
    const auto arrange = [&](auto& list) {
      auto copy = list;
      for (std::size_t i = 0; i < order.size(); ++i) list[i] = copy[order[i]];
    };
    arrange(data_.times);
    arrange(data_.lines);
    for (auto& column : data_.values) arrange(column);
  }

  Measurements data_;
  Status status_;
  std::vector<std::string> headings_, bad_cells_;
  std::optional<model::CellFormat> format_;
  model::DecimalSigns signs_;
  std::size_t time_ = 0, line_ = 0;
};

}  // namespace

Result<Measurements> parse_measurements(std::string_view text, const std::string& name) {
  return Reader(name).read(text);
}

Result<Measurements> read_measurements(const std::string& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    return Status{Ending::unreadable, fmt::format("cannot read {}: it is a folder", file)};
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return Status{Ending::unreadable, fmt::format("{}:1: the file cannot be read", file)};
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return parse_measurements(text, file);
}

}  // namespace continuo::results
