// continuo/symbolic/graph/table.hpp
// A function given by points, read from a CSV file:
//
//   const Result<Table> table = read_table("thrust.csv", Table::Between::linear);
//   if (!table) std::cerr << describe(table.status());       // "thrust.csv:7: 3 comes after 4: t must increase"
//   const double force = table->value(0.3);
//
// Before the first and after the last point the function keeps the end's value.
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/status/result.hpp>

namespace continuo::model {

class Table {
 public:
  /// Between two points: a straight line, or the value of the earlier point (from its x on).
  enum class Between { linear, step };

  /// x must increase strictly and have as many numbers as y, at least one.
  Table(std::vector<double> x, std::vector<double> y, Between between);

  [[nodiscard]] double value(double x) const {
    const Piece& piece = at(x);
    return piece.y + piece.slope * (x - piece.x);
  }
  /// The slope of the piece that `value` reads: at a corner the one to the right.
  [[nodiscard]] double slope(double x) const { return at(x).slope; }

  /// value(x) = y + slope*(x - x_i), also for x that carry derivatives.
  struct Piece {
    double x, y, slope;
  };
  [[nodiscard]] const Piece& at(double x) const;
  /// All that `at` may give from one x to another, in their order; each holds up to the x of the next.
  [[nodiscard]] std::span<const Piece> pieces(double from, double to) const;

  /// The one before the first point, then that of each point.
  [[nodiscard]] std::span<const Piece> all_pieces() const { return pieces_; }

  [[nodiscard]] std::span<const double> x() const { return x_; }
  [[nodiscard]] Between between() const { return between_; }

 private:
  Between between_;
  std::vector<double> x_;
  std::vector<Piece> pieces_;  // before the first point, then from each point on
};

/// Columns are told apart by commas, semicolons or blanks; a first line without numbers names them; `#` begins a
/// comment. `x` and `y` name the columns to read; empty ones mean the first and the second. A failure is unreadable,
/// its place "file:line".
[[nodiscard]] Result<Table> read_table(const std::filesystem::path& file, Table::Between between,
                                       std::string_view x = {}, std::string_view y = {});

/// The same from text, `name` being what messages call it.
[[nodiscard]] Result<Table> parse_table(std::string_view text, const std::string& name, Table::Between between,
                                        std::string_view x = {}, std::string_view y = {});

}  // namespace continuo::model
