// The lines of a table in a text file: their cells, and the numbers in them.
#pragma once
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace continuo::model {

/// What stands between the cells of a table and in its numbers, by its first line: semicolons where it has one, else
/// commas, else tabs, else blanks. Where no commas separate cells, a number may have one for its decimal sign: so write
/// the spreadsheets of many countries.
class CellFormat {
 public:
  explicit CellFormat(std::string_view first_line);

  /// Without the blanks and quotes around them. Between quotes nothing separates. An empty cell at the very end is not
  /// there.
  [[nodiscard]] std::vector<std::string_view> split(std::string_view line) const;

  struct Number {
    double value;
    bool has_point, has_comma;  // as the decimal sign
  };
  /// The number that the whole cell is.
  [[nodiscard]] std::optional<Number> number(std::string_view cell) const;

  [[nodiscard]] bool has_commas_between_cells() const { return separator_ == ','; }

 private:
  char separator_;
};

/// Whether the numbers of a table have all the same decimal sign; else one of them is read wrongly.
class DecimalSigns {
 public:
  /// False where this number, in this line, has another one than those before it.
  bool add(const CellFormat::Number& number, std::size_t line);
  [[nodiscard]] bool are_commas() const { return comma_ > 0; }
  /// The line of the first number with the other sign.
  [[nodiscard]] std::size_t first_point() const { return point_; }
  [[nodiscard]] std::size_t first_comma() const { return comma_; }

 private:
  std::size_t point_ = 0, comma_ = 0;  // lines; 0: none yet
};

/// The number that the whole text is, with a point for its decimal sign.
[[nodiscard]] std::optional<double> cell_number(std::string_view cell);

}  // namespace continuo::model
