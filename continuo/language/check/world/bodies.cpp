// continuo/language/check/world/bodies.cpp
// Bodies one by one and by pattern: what they are and where they begin.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <continuo/language/check/expressions/indices.hpp>
#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/placement.hpp>

namespace continuo::model::detail {

std::uint32_t Checker::group_of(const ast::WorldAttributes& attributes) {
  const ast::Expression* text = attribute(attributes, "group");
  if (!text) return 0;
  const std::string& name = std::get<ast::Name>(text->node).text;
  const auto known = std::ranges::find(world_.groups, name);
  if (known != world_.groups.end()) return static_cast<std::uint32_t>(known - world_.groups.begin());
  warn("E293", text->span, fmt::format("nothing ignores the group `{}`", name), {},
       fmt::format("write ignore {} with NAME, or leave `group` out", name));
  return 0;
}

BodyDescription Checker::description_of(const ast::WorldAttributes& attributes, Scope& scope) {
  Graph& g = model_.graph;
  BodyDescription body;
  const ast::Expression* radius = attribute(attributes, "radius");
  body.radius = radius ? world_number(*radius, scope, world_.length, "the radius", Sort::positive) : g.constant(0.5);
  body.material = material_of(attributes, scope);
  body.fixed = attribute(attributes, "fixed") != nullptr;
  body.group = group_of(attributes);
  const auto *mass = attribute(attributes, "mass"), *density = attribute(attributes, "density");
  if (mass && density) {
    fail("E225", density->span, "a body has a mass or a density", "both are given");
  } else if (mass) {
    body.mass = world_number(*mass, scope, world_.mass, "the mass", Sort::positive);
  } else if (body.radius.valid()) {
    Measured wanted = world_.mass;
    for (std::size_t axis = 0; axis < world_.axes(); ++axis) wanted = quotient(wanted, world_.length);
    body.density = density ? world_number(*density, scope, wanted, "the density", Sort::positive) : g.constant(1);
    const bool plane = world_.dimension == 2;
    const double factor = plane ? std::numbers::pi : 4 * std::numbers::pi / 3;
    const NodeId volume = g.multiply(g.constant(factor), g.power(body.radius, g.constant(plane ? 2 : 3)));
    if (body.density.valid()) body.mass = g.multiply(body.density, volume);
  }
  return body;
}

NodePoint Checker::velocity_of(const ast::WorldAttributes& attributes, Scope& scope) {
  if (const ast::Expression* text = attribute(attributes, "velocity"))
    return world_point(*text, scope, per_time(world_.length), "a velocity");
  const NodeId zero = model_.graph.constant(0);
  return {zero, zero, zero};
}

/// In space an angle is three numbers: the axis about which it is turned, and by how much as its length.
Turn Checker::turn_of(const ast::WorldAttributes& attributes, Scope& scope) {
  Graph& g = model_.graph;
  const NodeId zero = g.constant(0);
  Turn turn{.orientation = {zero}, .spin = {zero, zero, zero}};
  const bool plane = world_.dimension == 2;
  if (!plane) turn.orientation = {g.constant(1), zero, zero, zero};
  const Measured pure = Measured::known(Unit());
  const Measured rate = per_time(world_.length.is_known() ? pure : Measured::unknown());
  const ast::Expression *angle = attribute(attributes, "angle"), *spin = attribute(attributes, "spin");
  if (spin && plane) turn.spin[0] = turn_in_plane(*spin, scope, rate, "a spin");
  if (spin && !plane) turn.spin = turn_in_space(*spin, scope, rate, "a spin");
  if (angle && plane) turn.orientation[0] = turn_in_plane(*angle, scope, pure, "an angle");
  if (!angle || plane) return turn;
  const NodePoint about = turn_in_space(*angle, scope, pure, "an angle");
  if (!about[0].valid()) return turn;
  const NodeId whole = g.apply(Op::hypotenuse, g.apply(Op::hypotenuse, about[0], about[1]), about[2]);
  const NodeId half = g.multiply(whole, g.constant(0.5));
  // sin(a/2)/a times the three numbers, which are all 0 where a is.
  const NodeId least = g.constant(std::numeric_limits<double>::min());
  const NodeId part = g.divide(g.apply(Op::sine, half), g.apply(Op::maximum, whole, least));
  turn.orientation[0] = g.apply(Op::cosine, half);
  for (std::size_t k = 0; k < 3; ++k) turn.orientation[k + 1] = g.multiply(about[k], part);
  return turn;
}

NodeId Checker::turn_in_plane(const ast::Expression& text, Scope& scope, const Measured& wanted,
                              std::string_view what) {
  if (!std::holds_alternative<ast::List>(text.node)) return world_number(text, scope, wanted, what, Sort::any);
  fail("E227", text.span, fmt::format("{} in the plane is one number", what), {},
       "write `dimension 3` in the world for bodies in space");
  return {};
}
NodePoint Checker::turn_in_space(const ast::Expression& text, Scope& scope, const Measured& wanted,
                                 std::string_view what, bool parameters_only) {
  if (std::holds_alternative<ast::List>(text.node)) return world_point(text, scope, wanted, what, parameters_only);
  fail("E227", text.span, fmt::format("{} in space has three components", what), {},
       "its direction is the axis, as in (0, 0, 2)");
  return {};
}

void Checker::set_start(std::size_t body, const NodePoint& position, const NodePoint& velocity, const Turn& turn) {
  std::size_t state = bases_[world_.bodies[body].base].first;
  for (std::size_t axis = 0; axis < world_.axes(); ++axis) {
    model_.states[state++].initial = position[axis];
    model_.states[state++].initial = velocity[axis];
  }
  const bool plane = world_.dimension == 2;
  for (std::size_t k = 0; k < (plane ? 1 : 4); ++k) model_.states[state++].initial = turn.orientation[k];
  for (std::size_t k = 0; k < (plane ? 1 : 3); ++k) model_.states[state++].initial = turn.spin[k];
}

void Checker::make_body(BodyText& body) {
  const std::size_t number = world_.made.bodies.size();
  world_.made.bodies.emplace_back();
  if (!body.text) {  // of a pattern
    world_.made.bodies.back().name = body.name;
    world_.made.bodies.back().first_state = bases_[body.base].first;
    return;
  }
  const ast::WorldAttributes& attributes = body.text->attributes;
  BodyDescription made = description_of(attributes, body.scope);
  made.name = body.name;
  made.first_state = bases_[body.base].first;
  made.span = body.span;
  world_.made.bodies.back() = std::move(made);
  const NodeId zero = model_.graph.constant(0);
  NodePoint position{zero, zero, zero};
  if (const ast::Expression* at = attribute(attributes, "at")) {
    position = world_point(*at, body.scope, world_.length, "a position");
  } else {
    fail("E225", body.span, fmt::format("where is `{}`?", body.name), {}, "add at (0, 0)");
  }
  set_start(number, position, velocity_of(attributes, body.scope), turn_of(attributes, body.scope));
}

void Checker::make_pattern(PatternText& pattern) {
  const ast::WorldAttributes& attributes = pattern.text->attributes;
  BodyDescription shared = description_of(attributes, pattern.scope);
  shared.span = pattern.span;
  for (std::size_t k = 0; k < pattern.count; ++k) {
    BodyDescription& body = world_.made.bodies[pattern.first + k];
    shared.name = std::move(body.name);
    shared.first_state = body.first_state;
    body = shared;
  }
  const NodePoint velocity = velocity_of(attributes, pattern.scope);
  const Turn turn = turn_of(attributes, pattern.scope);
  if (pattern.text->pattern == ast::Pattern::random) return place_random(pattern, velocity, turn);
  if (!attribute(attributes, "from")) {
    fail("E225", pattern.text->name.span, "where does the pattern begin?", {}, "add from (0, 0): its first body");
    return;
  }
  if (pattern.text->pattern == ast::Pattern::grid) return place_grid(pattern, velocity, turn);
  place_stack(pattern, velocity, turn);
}

/// The first axis counts fastest.
void Checker::place_grid(PatternText& pattern, const NodePoint& velocity, const Turn& turn) {
  const ast::WorldAttributes& attributes = pattern.text->attributes;
  Graph& g = model_.graph;
  const NodePoint from = world_point(*attribute(attributes, "from"), pattern.scope, world_.length, "a position");
  const ast::Expression* apart = attribute(attributes, "spacing");
  if (!apart) {
    fail("E225", pattern.text->name.span, "how far apart are the bodies of the grid?", {},
         world_.dimension == 2 ? "add spacing (1, 1)" : "add spacing (1, 1, 1)");
    return;
  }
  const NodePoint spacing = world_point(*apart, pattern.scope, world_.length, "the spacing of a grid");
  NodeId jitter = g.constant(0);
  long seed = 1;
  if (const ast::Expression* text = attribute(attributes, "jitter"))
    jitter = world_number(*text, pattern.scope, world_.length, "the jitter", Sort::not_negative);
  if (const ast::Expression* text = attribute(attributes, "seed"))
    seed = whole_number(*text, pattern.scope, "a seed").value_or(1);
  if (!from[0].valid() || !spacing[0].valid() || !jitter.valid()) return;
  Random random(static_cast<std::uint64_t>(seed));
  std::array<long, 3> counts{1, 1, 1}, at{};
  std::ranges::copy(pattern.counts, counts.begin());
  std::size_t body = pattern.first;
  for (at[2] = 0; at[2] < counts[2]; ++at[2])
    for (at[1] = 0; at[1] < counts[1]; ++at[1])
      for (at[0] = 0; at[0] < counts[0]; ++at[0]) {
        NodePoint position{};
        for (std::size_t axis = 0; axis < world_.axes(); ++axis) {
          const NodeId way = g.multiply(g.constant(static_cast<double>(at[axis])), spacing[axis]);
          const NodeId moved = g.multiply(g.constant(random.between(-1, 1)), jitter);
          position[axis] = g.add(g.add(from[axis], way), moved);
        }
        set_start(body++, position, velocity, turn);
      }
}

/// One on the other, touching.
void Checker::place_stack(PatternText& pattern, const NodePoint& velocity, const Turn& turn) {
  Graph& g = model_.graph;
  const NodePoint from =
      world_point(*attribute(pattern.text->attributes, "from"), pattern.scope, world_.length, "a position");
  const NodeId radius = world_.made.bodies[pattern.first].radius;
  if (!from[0].valid() || !radius.valid()) return;
  for (std::size_t k = 0; k < pattern.count; ++k) {
    NodePoint position = from;
    NodeId& up = position[world_.axes() - 1];
    up = g.add(up, g.multiply(g.constant(2 * static_cast<double>(k)), radius));
    set_start(pattern.first + k, position, velocity, turn);
  }
}

/// Where they fall without touching each other: numbers, so that what they depend on decides the model.
void Checker::place_random(PatternText& pattern, const NodePoint& velocity, const Turn& turn) {
  const ast::WorldAttributes& attributes = pattern.text->attributes;
  Graph& g = model_.graph;
  Scope constant_scope = pattern.scope;
  constant_scope.constant = "a box of bodies at random";
  RandomPlacement wanted{.dimension = world_.axes(), .count = pattern.count};
  const auto corner = [&](const ast::Expression& text, std::array<double, 3>& to) {
    const NodePoint point = world_point(text, constant_scope, world_.length, "the corner of a box");
    for (std::size_t axis = 0; axis < world_.axes(); ++axis) {
      const auto value = point[axis].valid() ? g.value(point[axis]) : std::nullopt;
      if (!value) return false;
      to[axis] = *value;
    }
    return true;
  };
  const bool boxed = corner(*pattern.text->lower, wanted.lower) && corner(*pattern.text->upper, wanted.upper);
  const auto number = [&](std::string_view name, const Measured& measured, double otherwise) {
    const ast::Expression* text = attribute(attributes, name);
    if (!text) return std::optional(otherwise);
    return constant(*text, pattern.scope, measured, fmt::format("the {} of bodies at random", name));
  };
  const auto radius = number("radius", world_.length, 0.5), speed = number("speed", per_time(world_.length), 0);
  const ast::Expression* seed_text = attribute(attributes, "seed");
  const auto seed = seed_text ? whole_number(*seed_text, pattern.scope, "a seed") : std::optional(1L);
  if (!boxed || !radius || !speed || !seed || !(*radius > 0) || !std::isfinite(*radius)) return;
  wanted.radius = *radius;
  Random random(static_cast<std::uint64_t>(*seed));
  const std::vector<std::array<double, 3>> places = place_at_random(wanted, random);
  if (places.size() < pattern.count) {
    fail("E225", pattern.span, fmt::format("there is no place for {} bodies", pattern.count),
         fmt::format("{} found one", places.size()), "take a larger box, fewer or smaller bodies, or a grid");
    return;
  }
  for (std::size_t k = 0; k < pattern.count; ++k) {
    NodePoint position{}, way = velocity;
    const std::array<double, 3> direction = *speed != 0 ? random.direction(world_.axes()) : std::array<double, 3>{};
    for (std::size_t axis = 0; axis < world_.axes(); ++axis) {
      position[axis] = g.constant(places[k][axis]);
      if (velocity[axis].valid()) way[axis] = g.add(velocity[axis], g.constant(*speed * direction[axis]));
    }
    set_start(pattern.first + k, position, way, turn);
  }
}

}  // namespace continuo::model::detail
