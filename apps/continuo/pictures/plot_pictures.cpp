// gnuplot commands for the plots of a model, as far as the time shown.
#include <algorithm>
#include <cmath>

#include <apps/continuo/pictures/plot_pictures.hpp>
#include <apps/continuo/pictures/scene_pictures.hpp>
#include <fmt/format.h>

#include <continuo/results/figure.hpp>

namespace continuo::app {
namespace {

constexpr std::size_t most_plots = 3;  // one below the other

std::string axis_of(const live::LiveCurve& curve) {
  return curve.unit.empty() ? curve.label : fmt::format("{} [{}]", curve.label, curve.unit);
}

}  // namespace

PlotPictures::PlotPictures(const live::LiveModel& shown, const Recorder::Slices& slices) : shown_(shown) {
  data_ = "$data << END\n";
  std::size_t rows = 0;
  const std::size_t columns = shown.columns.size();
  extremes_.assign(columns, {INFINITY, -INFINITY});
  for (const auto& slice : slices) {
    for (std::size_t row = 0; row < slice->row_t.size(); ++row, ++rows) {
      data_ += fmt::format("{:.9g}", slice->row_t[row]);
      for (std::size_t i = 0; i < columns; ++i) {
        const float value = slice->rows[row * columns + i];
        data_ += std::isfinite(value) ? fmt::format(" {:.7g}", value) : " NaN";
        if (std::isfinite(value)) extremes_[i].take(value);
      }
      data_ += "\n";
    }
    rows_.push_back(rows);
    t_.push_back(slice->t);
  }
  data_ += "END\n";
  end_ = t_.back() > t_.front() ? t_.back() : t_.front() + 1;
}

/// Room for all curves of a plot from the beginning, so that its axes do not move.
std::string PlotPictures::ranges_of(const live::LivePlot& plot) const {
  constexpr double air = 0.05;
  const auto range = [](const char* axis, Extremes e, double with) {
    const results::Range over = results::axis_over(e.low, e.high, with);
    return fmt::format("set {}range [{}:{}]\n", axis, over.low, over.high);
  };
  Extremes up;
  for (const live::LiveCurve& curve : plot.curves) up.take(extremes_[curve.column]);
  return range("y", up, air) +
         (plot.against ? range("x", extremes_[plot.against->column], air) : range("x", {t_.front(), end_}, 0));
}

std::string PlotPictures::commands(std::size_t number) const {
  const std::size_t count = std::min(most_plots, shown_.plots.size());
  const std::size_t last = rows_[number] == 0 ? 0 : rows_[number] - 1;
  const std::string unit = safe_text(shown_.model().time_unit);
  const std::string time = unit.empty() ? "t" : fmt::format("t [{}]", unit);
  std::string all = fmt::format("set multiplot layout {},1 title '{}'\n", count, title_of(t_[number], shown_));
  for (std::size_t k = 0; k < count; ++k) {
    const live::LivePlot& plot = shown_.plots[k];
    const std::size_t across = plot.against ? plot.against->column + 2 : 1;
    std::string curves;
    std::size_t color = 0;
    for (const live::LiveCurve& curve : plot.curves) {
      const std::string_view rgb = results::color_of(color++);
      curves += fmt::format(
          "{}$data every ::0::{} using {}:{} with lines lw 2 lc rgb '{}' title '{}', "
          "$data every ::{}::{} using {}:{} with points pt 7 ps 1.2 lc rgb '{}' notitle",
          curves.empty() ? "" : ", ", last, across, curve.column + 2, rgb, safe_text(axis_of(curve)), last, last,
          across, curve.column + 2, rgb);
    }
    all += ranges_of(plot);
    all += fmt::format("set xlabel '{}'\nplot {}\n", plot.against ? safe_text(axis_of(*plot.against)) : time, curves);
  }
  return all + "unset multiplot\n";
}

}  // namespace continuo::app
