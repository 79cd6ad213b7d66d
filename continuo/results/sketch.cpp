// Draws lines and points as dots of braille.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <continuo/results/sketch.hpp>

namespace continuo::results {
namespace {

/// The part of an axis that is shown, and where its values stand.
struct Axis {
  bool is_logarithmic;
  double low = INFINITY, high = -INFINITY;

  double place(double value) const {
    if (!is_logarithmic) return value;
    return value > 0 ? std::log10(value) : NAN;
  }
  double value(double place) const { return is_logarithmic ? std::pow(10, place) : place; }
  void take(double value) {
    const double at = place(value);
    if (std::isfinite(at)) low = std::min(low, at), high = std::max(high, at);
  }
  void finish(double least) {
    const Range range = axis_over(low, high, 0);
    const double more = is_logarithmic ? 0 : std::max(0.0, least - (range.high - range.low)) / 2;
    low = range.low - more;
    high = range.high + more;
  }
};

/// Dots, two by four of which are a character.
class Dots {
 public:
  Dots(std::size_t columns, std::size_t rows) : columns_(columns), rows_(rows), cells_(columns * rows) {}
  double width() const { return static_cast<double>(2 * columns_ - 1); }
  double height() const { return static_cast<double>(4 * rows_ - 1); }

  /// From the lower left corner.
  void dot(double x, double y, std::size_t color) {
    const auto column = static_cast<std::size_t>(std::lround(x));
    const auto row = static_cast<std::size_t>(std::lround(height() - y));
    // The bits of U+2800: three rows of each column, then the fourth.
    static constexpr std::array<std::array<std::uint8_t, 2>, 4> bits = {
        {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}}};
    Cell& cell = cells_[row / 4 * columns_ + column / 2];
    cell.bits = static_cast<std::uint8_t>(cell.bits | bits[row % 4][column % 2]);
    cell.color = color;
  }
  void line(double x0, double y0, double x1, double y1, std::size_t color) {
    const double steps = std::ceil(std::max({std::abs(x1 - x0), std::abs(y1 - y0), 1.0}));
    for (double k = 0; k <= steps; ++k) dot(x0 + (x1 - x0) * k / steps, y0 + (y1 - y0) * k / steps, color);
  }
  std::string text(std::size_t row, bool colored) const {
    std::string text;
    std::size_t now = none;
    for (std::size_t column = 0; column < columns_; ++column) {
      const Cell& cell = cells_[row * columns_ + column];
      if (colored && cell.bits != 0 && cell.color != now) text += ansi(now = cell.color);
      if (cell.bits == 0) {
        text += ' ';
      } else {
        text += {static_cast<char>(0xE2), static_cast<char>(0xA0 | cell.bits >> 6),
                 static_cast<char>(0x80 | (cell.bits & 0x3F))};
      }
    }
    return now == none ? text : text + "\033[0m";
  }

  /// The nearest of the colours that every terminal has.
  static std::string ansi(std::size_t color) {
    static constexpr std::array<int, 6> codes = {34, 31, 32, 35, 33, 36};
    return fmt::format("\033[{}m", codes[color % codes.size()]);
  }

 private:
  static constexpr auto none = static_cast<std::size_t>(-1);
  struct Cell {
    std::uint8_t bits = 0;
    std::size_t color = 0;
  };
  std::size_t columns_, rows_;
  std::vector<Cell> cells_;
};

bool is_drawn_as_line(Curve::Style style) {
  return style == Curve::Style::line || style == Curve::Style::dashed_line || style == Curve::Style::thin_line ||
         style == Curve::Style::line_with_points || style == Curve::Style::dotted_line;
}

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

/// The beginning of a text that is so wide.
std::string cut(std::string_view text, std::size_t width) {
  std::size_t end = 0;
  for (std::size_t shown = 0; end < text.size(); ++end) {
    if ((text[end] & 0xC0) == 0x80) continue;
    if (shown++ == width) break;
  }
  return std::string(text.substr(0, end));
}

class Sketch {
 public:
  Sketch(const Panel& panel, const SketchStyle& style)
      : panel_(panel), style_(style), x_{panel.logarithmic_x}, y_{panel.logarithmic_y} {
    for (const Curve& curve : panel.curves) {
      if (!curve.widens_axes) continue;
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        if (!std::isfinite(x_.place(curve.x[i])) || !std::isfinite(y_.place(curve.y[i]))) continue;
        const double around = curve.discs.empty() ? 0 : curve.discs[i].radius;
        for (const double side : {-around, around}) x_.take(curve.x[i] + side), y_.take(curve.y[i] + side);
      }
    }
    x_.finish(panel.least_width);
    y_.finish(panel.least_height);
  }

