// Sobol' indices and elementary effects of a sweep, told.
#include <algorithm>
#include <cmath>

#include <apps/continuo/studies/sweep_indices.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/sweep_figures.hpp>

namespace continuo::app {
namespace {

using Json = nlohmann::ordered_json;
using studies::Estimate;

std::string digits_of(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : "-";
}

std::string share_of(const Estimate& e) {
  if (!std::isfinite(e.value)) return "-";
  return fmt::format("{:.3f} ({:.3f} to {:.3f})", e.value, e.low, e.high);
}

std::string effect_of(const Estimate& e) {
  return fmt::format("{} ({} to {})", digits_of(e.value), digits_of(e.low), digits_of(e.high));
}

Json json_of_estimate(const Estimate& e) {
  return {{"value", e.value}, {"low", e.low}, {"high", e.high}};
}

results::Bar bar_of(const Estimate& e) {
  return {e.value, {e.low, e.high}};
}

std::string left_out_text(std::uint64_t missing, std::string_view what) {
  if (missing == 0) return {};
  return fmt::format("{} {} with failed runs are left out.\n", missing, what);
}

}  // namespace

SweepIndices::SweepIndices(const studies::PreparedSweep& sweep) : sweep_(sweep) {
  const studies::SweepDesign* design = sweep.design();
  if (!design || (!design->indices() && !design->screening())) return;
  names_ = sweep.dimension_names();
  std::size_t place = 0;
  for (const model::SweepKeep& keep : sweep.plan().keeps) {
    const bool is_series = keep.kind == model::SweepKeep::Kind::series;
    place += is_series ? keep.times.count : 1;
    const std::string when = is_series ? fmt::format(" at t = {}", keep.times.at(keep.times.count - 1)) : "";
    const std::string unit = keep.unit.empty() ? "" : " [" + keep.unit + "]";
    outcomes_.push_back({.quantity = keep.name + when, .name = keep.name + unit + when, .place = place - 1});
  }
}

void SweepIndices::add(const studies::SweepOutcome& outcome) {
  for (Outcome& one : outcomes_) one.values.push_back(outcome.kept[one.place]);
}

std::string SweepIndices::indices_text(const Outcome& outcome) const {
  const auto indices = sobol_indices(*sweep_.design()->indices(), outcome.values);
  std::string text = fmt::format("\n{:<24}  {:<26}  {}\n", "variance of " + outcome.quantity, "first order", "total");
  for (std::size_t i = 0; i < names_.size(); ++i)
    text += fmt::format("  {:<22}  {:<26}  {}\n", names_[i], share_of(indices.first[i]), share_of(indices.total[i]));
  return text + left_out_text(indices.missing, "rows");
}

std::string SweepIndices::screening_text(const Outcome& outcome) const {
  const auto screening = morris_screening(*sweep_.design()->screening(), outcome.values);
  std::string text = fmt::format("\n{:<24}  {:<32}  {:<10}  {}\n", "effect on " + outcome.name, "mu*", "mu", "sigma");
  std::uint64_t missing = 0;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const studies::ElementaryEffects& effects = screening.effects[i];
    missing = std::max(missing, effects.missing);
    text += fmt::format("  {:<22}  {:<32}  {:<10}  {}\n", names_[i], effect_of(effects.mean_absolute),
                        digits_of(effects.mean), digits_of(effects.deviation));
  }
  return text + left_out_text(missing, "steps");
}

std::string SweepIndices::text() const {
  std::string text;
  for (const Outcome& outcome : outcomes_)
    text += sweep_.design()->indices() ? indices_text(outcome) : screening_text(outcome);
  return text;
}

Json SweepIndices::json() const {
  if (outcomes_.empty()) return nullptr;
  Json all = Json::array();
  for (const Outcome& outcome : outcomes_) {
    Json one{{"of", outcome.name}}, varied = Json::array();
    if (const auto* design = sweep_.design()->indices()) {
      const auto indices = sobol_indices(*design, outcome.values);
      for (std::size_t i = 0; i < names_.size(); ++i)
        varied.push_back({{"name", names_[i]},
                          {"first", json_of_estimate(indices.first[i])},
                          {"total", json_of_estimate(indices.total[i])}});
    } else {
      const auto screening = morris_screening(*sweep_.design()->screening(), outcome.values);
      for (std::size_t i = 0; i < names_.size(); ++i)
        varied.push_back({{"name", names_[i]},
                          {"mean_absolute", json_of_estimate(screening.effects[i].mean_absolute)},
                          {"mean", screening.effects[i].mean},
                          {"deviation", screening.effects[i].deviation}});
    }
    one["varied"] = std::move(varied);
    all.push_back(std::move(one));
  }
  return all;
}

std::vector<results::Panel> SweepIndices::panels() const {
  std::vector<results::Panel> panels;
  for (const Outcome& outcome : outcomes_) {
    if (const auto* design = sweep_.design()->indices()) {
      const auto indices = sobol_indices(*design, outcome.values);
      results::BarGroup first{"first order", {}}, total{"total", {}};
      for (const Estimate& e : indices.first) first.bars.push_back(bar_of(e));
      for (const Estimate& e : indices.total) total.bars.push_back(bar_of(e));
      panels.push_back(results::bar_panel("part of the variance of " + outcome.quantity, names_, {first, total}));
    } else {
      const auto screening = morris_screening(*sweep_.design()->screening(), outcome.values);
      results::BarGroup effects{"mean size of the effects (mu*)", {}};
      for (const auto& e : screening.effects) effects.bars.push_back(bar_of(e.mean_absolute));
      panels.push_back(results::bar_panel("effect on " + outcome.name, names_, {effects}));
    }
  }
  return panels;
}

}  // namespace continuo::app
