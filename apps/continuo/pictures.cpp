// apps/continuo/pictures.cpp
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>

#include <apps/continuo/own_process.hpp>
#include <apps/continuo/pictures.hpp>
#include <apps/continuo/program.hpp>
#include <fmt/format.h>

#include <continuo/results/figure.hpp>
#include <continuo/results/output_file.hpp>

namespace continuo::app {
namespace {

constexpr int width = 960, height = 720;  // pixels

struct Flat {
  double x, y;
};

/// What of a scene there is to draw with, in the plane of the picture: a scene in space is seen from above its corner.
class Drawn {
 public:
  Drawn(const live::LiveModel& shown, const std::vector<Recorder::Scene>& scenes) : shown_(shown), scenes_(scenes) {}

  std::optional<Flat> point(const live::SceneItem& item, std::string_view name, std::size_t frame) const {
    const live::SceneNumbers* part = find(item, name);
    if (!part || part->places.size() < 2) return std::nullopt;
    const auto at = [&](std::size_t i) { return number(frame, part->places[i]); };
    if (part->places.size() == 2) return Flat{at(0), at(1)};
    constexpr double half = 0.5;
    const double root = std::sqrt(0.75);
    return Flat{(at(0) - at(1)) * root, at(2) - (at(0) + at(1)) * half};
  }
  double value(const live::SceneItem& item, std::string_view name, std::size_t frame, double otherwise) const {
    const live::SceneNumbers* part = find(item, name);
    return part ? number(frame, part->places.front()) : otherwise;
  }
  const live::LiveModel& shown() const { return shown_; }
  std::size_t frames() const { return scenes_.size(); }
  double time(std::size_t frame) const { return scenes_[frame].t; }

 private:
  static const live::SceneNumbers* find(const live::SceneItem& item, std::string_view name) {
    const auto found = std::ranges::find(item.numbers, name, &live::SceneNumbers::name);
    return found == item.numbers.end() ? nullptr : &*found;
  }
  double number(std::size_t frame, std::size_t place) const {
    return static_cast<double>(scenes_[frame].numbers[place]);
  }

  const live::LiveModel& shown_;
  const std::vector<Recorder::Scene>& scenes_;
};

struct Frame {
  double left = std::numeric_limits<double>::infinity(), right = -left, low = left, high = -left;

  void take(Flat p, double around) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
    left = std::min(left, p.x - around);
    right = std::max(right, p.x + around);
    low = std::min(low, p.y - around);
    high = std::max(high, p.y + around);
  }
  bool empty() const { return !(left <= right); }
};

/// All that is ever drawn, with a margin.
Frame frame_of(const Drawn& drawn) {
  Frame frame;
  for (std::size_t k = 0; k < drawn.frames(); ++k) {
    for (const live::SceneItem& item : drawn.shown().drawing) {
      const double around = std::max(drawn.value(item, "radius", k, 0), drawn.value(item, "size", k, 0) / 2);
      for (const char* name : {"at", "to"}) {
        if (const auto p = drawn.point(item, name, k)) frame.take(*p, around);
      }
      if (item.shape == model::Shape::floor) frame.low = std::min(frame.low, drawn.value(item, "height", k, 0));
    }
  }
  if (frame.empty()) return frame;
  const double size = std::max({frame.right - frame.left, frame.high - frame.low, 1e-9});
  frame.take({(frame.left + frame.right) / 2, (frame.low + frame.high) / 2}, size / 2);
  const double margin = 0.08 * size;
  frame.left -= margin, frame.right += margin, frame.low -= margin, frame.high += margin;
  return frame;
}

/// A name that gnuplot knows, else the item's place in the palette.
std::string color_of(const live::SceneItem& item, std::size_t number) {
  static constexpr std::array<std::string_view, 12> known = {"red",   "green", "blue", "orange", "black", "gray",
                                                             "brown", "cyan",  "gold", "purple", "pink",  "yellow"};
  if (std::ranges::find(known, item.color) != known.end()) return item.color;
  const bool hexadecimal = item.color.size() == 7 && item.color.front() == '#' &&
                           item.color.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  return hexadecimal ? item.color : std::string(results::color_of(number));
}

std::string safe_text(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    const bool special = c == '\'' || c == '"' || c == '\\' || c == '`' || c == '\n';
    safe += special ? ' ' : c;
  }
  return safe;
}

class Page {
 public:
  Page(const Drawn& drawn, std::size_t frame) : drawn_(drawn), frame_(frame) {}

  /// The commands of one picture: curves as data, circles and texts as objects.
  std::string commands(const std::string& path, const Frame& view) {
    std::size_t number = 0;
    for (const live::SceneItem& item : drawn_.shown().drawing) add(item, color_of(item, number++), view);
    const std::string unit = drawn_.shown().model().time_unit;
    return fmt::format(
        "set output '{}'\nunset object\nunset label\nunset arrow\n{}set title 't = {:.3f} {}'\nplot {}\n{}", path,
        objects_, drawn_.time(frame_), safe_text(unit), curves_.empty() ? "NaN notitle" : curves_, data_);
  }

 private:
  void line(const std::vector<Flat>& points, const std::string& color, double thick) {
    curves_ += fmt::format("{}'-' with lines lw {} lc rgb '{}' notitle", curves_.empty() ? "" : ", ", thick, color);
    for (const Flat p : points) data_ += fmt::format("{} {}\n", p.x, p.y);
    data_ += "e\n";
  }

