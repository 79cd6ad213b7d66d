// continuo/language/check/declarations/files.cpp
// Finds and reads the files that a model names.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <continuo/language/check/declarations/files.hpp>
#include <continuo/language/check/declarations/folder_file.hpp>
#include <continuo/shapes/wavefront.hpp>

namespace continuo::model::detail {

namespace {

std::string folder_of(const Report& report) {
  return std::filesystem::path(report.source().name()).parent_path().string();
}

/// Of a text that came over a network: `name` is as the text has it.
std::optional<Table> points_in_folder(const std::string& name, Span span, Table::Between between,
                                      std::string_view column, Report& report) {
  const Result<std::string> text = read_from_folder(folder_of(report), name);
  if (!text) {
    report.fail("E270", span, "this file is not read", text.status().message,
                "files are found relative to the model's folder, and not outside of it");
    return std::nullopt;
  }
  if (!column.empty()) {
    if (Result<Table> named = parse_table(*text, name, between, {}, column)) return *std::move(named);
  }
  Result<Table> read = parse_table(*text, name, between);
  if (read) return *std::move(read);
  // Its place only: the message quotes what stands there.
  report.fail("E272", span, "this file is not a table", fmt::format("{} is not as it has to be", read.status().place),
              "`continuo check`, where the file is, says more");
  return std::nullopt;
}

bool is_confined(const Report& report) {
  return report.files() == FileReach::model_folder;
}

/// The content of a file; E270 where there is none, or none that may be read.
std::optional<std::string> text_of(const std::string& name, Span span, Report& report) {
  if (is_confined(report)) {
    Result<std::string> text = read_from_folder(folder_of(report), name);
    if (text) return *std::move(text);
    report.fail("E270", span, "this file is not read", text.status().message,
                "files are found relative to the model's folder, and not outside of it");
    return std::nullopt;
  }
  const std::string file = file_of(name, span, report);
  if (file.empty()) return std::nullopt;
  std::ifstream stream(file, std::ios::binary);
  return std::string{std::istreambuf_iterator<char>(stream), {}};
}

std::optional<NamedColumn> column_in(std::string_view text, const std::string& name, Span span,
                                     const std::string& column, Report& report) {
  Result<NamedColumn> read = parse_column(text, name, column);
  if (read) return *std::move(read);
  report.fail(
      "E272", span, "this file is not a table",
      is_confined(report) ? fmt::format("it has no column of numbers named `{}`", column) : describe(read.status()),
      fmt::format("a column named `{}` is read, or the only one", column));
  return std::nullopt;
}

/// Columns of one table, each by its name, which is needed: only where there is one column a table does without.
template <std::size_t Count>
std::optional<std::array<NamedColumn, Count>> columns_of(const std::string& file, Span span,
                                                         const std::array<std::string, Count>& names, Report& report) {
  const auto text = text_of(file, span, report);
  if (!text) return std::nullopt;
  if (parse_column(*text, file, {})) {
    report.fail("E272", span, "this file is no table of points", "it has one column",
                fmt::format("its first line names the columns `{}`", fmt::join(names, "`, `")));
    return std::nullopt;
  }
  std::array<NamedColumn, Count> columns;
  for (std::size_t k = 0; k < Count; ++k) {
    auto column = column_in(*text, file, span, names[k], report);
    if (!column) return std::nullopt;
    columns[k] = *std::move(column);
  }
  return columns;
}

}  // namespace

std::string file_of(const std::string& name, Span span, Report& report) {
  namespace fs = std::filesystem;
  if (report.files() == FileReach::model_folder && !name.empty()) return name;  // points_of looks for it
  const fs::path path = fs::path(folder_of(report)) / name;
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) {
    report.fail("E270", span, "there is no such file", fmt::format("looked for {}", path.string()),
                "files are found relative to the model's folder");
    return {};
  }
  return path.string();
}

std::optional<Table> points_of(const std::string& file, Span span, Table::Between between, std::string_view column,
                               Report& report) {
  if (file.empty()) return std::nullopt;
  if (report.files() == FileReach::model_folder) return points_in_folder(file, span, between, column, report);
  if (!column.empty()) {
    if (Result<Table> named = read_table(file, between, {}, column)) return *std::move(named);
  }
  Result<Table> read = read_table(file, between);
  if (read) return *std::move(read);
  report.fail("E272", span, "this file is not a table", describe(read.status()),
              column.empty() ? std::string() : fmt::format("a column named `{}` is read where there is one", column));
  return std::nullopt;
}

std::optional<NamedColumn> column_of(const std::string& name, Span span, const std::string& column, Report& report) {
  const auto text = text_of(name, span, report);
  return text ? column_in(*text, name, span, column, report) : std::nullopt;
}

std::optional<std::array<NamedColumn, 2>> points_of_chain(const std::string& name, Span span, Report& report) {
  return columns_of<2>(name, span, {"x", "y"}, report);
}

std::optional<std::array<NamedColumn, 3>> points_of_heights(const std::string& name, Span span, Report& report) {
  return columns_of<3>(name, span, {"x", "y", "z"}, report);
}

std::optional<TriangleMesh<double>> triangles_of(const std::string& name, Span span, Report& report) {
  const auto text = text_of(name, span, report);
  if (!text) return std::nullopt;
  Result<TriangleMesh<double>> read = parse_wavefront(*text, name);
  if (read) return *std::move(read);
  report.fail(
      "E273", span, "this file is not a mesh",
      is_confined(report) ? fmt::format("{} is not as it has to be", read.status().place) : describe(read.status()),
      "a Wavefront OBJ file has lines `v 0 0 1` and `f 1 2 3`");
  return std::nullopt;
}

}  // namespace continuo::model::detail
