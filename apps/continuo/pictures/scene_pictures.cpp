// gnuplot commands for the scene of a model.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>

#include <apps/continuo/pictures/scene_pictures.hpp>

#include <continuo/results/figure.hpp>

namespace continuo::app {
namespace {

/// What of a scene there is to draw with, in the plane of the picture: a scene in space is seen from above its corner.
class Drawn {
 public:
  Drawn(const live::LiveModel& shown, const Recorder::Slices& slices) : shown_(shown), slices_(slices) {}

  std::optional<Flat> point(const live::SceneItem& item, std::string_view name, std::size_t frame) const {
    const live::SceneNumbers* part = find(item, name);
    if (!part || part->places.size() < 2) return std::nullopt;
    const auto at = [&](std::size_t i) { return number(frame, part->places[i]); };
    if (part->places.size() == 2) return Flat{at(0), at(1)};
    return flat_of(at(0), at(1), at(2));
  }
  double value(const live::SceneItem& item, std::string_view name, std::size_t frame, double otherwise) const {
    const live::SceneNumbers* part = find(item, name);
    return part ? number(frame, part->places.front()) : otherwise;
  }
  void add_path(const live::SceneItem& item, std::size_t frame, std::vector<Flat>& path) const {
    const live::Slice& slice = *slices_[frame];
    for (std::size_t row = 0; row < slice.row_t.size(); ++row) {
      const auto at = [&](std::size_t i) {
        return static_cast<double>(slice.paths[row * shown_.paths.size() + item.path[i]]);
      };
      path.push_back(item.path.size() == 2 ? Flat{at(0), at(1)} : flat_of(at(0), at(1), at(2)));
    }
  }
  /// Of a ball in space too: as large as a sphere of that radius looks.
  double radius(const live::SceneItem& item, std::size_t frame) const {
    const live::SceneNumbers* at = find(item, "at");
    const double seen = at && at->places.size() == 3 ? results::size_in_space : 1;
    return seen * value(item, "radius", frame, 0.1);
  }
  const live::LiveModel& shown() const { return shown_; }
  std::size_t frames() const { return slices_.size(); }
  double time(std::size_t frame) const { return slices_[frame]->t; }

 private:
  static const live::SceneNumbers* find(const live::SceneItem& item, std::string_view name) {
    const auto found = std::ranges::find(item.numbers, name, &live::SceneNumbers::name);
    return found == item.numbers.end() ? nullptr : &*found;
  }
  double number(std::size_t frame, std::size_t place) const {
    return static_cast<double>(slices_[frame]->scene[place]);
  }

