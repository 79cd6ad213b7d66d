// Statistics of a sweep as text and as JSON.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <apps/continuo/studies/sweep_report.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/summary.hpp>

namespace continuo::app {
namespace {

using Json = nlohmann::ordered_json;
using model::SweepKeep;
using results::short_number;
using studies::OutcomeSummary;

constexpr std::size_t most_failures = 5, most_times = 11;
constexpr std::array<double, 5> quantile_parts = {0.05, 0.25, 0.5, 0.75, 0.95};

/// The columns of a table, each as wide as its widest cell.
std::string aligned(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const auto& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  std::string text;
  for (const auto& line : lines) {
    std::string row;
    for (std::size_t c = 0; c < line.size(); ++c)
      row += c == 0 ? fmt::format("{:<{}}", line[c], widths[c]) : fmt::format("  {:>{}}", line[c], widths[c]);
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + '\n';
  }
  return text;
}

std::vector<std::string> line_of(std::string name, const OutcomeSummary& summary) {
  std::vector<std::string> line{std::move(name)};
  const std::vector<double> quantiles = summary.quantiles(quantile_parts);
  for (const double number : {summary.mean(), summary.deviation(), summary.lowest(), quantiles[0], quantiles[2],
                              quantiles[4], summary.highest()})
    line.push_back(std::isnan(number) ? "-" : short_number(number));
  line.push_back(fmt::format("{}", summary.count()));
  return line;
}

Json json_of(const OutcomeSummary& summary) {
  Json quantiles = Json::array();
  const std::vector<double> values = summary.quantiles(quantile_parts);
  for (std::size_t i = 0; i < quantile_parts.size(); ++i)
    quantiles.push_back({{"p", quantile_parts[i]}, {"value", values[i]}});
  return {{"count", summary.count()},
          {"missing", summary.missing()},
          {"mean", summary.mean()},
          {"deviation", summary.deviation()},
          {"lowest", summary.lowest()},
          {"highest", summary.highest()},
          {"quantiles", std::move(quantiles)},
          {"quantile_error", summary.quantile_error()}};
}

}  // namespace

SweepReport::SweepReport(const studies::PreparedSweep& sweep)
    : sweep_(sweep),
      summaries_(sweep.width(), OutcomeSummary(studies::summary_capacity(sweep.width(), sweep.runs(), 100'000'000))),
      endings_(static_cast<std::size_t>(last_ending) + 1) {}

void SweepReport::add(std::uint64_t run, const studies::SweepOutcome& outcome) {
  ++runs_;
  ++endings_[static_cast<std::size_t>(outcome.ending)];
  for (std::size_t i = 0; i < summaries_.size(); ++i) summaries_[i].add(outcome.kept[i]);
  if (succeeded(outcome.ending)) return;
  ++failed_;
  if (failures_.size() >= most_failures) return;
  failures_.push_back({run, outcome.message.empty() ? std::string(to_string(outcome.ending)) : outcome.message});
}

std::string SweepReport::label(std::uint64_t run) const {
  std::string text;
  const std::vector<double> values = sweep_.values(run);
  for (std::size_t a = 0; a < values.size(); ++a)
    text += fmt::format("{}{} = {}", a == 0 ? "" : ", ", sweep_.plan().axes[a].column(), short_number(values[a]));
  return text;
}

std::string SweepReport::text() const {
  const model::SweepPlan& plan = sweep_.plan();
  std::vector<std::vector<std::string>> lines{
      {"", "mean", "deviation", "lowest", "5 %", "median", "95 %", "highest", "runs"}};
  std::size_t place = 0;
  for (const SweepKeep& keep : plan.keeps) {
    const std::string unit = keep.unit.empty() ? "" : " [" + keep.unit + "]";
    const std::size_t width = keep.width(), shown = std::min(width, most_times);
    for (std::size_t i = 0; i < shown; ++i) {
      const std::size_t k = shown > 1 ? i * (width - 1) / (shown - 1) : 0;
      std::string name = keep.name + unit;
      if (keep.kind == SweepKeep::Kind::series) name += fmt::format(" t = {}", short_number(keep.times.at(k)));
      lines.push_back(line_of(std::move(name), summaries_[place + k]));
    }
    place += width;
  }
  double error = 0;
  for (const OutcomeSummary& summary : summaries_) error = std::max(error, summary.quantile_error());
  return aligned(lines) +
         (error > 0 ? fmt::format("Each quantile is that of a part within {} of its own.\n", short_number(error)) : "");
}

std::string SweepReport::failures_text() const {
  if (failed_ == 0) return {};
  std::string text = fmt::format("{} of {} runs failed:", failed_, runs_);
  for (const Failure& failure : failures_)
    text += fmt::format("\n  run {} ({}): {}", failure.run, label(failure.run), failure.message);
  if (failed_ > failures_.size()) text += fmt::format("\n  and {} more", failed_ - failures_.size());
  return text;
}

Json SweepReport::json() const {
  const model::SweepPlan& plan = sweep_.plan();
  Json varied = Json::array(), kept = Json::array(), failures = Json::array(), endings = Json::object();
  for (const model::SweepAxis& axis : plan.axes) varied.push_back({{"name", axis.column()}, {"unit", axis.unit}});
  std::size_t place = 0;
  for (const SweepKeep& keep : plan.keeps) {
    Json one{{"name", keep.name}, {"unit", keep.unit}};
    const std::size_t width = keep.width();
    Json statistics = Json::array();
    for (std::size_t k = 0; k < width; ++k) {
      Json of_time = json_of(summaries_[place + k]);
      if (keep.kind == SweepKeep::Kind::series) of_time["t"] = keep.times.at(k);
      statistics.push_back(std::move(of_time));
    }
    place += width;
    one["statistics"] = std::move(statistics);
    kept.push_back(std::move(one));
  }
  for (const Failure& failure : failures_) {
    Json at = Json::object();
    const std::vector<double> values = sweep_.values(failure.run);
    for (std::size_t a = 0; a < values.size(); ++a) at[plan.axes[a].column()] = values[a];
    failures.push_back({{"run", failure.run}, {"at", std::move(at)}, {"message", failure.message}});
  }
  for (std::size_t i = 0; i < endings_.size(); ++i)
    if (endings_[i] > 0) endings[std::string(to_string(static_cast<Ending>(i)))] = endings_[i];
  return {{"runs", sweep_.runs()},
          {"done", runs_},
          {"failed", failed_},
          {"sampling", std::string(to_string(plan.sampling))},
          {"seed", plan.seed},
          {"varied", std::move(varied)},
          {"kept", std::move(kept)},
          {"endings", std::move(endings)},
          {"failures", std::move(failures)}};
}

}  // namespace continuo::app
