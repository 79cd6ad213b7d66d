// The table of -o: its rows are on the disk as they come, so that a run of any length needs no memory for them, and
// whatever ends it leaves those that there are.
#pragma once
#include <optional>
#include <string>
#include <utility>

#include <continuo/results/table_file.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::app {

class MotionTable {
 public:
  /// `path`: empty where no table is wanted. The program must outlive this object.
  MotionTable(std::string path, const model::ModelProgram& program) : path_(std::move(path)), program_(program) {}
  MotionTable(const MotionTable&) = delete;
  MotionTable& operator=(const MotionTable&) = delete;

  /// What gets the rows of a run of this experiment, which then keeps none of them. `keeps_rows`: something else needs
  /// them as well. Nothing where there is no plan of such a run; then `finish` writes the rows that it has kept.
  model::OnRow rows_of(model::Experiment& experiment, bool keeps_rows);
  /// Ends the table: as whole, or as that of a run that did not come to its end.
  Status finish(const model::Run& run, bool is_whole);
  /// Where the table stands at present.
  std::string present_name() const { return table_ ? table_->present_name() : std::string(); }

 private:
  bool add(const model::RunRow& row);

  std::string path_;
  const model::ModelProgram& program_;
  std::optional<model::Plan> plan_;
  std::optional<results::TableFile> table_;  // from the first row on
};

}  // namespace continuo::app