  std::string text() {
    const std::size_t widest = std::max<std::size_t>(style_.columns / 3, 10);
    const std::string top = number(y_, y_.high, widest), bottom = number(y_, y_.low, widest);
    const std::size_t margin = std::max(top.size(), bottom.size()) + 1;
    const std::size_t columns = style_.columns > margin + 5 ? style_.columns - margin - 1 : 4;
    const std::size_t rows = std::max<std::size_t>(style_.rows > 4 ? style_.rows - 3 : 1, 3);
    Dots dots(fitting(columns, rows), rows);
    draw(dots);
    const auto width = static_cast<std::size_t>((dots.width() + 1) / 2);
    std::string text = heading() + "\n";
    for (std::size_t row = 0; row < rows; ++row) {
      const std::string& label = row == 0 ? top : row + 1 == rows ? bottom : empty_;
      text += fmt::format("{:>{}}│{}\n", label, margin, dots.text(row, style_.color));
    }
    std::string line = fmt::format("{:>{}}└", "", margin);
    for (std::size_t i = 0; i < width; ++i) line += "─";
    const std::string left = number(x_, x_.low, width / 3), right = number(x_, x_.high, width / 3);
    const std::size_t room = width > left.size() + right.size() ? width - left.size() - right.size() : 0;
    const std::string name = room > 2 ? cut(panel_.x_label, room - 2) : "";
    const std::size_t before = (room - std::min(room, width_of(name))) / 2;
    const std::size_t after = room - std::min(room, width_of(name)) - before;
    return text + cut_line(line) +
           cut_line(fmt::format("{:>{}}{}{:{}}{}{:{}}{}", "", margin + 1, left, "", before, name, "", after, right));
  }

 private:
  /// A number as an axis has it: so many digits as tell the ends apart, or as there is room for.
  static std::string number(const Axis& axis, double place, std::size_t width) {
    if (axis.is_logarithmic) return fmt::format("{:.3g}", axis.value(place));
    const double extent = axis.high - axis.low, size = std::max(std::abs(axis.low), std::abs(axis.high));
    if (std::abs(place) < 1e-12 * size) return "0";
    constexpr int least = 3, most = 15;
    int digits = least;
    if (extent > 0) digits += std::clamp(static_cast<int>(std::ceil(std::log10(size / extent))), 0, most - least);
    while (digits > least && fmt::format("{:.{}g}", place, digits).size() > width) --digits;
    return fmt::format("{:.{}g}", place, digits);
  }
  std::string cut_line(const std::string& text) const { return cut(text, style_.columns) + "\n"; }

  /// The names of the curves, in their colours; too long a list ends with dots.
  std::string heading() const {
    std::string text;
    std::size_t width = 0;
    const auto add = [&](const std::string& part, std::string_view color) {
      text += style_.color && !color.empty() ? fmt::format("{}{}\033[0m", color, part) : part;
      width += width_of(part);
    };
    add(cut(panel_.y_label, style_.columns), "");
    std::size_t named = 0;
    for (const Curve& curve : panel_.curves) named += curve.label.empty() ? 0 : 1;
    for (std::size_t i = 0; named > 1 && i < panel_.curves.size(); ++i) {
      const Curve& curve = panel_.curves[i];
      if (curve.label.empty()) continue;
      if (width + width_of(curve.label) + 8 > style_.columns) return text + (width + 3 < style_.columns ? " …" : "");
      add("  ", "");
      add("━ " + curve.label, style_.color ? Dots::ansi(curve.number.value_or(i)) : "");
    }
    return text;
  }

  /// How wide the field is where both scales are equal: a character is twice as high as it is wide.
  std::size_t fitting(std::size_t columns, std::size_t rows) const {
    if (!panel_.equal_scale || !(y_.high > y_.low)) return columns;
    const double wide = (x_.high - x_.low) / (y_.high - y_.low) * 2 * static_cast<double>(rows);
    return static_cast<std::size_t>(std::clamp(wide, 8.0, static_cast<double>(columns)));
  }

  void draw(Dots& dots) const {
    const auto right = [&](double value) { return (x_.place(value) - x_.low) / (x_.high - x_.low) * dots.width(); };
    const auto up = [&](double value) { return (y_.place(value) - y_.low) / (y_.high - y_.low) * dots.height(); };
    const auto shows = [&](double x, double y) { return x >= 0 && x <= dots.width() && y >= 0 && y <= dots.height(); };
    for (std::size_t k = 0; k < panel_.curves.size(); ++k) {
      const Curve& curve = panel_.curves[k];
      if (curve.style == Curve::Style::area) continue;
      const std::size_t color = curve.number.value_or(k);
      double x0 = NAN, y0 = NAN;
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const double x = right(curve.x[i]), y = up(curve.y[i]);
        if (shows(x, y)) {
          if (is_drawn_as_line(curve.style) && shows(x0, y0)) {
            dots.line(x0, y0, x, y, color);
          } else {
            dots.dot(x, y, color);
          }
        }
        x0 = x, y0 = y;
      }
    }
  }

  const Panel& panel_;
  const SketchStyle& style_;
  Axis x_, y_;
  std::string empty_;
};

}  // namespace

std::string sketch(const Panel& panel, const SketchStyle& style) {
  return Sketch(panel, style).text();
}

}  // namespace continuo::results
