// Draws the bodies of a world at the end of a run, in the plane or projected from space.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <continuo/language/model.hpp>
#include <continuo/language/world.hpp>
#include <continuo/results/bodies_panel.hpp>
#include <continuo/results/plots.hpp>
#include <continuo/shapes/matrix.hpp>
#include <continuo/worlds/world_shapes.hpp>

namespace continuo::results {
namespace {

using Flat = std::array<double, 2>;

constexpr std::size_t most_discs = 3000;
constexpr std::size_t most_forms = 500;  // of more bodies discs are shown
constexpr std::string_view still_color = "#8a8a8a";

std::string_view family_of(std::string_view body) {
  return body.substr(0, body.find('['));
}

struct Seen {
  Flat at{};
  double radius = 0, nearness = 0;
  std::size_t number = 0;
  std::string_view color;
};

class BodiesPanel {
 public:
  BodiesPanel(const model::Model& model, const model::Run& run, const MotionCurves* curves)
      : model_(model), run_(run), world_(*model.world), curves_(curves) {
    for (const model::BodyDescription& body : world_.bodies) {
      const std::string_view family = family_of(body.name);
      if (std::ranges::find(families_, family) == families_.end()) families_.push_back(family);
    }
  }

  Panel panel() {
    add_ways();
    add_bodies();
    add_meshes();
    add_walls();
    add_names();
    const auto& columns = run_.motion.columns;
    const std::string when = fmt::format("at {} = {:.4g}{}", columns[0].name, run_.motion.row(last_row())[0],
                                         columns[0].unit.empty() ? "" : " " + columns[0].unit);
    const bool is_flat = world_.dimension == 2;
    panel_.x_label = is_flat ? label_of(axis(0)) + ", " + when : when + ", seen along (-1, 1, -1)";
    panel_.y_label = is_flat ? label_of(axis(1)) : "";
    panel_.equal_scale = true;
    panel_.no_numbers = !is_flat;
    return std::move(panel_);
  }

 private:
  std::size_t last_row() const { return run_.motion.rows() - 1; }
  /// "x [m]" of whatever body.
  model::Column axis(std::size_t k) const { return {k == 0 ? "x" : "y", world_.length_unit}; }
  std::string_view color_of_body(std::size_t i) const {
    if (world_.bodies[i].fixed) return still_color;
    return color_of(
        static_cast<std::size_t>(std::ranges::find(families_, family_of(world_.bodies[i].name)) - families_.begin()));
  }
  double coordinate(std::size_t body, std::size_t axis, std::size_t row) const {
    return run_.motion.row(row)[1 + world_.bodies[body].first_state + 2 * axis];
  }
  Flat place(std::size_t body, std::size_t row) const {
    const double x = coordinate(body, 0, row), y = coordinate(body, 1, row);
    if (world_.dimension == 2) return {x, y};
    return {right_in_space(x, y), up_in_space(x, y, coordinate(body, 2, row))};
  }
  double nearness(std::size_t body) const {
    if (world_.dimension == 2) return 0;
    return nearness_in_space(coordinate(body, 0, last_row()), coordinate(body, 1, last_row()),
                             coordinate(body, 2, last_row()));
  }

