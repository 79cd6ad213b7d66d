// Formats numbers and fields for CSV, and writes the rows of a table.
#include <cmath>
#include <iterator>

#include <fmt/compile.h>
#include <fmt/format.h>

#include <continuo/results/csv_writer.hpp>

namespace continuo::results {

void append_number(std::string& text, double value) {
  if (value == 0) value = 0;                       // -0 is a distinction nobody reads
  if (std::isnan(value)) value = std::abs(value);  // and so is -nan
  fmt::format_to(std::back_inserter(text), FMT_COMPILE("{}"), value);
}

std::string number(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

void append_field(std::string& text, std::string_view field) {
  if (field.find_first_of(",\t\"\r\n") == std::string_view::npos) {
    text += field;
    return;
  }
  text += '"';
  for (const char c : field) {
    if (c == '"') text += '"';
    text += c;
  }
  text += '"';
}

CsvWriter::CsvWriter(OutputFile& out, std::string_view manifest_hash, std::span<const std::string> columns,
                     char separator)
    : out_(out), separator_(separator) {
  if (!manifest_hash.empty()) line_ = fmt::format("# manifest {}\n", manifest_hash);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (i > 0) line_ += separator_;
    append_field(line_, columns[i]);
  }
  line_ += '\n';
  out_.write(line_);
  out_.flush();
}

void CsvWriter::append_values(std::span<const double> values) {
  for (const double value : values) {
    if (!line_.empty()) line_ += separator_;
    append_number(line_, value);
  }
  line_ += '\n';
}

void CsvWriter::row(std::span<const double> values) {
  line_.clear();
  append_values(values);
  out_.write(line_);
}

void CsvWriter::row(std::string_view name, std::span<const double> values) {
  line_.clear();
  append_field(line_, name);
  append_values(values);
  out_.write(line_);
}

}  // namespace continuo::results
