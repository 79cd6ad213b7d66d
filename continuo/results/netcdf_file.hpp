// A netCDF-4 file as a value, and its writing. Only netcdf_file.cpp knows the library; nothing here knows a model.
//
//   NetcdfFile file;
//   const std::size_t time = file.dimension("time", 3);
//   file.variable({.name = "x", .dimensions = {time}, .values = [] { return std::vector{0.0, 1.0, 4.0}; }});
//   if (const Status status = write_netcdf_file(file, "x.nc"); !status) fmt::print(stderr, "{}\n", status.message);
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <continuo/status/status.hpp>

namespace continuo::results {

/// A text that describes a variable or the file, such as its units.
struct NetcdfAttribute {
  std::string name, text;  // without text: left out
};

/// An index of variables with its size.
struct NetcdfDimension {
  std::string name;
  std::size_t size = 0;
};

/// A variable over dimensions: numbers, or texts.
struct NetcdfVariable {
  /// Asked for when the file has come to them, so that those of one variable at a time are in memory.
  using Numbers = std::function<std::vector<double>()>;
  using Texts = std::vector<std::string>;

  std::string name;
  std::vector<std::size_t> dimensions{};  // places in NetcdfFile::dimensions; the last one's index runs fastest
  std::vector<NetcdfAttribute> attributes{};
  std::variant<Numbers, Texts> values{};
  bool integers = false;  // stored as such
};

/// The content of a file.
struct NetcdfFile {
  std::vector<NetcdfAttribute> attributes;
  std::vector<NetcdfDimension> dimensions;
  std::vector<NetcdfVariable> variables;

  /// Its place, for the variables over it.
  std::size_t dimension(std::string name, std::size_t size) {
    dimensions.push_back({std::move(name), size});
    return dimensions.size() - 1;
  }
  /// Appends a variable.
  void variable(NetcdfVariable variable) { variables.push_back(std::move(variable)); }
};

/// What went wrong, if anything.
Status write_netcdf_file(const NetcdfFile& file, const std::string& path);

}  // namespace continuo::results
