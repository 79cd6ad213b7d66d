// continuo/results/table_file.hpp
// A table that is written row by row as it comes, in the format that the ending of its name says: .csv, .tsv, .nc
// (netCDF), .json, .mat (MATLAB's version 5, which Octave and SciPy read). Nothing of it stays in memory.
//
//   TableFile table("ball.csv", {.columns = {{"t", "s"}, {"h", "m"}}});
//   table.row(std::array{0.0, 10.0});
//   if (const Status status = table.close(); !status) fmt::print(stderr, "{}\n", status.message);
//
// Until it is whole it stands beside as ball.unfinished.csv. JSON and MATLAB files are made at the end of a netCDF
// file, ball.unfinished.nc, since a part of them is nothing that can be read.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <continuo/results/netcdf_file.hpp>
#include <continuo/simulation/run.hpp>
#include <continuo/status/result.hpp>
#include <continuo/status/status.hpp>

namespace continuo::results {

/// The formats of tables.
enum class TableFormat { csv, tsv, netcdf, json, matlab };

/// What the ending of the name says. Standard output, pipes and devices get CSV where their names say nothing.
[[nodiscard]] Result<TableFormat> table_format(const std::string& path);

/// Whether a table can be written there, in the format of its name: told before a long run, not after it.
Status check_table(const std::string& path);

/// What a table has besides its rows.
struct TableHead {
  std::vector<model::Column> columns;
  std::string manifest{};                // the hash of its manifest, or empty
  std::optional<NetcdfLayout> layout{};  // the arrays of a netCDF file; else one for each column
};

/// A table on its way to the disk.
class TableFile {
 public:
  /// Begins the table. What fails, here or later, is in the status.
  TableFile(const std::string& path, TableHead head);
  ~TableFile();
  /// Takes over a table that has begun.
  /// @{
  TableFile(TableFile&&) noexcept;
  TableFile& operator=(TableFile&&) noexcept;
  /// @}

  /// A number for each column; behind them there may be more, for the layout of a netCDF file.
  void row(std::span<const double> values);
  /// The table is whole and gets its name.
  Status close();
  /// The table ends here, and keeps the name of one that is not whole.
  Status leave();
  /// The first failure so far, or a success.
  [[nodiscard]] const Status& status() const;
  /// Where the rows stand at present.
  [[nodiscard]] std::string present_name() const;

  /// One format.
  class Rows;

 private:
  std::unique_ptr<Rows> rows_;
};

}  // namespace continuo::results
