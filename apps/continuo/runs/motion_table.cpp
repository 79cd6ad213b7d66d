// Begins the table of a run with its first row, and writes the others as they come.
#include <vector>

#include <apps/continuo/runs/motion_table.hpp>

#include <continuo/results/json.hpp>
#include <continuo/results/netcdf.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/runs/run.hpp>

namespace continuo::app {

model::OnRow MotionTable::rows_of(model::Experiment& experiment, bool keeps_rows) {
  if (!runs::kind_of(program_.model).has_start) return {};
  experiment.keep_rows = keeps_rows;
  if (path_.empty()) return [](const model::RunRow&) { return true; };  // extremes are looked for at rows as well
  std::vector<model::Diagnostic> problems;                              // the run itself will tell of them
  plan_ = runs::plan_from_start(program_, experiment, problems);
  if (!plan_) return {};
  return [this](const model::RunRow& row) { return add(row); };
}

bool MotionTable::add(const model::RunRow& row) {
  if (!table_) {
    results::TableHead head{.columns = {row.columns.begin(), row.columns.end()},
                            .manifest = results::manifest_hash(program_.model, *plan_,
                                                               row.values.subspan(1, row.states), CONTINUO_VERSION)};
    if (const auto format = results::table_format(path_); format && *format == results::TableFormat::netcdf)
      head.layout = results::netcdf_layout(program_.model, *plan_, row.columns, head.manifest);
    table_.emplace(path_, std::move(head));
  }
  table_->row(row.values);
  return static_cast<bool>(table_->status());
}

Status MotionTable::finish(const model::Run& run, bool is_whole) {
  if (path_.empty()) return {};
  if (!table_) {
    plan_ = run.plan;
    std::vector<double> values;
    for (std::size_t i = 0; i < run.motion.rows(); ++i) {
      values.assign(run.motion.row(i).begin(), run.motion.row(i).end());
      if (!run.total_energy.empty()) values.push_back(run.total_energy[i]);
      if (!add({.columns = run.motion.columns, .states = run.motion.states, .values = values})) break;
    }
  }
  if (!table_) return {};  // there is no row
  return is_whole ? table_->close() : table_->leave();
}

}  // namespace continuo::app
