// gnuplot commands for spheres, discs, walls and springs.
#include <array>
#include <cstdint>
#include <numeric>

#include <apps/continuo/pictures/body_pictures.hpp>

#include <continuo/language/world.hpp>

namespace continuo::app {
namespace {

using worlds::dot, worlds::Point;

// Colours as numbers, which `lc rgb variable` wants: the first of the curves', as on the page.
constexpr std::array<std::uint32_t, 5> colors_of_bodies = {0x0072B2, 0xD55E00, 0x009E73, 0xCC79A7, 0xE69F00};
constexpr std::uint32_t still = 0x8A8A8A, white = 0xFFFFFF, black = 0x000000;
constexpr std::string_view wall_color = "#e9e9e9", edge_color = "#8a8a8a";
constexpr std::string_view as_circles = "using 1:2:3:4 with circles lc rgb variable fs solid noborder";

std::uint32_t mixed(std::uint32_t a, std::uint32_t b, double part) {
  std::uint32_t color = 0;
  for (const unsigned shift : {0U, 8U, 16U}) {
    const double from = a >> shift & 255U, to = b >> shift & 255U;
    color |= static_cast<std::uint32_t>(std::lround(from + part * (to - from))) << shift;
  }
  return color;
}

std::string circle(Flat at, double radius, std::uint32_t color) {
  return fmt::format("{:.7g} {:.7g} {:.7g} {}\n", at.x, at.y, radius, color);
}

/// A vector of the body in the directions of space; q is (x, y, z, w), v + 2*u*(u*v + w*v) crosswise.
Point turned(const float* q, const Point& v) {
  const std::array<double, 4> p = {static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2]),
                                   static_cast<double>(q[3])};
  const auto cross = [&](const Point& b) {
    return Point{p[1] * b[2] - p[2] * b[1], p[2] * b[0] - p[0] * b[2], p[0] * b[1] - p[1] * b[0]};
  };
  Point inner = cross(v);
  for (std::size_t k = 0; k < 3; ++k) inner[k] += p[3] * v[k];
  Point made = cross(inner);
  for (std::size_t k = 0; k < 3; ++k) made[k] = v[k] + 2 * made[k];
  return made;
}

}  // namespace

BodyPictures::BodyPictures(const worlds::WorldRun& world)
    : dimension_(world.dimension()), shapes_(world.bodies()), walls_(world.walls()), springs_(world.springs()) {
  lower_.fill(std::numeric_limits<double>::infinity());
  upper_.fill(-std::numeric_limits<double>::infinity());
}

Point BodyPictures::place(const live::Bodies& bodies, std::size_t i) const {
  Point p{};
  for (std::size_t k = 0; k < bodies.dimension; ++k)
    p[k] = static_cast<double>(bodies.position[i * bodies.dimension + k]);
  return p;
}

Flat BodyPictures::flat(const Point& p) const {
  return dimension_ == 2 ? Flat{p[0], p[1]} : flat_of(p[0], p[1], p[2]);
}

double BodyPictures::radius_of(std::size_t i) const {
  return shapes_[i].radius * (dimension_ == 2 ? 1 : size_in_space);
}

void BodyPictures::take(const live::Bodies& bodies, PictureFrame& frame) {
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    const Point p = place(bodies, i);
    frame.take(flat(p), radius_of(i));
    for (std::size_t k = 0; k < 3; ++k) {
      lower_[k] = std::min(lower_[k], p[k] - shapes_[i].radius);
      upper_[k] = std::max(upper_[k], p[k] + shapes_[i].radius);
    }
  }
}

/// The frame, cut by the wall: what lies behind.
std::vector<Flat> BodyPictures::wall_in_plane(const worlds::WallShape& wall, const PictureFrame& frame) const {
  const std::array<Flat, 4> corners = {Flat{frame.left, frame.low}, Flat{frame.right, frame.low},
                                       Flat{frame.right, frame.high}, Flat{frame.left, frame.high}};
  const auto room = [&](Flat p) { return wall.normal[0] * p.x + wall.normal[1] * p.y - wall.offset; };
  std::vector<Flat> cut;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Flat a = corners[i], b = corners[(i + 1) % corners.size()];
    const double at_a = room(a), at_b = room(b);
    if (at_a <= 0) cut.push_back(a);
    if ((at_a <= 0) == (at_b <= 0)) continue;
    const double part = at_a / (at_a - at_b);
    cut.push_back({a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)});
  }
  return cut;
}

/// The wall within the box that bodies reach.
std::vector<Flat> BodyPictures::wall_in_space(const worlds::WallShape& wall) const {
  Point lower = lower_, upper = upper_;
  double size = 0;
  for (std::size_t k = 0; k < 3; ++k) size = std::max(size, upper[k] - lower[k]);
  for (std::size_t k = 0; k < 3; ++k) lower[k] -= 0.02 * size, upper[k] += 0.02 * size;
  const auto corner = [&](unsigned bits) {
    return Point{(bits & 1U) != 0 ? upper[0] : lower[0], (bits & 2U) != 0 ? upper[1] : lower[1],
                 (bits & 4U) != 0 ? upper[2] : lower[2]};
  };
  std::vector<Flat> cut;
  for (unsigned bits = 0; bits < 8; ++bits) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      if ((bits & axis) != 0) continue;
      const Point a = corner(bits), b = corner(bits | axis);
      const double at_a = dot(wall.normal, a) - wall.offset, at_b = dot(wall.normal, b) - wall.offset;
      if (at_a * at_b > 0 || at_a == at_b) continue;
      const double part = at_a / (at_a - at_b);
      Point p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = a[k] + part * (b[k] - a[k]);
      cut.push_back(flat(p));
    }
  }
  // The corners of a convex polygon, by their direction from within.
  Flat middle{0, 0};
  for (const Flat p : cut)
    middle.x += p.x / static_cast<double>(cut.size()), middle.y += p.y / static_cast<double>(cut.size());
  std::ranges::sort(cut, {}, [&](Flat p) { return std::atan2(p.y - middle.y, p.x - middle.x); });
  return cut;
}

