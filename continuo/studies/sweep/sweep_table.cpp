// Names the columns of a sweep, and lays them out as the variables of a netCDF file.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <continuo/results/csv_writer.hpp>
#include <continuo/studies/sweep/sweep_table.hpp>

namespace continuo::studies {
namespace {

using model::SweepAxis;
using model::SweepKeep;
using results::NetcdfLayout;
using results::NetcdfVariable;

/// The columns of a run beside those that were asked for: its number, how it ended, and when.
constexpr std::size_t columns_before_axes = 1, columns_behind_axes = 2;

/// A slash separates groups in names of netCDF.
std::string variable_name(std::string name) {
  std::ranges::replace(name, '/', '_');
  return name;
}

/// "reached_end stopped_by_event ...": the words of the numbers from 0 on.
std::string meanings_of_endings() {
  std::vector<std::string> words;
  for (int i = 0; i <= static_cast<int>(last_ending); ++i) {
    std::string word(to_string(static_cast<Ending>(i)));
    std::ranges::replace(word, ' ', '_');
    words.push_back(std::move(word));
  }
  return fmt::format("{}", fmt::join(words, " "));
}

std::string values_text(const SweepAxis& axis) {
  const auto* drawn = std::get_if<model::SweepDistribution>(&axis.values);
  if (!drawn) return {};
  return fmt::format("{}({})", to_string(drawn->kind), fmt::join(drawn->numbers, ", "));
}

std::vector<model::Column> columns_of(const PreparedSweep& sweep) {
  const model::SweepPlan& plan = sweep.plan();
  std::vector<model::Column> columns{{"run", {}}};
  for (const SweepAxis& axis : plan.axes) columns.push_back({axis.column(), axis.unit});
  columns.insert(columns.end(), {{"outcome", {}}, {"ended", sweep.model().time_unit}});
  for (const SweepKeep& keep : plan.keeps) {
    if (keep.kind != SweepKeep::Kind::series) columns.push_back({keep.name, keep.unit});
    if (keep.kind != SweepKeep::Kind::series) continue;
    for (std::size_t k = 0; k < keep.times.count; ++k)
      columns.push_back({fmt::format("{} t={}", keep.name, results::number(keep.times.at(k))), keep.unit});
  }
  return columns;
}

class SweepLayout {
 public:
  explicit SweepLayout(const PreparedSweep& sweep) : sweep_(sweep) {}

  NetcdfLayout layout(const std::string& hash) {
    const model::SweepPlan& plan = sweep_.plan();
    file_.attributes = {{"Conventions", "CF-1.8"},
                        {"title", sweep_.model().name},
                        {"source", "Continuo"},
                        {"comment", sweep_.model().heading},
                        {"sampling", fmt::format("{}, seed {}", to_string(plan.sampling), plan.seed)},
                        {"manifest", hash}};
    run_ = file_.dimension("run");
    add("run", {{"long_name", "number of the run"}}, {run_}, 1);
    std::vector<std::string> varied;
    for (const SweepAxis& axis : plan.axes) {
      varied.push_back(variable_name(axis.column()));
      add(axis.column(), {{"units", axis.unit}, {"distribution", values_text(axis)}}, {run_}, 1);
    }
    coordinates_ = fmt::format("{}", fmt::join(varied, " "));
    add("outcome", {{"long_name", "how the run ended"}, {"flag_meanings", meanings_of_endings()}}, {run_}, 1);
    add("ended", {{"units", sweep_.model().time_unit}, {"long_name", "time of the end"}}, {run_}, 1);
    for (const SweepKeep& keep : plan.keeps) {
      std::vector<std::size_t> dimensions{run_};
      if (keep.kind == SweepKeep::Kind::series) dimensions.push_back(dimension_of(keep.times));
      add(keep.name, {{"units", keep.unit}, {"coordinates", coordinates_}}, std::move(dimensions), keep.width());
    }
    return std::move(file_);
  }

 private:
  void add(const std::string& name, std::vector<results::NetcdfAttribute> attributes,
           std::vector<std::size_t> dimensions, std::size_t width) {
    NetcdfVariable::Columns columns(width);
    std::iota(columns.begin(), columns.end(), next_column_);
    next_column_ += width;
    file_.variable({.name = variable_name(name),
                    .dimensions = std::move(dimensions),
                    .attributes = std::move(attributes),
                    .values = std::move(columns)});
  }

  /// Series of the same times share their dimension.
  std::size_t dimension_of(const model::SweepTimes& times) {
    for (const auto& [known, place] : times_)
      if (known.first == times.first && known.interval == times.interval && known.count == times.count) return place;
    const std::string name = times_.empty() ? "time" : fmt::format("time{}", times_.size() + 1);
    const std::size_t place = file_.dimension(name, times.count);
    NetcdfVariable::Numbers values(times.count);
    for (std::size_t k = 0; k < times.count; ++k) values[k] = times.at(k);
    file_.variable({.name = name,
                    .dimensions = {place},
                    .attributes = {{"units", sweep_.model().time_unit}},
                    .values = std::move(values)});
    times_.emplace_back(times, place);
    return place;
  }

  const PreparedSweep& sweep_;
  NetcdfLayout file_;
  std::size_t run_ = 0, next_column_ = 0;
  std::string coordinates_;
  std::vector<std::pair<model::SweepTimes, std::size_t>> times_;
};

}  // namespace

SweepTable::SweepTable(const std::string& path, const PreparedSweep& sweep, const std::string& hash)
    : sweep_(sweep),
      table_(path, {.columns = columns_of(sweep), .manifest = hash, .layout = SweepLayout(sweep).layout(hash)}) {}

void SweepTable::add(std::uint64_t run, const SweepOutcome& outcome) {
  row_.clear();
  row_.reserve(columns_before_axes + sweep_.plan().axes.size() + columns_behind_axes + sweep_.width());
  row_.push_back(static_cast<double>(run));
  const std::vector<double> values = sweep_.values(run);
  row_.insert(row_.end(), values.begin(), values.end());
  row_.push_back(static_cast<double>(outcome.ending));
  row_.push_back(outcome.t);
  row_.insert(row_.end(), outcome.kept.begin(), outcome.kept.end());
  table_.row(row_);
}

}  // namespace continuo::studies
