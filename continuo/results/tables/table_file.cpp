// Chooses the format of a table by its name; writes text and netCDF directly, JSON and MATLAB files from a netCDF file.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include <continuo/results/csv_writer.hpp>
#include <continuo/results/table_file.hpp>
#include <continuo/results/tables/matlab_file.hpp>
#include <continuo/results/tables/stored_rows.hpp>

namespace continuo::results {

/// What every format does.
class TableFile::Rows {
 public:
  virtual ~Rows() = default;
  virtual void row(std::span<const double> values) = 0;
  virtual Status close() = 0;
  virtual Status leave() = 0;
  virtual const Status& status() const = 0;
  virtual std::string present_name() const = 0;
};

namespace {

struct FormatEnding {
  std::string_view text;
  TableFormat format;
};
constexpr std::array endings{FormatEnding{".csv", TableFormat::csv}, FormatEnding{".tsv", TableFormat::tsv},
                             FormatEnding{".nc", TableFormat::netcdf}, FormatEnding{".json", TableFormat::json},
                             FormatEnding{".mat", TableFormat::matlab}};

std::vector<std::string> names_of(const std::vector<model::Column>& columns) {
  std::vector<std::string> names;
  for (const model::Column& column : columns) names.push_back(column.name);
  return names;
}

class TextRows final : public TableFile::Rows {
 public:
  TextRows(const std::string& path, const TableHead& head, char separator)
      : out_(path, Unfinished::kept),
        csv_(out_, head.manifest, names_of(head.columns), separator),
        columns_(head.columns.size()) {}

  void row(std::span<const double> values) override { csv_.row(values.first(columns_)); }
  Status close() override { return out_.close(); }
  Status leave() override { return out_.leave(); }
  const Status& status() const override { return out_.status(); }
  std::string present_name() const override { return out_.present_name(); }

 private:
  OutputFile out_;
  CsvWriter csv_;
  std::size_t columns_;
};

class NetcdfRows final : public TableFile::Rows {
 public:
  NetcdfRows(const std::string& path, const NetcdfLayout& layout) : file_(path, layout) {}

  void row(std::span<const double> values) override { file_.row(values); }
  Status close() override { return file_.close(); }
  Status leave() override { return file_.leave(); }
  const Status& status() const override { return file_.status(); }
  std::string present_name() const override { return file_.present_name(); }

 private:
  NetcdfFile file_;
};

/// A variable for each column.
NetcdfLayout plain_layout(const TableHead& head) {
  NetcdfLayout layout{.attributes = {{"manifest", head.manifest}}, .dimensions = {}, .variables = {}};
  const std::size_t row = layout.dimension("row");
  for (std::size_t i = 0; i < head.columns.size(); ++i)
    layout.variable({.name = head.columns[i].name,
                     .dimensions = {row},
                     .attributes = {{"units", head.columns[i].unit}},
                     .values = NetcdfVariable::Columns{i}});
  return layout;
}

void append_text(std::string& json, std::string_view value) {
  json += '"';
  for (const char c : value) {
    if (c == '"' || c == '\\') json += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      json += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      json += c;
    }
  }
  json += '"';
}

/// `{"manifest": ..., "columns": [...], "units": [...], "rows": [[...], ...]}`, a row on a line. What is not finite is
/// null.
Status write_json(OutputFile& out, const TableHead& head, StoredRows& rows) {
  std::string text = "{\"manifest\": ";
  append_text(text, head.manifest);
  for (const auto& [key, of] : {std::pair{"columns", &model::Column::name}, {"units", &model::Column::unit}}) {
    text += fmt::format(",\n\"{}\": [", key);
    for (const model::Column& column : head.columns) {
      if (text.back() != '[') text += ", ";
      append_text(text, column.*of);
    }
    text += ']';
  }
  text += ",\n\"rows\": [";
  out.write(text);
  for (std::uint64_t begin = 0; begin < rows.rows() && out.status(); begin += rows.rows_of_block()) {
    const std::uint64_t end = std::min(rows.rows(), begin + rows.rows_of_block());
    const std::vector<double> block = rows.block(begin, end);
    if (block.empty()) out.fail("the rows cannot be read again");
    for (std::size_t i = 0; i < block.size(); ++i) {
      const std::size_t column = i % rows.columns();
      text = column > 0 ? ", " : begin + i > 0 ? "],\n[" : "\n[";
      if (std::isfinite(block[i])) {
        append_number(text, block[i]);
      } else {
        text += "null";
      }
      out.write(text);
    }
  }
  out.write(rows.rows() > 0 ? "]\n]}\n" : "]}\n");
  return out.status();
}

/// Rows that are kept as a netCDF file, of which the wanted one is made at the end.
class ConvertedRows final : public TableFile::Rows {
 public:
  ConvertedRows(std::string path, TableHead head, TableFormat format)
      : path_(std::move(path)), head_(std::move(head)), format_(format), file_(path_, plain_layout(head_), ".nc") {}