void BodyPictures::draw_walls(const PictureFrame& frame, PictureParts& parts) const {
  for (const worlds::WallShape& wall : walls_) {
    const bool faces_away = dimension_ == 3 && !(nearness_of(wall.normal[0], wall.normal[1], wall.normal[2]) > 0);
    if (faces_away && !wall.thin) continue;  // it would hide what is before us
    std::vector<Flat> shown = dimension_ == 2 ? wall_in_plane(wall, frame) : wall_in_space(wall);
    if (shown.size() < 3) continue;
    if (!wall.thin) parts.polygon(shown, wall_color);
    if (dimension_ == 3) {
      shown.push_back(shown.front());
      parts.line(shown, edge_color, 1);
      continue;
    }
    // Its face, as long as the picture is wide.
    const double reach = std::hypot(frame.right - frame.left, frame.high - frame.low);
    const Flat middle{(frame.left + frame.right) / 2, (frame.low + frame.high) / 2};
    const double off = wall.normal[0] * middle.x + wall.normal[1] * middle.y - wall.offset;
    const Flat foot{middle.x - off * wall.normal[0], middle.y - off * wall.normal[1]};
    parts.line({{foot.x - reach * wall.normal[1], foot.y + reach * wall.normal[0]},
                {foot.x + reach * wall.normal[1], foot.y - reach * wall.normal[0]}},
               edge_color, 2);
  }
}

void BodyPictures::draw_springs(const live::Bodies& bodies, PictureParts& parts) const {
  if (springs_.empty()) return;
  std::string lines;
  for (const worlds::SpringShape& spring : springs_) {
    const Flat a = flat(place(bodies, spring.a)),
               b = flat(spring.b == model::no_body ? spring.point : place(bodies, spring.b));
    lines += fmt::format("{:.7g} {:.7g}\n{:.7g} {:.7g}\n\n", a.x, a.y, b.x, b.y);
  }
  parts.curve(fmt::format("with lines lw 1.5 lc rgb '{}'", edge_color), lines);
}

void BodyPictures::draw_discs(const live::Bodies& bodies, PictureParts& parts) const {
  std::string discs, marks;
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    const Flat at = flat(place(bodies, i));
    const double radius = shapes_[i].radius, angle = static_cast<double>(bodies.orientation[i]);
    const std::uint32_t color = shapes_[i].fixed ? still : colors_of_bodies[i % colors_of_bodies.size()];
    discs += circle(at, radius, mixed(color, black, 0.35)) + circle(at, 0.92 * radius, color);
    if (!shapes_[i].fixed)
      marks += fmt::format("{:.7g} {:.7g}\n{:.7g} {:.7g}\n\n", at.x, at.y, at.x + 0.9 * radius * std::cos(angle),
                           at.y + 0.9 * radius * std::sin(angle));
  }
  parts.curve(as_circles, discs);
  if (!marks.empty()) parts.curve("with lines lw 1.5 lc rgb 'white'", marks);
}

/// From the farthest to the nearest, each with the light from the upper left, and two dark poles that turn with it.
void BodyPictures::draw_spheres(const live::Bodies& bodies, PictureParts& parts) const {
  constexpr std::size_t few = 2000;  // beyond they are too small for poles
  std::vector<std::size_t> order(shapes_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) {
    const Point p = place(bodies, i);
    return nearness_of(p[0], p[1], p[2]);
  });
  std::string spheres;
  for (const std::size_t i : order) {
    const Point p = place(bodies, i);
    const Flat at = flat(p);
    const double radius = radius_of(i);
    const std::uint32_t color = shapes_[i].fixed ? still : colors_of_bodies[i % colors_of_bodies.size()];
    spheres += circle(at, radius, mixed(color, black, 0.45));
    spheres += circle({at.x - 0.06 * radius, at.y + 0.07 * radius}, 0.9 * radius, color);
    spheres += circle({at.x - 0.2 * radius, at.y + 0.24 * radius}, 0.55 * radius, mixed(color, white, 0.25));
    spheres += circle({at.x - 0.3 * radius, at.y + 0.36 * radius}, 0.25 * radius, mixed(color, white, 0.6));
    if (shapes_.size() > few) continue;
    for (const double side : {0.87, -0.87}) {
      const Point pole = turned(&bodies.orientation[4 * i], {side, 0, 0});
      if (!(nearness_of(pole[0], pole[1], pole[2]) > 0)) continue;
      const double r = shapes_[i].radius;
      spheres += circle(flat({p[0] + r * pole[0], p[1] + r * pole[1], p[2] + r * pole[2]}), 0.13 * radius,
                        mixed(color, black, 0.7));
    }
  }
  parts.curve(as_circles, spheres);
}

void BodyPictures::draw(const live::Bodies& bodies, PictureParts& parts) const {
  draw_springs(bodies, parts);
  dimension_ == 2 ? draw_discs(bodies, parts) : draw_spheres(bodies, parts);
}

}  // namespace continuo::app
