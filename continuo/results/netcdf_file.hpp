// A netCDF file that grows row by row. Nothing here knows a model.
//
//   NetcdfLayout layout;
//   const std::size_t time = layout.dimension("time");
//   layout.variable({.name = "x", .dimensions = {time}, .values = NetcdfVariable::Columns{0}});
//   NetcdfFile file("x.nc", layout);
//   for (const double x : {0.0, 1.0, 4.0}) file.row(std::array{x});
//   if (const Status status = file.close(); !status) fmt::print(stderr, "{}\n", status.message);
//
// The format is the classic one with 64-bit offsets (CDF-2), in which every row is a record at the end of the file, and
// the number of records stands at its beginning. It is changed when records are stored: at every instant the file is
// whole, with the rows stored until then.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <continuo/results/output_file.hpp>
#include <continuo/status/status.hpp>

namespace continuo::results {

/// A text that describes a variable or the file, such as its units.
struct NetcdfAttribute {
  std::string name, text;  // without text: left out
};

/// An index of variables with its size; 0 for that which counts the rows.
struct NetcdfDimension {
  std::string name;
  std::size_t size = 0;
};

/// A variable over dimensions.
struct NetcdfVariable {
  using Numbers = std::vector<double>;
  using Integers = std::vector<std::int32_t>;
  using Texts = std::vector<std::string>;    // stored as letters, over a dimension more
  using Columns = std::vector<std::size_t>;  // of the rows: over the dimension of the rows, and others

  std::string name;
  std::vector<std::size_t> dimensions{};  // places in NetcdfLayout::dimensions; the last one's index runs fastest
  std::vector<NetcdfAttribute> attributes{};
  std::variant<Columns, Numbers, Integers, Texts> values{};
};

/// What is in a file besides its rows, and which variables these are.
struct NetcdfLayout {
  std::vector<NetcdfAttribute> attributes;
  std::vector<NetcdfDimension> dimensions;
  std::vector<NetcdfVariable> variables;

  /// Its place, for the variables over it. Without a size it counts the rows; there is one such.
  std::size_t dimension(std::string name, std::size_t size = 0) {
    dimensions.push_back({std::move(name), size});
    return dimensions.size() - 1;
  }
  /// Appends a variable.
  void variable(NetcdfVariable variable) { variables.push_back(std::move(variable)); }
};

/// The file on its way to the disk.
class NetcdfFile {
 public:
  /// Writes all but the rows. `unfinished_ending` as for OutputFile.
  NetcdfFile(const std::string& path, const NetcdfLayout& layout, std::string_view unfinished_ending = {});

  /// One more record.
  void row(std::span<const double> values);
  /// As those of OutputFile.
  /// @{
  Status close();
  Status leave();
  [[nodiscard]] const Status& status() const { return out_.status(); }
  [[nodiscard]] std::string present_name() const { return out_.present_name(); }
  /// @}
  /// The byte where the rows begin: each is the numbers of its columns, in the order of the variables, as bytes from
  /// the highest on.
  [[nodiscard]] std::uint64_t first_row() const { return first_row_; }
  /// Rows so far.
  [[nodiscard]] std::uint64_t rows() const { return rows_; }

 private:
  void store_count();

  OutputFile out_;
  std::vector<std::size_t> columns_;  // in the order of the record
  std::string record_;
  std::uint64_t first_row_ = 0, rows_ = 0;
};

}  // namespace continuo::results