  void add_ways() {
    if (std::ranges::count(world_.bodies, false, &model::BodyDescription::fixed) > static_cast<int>(most_ways)) return;
    for (std::size_t i = 0; i < world_.bodies.size(); ++i) {
      if (world_.bodies[i].fixed) continue;
      Curve way{
          .label = "", .x = {}, .y = {}, .color = std::string(color_of_body(i)), .style = Curve::Style::thin_line};
      auto followed = curves_ ? curves_->way_of(i) : std::nullopt;
      for (std::size_t row = 0; !followed && row <= last_row(); ++row) {
        const Flat at = place(i, row);
        way.x.push_back(at[0]), way.y.push_back(at[1]);
      }
      if (followed) way.x = std::move(followed->x), way.y = std::move(followed->y);
      panel_.curves.push_back(std::move(way));
    }
  }
  void add_bodies() {
    const worlds::Shapes shapes = world_.is_rigid() ? worlds::shapes_of(model_, run_.plan.variables) : worlds::Shapes{};
    if (!shapes.forms.empty() && world_.bodies.size() <= most_forms) return add_forms(shapes);
    std::vector<model::NodeId> nodes;
    for (const model::BodyDescription& body : world_.bodies) nodes.push_back(body.radius);
    const std::vector<double> radii = evaluate(model_, nodes, run_.plan.variables);
    const double size = world_.dimension == 2 ? 1 : size_in_space;  // of a unit of length, as seen
    std::vector<Seen> all(world_.bodies.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = {place(i, last_row()), radii[i] * size, nearness(i), i, color_of_body(i)};
    if (world_.dimension == 3) {
      std::ranges::sort(all, {}, [](const Seen& body) { return std::pair(body.nearness, body.number); });
      all = seen_of(all);
    }
    if (all.size() > most_discs) return add_dots(all);
    Curve bodies{.label = "", .x = {}, .y = {}, .style = Curve::Style::discs};
    for (const Seen& body : all) {
      bodies.x.push_back(body.at[0]), bodies.y.push_back(body.at[1]);
      bodies.discs.push_back({body.radius, body.color});
    }
    panel_.curves.push_back(std::move(bodies));
  }
  /// From far to near. In the plane all are as near.
  void add_forms(const worlds::Shapes& shapes) {
    std::vector<std::size_t> order(world_.bodies.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(nearness(i), i); });
    const double size = world_.dimension == 2 ? 1 : size_in_space;
    for (const std::size_t i : order) {
      if (shapes.bodies[i].form == worlds::no_form) {
        const Flat at = place(i, last_row());
        Curve disc{.label = "", .x = {at[0]}, .y = {at[1]}, .style = Curve::Style::discs};
        disc.discs.push_back({shapes.bodies[i].radius * size, color_of_body(i)});
        panel_.curves.push_back(std::move(disc));
      } else {
        add_form(i, shapes.forms[shapes.bodies[i].form]);
      }
    }
  }
  /// Its faces, in space those that look at us, and their edges.
  void add_form(std::size_t body, const worlds::BodyForm& form) {
    Curve area{.label = "", .x = {}, .y = {}, .color = std::string(color_of_body(body)), .style = Curve::Style::area};
    area.fill = 0.8;
    for (const std::vector<std::uint32_t>& face : form.faces) {
      double twice = 0;  // the area as seen: above 0 where it looks at us
      std::vector<Flat> corners;
      for (const std::uint32_t corner : face) corners.push_back(place_of(body, form.corners[corner]));
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const Flat &a = corners[k], &b = corners[(k + 1) % corners.size()];
        twice += a[0] * b[1] - a[1] * b[0];
      }
      if (!(twice > 0)) continue;
      corners.push_back(corners.front());
      for (const Flat& at : corners) area.x.push_back(at[0]), area.y.push_back(at[1]);
      area.x.push_back(NAN), area.y.push_back(NAN);
    }
    Curve edges{.label = "", .x = area.x, .y = area.y, .color = "#404040", .style = Curve::Style::thin_line};
    panel_.curves.push_back(std::move(area));
    panel_.curves.push_back(std::move(edges));
  }
  /// Of a point of the body at the end, in the picture.
  Flat place_of(std::size_t body, const worlds::Point& local) const {
    const auto state = [&](std::size_t k) {
      return run_.motion.row(last_row())[1 + world_.bodies[body].first_state + k];
    };
    const Flat centre = place(body, last_row());
    if (world_.dimension == 2) {
      const double c = std::cos(state(4)), s = std::sin(state(4));
      return {centre[0] + c * local[0] - s * local[1], centre[1] + s * local[0] + c * local[1]};
    }
    const Vector<double, 3> arm = rotation(Vector<double, 4>{{state(6), state(7), state(8), state(9)}}) *
                                  Vector<double, 3>{{local[0], local[1], local[2]}};
    return {centre[0] + right_in_space(arm[0], arm[1]), centre[1] + up_in_space(arm[0], arm[1], arm[2])};
  }
  /// As a picture file has a hundred numbers for a disc, so many are dots.
  void add_dots(const std::vector<Seen>& all) {
    std::vector<std::string_view> colors;
    for (const Seen& body : all)
      if (std::ranges::find(colors, body.color) == colors.end()) colors.push_back(body.color);
    for (const std::string_view color : colors) {
      Curve dots{.label = "", .x = {}, .y = {}, .color = std::string(color), .style = Curve::Style::dots};
      for (const Seen& body : all)
        if (body.color == color) dots.x.push_back(body.at[0]), dots.y.push_back(body.at[1]);
      panel_.curves.push_back(std::move(dots));
    }
  }
  /// Those of which something is not hidden by nearer ones, to a part in 700 of the picture; from far to near.
  static std::vector<Seen> seen_of(const std::vector<Seen>& all) {
    constexpr int pixels = 700;
    Flat low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
    for (const Seen& body : all)
      for (const std::size_t k : {0U, 1U})
        low[k] = std::min(low[k], body.at[k] - body.radius), high[k] = std::max(high[k], body.at[k] + body.radius);
    const double pixel = std::max(high[0] - low[0], high[1] - low[1]) / pixels;
    if (!(pixel > 0) || !std::isfinite(pixel)) return all;
    std::vector<bool> is_hidden(static_cast<std::size_t>(pixels + 1) * (pixels + 1));
    const auto to_pixel = [&](double at, std::size_t k) { return static_cast<int>((at - low[k]) / pixel); };
    std::vector<Seen> seen;
    for (auto body = all.rbegin(); body != all.rend(); ++body) {
      bool shows = body->radius < pixel;
      for (int row = to_pixel(body->at[1] - body->radius, 1); row <= to_pixel(body->at[1] + body->radius, 1); ++row) {
        const double up = low[1] + (row + 0.5) * pixel - body->at[1];
        const double half = std::sqrt(std::max(0.0, body->radius * body->radius - up * up));
        for (int column = to_pixel(body->at[0] - half, 0); column < to_pixel(body->at[0] + half, 0); ++column) {
          auto hidden = is_hidden[static_cast<std::size_t>(row * (pixels + 1) + column)];
          shows = shows || !hidden;
          hidden = true;
        }
      }
      if (shows) seen.push_back(*body);
    }
    std::ranges::reverse(seen);
    return seen;
  }

