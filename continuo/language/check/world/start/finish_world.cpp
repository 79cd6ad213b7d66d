// continuo/language/check/world/start/finish_world.cpp
// Bodies are sorted along one axis, so that only near ones are compared.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include <fmt/format.h>

#include <continuo/language/check/world/start/finish_world.hpp>
#include <continuo/language/check/world/start/start_meshes.hpp>
#include <continuo/language/check/world/start/start_shapes.hpp>
#include <continuo/language/world_methods.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

/// Where bodies begin.
struct Places : StartShapes {
  Places(const Model& model, const WorldDescription& made, std::span<const double> variables)
      : StartShapes(model, made, variables), axes(static_cast<std::size_t>(made.dimension)) {}

  std::size_t axes;

  std::size_t longest_axis() const {
    std::array<double, 3> size{};
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const auto [low, high] = std::ranges::minmax(centre, {}, [&](const auto& x) { return x[axis]; });
      size[axis] = high[axis] - low[axis];
    }
    return static_cast<std::size_t>(std::ranges::max_element(size) - size.begin());
  }
  /// visit(i, j) for all pairs whose shadows on that axis overlap.
  template <class Visit>
  void for_near_pairs(Visit&& visit) const {
    const std::size_t axis = longest_axis();
    const auto low = [&](std::size_t i) { return centre[i][axis] - radius[i]; };
    std::vector<std::size_t> order(centre.size()), open;
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, low);
    for (const std::size_t i : order) {
      std::erase_if(open, [&](std::size_t j) { return centre[j][axis] + radius[j] <= low(i); });
      for (const std::size_t j : open) visit(j, i);
      open.push_back(i);
    }
  }
};

/// How deep two bodies, or a body and a wall, begin within each other.
struct Overlap {
  std::size_t a, b;
  double depth;
};

std::string others(std::size_t count) {
  return count == 1 ? std::string() : fmt::format(", {} such in all", count);
}

/// Sensors and characters push nobody, but solid bodies stop characters.
bool pass_through(const BodyDescription& a, const BodyDescription& b) {
  const auto pushes = [](const BodyDescription& body) { return !body.traits.sensor; };
  return (!pushes(a) && !pushes(b)) || (!pushes(a) && !a.character) || (!pushes(b) && !b.character);
}

void look_at_bodies(const WorldDescription& made, const Places& places, Report& report) {
  std::vector<Overlap> found;
  const auto meet = [&](std::size_t i, std::size_t j) {
    const BodyDescription &a = made.bodies[i], &b = made.bodies[j];
    if ((a.is_unstoppable() && b.is_unstoppable()) || pass_through(a, b)) return false;
    const auto parts = [&](const JointDescription& joint) {
      return !joint.collide && std::minmax(joint.first, joint.second) == std::minmax(i, j);
    };
    if (std::ranges::any_of(made.joints, parts)) return false;
    return std::ranges::none_of(made.ignored, [&](const auto& pair) {
      return (pair.first == a.group && pair.second == b.group) || (pair.first == b.group && pair.second == a.group);
    });
  };
  places.for_near_pairs([&](std::size_t i, std::size_t j) {
    const double depth = places.depth(i, j);
    if (depth > least_depth * std::min(places.radius[i], places.radius[j]) && meet(i, j))
      found.push_back({std::min(i, j), std::max(i, j), depth});
  });
  if (!found.empty()) {
    const Overlap& first = *std::ranges::min_element(found, {}, [](const Overlap& o) { return std::pair(o.b, o.a); });
    report.warn("E295", made.bodies[first.b].span,
                fmt::format("`{}` begins within `{}`", made.bodies[first.b].name, made.bodies[first.a].name),
                fmt::format("by {:.3g}{}", first.depth, others(found.size())),
                "leave room between them, or let their groups ignore each other");
  }
}

void look_at_walls(const Model& model, const WorldDescription& made, const Places& places,
                   std::span<const double> variables, Report& report) {
  std::vector<Overlap> found;
  for (const WallDescription& wall : made.walls) {
    std::vector<NodeId> parts(wall.normal.begin(), wall.normal.begin() + static_cast<std::ptrdiff_t>(places.axes));
    parts.push_back(wall.offset);
    const std::vector<double> numbers = evaluate(model, parts, variables);
    double length = 0;
    for (std::size_t axis = 0; axis < places.axes; ++axis) length = std::hypot(length, numbers[axis]);
    std::array<double, 3> normal{};
    for (std::size_t axis = 0; axis < places.axes; ++axis) normal[axis] = numbers[axis] / length;
    found.clear();
    for (std::size_t i = 0; i < made.bodies.size(); ++i) {
      const double depth = places.depth_in_wall(i, normal, numbers.back() / length, wall.thin);
      if (depth > least_depth * places.radius[i] && !made.bodies[i].is_unstoppable()) found.push_back({i, i, depth});
    }
    if (found.empty()) continue;
    const BodyDescription& body = made.bodies[found.front().a];
    report.warn("E295", body.span, fmt::format("`{}` begins within the wall `{}`", body.name, wall.name),
                fmt::format("by {:.3g}{}", found.front().depth, others(found.size())), "leave room in front of it");
  }
}

/// E293: groups that no body is in.
void look_at_groups(const WorldText& text, const WorldAtWork& work, Report& report) {
  std::vector<std::string> filled;
  for (const BodyDescription& body : work.made.bodies)
    if (std::ranges::find(filled, work.groups[body.group]) == filled.end()) filled.push_back(work.groups[body.group]);
  for (const auto& item : text.items) {
    const auto* ignore = std::get_if<ast::WorldIgnore>(&item.text->node);
    if (!ignore) continue;
    for (const ast::Identifier* name : {&ignore->a, &ignore->b})
      if (std::ranges::find(filled, name->text) == filled.end())
        report.warn("E293", name->span, fmt::format("no body is in the group `{}`", name->text), {},
                    did_you_mean(name->text, filled));
  }
}

/// E295, with the parameters as the text has them.
void look_at_start(const Model& model, const WorldDescription& made, Report& report) {
  const std::vector<double> variables = start_values(model);
  const Places places(model, made, variables);
  look_at_bodies(made, places, report);
  look_at_walls(model, made, places, variables, report);
  look_at_meshes(model, made, places, variables, report);
}

/// E264: what the exact motion refuses where the model names it.
void look_at_exact_mode(const Model& model, const WorldDescription& made, Report& report) {
  if (made.mode.fast) return;
  for (const ExactRefusal& refusal : exact_refusals(made, model))
    report.fail("E264", refusal.span, refusal.message, {}, "write mode fast step 1/60, or leave this out");
}

}  // namespace

std::shared_ptr<const WorldDescription> finish_world(const WorldText& text, WorldAtWork world, const Model& model,
                                                     Report& report) {
  look_at_groups(text, world, report);
  if (!text.text) return nullptr;
  look_at_exact_mode(model, world.made, report);
  if (report.errors() == 0) look_at_start(model, world.made, report);
  return std::make_shared<const WorldDescription>(std::move(world.made));
}

}  // namespace continuo::model::detail
