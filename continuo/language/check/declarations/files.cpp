// continuo/language/check/declarations/files.cpp
// Finds and reads the files that a model names.
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include <continuo/language/check/declarations/files.hpp>

namespace continuo::model::detail {

std::string file_of(const std::string& name, Span span, Report& report) {
  namespace fs = std::filesystem;
  const fs::path path = fs::path(report.source().name()).parent_path() / name;
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
  if (!column.empty()) {
    if (Result<Table> named = read_table(file, between, {}, column)) return *std::move(named);
  }
  Result<Table> read = read_table(file, between);
  if (read) return *std::move(read);
  report.fail("E272", span, "this file is not a table", describe(read.status()),
              column.empty() ? std::string() : fmt::format("a column named `{}` is read where there is one", column));
  return std::nullopt;
}

}  // namespace continuo::model::detail
