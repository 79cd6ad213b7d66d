// Writes the part of a gnuplot script that draws one panel.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include <continuo/results/csv_writer.hpp>
#include <continuo/results/pictures/gnuplot_panel.hpp>

namespace continuo::results {

namespace {

constexpr double closest_marks = 4;          // pixels; nearer ones would join to a grey block
constexpr std::size_t most_long_marks = 40;  // more would paint the background, and stand at its foot alone

// Okabe and Ito's colours, told apart by all common kinds of colour vision. M. Okabe, K. Ito, "Color universal design"
// (2008). Yellow is left out, too pale on white, and black, which marks what others are compared with.
constexpr std::string_view palette[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

/// The same colours where the background is dark: blue, which would be lost there, becomes sky blue, and this yellow.
std::string_view on_background(bool is_dark, std::string_view color) {
  if (!is_dark) return color;
  if (color == "#0072b2") return "#56b4e9";
  if (color == "#56b4e9") return "#f0e442";
  return color == "#000000" ? "#ffffff" : color;
}

// Viridis in five colours: as light as the value is high, for all kinds of colour vision, and printed without colours.
// N. Smith, S. van der Walt (2015).
constexpr std::string_view scale_of_colors =
    "set palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', 4 '#fde725')\n";

constexpr Theme light_theme{"#ffffff", "#333333", "#555555", "#dddddd", "#999999"};
constexpr Theme dark_theme{"#16181d", "#dddddd", "#aaaaaa", "#3a3d44", "#888888"};

}  // namespace

const Theme& theme_of(bool is_dark) {
  return is_dark ? dark_theme : light_theme;
}

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\' || c == '`') {
      result += fmt::format("\\{:03o}", static_cast<unsigned>(c));
    } else {
      result += c == '\n' ? ' ' : c;
    }
  }
  return result + "\"";
}

namespace {

/// Where a value stands on an axis; what has no place is no number. Of an axis of decades gnuplot knows no more.
double place_of(bool is_logarithmic, double value) {
  if (!is_logarithmic) return value;
  return value >= 1e-300 && value <= 1e300 ? std::log10(value) : NAN;
}
bool has_place(const Panel& panel, const Curve& curve, std::size_t i) {
  return std::isfinite(place_of(panel.logarithmic_x, curve.x[i])) &&
         std::isfinite(place_of(panel.logarithmic_y, curve.y[i]));
}

void append_disc(std::string& script, const Curve::Disc& disc) {
  script += ' ';
  append_number(script, disc.radius);
  script += fmt::format(" 0x{}", disc.color.substr(1));  // without its '#'
}

/// The ends of its interval, of which one without is a point.
void append_bar(std::string& script, const Curve& curve, std::size_t i) {
  for (const double end : {curve.intervals[i].low, curve.intervals[i].high}) {
    script += ' ';
    append_number(script, std::isfinite(end) ? end : curve.y[i]);
  }
}

/// A little beyond an edge, a pixel or two, but not beyond the last: where cells only touch, a line between them is
/// lighter.
double overlapped(const std::vector<double>& edges, std::size_t i, bool is_logarithmic) {
  if (i + 1 == edges.size()) return edges[i];
  constexpr double share = 1.0 / 600;
  const double low = edges.front(), high = edges.back(), next = edges[i + 1];
  const double moved = is_logarithmic ? edges[i] * std::pow(high / low, share) : edges[i] + (high - low) * share;
  return std::min(moved, next);
}

/// The cells with a value, then those without, each in its own block of data: its corner, its edges, its value. Each
/// lies over those to the left and below.
void append_cells(std::string& script, const Panel& panel, std::size_t number) {
  const auto& [x_edges, y_edges, values, label] = panel.cells;
  for (const bool has_value : {true, false}) {
    script += fmt::format("${}{} << END\n", has_value ? "cells" : "gaps", number);
    for (std::size_t row = 0; row + 1 < y_edges.size(); ++row) {
      for (std::size_t column = 0; column + 1 < x_edges.size(); ++column) {
        const double value = values[row * (x_edges.size() - 1) + column];
        if (std::isfinite(value) != has_value) continue;
        const double right = overlapped(x_edges, column + 1, panel.logarithmic_x);
        const double top = overlapped(y_edges, row + 1, panel.logarithmic_y);
        for (const double v :
             {x_edges[column], y_edges[row], x_edges[column], right, y_edges[row], top, has_value ? value : 0}) {
          append_number(script, v);
          script += ' ';
        }
        script += '\n';
      }
    }
    script += "END\n";
  }
}

void append_data(std::string& script, const Panel& panel, const std::string& name, const Curve& curve) {
  script += fmt::format("{} << END\n", name);
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (has_place(panel, curve, i)) {
      append_number(script, curve.x[i]);
      script += ' ';
      append_number(script, curve.y[i]);
      if (curve.style == Curve::Style::discs) append_disc(script, curve.discs[i]);
      if (curve.style == Curve::Style::bars) append_bar(script, curve, i);
    }
    script += '\n';  // an empty line breaks the curve
  }
  script += "END\n";
}

/// `own`: a colour, or none.
std::string style_of(const Curve& curve, Curve::Style style, std::size_t number, bool is_dark) {
  const std::string_view own = curve.color;
  const std::string_view color = on_background(is_dark, own.empty() ? color_of(number) : own);
  // Dashes tell the second round of colours from the first.
  const std::size_t round = own.empty() ? number / std::size(palette) : 0;
  switch (style) {
    case Curve::Style::dashed_line:
      return fmt::format("lines lw 1.8 dt '-' lc rgb '{}'", color);
    case Curve::Style::dotted_line:
      return fmt::format("lines lw 1 dt 3 lc rgb '{}'", color);
    case Curve::Style::line_with_points:
      return fmt::format("linespoints lw 1.8 pt 7 ps 0.4 dt {} lc rgb '{}'", round + 1, color);
    case Curve::Style::thin_line:
      return fmt::format("lines lw 0.9 lc rgb '{}'", color);
    case Curve::Style::full_points:
      return fmt::format("points pt 7 ps 1.0 lc rgb '{}'", color);
    case Curve::Style::empty_points:
      return fmt::format("points pt 6 lw 2 ps 1.0 lc rgb '{}'", color);
    case Curve::Style::dots:
      return fmt::format("points pt 7 ps 0.45 lc rgb '{}'", color);
    case Curve::Style::area:
      return fmt::format("filledcurves closed fs transparent solid {} noborder lc rgb '{}'", curve.fill, color);
    case Curve::Style::bars:
      return fmt::format("boxes fs solid 0.85 noborder lc rgb '{}'", color);
    case Curve::Style::discs:
      return "circles fs solid border lc rgb '#ffffff' lw 0.5 lc rgb variable";
    case Curve::Style::line:
      break;
  }
  return fmt::format("lines lw 1.8 dt {} lc rgb '{}'", round + 1, color);
}

/// What one axis spans: all values and a little air, so that no curve lies on the frame.
Range range_of(const Panel& panel, std::vector<double> Curve::* values, double air) {
  double low = INFINITY, high = -INFINITY;
  for (const Curve& curve : panel.curves) {
    if (!curve.widens_axes) continue;
    for (std::size_t i = 0; i < (curve.*values).size(); ++i) {
      const double v = (curve.*values)[i], around = curve.discs.empty() ? 0 : curve.discs[i].radius;
      if (std::isfinite(v)) low = std::min(low, v - around), high = std::max(high, v + around);
    }
    if (curve.style != Curve::Style::bars || values == &Curve::x) continue;
    low = std::min(low, 0.0), high = std::max(high, 0.0);
    for (const Range& interval : curve.intervals) {
      if (std::isfinite(interval.low)) low = std::min(low, interval.low);
      if (std::isfinite(interval.high)) high = std::max(high, interval.high);
    }
  }
  return axis_over(low, high, air);
}
/// The same about its middle, where it would show less than is known.
Range at_least(const Range& range, double extent) {
  const double more = (extent - (range.high - range.low)) / 2;
  return more > 0 ? Range{range.low - more, range.high + more} : range;
}
Range range_of_x(const Panel& panel) {
  return at_least(range_of(panel, &Curve::x, panel.equal_scale ? 0.05 : 0), panel.least_width);
}
Range range_of_y(const Panel& panel) {
  return at_least(range_of(panel, &Curve::y, 0.05), panel.least_height);
}
std::string range_text(const Range& range) {
  return fmt::format("[{}:{}]", range.low, range.high);
}

/// The least and the greatest place with a point.
std::array<double, 2> places_of(const Panel& panel) {
  double low = INFINITY, high = -INFINITY;
  for (const Curve& curve : panel.curves) {
    for (const double x : curve.x) {
      const double place = place_of(panel.logarithmic_x, x);
      if (std::isfinite(place)) low = std::min(low, place), high = std::max(high, place);
    }
  }
  return {low, high};
}

/// The marks that can be told apart.
std::vector<double> distinct_marks(const Panel& panel) {
  const auto [low, high] = places_of(panel);
  std::vector<double> marks;
  for (const double mark : panel.marks) {
    const double place = place_of(panel.logarithmic_x, mark);
    if (!std::isfinite(place)) continue;
    const double before = marks.empty() ? -INFINITY : place_of(panel.logarithmic_x, marks.back());
    if (place - before >= closest_marks * (high - low) / width_of_pictures) marks.push_back(mark);
  }
  return marks;
}

constexpr double least_decades = 1e-12;  // less is round-off

/// Of a logarithmic axis with one value, or none.
std::string decades_about(double value) {
  const double middle = std::isfinite(value) ? value : 1;
  return range_text({middle / 10, middle * 10});
}

std::string x_range_text(const Panel& panel) {
  if (!panel.cells.values.empty()) return range_text({panel.cells.x_edges.front(), panel.cells.x_edges.back()});
  if (!panel.x_names.empty()) return range_text({-0.6, static_cast<double>(panel.x_names.size()) - 0.4});
  if (!panel.logarithmic_x) return range_text(range_of_x(panel));
  const auto [low, high] = places_of(panel);
  return high - low > least_decades ? range_text({std::pow(10, low), std::pow(10, high)})
                                    : decades_about(std::pow(10, low));
}

std::string y_range_text(const Panel& panel) {
  if (!panel.cells.values.empty()) return range_text({panel.cells.y_edges.front(), panel.cells.y_edges.back()});
  if (!panel.logarithmic_y) return range_text(range_of_y(panel));
  double low = INFINITY, high = 0;
  for (const Curve& curve : panel.curves)
    for (std::size_t i = 0; i < curve.y.size(); ++i)
      if (has_place(panel, curve, i)) low = std::min(low, curve.y[i]), high = std::max(high, curve.y[i]);
  return std::log10(high / low) > least_decades ? "[*:*]" : decades_about(low);  // to whole decades
}

std::size_t shown_points(const Panel& panel, const Curve& curve) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < curve.y.size(); ++i) count += has_place(panel, curve, i) ? 1 : 0;
  return count;
}

bool is_line(Curve::Style style) {
  return style == Curve::Style::line || style == Curve::Style::dashed_line || style == Curve::Style::thin_line ||
         style == Curve::Style::dotted_line || style == Curve::Style::line_with_points;
}

/// Ticks between the powers of ten, where there are few enough of these.
std::string_view small_ticks(const Panel& panel, std::vector<double> Curve::* values, bool logarithmic) {
  constexpr double most_decades = 6;
  double low = INFINITY, high = 0;
  for (const Curve& curve : panel.curves)
    for (const double v : curve.*values)
      if (std::isfinite(v) && v > 0) low = std::min(low, v), high = std::max(high, v);
  return logarithmic && high > low * std::pow(10, most_decades) ? "1" : "default";
}

/// Names below the axis, or numbers.
void append_x_names(std::string& script, const std::vector<std::string>& names) {
  if (names.empty()) {
    script += "set xtics norotate autofreq\n";
    return;
  }
  std::size_t letters = 0;
  for (const std::string& name : names) letters += name.size() + 2;
  constexpr std::size_t most_letters = 110;  // side by side
  script += fmt::format("set xtics {} (", letters > most_letters ? "rotate by 30 right" : "norotate");
  for (std::size_t i = 0; i < names.size(); ++i)
    script += fmt::format("{}{} {}", i > 0 ? ", " : "", in_quotes(names[i]), i);
  script += ")\nset format x '%s'\n";
}

/// What draws the cells, and their scale of colours beside them.
std::string cells_text(std::string& script, const Cells& cells, std::size_t number) {
  if (cells.values.empty()) {
    script += "unset colorbox\nset rmargin 3\n";
    return {};
  }
  double low = INFINITY, high = -INFINITY;
  bool has_gaps = false;
  for (const double value : cells.values) {
    has_gaps = has_gaps || !std::isfinite(value);
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  }
  script += scale_of_colors;
  script += fmt::format("set colorbox\nset rmargin 4\nset cbrange {}\nset cblabel {}\n",
                        range_text(axis_over(low, high, 0)), in_quotes(cells.label));
  std::string text;
  if (has_gaps)
    text = fmt::format(
        "$gaps{} using 1:2:3:4:5:6 with boxxyerror fs solid 1 noborder fc rgb '#b0b0b0' title 'no value'", number);
  if (low <= high)
    text += fmt::format("{}$cells{} using 1:2:3:4:5:6:7 with boxxyerror fs solid 1 noborder fc palette",
                        text.empty() ? "" : ", ", number);
  return text;
}

/// What draws a curve.
std::string curve_text(const Panel& panel, std::size_t number, std::size_t i, bool is_dark) {
  const Curve& curve = panel.curves[i];
  Curve::Style style = curve.style;
  const std::size_t points = shown_points(panel, curve);
  if (points == 1 && is_line(style)) style = Curve::Style::full_points;  // a line to nowhere is none
  const std::string data = fmt::format("$curve{}_{} using ", number, i);
  std::string columns = "1:2";
  if (style == Curve::Style::discs) columns = "1:2:3:4";
  if (style == Curve::Style::bars) columns = fmt::format("1:2:({})", curve.bar_width);
  std::string text = fmt::format("{} with {} {}", points > 0 ? data + columns : "NaN",
                                 style_of(curve, style, curve.number.value_or(i), is_dark),
                                 curve.label.empty() ? "notitle" : "title " + in_quotes(curve.label));
  if (style == Curve::Style::bars && points > 0)
    text += fmt::format(", {}1:3:(0):($4-$3) with vectors heads size graph 0.008,90 lw 1.5 lc rgb '{}' notitle", data,
                        theme_of(is_dark).text);
  return text;
}

/// As much of a curve as the picture needs.
Curve drawn(const Panel& panel, const Curve& curve) {
  if (curve.style == Curve::Style::area && !curve.widens_axes) {  // gnuplot leaves some of it beyond the frame
    return clipped(curve, range_of_x(panel), range_of_y(panel));
  }
  return is_line(curve.style) && !panel.logarithmic_x ? thinned(curve, 2 * width_of_pictures) : curve;
}

}  // namespace

void append_panel_data(std::string& script, const Panel& panel, std::size_t number) {
  for (std::size_t i = 0; i < panel.curves.size(); ++i)
    append_data(script, panel, fmt::format("$curve{}_{}", number, i), drawn(panel, panel.curves[i]));
  if (!panel.cells.values.empty()) append_cells(script, panel, number);
}

void append_panel(std::string& script, const Panel& panel, std::size_t number, bool is_dark, double bottom,
                  double height) {
  const Theme& theme = theme_of(is_dark);
  script += fmt::format("set origin 0,{:.5f}\nset size 1,{:.5f}\n", bottom, height);
  script += panel.equal_scale ? "set size ratio -1\n" : "set size noratio\n";
  script += "unset zeroaxis\n";
  if (panel.zero_lines)
    script +=
        fmt::format("set {} lw 1 dt 1 lc rgb '{}'\n", panel.x_names.empty() ? "zeroaxis" : "xzeroaxis", theme.mark);
  script += panel.logarithmic_x ? "set logscale x\nset format x '%.0e'\n" : "unset logscale x\nset format x '%h'\n";
  script += panel.logarithmic_y ? "set logscale y\nset format y '%.0e'\n" : "unset logscale y\nset format y '%h'\n";
  if (panel.no_numbers) script += "set format ''\n";
  script += fmt::format("set mxtics {}\nset mytics {}\n", small_ticks(panel, &Curve::x, panel.logarithmic_x),
                        small_ticks(panel, &Curve::y, panel.logarithmic_y));
  append_x_names(script, panel.x_names);
  script +=
      fmt::format("set xlabel {}\nset ylabel {}\nunset arrow\n", in_quotes(panel.x_label), in_quotes(panel.y_label));
  script += fmt::format("set xrange {}\nset yrange {}\n", x_range_text(panel), y_range_text(panel));
  const auto marks = distinct_marks(panel);
  const bool short_marks = marks.size() > most_long_marks;
  for (const double mark : marks) {
    script +=
        fmt::format("set arrow from first {0}, graph 0 to first {0}, graph {1} nohead back lw 1 dt {2} lc rgb '{3}'\n",
                    mark, short_marks ? "0.04" : "1", short_marks ? 1 : 3, theme.mark);
  }
  std::string plotted = cells_text(script, panel.cells, number);
  for (std::size_t i = 0; i < panel.curves.size(); ++i)
    plotted += (plotted.empty() ? "" : ", ") + curve_text(panel, number, i, is_dark);
  script += "plot " + (plotted.empty() ? "NaN notitle" : plotted);
  if (!marks.empty())
    script += fmt::format(", NaN with lines lw 1 dt {} lc rgb '{}' title {}", short_marks ? 1 : 3, theme.mark,
                          in_quotes(panel.mark_label));
  script += '\n';
}

Range axis_over(double low, double high, double air) {
  constexpr double highest = 4e307;  // gnuplot adds and subtracts such
  if (!(low <= high)) return {0, 1};
  low = std::clamp(low, -highest, highest), high = std::clamp(high, -highest, highest);
  double margin = air * (high - low);
  if (high == low || high - low < 1e-14 * std::max(std::abs(low), std::abs(high))) {
    margin = 0.01 * std::abs(low);
    if (low - margin == low) margin = 1;
  }
  return {low - margin, high + margin};
}

std::string_view color_of(std::size_t number) {
  return palette[number % std::size(palette)];
}

}  // namespace continuo::results