  void row(std::span<const double> values) override { file_.row(values); }
  Status close() override { return convert(true); }
  Status leave() override { return convert(false); }
  const Status& status() const override { return is_converted_ ? status_ : file_.status(); }
  std::string present_name() const override { return is_converted_ ? present_name_ : file_.present_name(); }

 private:
  Status convert(bool is_whole) {
    if (is_converted_) return status_;
    status_ = file_.leave();
    present_name_ = file_.present_name();
    is_converted_ = true;
    if (!status_) return status_;
    StoredRows rows(present_name_, file_.first_row(), head_.columns.size(), file_.rows());
    OutputFile out(path_, is_whole ? Unfinished::removed : Unfinished::kept);
    status_ = format_ == TableFormat::json ? write_json(out, head_, rows)
                                           : write_matlab(out, head_.columns, head_.manifest, rows);
    if (status_) status_ = is_whole ? out.close() : out.leave();
    if (!status_) {
      status_.message += fmt::format("; the rows are in {}", present_name_);  // which stays
      return status_;
    }
    ::unlink(present_name_.c_str());
    present_name_ = out.present_name();
    return status_;
  }

  std::string path_;
  TableHead head_;
  TableFormat format_;
  NetcdfFile file_;
  bool is_converted_ = false;
  Status status_;
  std::string present_name_;
};

std::unique_ptr<TableFile::Rows> rows_of(const std::string& path, TableHead head) {
  const Result<TableFormat> format = table_format(path);
  switch (format ? *format : TableFormat::csv) {
    case TableFormat::netcdf:
      return std::make_unique<NetcdfRows>(path, head.layout ? *head.layout : plain_layout(head));
    case TableFormat::json:
    case TableFormat::matlab:
      return std::make_unique<ConvertedRows>(path, std::move(head), *format);
    case TableFormat::csv:
    case TableFormat::tsv:
      break;
  }
  return std::make_unique<TextRows>(path, head, format && *format == TableFormat::tsv ? '\t' : ',');
}

}  // namespace

Result<TableFormat> table_format(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  const auto found = std::ranges::find(endings, ending, &FormatEnding::text);
  const FilePlace place = place_of(path);
  if (place.descriptor || (place.kind == FilePlace::Kind::stream && found == endings.end())) return TableFormat::csv;
  if (found != endings.end()) return found->format;
  const std::string_view parquet =
      ending == ".parquet" ? "; for Parquet, read the CSV by pandas and write it by `to_parquet`" : "";
  return invalid_input(fmt::format(
      "cannot write {}: the ending of its name says the format, .csv, .tsv, .json, .nc (netCDF) or .mat (MATLAB){}",
      path, parquet));
}

Status check_table(const std::string& path) {
  const Result<TableFormat> format = table_format(path);
  if (!format) return format.status();
  const bool is_text = *format == TableFormat::csv || *format == TableFormat::tsv;
  if (!is_text && place_of(path).kind == FilePlace::Kind::stream)
    return invalid_input(fmt::format("cannot write {}: only .csv and .tsv can go into a pipe or a device", path));
  return check_writable(path);
}

TableFile::TableFile(const std::string& path, TableHead head) : rows_(rows_of(path, std::move(head))) {}
TableFile::~TableFile() = default;
TableFile::TableFile(TableFile&&) noexcept = default;
TableFile& TableFile::operator=(TableFile&&) noexcept = default;

void TableFile::row(std::span<const double> values) {
  rows_->row(values);
}
Status TableFile::close() {
  return rows_->close();
}
Status TableFile::leave() {
  return rows_->leave();
}
const Status& TableFile::status() const {
  return rows_->status();
}
std::string TableFile::present_name() const {
  return rows_->present_name();
}

}  // namespace continuo::results