  const live::LiveModel& shown_;
  const Recorder::Slices& slices_;
};

constexpr std::string_view floor_color = "#8996a3", ground_color = "#e6eaf0", line_color = "#5c6b7a";

/// What a model means by its colours: those of the page (web/src/palette.ts).
std::string color_named(std::string name) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 14> named = {{{"red", "#d55e00"},
                                                                                           {"blue", "#0072b2"},
                                                                                           {"green", "#009e73"},
                                                                                           {"orange", "#e69f00"},
                                                                                           {"yellow", "#cdbf1a"},
                                                                                           {"purple", "#cc79a7"},
                                                                                           {"pink", "#cc79a7"},
                                                                                           {"gray", "#7b8794"},
                                                                                           {"grey", "#7b8794"},
                                                                                           {"black", "#1b2733"},
                                                                                           {"white", "#f4f6f8"},
                                                                                           {"cyan", "#56b4e9"},
                                                                                           {"gold", "#e69f00"},
                                                                                           {"brown", "#8a5a2b"}}};
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto* const found = std::ranges::find(named, name, &std::pair<std::string_view, std::string_view>::first);
  if (found != named.end()) return std::string(found->second);
  const bool hexadecimal =
      name.size() == 7 && name.front() == '#' && name.find_first_not_of("0123456789abcdef", 1) == std::string::npos;
  return hexadecimal ? name : std::string(line_color);
}

/// As on the page: balls differ from one another where they are few, a trail has its ball's colour.
std::vector<std::string> colors_of(const std::vector<live::SceneItem>& items) {
  using model::Shape;
  constexpr std::ptrdiff_t few = 8;
  const auto is_plain = [](const live::SceneItem& item) { return item.shape == Shape::ball && item.color.empty(); };
  const auto plain = std::ranges::count_if(items, is_plain);
  std::size_t next = 0;
  std::vector<std::string> colors;
  for (const live::SceneItem& item : items) {
    const bool differs = is_plain(item) && plain > 1 && plain <= few;
    if (!item.color.empty()) {
      colors.push_back(color_named(item.color));
    } else if (item.shape == Shape::ball || item.shape == Shape::box) {
      colors.emplace_back(results::color_of(differs ? next++ : 0));
    } else if (item.shape == Shape::arrow) {
      colors.emplace_back(results::color_of(1));
    } else {
      colors.emplace_back(item.shape == Shape::trail ? std::string_view() : line_color);
    }
  }
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!colors[i].empty()) continue;
    std::size_t ball = i;
    while (ball > 0 && items[ball].shape != Shape::ball) --ball;
    while (ball < items.size() && items[ball].shape != Shape::ball) ++ball;
    colors[i] = ball < items.size() ? colors[ball] : std::string(results::color_of(1));
  }
  return colors;
}

/// A colour with so much of its light.
std::string shaded(const std::string& color, double light) {
  std::string made = "#";
  for (std::size_t k = 1; k < 7; k += 2) {
    const double part = std::stoi(color.substr(k, 2), nullptr, 16) * light;
    made += fmt::format("{:02x}", static_cast<int>(std::clamp(part, 0.0, 255.0)));
  }
  return made;
}

class Page {
 public:
  Page(const Drawn& drawn, std::size_t frame, PictureParts& parts) : drawn_(drawn), frame_(frame), parts_(parts) {}

  void draw(const PictureFrame& view) {
    const auto& items = drawn_.shown().drawing;
    const std::vector<std::string> colors = colors_of(items);
    for (std::size_t i = 0; i < items.size(); ++i) add(items[i], colors[i], view);
  }

 private:
  void line(const std::vector<Flat>& points, const std::string& color, double thick) {
    parts_.line(points, color, thick);
  }

