// The table of a sweep: the rows of all runs, one run after the other, on the disk as they come. So a sweep of any
// length needs no memory for its rows, and whatever ends it leaves those that there are.
//
//   SweepTable table("k.csv", sweep, hash_of_sweep(sweep, base));
//   table.add(member, row);     // from as many threads as there are
//   table.end(member, run);
//   table.finish(true);
#pragma once
#include <condition_variable>
#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <apps/continuo/runs/sweep.hpp>

#include <continuo/results/table_file.hpp>

namespace continuo::app {

/// The hash of what a sweep is made of: the model, its tables, the experiment, and the values. Equal hashes mean equal
/// results.
std::string hash_of_sweep(const Sweep& sweep, const Prepared& base);

class SweepTable {
 public:
  /// `path`: empty where no table is wanted. The sweep must outlive this object.
  SweepTable(std::string path, const Sweep& sweep, std::string hash)
      : path_(std::move(path)), sweep_(sweep), hash_(std::move(hash)) {}

  bool is_wanted() const { return !path_.empty(); }
  /// A row of a member. Members stand in the table in their order: one that is ahead of its turn waits when it has
  /// many rows. False: no more of them are wanted, since they cannot be written. Without a table nothing is done.
  bool add(std::size_t member, const model::RunRow& row);
  /// A member that was begun has ended. A run that has handed over no row is written as it is.
  void end(std::size_t member, const std::optional<model::Run>& run);
  /// Whether no more rows are wanted.
  bool is_refused() const;
  /// Ends the table when all members have ended: as whole, or as that of a sweep that did not come to its end.
  Status finish(bool is_whole);
  /// Where the table stands at present.
  std::string present_name() const { return table_ ? table_->present_name() : std::string(); }

 private:
  /// What a member has handed over before its turn.
  struct Waiting {
    std::vector<double> rows{};  // without the values of the sweep
    bool has_begun = false, has_ended = false;
  };
  void begin(const model::RunRow& row);
  bool has_these_columns(std::span<const model::Column> columns) const;
  bool works() const { return is_of_one_kind_ && (!table_ || table_->status()); }
  void write(std::size_t member, std::span<const double> rows);
  void advance_turn();

  std::string path_;
  const Sweep& sweep_;
  std::string hash_;
  mutable std::mutex mutex_;
  std::condition_variable turned_;
  std::size_t turn_ = 0;  // the member whose rows are written
  std::map<std::size_t, Waiting> waiting_;
  std::vector<model::Column> columns_;  // of every member
  bool is_of_one_kind_ = true;          // whether all have these
  std::optional<results::TableFile> table_;
};

}  // namespace continuo::app
