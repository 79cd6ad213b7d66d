// Chooses how a sweep is drawn.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <apps/continuo/studies/sweep_pictures.hpp>

#include <continuo/results/sweep_figures.hpp>

namespace continuo::app {
namespace {

using model::SweepKeep;

constexpr std::uint64_t most_dots = 20'000, most_cells = 1'000'000;
constexpr std::size_t most_panels = 6;  // more would be a page that nobody reads
constexpr std::array<double, 5> parts = {0.05, 0.25, 0.5, 0.75, 0.95};

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " [" + unit + "]";
}

std::string label_of(const model::SweepAxis& axis) {
  return with_unit(axis.column(), axis.unit);
}

/// The values of an axis of a grid that rise; null for others.
const std::vector<double>* rising(const model::SweepAxis& axis) {
  const auto* points = std::get_if<model::SweepPoints>(&axis.values);
  const bool is_one = points && points->file.empty() && points->values.size() > 1 &&
                      std::ranges::adjacent_find(points->values, std::ranges::greater_equal()) == points->values.end();
  return is_one ? &points->values : nullptr;
}

/// Whether the ratios are more nearly equal than the distances.
bool is_logarithmic(const std::vector<double>& values) {
  if (values.size() < 3 || values.front() <= 0) return false;
  const std::size_t middle = values.size() / 2;
  const double part = static_cast<double>(middle) / static_cast<double>(values.size() - 1);
  const double even = values.front() + part * (values.back() - values.front());
  const double ratio = values.front() * std::pow(values.back() / values.front(), part);
  return std::abs(values[middle] - ratio) < std::abs(values[middle] - even);
}

}  // namespace

SweepPictures::SweepPictures(const studies::PreparedSweep& sweep) : sweep_(sweep), varied_(sweep.plan().axes.size()) {
  const model::SweepPlan& plan = sweep.plan();
  is_plane_ = !sweep.design() && plan.axes.size() == 2 && rising(plan.axes[0]) && rising(plan.axes[1]) &&
              sweep.runs() <= most_cells;
  if (!is_plane_) step_ = (sweep.runs() + most_dots - 1) / most_dots;
  std::size_t place = 0;
  for (const SweepKeep& keep : plan.keeps) {
    if (keep.kind != SweepKeep::Kind::series) numbers_.push_back({with_unit(keep.name, keep.unit), place});
    place += keep.kind == SweepKeep::Kind::series ? keep.times.count : 1;
  }
}

void SweepPictures::add(std::uint64_t run, const studies::SweepOutcome& outcome) {
  if (run % step_ != 0) return;
  for (Number& number : numbers_) number.values.push_back(outcome.kept[number.place]);
  if (is_plane_) return;
  const std::vector<double> values = sweep_.values(run);
  for (std::size_t a = 0; a < values.size(); ++a) varied_[a].push_back(values[a]);
}

std::vector<results::Panel> SweepPictures::planes() const {
  const model::SweepAxis &up = sweep_.plan().axes[0], &across = sweep_.plan().axes[1];  // the last one varies first
  std::vector<results::Panel> panels;
  for (const Number& number : numbers_) {
    results::HeatMap map{.x_label = label_of(across),
                         .y_label = label_of(up),
                         .label = number.label,
                         .x = *rising(across),
                         .y = *rising(up),
                         .values = number.values};
    map.values.resize(map.x.size() * map.y.size(), NAN);
    map.logarithmic_x = is_logarithmic(map.x), map.logarithmic_y = is_logarithmic(map.y);
    panels.push_back(results::heat_panel(map));
  }
  return panels;
}

std::vector<results::Panel> SweepPictures::scatter() const {
  std::vector<results::Panel> panels;
  for (const Number& number : numbers_)
    for (std::size_t a = 0; a < varied_.size(); ++a)
      panels.push_back(
          results::scatter_panel(label_of(sweep_.plan().axes[a]), number.label, varied_[a], number.values));
  return panels;
}

std::vector<results::Panel> SweepPictures::panels(const SweepReport& report) const {
  std::vector<results::Panel> panels;
  std::size_t place = 0;
  for (const SweepKeep& keep : sweep_.plan().keeps) {
    if (keep.kind != SweepKeep::Kind::series) {
      ++place;
      continue;
    }
    results::FanChart fan{.x_label = with_unit("t", sweep_.model().time_unit),
                          .label = with_unit(keep.name.substr(0, keep.name.find(" at ")), keep.unit),
                          .x = {},
                          .parts = {parts.begin(), parts.end()},
                          .quantiles = std::vector<std::vector<double>>(parts.size())};
    for (std::size_t k = 0; k < keep.times.count; ++k) {
      fan.x.push_back(keep.times.at(k));
      const auto quantiles = report.summary(place + k).quantiles(parts);
      for (std::size_t i = 0; i < parts.size(); ++i) fan.quantiles[i].push_back(quantiles[i]);
    }
    place += keep.times.count;
    panels.push_back(results::fan_panel(fan));
  }
  for (results::Panel& panel : is_plane_ ? planes() : scatter()) panels.push_back(std::move(panel));
  if (panels.size() > most_panels) panels.resize(most_panels);
  return panels;
}

}  // namespace continuo::app
