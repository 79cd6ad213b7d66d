// Puts the rows of runs that go on at the same time into one table, in the order of the runs.
#include <algorithm>
#include <chrono>
#include <utility>

#include <apps/continuo/runs/sweep_table.hpp>
#include <apps/continuo/terminal/interrupt.hpp>

#include <continuo/results/csv_writer.hpp>
#include <continuo/results/sha256.hpp>
#include <continuo/simulation/recorded_run.hpp>

namespace continuo::app {
namespace {

constexpr std::chrono::milliseconds longest_wait{100};      // until somebody looks for Ctrl-C
constexpr std::size_t most_waiting = std::size_t{1} << 17;  // numbers of a member before its turn: a megabyte

/// "name=value" for each, with all digits.
void append_values(std::string& text, const model::Overrides& values) {
  for (const auto& [name, value] : values) text += name + '=' + results::number(value) + '\n';
}

}  // namespace

std::string hash_of_sweep(const Sweep& sweep, const Prepared& base) {
  const model::Experiment& asked = base.experiment;
  std::string text(base.loaded.source.text());
  text += '\n' + std::string(CONTINUO_VERSION) + '\n' + std::to_string(model::checksum_of_tables(*base.program)) +
          '\n' + asked.method.value_or("") + '\n';
  for (const std::optional<double>& number :
       {asked.rtol, asked.step, asked.from, asked.to, asked.output, asked.max_step})
    text += (number ? results::number(*number) : std::string()) + '\n';
  text += std::to_string(asked.max_steps.value_or(0)) + (asked.output_steps ? " steps\n" : "\n");
  for (const double tolerance : asked.atol) text += results::number(tolerance) + ' ';
  for (const model::Overrides* values : {&asked.rtol_of, &asked.atol_of, &asked.parameters, &asked.initial}) {
    append_values(text, *values);
    text += '\n';
  }
  for (const SweepAxis& axis : sweep.axes) {
    text += axis.column() + ':';
    for (const double value : axis.values) text += ' ' + results::number(value);
    text += '\n';
  }
  return results::sha256(text);
}

bool SweepTable::has_these_columns(std::span<const model::Column> columns) const {
  return std::ranges::equal(columns, columns_, {}, &model::Column::name, &model::Column::name);
}

void SweepTable::begin(const model::RunRow& row) {
  columns_.assign(row.columns.begin(), row.columns.end());
  results::TableHead head{.columns = {}, .manifest = hash_};
  for (std::string& name : sweep_.columns()) head.columns.push_back({.name = std::move(name), .unit = {}});
  head.columns.insert(head.columns.end(), columns_.begin(), columns_.end());
  table_.emplace(path_, std::move(head));
}

void SweepTable::write(std::size_t member, std::span<const double> rows) {
  std::vector<double> row = sweep_.values(member);
  const std::size_t swept = row.size();
  for (; !rows.empty() && table_->status(); rows = rows.subspan(columns_.size())) {
    row.resize(swept);
    row.insert(row.end(), rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(columns_.size()));
    table_->row(row);
  }
}

bool SweepTable::add(std::size_t member, const model::RunRow& row) {
  if (!is_wanted()) return true;
  std::unique_lock lock(mutex_);
  if (!table_) begin(row);
  is_of_one_kind_ = is_of_one_kind_ && has_these_columns(row.columns);
  const auto values = row.values.first(row.columns.size());
  Waiting& own = waiting_[member];
  own.has_begun = true;
  // After Ctrl-C the member whose turn it is may never have been begun.
  while (member != turn_ && own.rows.size() >= most_waiting && works() && !interrupt_flag())
    turned_.wait_for(lock, longest_wait);
  if (!works()) {
    turned_.notify_all();
    return false;
  }
  if (member == turn_) {
    write(member, std::exchange(own.rows, {}));
    write(member, values);
  } else {
    own.rows.insert(own.rows.end(), values.begin(), values.end());
  }
  return works();
}

void SweepTable::end(std::size_t member, const std::optional<model::Run>& run) {
  if (!is_wanted()) return;
  const bool has_begun = [&] {
    const std::scoped_lock lock(mutex_);
    return waiting_[member].has_begun;
  }();
  for (std::size_t i = 0; run && !has_begun && i < run->motion.rows(); ++i) {
    const model::Motion& motion = run->motion;
    if (!add(member, {.columns = motion.columns, .states = motion.states, .values = motion.row(i)})) break;
  }
  const std::scoped_lock lock(mutex_);
  waiting_[member].has_ended = true;
  advance_turn();
}

/// Whose turn it was may have ended before it came.
void SweepTable::advance_turn() {
  for (auto first = waiting_.begin(); first != waiting_.end() && first->first == turn_ && first->second.has_ended;
       first = waiting_.begin()) {
    if (works()) write(turn_, first->second.rows);
    waiting_.erase(first);
    ++turn_;
  }
  turned_.notify_all();
}

bool SweepTable::is_refused() const {
  const std::scoped_lock lock(mutex_);
  return !works();
}

Status SweepTable::finish(bool is_whole) {
  if (!table_) return {};
  for (const auto& [member, waiting] : waiting_)  // behind one that was not begun
    if (works()) write(member, waiting.rows);
  if (is_of_one_kind_) return is_whole ? table_->close() : table_->leave();
  if (const Status status = table_->leave(); !status) return status;
  return invalid_input(
      "the runs have different states, so they have no common table: leave out -o and --events; the rows "
      "of the first ones are in " +
      present_name());
}

}  // namespace continuo::app