  void add(const live::SceneItem& item, const std::string& color, const Frame& view) {
    using model::Shape;
    const auto at = drawn_.point(item, "at", frame_), to = drawn_.point(item, "to", frame_);
    switch (item.shape) {
      case Shape::floor: {
        const double y = drawn_.value(item, "height", frame_, 0);
        line({{view.left, y}, {view.right, y}}, "gray40", 3);
        return;
      }
      case Shape::ball:
        if (at) ball(*at, drawn_.value(item, "radius", frame_, 0.1), color);
        break;
      case Shape::box:
        if (at) box(item, *at, color);
        break;
      case Shape::spring:
        if (at && to) spring(item, *at, *to, color);
        break;
      case Shape::rod:
      case Shape::rope:
        if (at && to) line({*at, *to}, color, item.shape == Shape::rod ? 4 : 2);
        break;
      case Shape::arrow:
        if (at && to)
          objects_ +=
              fmt::format("set arrow from {},{} to {},{} lw 3 lc rgb '{}'\n", at->x, at->y, to->x, to->y, color);
        break;
      case Shape::trail:
        trail(item, color);
        break;
      case Shape::text:
        if (at) label(item.text, *at);
        break;
    }
    if (at && !item.label.empty()) label(item.label, *at);
  }

  void label(const std::string& text, Flat at) {
    objects_ += fmt::format("set label '{}' at {},{} center front\n", safe_text(text), at.x, at.y);
  }

  void ball(Flat at, double radius, const std::string& color) {
    objects_ += fmt::format("set object circle at {},{} size {} fc rgb '{}' fillstyle solid noborder front\n", at.x,
                            at.y, radius, color);
  }

  void box(const live::SceneItem& item, Flat at, const std::string& color) {
    const auto found = std::ranges::find(item.numbers, "size", &live::SceneNumbers::name);
    const auto size = found == item.numbers.end() ? std::optional<Flat>() : drawn_.point(item, "size", frame_);
    const double wide = size ? size->x / 2 : 0.5, high = size ? size->y / 2 : 0.5;
    const double angle = drawn_.value(item, "angle", frame_, 0), c = std::cos(angle), s = std::sin(angle);
    std::string corners;
    for (const auto [x, y] : {Flat{-wide, -high}, {wide, -high}, {wide, high}, {-wide, high}, {-wide, -high}})
      corners += fmt::format("{}{},{}", corners.empty() ? "from " : " to ", at.x + c * x - s * y, at.y + s * x + c * y);
    objects_ += fmt::format("set object polygon {} fc rgb '{}' fillstyle solid noborder\n", corners, color);
  }

  void spring(const live::SceneItem& item, Flat from, Flat to, const std::string& color) {
    const double dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy);
    if (!(length > 0)) return;
    const int turns = std::clamp(static_cast<int>(drawn_.value(item, "turns", frame_, 10)), 1, 100);
    const double wide = drawn_.value(item, "width", frame_, 0.1) / 2;
    std::vector<Flat> zigzag = {from};
    for (int k = 0; k < 2 * turns; ++k) {
      const double part = 0.1 + 0.8 * (k + 0.5) / (2 * turns), side = k % 2 == 0 ? wide : -wide;
      zigzag.push_back({from.x + part * dx - side * dy / length, from.y + part * dy + side * dx / length});
    }
    zigzag.push_back(to);
    line(zigzag, color, 2);
  }

  void trail(const live::SceneItem& item, const std::string& color) {
    const double length = drawn_.value(item, "length", frame_, std::numeric_limits<double>::infinity());
    std::vector<Flat> path;
    for (std::size_t k = 0; k <= frame_; ++k) {
      if (drawn_.time(k) < drawn_.time(frame_) - length) continue;
      if (const auto p = drawn_.point(item, "at", k)) path.push_back(*p);
    }
    line(path, color, 1);
  }

  const Drawn& drawn_;
  std::size_t frame_;
  std::string objects_, curves_, data_;
};

}  // namespace

std::string draw_pictures(const std::string& folder, const live::LiveModel& shown,
                          const std::vector<Recorder::Scene>& scenes) {
  if (shown.drawing.empty()) return "the model draws nothing: add draw { ... }, or take --export, which has its plots";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fmt::format("cannot make {}: {}", folder, error.message());
  const Drawn drawn(shown, scenes);
  const Frame view = frame_of(drawn);
  if (view.empty()) return "nothing of the drawing has a place";
  std::string script = fmt::format(
      "set terminal pngcairo size {},{} font ',11'\nset size ratio -1\nset xrange [{}:{}]\nset yrange [{}:{}]\nset "
      "grid lc "
      "rgb 'gray90'\nset border lc rgb 'gray60'\n",
      width, height, view.left, view.right, view.low, view.high);
  for (std::size_t k = 0; k < scenes.size(); ++k)
    script += Page(drawn, k).commands(fmt::format("{:05d}.png", k + 1), view);
  const ScratchFolder scratch;
  const std::string program = scratch.file("pictures.gnuplot");
  if (const auto failure =
          results::write_file(program, fmt::format("cd '{}'\n", std::filesystem::absolute(folder).string()) + script))
    return *failure;
  const int exit = run_program({"gnuplot", program});
  if (exit == -1) return "pictures are drawn by gnuplot, which is not installed";
  return exit == 0 ? "" : fmt::format("gnuplot could not draw into {}", folder);
}

}  // namespace continuo::app
