// The table of a sweep: a row for each run, with the values that it had, how it ended and what was kept of it.
//
//   SweepTable table("k.nc", sweep, hash);
//   table.add(run, outcome);                    // in the order of the runs
//   if (const Status status = table.close(); !status) fmt::print(stderr, "{}\n", status.message);
//   >>> xarray.open_dataset("k.nc").peak        # (run), with the coordinates k and c
//
// In a netCDF file the dimensions are run and the times of series, and what was varied is a coordinate of all that was
// kept (CF conventions 1.8). In other formats a series is a column for each of its times.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <continuo/results/table_file.hpp>
#include <continuo/studies/sweep/sweep_run.hpp>

namespace continuo::studies {

/// The table on its way to the disk.
class SweepTable {
 public:
  /// Begins it. What fails, here or later, is in the status. The sweep must outlive this object.
  SweepTable(const std::string& path, const PreparedSweep& sweep, const std::string& hash);

  /// The row of a run.
  void add(std::uint64_t run, const SweepOutcome& outcome);
  /// The first failure so far, or a success.
  [[nodiscard]] const Status& status() const { return table_.status(); }
  /// The table is whole and gets its name.
  Status close() { return table_.close(); }
  /// The table ends here, and keeps the name of one that is not whole.
  Status leave() { return table_.leave(); }
  /// Where the rows stand at present.
  [[nodiscard]] std::string present_name() const { return table_.present_name(); }

 private:
  const PreparedSweep& sweep_;
  results::TableFile table_;
  std::vector<double> row_;
};

}  // namespace continuo::studies
