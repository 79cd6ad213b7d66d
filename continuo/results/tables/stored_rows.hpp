// The rows of a netCDF file that was written just now, read again block by block to make another file of them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace continuo::results {

/// Rows of numbers that lie in a file from a place on.
class StoredRows {
 public:
  /// `first`: the byte where they begin.
  StoredRows(const std::string& path, std::uint64_t first, std::size_t columns, std::uint64_t rows)
      : file_(path, std::ios::binary), first_(first), columns_(columns), rows_(rows) {}

  /// Numbers in a row.
  [[nodiscard]] std::size_t columns() const { return columns_; }
  /// Rows in the file.
  [[nodiscard]] std::uint64_t rows() const { return rows_; }
  /// How many rows are read well together.
  [[nodiscard]] std::uint64_t rows_of_block() const;
  /// Row after row; empty where they cannot be read.
  [[nodiscard]] std::vector<double> block(std::uint64_t begin, std::uint64_t end);

 private:
  std::ifstream file_;
  std::uint64_t first_;
  std::size_t columns_;
  std::uint64_t rows_;
};

}  // namespace continuo::results