  void add(const live::SceneItem& item, const std::string& color, const PictureFrame& view) {
    using model::Shape;
    const auto at = drawn_.point(item, "at", frame_), to = drawn_.point(item, "to", frame_);
    switch (item.shape) {
      case Shape::floor: {
        const double y = drawn_.value(item, "height", frame_, 0);
        parts_.polygon({{view.left, view.low}, {view.right, view.low}, {view.right, y}, {view.left, y}}, ground_color);
        line({{view.left, y}, {view.right, y}}, std::string(floor_color), 2);
        return;
      }
      case Shape::ball:
        if (at) ball(*at, drawn_.radius(item, frame_), color);
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
          parts_.objects +=
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
    parts_.objects += fmt::format("set label '{}' at {},{} center front\n", safe_text(text), at.x, at.y);
  }

  void ball(Flat at, double radius, const std::string& color) {
    // A dark rim, and light from the upper left.
    struct Disc {
      double right, up, size, light;
    };
    for (const auto [right, up, size, light] :
         {Disc{0, 0, 1, 0.7}, Disc{0, 0, 0.92, 0.9}, Disc{-0.08, 0.1, 0.78, 1.0}, Disc{-0.2, 0.26, 0.42, 1.12}})
      parts_.objects += fmt::format("set object circle at {},{} size {} fc rgb '{}' fillstyle solid noborder front\n",
                                    at.x + right * radius, at.y + up * radius, size * radius, shaded(color, light));
  }

  void box(const live::SceneItem& item, Flat at, const std::string& color) {
    const auto found = std::ranges::find(item.numbers, "size", &live::SceneNumbers::name);
    const auto size = found == item.numbers.end() ? std::optional<Flat>() : drawn_.point(item, "size", frame_);
    const double wide = size ? size->x / 2 : 0.5, high = size ? size->y / 2 : 0.5;
    const double angle = drawn_.value(item, "angle", frame_, 0), c = std::cos(angle), s = std::sin(angle);
    std::string corners;
    for (const auto [x, y] : {Flat{-wide, -high}, {wide, -high}, {wide, high}, {-wide, high}, {-wide, -high}})
      corners += fmt::format("{}{},{}", corners.empty() ? "from " : " to ", at.x + c * x - s * y, at.y + s * x + c * y);
    parts_.objects += fmt::format("set object polygon {} fc rgb '{}' fillstyle solid noborder\n", corners, color);
  }

  void spring(const live::SceneItem& item, Flat from, Flat to, const std::string& color) {
    const double dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy);
    if (!(length > 0)) return;
    const int turns = std::clamp(static_cast<int>(drawn_.value(item, "turns", frame_, 10)), 1, 100);
    const double wide = drawn_.value(item, "width", frame_, 0.1) / 2;
    // The page's coil (web/src/scene/curves.ts): straight ends, between them waves.
    constexpr int points_of_turn = 14;
    const int count = points_of_turn * turns;
    std::vector<Flat> coil = {from};
    for (int k = 0; k <= count; ++k) {
      const double part = static_cast<double>(k) / count, along = 0.08 + 0.84 * part;
      const double side = wide * std::sin(2 * std::acos(-1.0) * turns * part);
      coil.push_back({from.x + along * dx - side * dy / length, from.y + along * dy + side * dx / length});
    }
    coil.push_back(to);
    line(coil, color, 2);
  }

  /// Through the points of the rows, which are dense where it bends.
  void trail(const live::SceneItem& item, const std::string& color) {
    const double length = drawn_.value(item, "length", frame_, std::numeric_limits<double>::infinity());
    std::vector<Flat> path;
    for (std::size_t k = 0; k <= frame_; ++k) {
      if (drawn_.time(k) < drawn_.time(frame_) - length) continue;
      drawn_.add_path(item, k, path);
    }
    line(path, color, 1);
  }

  const Drawn& drawn_;
  std::size_t frame_;
  PictureParts& parts_;
};

}  // namespace

std::string safe_text(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    const bool special = c == '\'' || c == '"' || c == '\\' || c == '`' || c == '\n';
    safe += special ? ' ' : c;
  }
  return safe;
}

std::string title_of(double t, const live::LiveModel& shown) {
  const std::string time = std::abs(t) < 1e6 ? fmt::format("{:.3f}", t) : fmt::format("{:.4g}", t);
  return fmt::format("t = {} {}", time, safe_text(shown.model().time_unit));
}

void take_scene(const live::LiveModel& shown, const Recorder::Slices& slices, PictureFrame& frame) {
  const Drawn drawn(shown, slices);
  for (std::size_t k = 0; k < drawn.frames(); ++k) {
    for (const live::SceneItem& item : shown.drawing) {
      const double radius = item.shape == model::Shape::ball ? drawn.radius(item, k) : 0;
      const double around = std::max(radius, drawn.value(item, "size", k, 0) / 2);
      for (const char* name : {"at", "to"}) {
        if (const auto p = drawn.point(item, name, k)) frame.take(*p, around);
      }
      if (item.shape != model::Shape::floor) continue;
      frame.floor = std::min(frame.floor, drawn.value(item, "height", k, 0));
      frame.low = std::min(frame.low, frame.floor);
    }
  }
}

void draw_scene(const live::LiveModel& shown, const Recorder::Slices& slices, std::size_t number,
                const PictureFrame& frame, PictureParts& parts) {
  const Drawn drawn(shown, slices);
  Page(drawn, number, parts).draw(frame);
}

}  // namespace continuo::app
