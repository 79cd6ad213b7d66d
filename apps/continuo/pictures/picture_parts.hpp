// What pictures are made of: places in their plane, and the words by which gnuplot draws them.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <continuo/results/figure.hpp>

namespace continuo::app {

struct Flat {
  double x, y;
};

inline Flat flat_of(double x, double y, double z) {
  return {results::right_in_space(x, y), results::up_in_space(x, y, z)};
}

/// The part of the plane that is shown.
struct PictureFrame {
  double left = std::numeric_limits<double>::infinity(), right = -left, low = left, high = -left;
  double floor = left;  // the lowest that a scene in the plane has

  void take(Flat p, double around) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
    left = std::min(left, p.x - around);
    right = std::max(right, p.x + around);
    low = std::min(low, p.y - around);
    high = std::max(high, p.y + around);
  }
  bool empty() const { return !(left <= right); }
};

/// Objects lie behind curves unless they say otherwise; `data` has that of the curves, in their order.
struct PictureParts {
  std::string objects, curves, data;

  void curve(std::string_view style, const std::string& points) {
    curves += fmt::format("{}'-' {} notitle", curves.empty() ? "" : ", ", style);
    data += points + "e\n";
  }
  void append(const PictureParts& other) {
    objects += other.objects;
    if (!curves.empty() && !other.curves.empty()) curves += ", ";
    curves += other.curves, data += other.data;
  }
  void line(const std::vector<Flat>& points, std::string_view color, double thick) {
    std::string text;
    for (const Flat p : points) text += fmt::format("{} {}\n", p.x, p.y);
    curve(fmt::format("with lines lw {} lc rgb '{}'", thick, color), text);
  }
  void polygon(const std::vector<Flat>& corners, std::string_view color) {
    if (corners.size() < 3) return;
    std::string text;
    for (const Flat p : corners) text += fmt::format("{}{},{}", text.empty() ? "from " : " to ", p.x, p.y);
    text += fmt::format(" to {},{}", corners.front().x, corners.front().y);
    objects += fmt::format("set object polygon {} fc rgb '{}' fillstyle solid noborder behind\n", text, color);
  }
};

}  // namespace continuo::app