  /// Chains, and the edges of triangles where these are not too many.
  void add_meshes() {
    constexpr std::size_t most_triangles = 5000;
    if (world_.meshes.empty()) return;
    for (const worlds::StaticMeshShape& mesh : worlds::shapes_of(model_, run_.plan.variables).meshes) {
      if (world_.dimension == 3 && mesh.facets.size() > most_triangles) continue;
      Curve edges{.label = "", .x = {}, .y = {}, .color = std::string(still_color)};
      if (world_.dimension == 3) edges.style = Curve::Style::thin_line;
      for (const auto& [a, b, c] : mesh.facets) {
        for (const std::uint32_t corner : {a, b, c, a}) {
          const worlds::Point& p = mesh.corners[corner];
          edges.x.push_back(world_.dimension == 2 ? p[0] : right_in_space(p[0], p[1]));
          edges.y.push_back(world_.dimension == 2 ? p[1] : up_in_space(p[0], p[1], p[2]));
        }
        edges.x.push_back(NAN), edges.y.push_back(NAN);
      }
      panel_.curves.push_back(std::move(edges));
    }
  }
  /// Walls of the plane, as far as bodies come.
  void add_walls() {
    if (world_.dimension != 2 || world_.walls.empty()) return;
    std::vector<model::NodeId> nodes;
    for (const model::WallDescription& wall : world_.walls)
      nodes.insert(nodes.end(), {wall.normal[0], wall.normal[1], wall.offset});
    const std::vector<double> values = evaluate(model_, nodes, run_.plan.variables);
    const Flat low = corner(-1), high = corner(1);
    for (std::size_t w = 0; w < world_.walls.size(); ++w) {
      const double size = std::hypot(values[3 * w], values[3 * w + 1]);
      add_line({values[3 * w] / size, values[3 * w + 1] / size}, values[3 * w + 2] / size, low, high);
    }
  }
  /// Of what is drawn so far, with room for a wall beside it.
  Flat corner(double side) const {
    Flat result;
    for (const std::size_t k : {0U, 1U}) {
      double low = INFINITY, high = -INFINITY;
      for (const Curve& curve : panel_.curves)
        for (std::size_t i = 0; i < curve.x.size(); ++i) {
          const double at = k == 0 ? curve.x[i] : curve.y[i], around = curve.discs.empty() ? 0 : curve.discs[i].radius;
          if (std::isfinite(at)) low = std::min(low, at - around), high = std::max(high, at + around);
        }
      result[k] = side < 0 ? low - 0.02 * (high - low) : high + 0.02 * (high - low);
    }
    return result;
  }
  /// The points with normal . x = offset in a box: its sides cut the line at parameters along it.
  void add_line(Flat normal, double offset, Flat low, Flat high) {
    const Flat from{normal[0] * offset, normal[1] * offset}, along{-normal[1], normal[0]};
    double first = -INFINITY, last = INFINITY;
    for (const std::size_t k : {0U, 1U}) {
      if (along[k] == 0) {
        if (from[k] < low[k] || from[k] > high[k]) return;
        continue;
      }
      const double a = (low[k] - from[k]) / along[k], b = (high[k] - from[k]) / along[k];
      first = std::max(first, std::min(a, b)), last = std::min(last, std::max(a, b));
    }
    if (!(first < last) || !std::isfinite(last - first)) return;
    panel_.curves.push_back({.label = "",
                             .x = {from[0] + first * along[0], from[0] + last * along[0]},
                             .y = {from[1] + first * along[1], from[1] + last * along[1]},
                             .color = std::string(still_color)});
  }

  /// A line of the key for each family that moves, where there are several.
  void add_names() {
    if (families_.size() < 2 || families_.size() > most_ways) return;
    for (std::size_t i = 0; i < world_.bodies.size(); ++i) {
      const std::string_view family = family_of(world_.bodies[i].name);
      if (world_.bodies[i].fixed || std::ranges::find(panel_.curves, family, &Curve::label) != panel_.curves.end())
        continue;
      panel_.curves.push_back({.label = std::string(family),
                               .x = {},
                               .y = {},
                               .color = std::string(color_of_body(i)),
                               .style = Curve::Style::full_points});
    }
  }

  const model::Model& model_;
  const model::Run& run_;
  const model::WorldDescription& world_;
  const MotionCurves* curves_;  // may be null
  std::vector<std::string_view> families_;
  Panel panel_{.x_label = "", .y_label = "", .curves = {}};
};

}  // namespace

Panel bodies_panel(const model::Model& model, const model::Run& run, const MotionCurves* curves) {
  return BodiesPanel(model, run, curves).panel();
}

}  // namespace continuo::results
