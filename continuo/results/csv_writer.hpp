// continuo/results/csv_writer.hpp
// Tables as text: RFC 4180 with a first line `# manifest HASH`. Numbers are the shortest that read back as the same
// double, with a point whatever the locale; NaN and infinities are `nan`, `inf`, `-inf`.
//
//   CsvWriter csv(out, hash, {"t", "h", "h'"});
//   csv.row(std::array{0.0, 10.0, 0.0});
#pragma once
#include <span>
#include <string>
#include <string_view>

#include <continuo/results/output_file.hpp>

namespace continuo::results {

/// The number at the end of the text.
void append_number(std::string& text, double value);
/// The shortest text that reads back as the same double.
[[nodiscard]] std::string number(double value);

/// The field at the end of the text, in quotes where it holds a comma, a tab, a quote or a line end.
void append_field(std::string& text, std::string_view field);

/// Writes row by row as they come; nothing is kept.
class CsvWriter {
 public:
  /// Writes the first line with the hash, and the names of the columns. The file must outlive the writer.
  CsvWriter(OutputFile& out, std::string_view manifest_hash, std::span<const std::string> columns,
            char separator = ',');

  /// A row of numbers, one for each column.
  void row(std::span<const double> values);
  /// A row that begins with a text: the event list.
  void row(std::string_view name, std::span<const double> values);

 private:
  void append_values(std::span<const double> values);

  OutputFile& out_;
  char separator_;
  std::string line_;
};

}  // namespace continuo::results
