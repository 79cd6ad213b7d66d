// gnuplot commands for spheres, discs, polygons, polyhedra, walls, meshes, springs and joints.
#include <array>
#include <cstdint>
#include <numeric>

#include <apps/continuo/pictures/body_pictures.hpp>
#include <apps/continuo/pictures/lit_color.hpp>

#include <continuo/language/world.hpp>

namespace continuo::app {
namespace {

using worlds::dot, worlds::Point;

// Colours as numbers, which `lc rgb variable` wants: the first of the curves', as on the page.
constexpr std::array<std::uint32_t, 5> colors_of_bodies = {0x0072B2, 0xD55E00, 0x009E73, 0xCC79A7, 0xE69F00};
constexpr std::string_view wall_color = "#e9e9e9", joint_color = "#303030";
constexpr std::string_view as_circles = "using 1:2:3:4 with circles lc rgb variable fs solid noborder";

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
    : dimension_(world.dimension()),
      shapes_(world.bodies()),
      walls_(world.walls()),
      meshes_(world.meshes()),
      springs_(world.springs()),
      forms_(world.forms()),
      joints_(world.joints()),
      ground_(dimension_ == 3 ? GroundPictures(meshes_) : GroundPictures()) {
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
  return shapes_[i].radius * (dimension_ == 2 ? 1 : results::size_in_space);
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

/// Ground belongs into the picture whole, unless bodies would be too small in it.
void BodyPictures::take_meshes(PictureFrame& frame) const {
  constexpr double most = 30;  // times as wide as without
  PictureFrame wider = frame;
  for (const worlds::StaticMeshShape& mesh : meshes_)
    for (const Point& corner : mesh.corners) wider.take(flat(corner), 0);
  const auto size = [](const PictureFrame& of) { return std::max(of.right - of.left, of.high - of.low); };
  if (size(wider) <= most * size(frame)) frame = wider;
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
    const bool faces_away =
        dimension_ == 3 && !(results::nearness_in_space(wall.normal[0], wall.normal[1], wall.normal[2]) > 0);
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

void BodyPictures::draw_meshes(const PictureFrame& frame, PictureParts& parts) const {
  if (dimension_ == 3) return ground_.draw(parts);
  for (const worlds::StaticMeshShape& mesh : meshes_) draw_chain(mesh, frame, parts);
}

/// A line, and where one side is not free a band on that side.
void BodyPictures::draw_chain(const worlds::StaticMeshShape& chain, const PictureFrame& frame,
                              PictureParts& parts) const {
  const double width = 0.025 * (frame.high - frame.low);
  std::string band, line;
  for (const auto& [first, second, last] : chain.facets) {
    const Flat a = flat(chain.corners[first]), b = flat(chain.corners[second]);
    const double size = std::hypot(b.x - a.x, b.y - a.y);
    const Flat back{-(b.y - a.y) / size * width, (b.x - a.x) / size * width};  // to the left of its way
    for (const Flat p : {a, b, Flat{b.x + back.x, b.y + back.y}, Flat{a.x + back.x, a.y + back.y}, a})
      band += fmt::format("{:.7g} {:.7g}\n", p.x, p.y);
    band += '\n';
    line += fmt::format("{:.7g} {:.7g}\n{:.7g} {:.7g}\n\n", a.x, a.y, b.x, b.y);
  }
  if (!chain.thin) parts.curve(fmt::format("using 1:2 with filledcurves closed fc rgb '{}'", wall_color), band);
  parts.curve(fmt::format("with lines lw 2 lc rgb '{}'", edge_color), line);
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

std::uint32_t BodyPictures::color_of(std::size_t i) const {
  return shapes_[i].fixed ? still : colors_of_bodies[i % colors_of_bodies.size()];
}

/// A vector of body i in the directions of the world.
Point BodyPictures::turned_by(const live::Bodies& bodies, std::size_t i, const Point& v) const {
  if (dimension_ == 3) return turned(&bodies.orientation[4 * i], v);
  const double angle = static_cast<double>(bodies.orientation[i]), c = std::cos(angle), s = std::sin(angle);
  return {c * v[0] - s * v[1], s * v[0] + c * v[1], 0};
}

/// A point of a body, or of the world where it is no body.
Point BodyPictures::placed(const live::Bodies& bodies, std::size_t body, const Point& local) const {
  if (body == model::no_body) return local;
  Point p = place(bodies, body);
  const Point arm = turned_by(bodies, body, local);
  for (std::size_t k = 0; k < 3; ++k) p[k] += arm[k];
  return p;
}

void BodyPictures::draw_discs(const live::Bodies& bodies, PictureParts& parts) const {
  std::string discs, marks;
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    if (shapes_[i].form != worlds::no_form) continue;
    const Flat at = flat(place(bodies, i));
    const double radius = shapes_[i].radius, angle = static_cast<double>(bodies.orientation[i]);
    const std::uint32_t color = color_of(i);
    discs += circle(at, radius, mixed(color, black, 0.35)) + circle(at, 0.92 * radius, color);
    if (!shapes_[i].fixed)
      marks += fmt::format("{:.7g} {:.7g}\n{:.7g} {:.7g}\n\n", at.x, at.y, at.x + 0.9 * radius * std::cos(angle),
                           at.y + 0.9 * radius * std::sin(angle));
  }
  if (!discs.empty()) parts.curve(as_circles, discs);
  if (!marks.empty()) parts.curve("with lines lw 1.5 lc rgb 'white'", marks);
}

/// Each with its edge, so that it hides those before it; of very many, all edges together.
void BodyPictures::draw_polygons(const live::Bodies& bodies, PictureParts& parts) const {
  constexpr std::size_t few = 200;
  std::string areas, edges;
  const auto flush = [&] {
    if (areas.empty()) return;
    parts.curve(as_polygons, areas);
    parts.curve("using 1:2:3 with lines lw 1.5 lc rgb variable", edges);
    areas.clear(), edges.clear();
  };
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    if (shapes_[i].form == worlds::no_form) continue;
    const worlds::BodyForm& form = forms_[shapes_[i].form];
    for (const std::vector<std::uint32_t>& face : form.faces) {
      for (std::size_t k = 0; k <= face.size(); ++k) {
        const Flat at = flat(placed(bodies, i, form.corners[face[k % face.size()]]));
        areas += fmt::format("{:.7g} {:.7g} {}\n", at.x, at.y, color_of(i));
        edges += fmt::format("{:.7g} {:.7g} {}\n", at.x, at.y, mixed(color_of(i), black, 0.35));
      }
      areas += '\n', edges += '\n';
    }
    if (shapes_.size() <= few) flush();
  }
  flush();
}

/// The faces that look at us, lit from the upper left. They do not hide each other, since it is convex.
std::string BodyPictures::polyhedron(const live::Bodies& bodies, std::size_t i) const {
  const worlds::BodyForm& form = forms_[shapes_[i].form];
  std::string text;
  for (const std::vector<std::uint32_t>& face : form.faces) {
    const Point &a = form.corners[face[0]], &b = form.corners[face[1]], &c = form.corners[face[2]];
    const Point u = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v = {c[0] - b[0], c[1] - b[1], c[2] - b[2]};
    Point normal =
        turned_by(bodies, i, {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]});
    const double size = std::sqrt(dot(normal, normal));
    if (!(size > 0) || !(results::nearness_in_space(normal[0], normal[1], normal[2]) > 0)) continue;
    const double lit = dot(normal, sun) / size;
    const std::uint32_t color = lit_by(color_of(i), lit);
    for (std::size_t k = 0; k <= face.size(); ++k) {
      const Flat at = flat(placed(bodies, i, form.corners[face[k % face.size()]]));
      text += fmt::format("{:.7g} {:.7g} {}\n", at.x, at.y, color);
    }
    text += '\n';
  }
  return text;
}

/// With the light from the upper left, and two dark poles that turn with it.
std::string BodyPictures::sphere(const live::Bodies& bodies, std::size_t i) const {
  constexpr std::size_t few = 2000;  // beyond they are too small for poles
  const Point p = place(bodies, i);
  const Flat at = flat(p);
  const double radius = radius_of(i);
  const std::uint32_t color = color_of(i);
  std::string text = circle(at, radius, mixed(color, black, 0.45));
  text += circle({at.x - 0.06 * radius, at.y + 0.07 * radius}, 0.9 * radius, color);
  text += circle({at.x - 0.2 * radius, at.y + 0.24 * radius}, 0.55 * radius, mixed(color, white, 0.25));
  text += circle({at.x - 0.3 * radius, at.y + 0.36 * radius}, 0.25 * radius, mixed(color, white, 0.6));
  if (shapes_.size() > few) return text;
  for (const double side : {0.87, -0.87}) {
    const Point pole = turned(&bodies.orientation[4 * i], {side, 0, 0});
    if (!(results::nearness_in_space(pole[0], pole[1], pole[2]) > 0)) continue;
    const double r = shapes_[i].radius;
    text += circle(flat({p[0] + r * pole[0], p[1] + r * pole[1], p[2] + r * pole[2]}), 0.13 * radius,
                   mixed(color, black, 0.7));
  }
  return text;
}

/// From the farthest to the nearest, each with the ground before it; spheres that follow each other are one curve.
void BodyPictures::draw_in_space(const live::Bodies& bodies, PictureParts& parts) const {
  std::vector<std::size_t> order(shapes_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) {
    const Point p = place(bodies, i);
    return results::nearness_in_space(p[0], p[1], p[2]);
  });
  std::string text;
  bool are_spheres = true;
  const auto flush = [&] {
    if (!text.empty()) parts.curve(are_spheres ? as_circles : as_polygons, text);
    text.clear();
  };
  for (const std::size_t i : order) {
    const bool is_sphere = shapes_[i].form == worlds::no_form;
    if (is_sphere != are_spheres) flush();
    are_spheres = is_sphere;
    text += is_sphere ? sphere(bodies, i) : polyhedron(bodies, i);
    PictureParts ground;
    ground_.draw_before(place(bodies, i), radius_of(i), ground);
    if (ground.curves.empty()) continue;
    flush();
    parts.append(ground);
  }
  flush();
}

/// Pins as small rings, ropes and distances as lines between their ends, guides as lines along their axes.
void BodyPictures::draw_joints(const live::Bodies& bodies, PictureParts& parts) const {
  std::string lines, pins;
  const auto line = [&](const Point& from, const Point& to) {
    const Flat a = flat(from), b = flat(to);
    lines += fmt::format("{:.7g} {:.7g}\n{:.7g} {:.7g}\n\n", a.x, a.y, b.x, b.y);
  };
  for (const worlds::JointShape& joint : joints_) {
    const Point first = placed(bodies, joint.first, joint.on_first),
                second = placed(bodies, joint.second, joint.on_second);
    const Point gap = {first[0] - second[0], first[1] - second[1], first[2] - second[2]};
    if (std::sqrt(dot(gap, gap)) > joint.apart + 0.05 * shapes_[joint.first].radius) continue;  // it is broken
    if (joint.kind == "distance" || joint.kind == "rope") {
      line(first, second);
    } else if (joint.kind == "slider") {
      const Point along = joint.second == model::no_body ? joint.axis : turned_by(bodies, joint.second, joint.axis);
      const double reach = shapes_[joint.first].radius;
      Point from = first, to = first;
      for (std::size_t k = 0; k < 3; ++k) from[k] -= 1.5 * reach * along[k], to[k] += 1.5 * reach * along[k];
      line(from, to);
    } else if (joint.kind != "gear") {
      const Flat at = flat(first);
      pins += fmt::format("{:.7g} {:.7g}\n", at.x, at.y);
    }
  }
  if (!lines.empty()) parts.curve(fmt::format("with lines lw 1.5 lc rgb '{}'", joint_color), lines);
  if (!pins.empty()) parts.curve(fmt::format("with points pt 7 ps 0.9 lc rgb '{}'", joint_color), pins);
  if (!pins.empty()) parts.curve("with points pt 7 ps 0.4 lc rgb 'white'", pins);
}

void BodyPictures::draw(const live::Bodies& bodies, PictureParts& parts) const {
  draw_springs(bodies, parts);
  if (dimension_ == 2) {
    draw_polygons(bodies, parts);
    draw_discs(bodies, parts);
  } else {
    draw_in_space(bodies, parts);
  }
  draw_joints(bodies, parts);
}

}  // namespace continuo::app
