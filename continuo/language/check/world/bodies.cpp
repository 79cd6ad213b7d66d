// continuo/language/check/world/bodies.cpp
// Bodies, their turns and starts, and the places of grids, stacks and bodies at random.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/bodies.hpp>
#include <continuo/language/check/world/characters.hpp>
#include <continuo/language/check/world/materials.hpp>
#include <continuo/language/check/world/placement.hpp>

namespace continuo::model::detail {

void Bodies::make() {
  find_parts();
  for (const BodyText& body : text_.bodies) make_body(body);
  for (const PatternText& pattern : text_.patterns) make_pattern(pattern);
}

std::uint32_t Bodies::group_of(const ast::WorldAttributes& attributes) {
  const ast::Expression* text = attribute(attributes, "group");
  if (!text) return 0;
  const std::string& name = std::get<ast::Name>(text->node).text;
  const auto known = std::ranges::find(work_.groups, name);
  if (known != work_.groups.end()) return static_cast<std::uint32_t>(known - work_.groups.begin());
  report_.warn("E293", text->span, fmt::format("nothing ignores the group `{}`", name), {},
               fmt::format("write ignore {} with NAME, or leave `group` out", name));
  return 0;
}

BodyDescription Bodies::description_of(const ast::WorldAttributes& attributes, const MadeShape& made, Scope& scope) {
  BodyDescription body;
  body.shape = made.shape;
  body.radius = made.radius;
  body.material = material_of(attributes, scope, work_, numbers_);
  body.driven = attribute(attributes, "driven") != nullptr;
  body.fixed = body.driven || attribute(attributes, "fixed") != nullptr;
  body.group = group_of(attributes);
  const auto *mass = attribute(attributes, "mass"), *density = attribute(attributes, "density");
  if (mass && density) {
    report_.fail("E225", density->span, "a body has a mass or a density", "both are given");
  } else if (mass) {
    body.mass = numbers_.number(*mass, scope, work_.mass, "the mass", Sort::positive);
  } else if (made.volume.valid()) {
    Measured wanted = work_.mass;
    for (std::size_t axis = 0; axis < text_.axes(); ++axis) wanted = quotient(wanted, work_.length);
    body.density =
        density ? numbers_.number(*density, scope, wanted, "the density", Sort::positive) : graph_.constant(1);
    if (body.density.valid()) body.mass = graph_.multiply(body.density, made.volume);
  }
  return body;
}

NodePoint Bodies::velocity_of(const ast::WorldAttributes& attributes, Scope& scope) {
  if (const ast::Expression* text = attribute(attributes, "velocity"))
    return numbers_.point(*text, scope, expressions_.workspace.time.per_time(work_.length), "a velocity");
  const NodeId zero = graph_.constant(0);
  return {zero, zero, zero};
}

void Bodies::set_start(std::size_t body, const NodePoint& position, const NodePoint& velocity, const Turn& turn) {
  std::size_t state = expressions_.workspace.declared.bases[text_.bodies[body].base].first;
  for (std::size_t axis = 0; axis < text_.axes(); ++axis) {
    states_[state++].initial = position[axis];
    states_[state++].initial = velocity[axis];
  }
  const bool plane = text_.dimension == 2;
  for (std::size_t k = 0; k < (plane ? 1 : 4); ++k) states_[state++].initial = turn.orientation[k];
  for (std::size_t k = 0; k < (plane ? 1 : 3); ++k) states_[state++].initial = turn.spin[k];
}

void Bodies::make_body(const BodyText& body) {
  Scope scope = body.scope;
  const std::size_t number = work_.made.bodies.size();
  work_.made.bodies.emplace_back();
  if (!body.text) {  // of a pattern
    work_.made.bodies.back().name = body.name;
    work_.made.bodies.back().first_state = expressions_.workspace.declared.bases[body.base].first;
    return;
  }
  const ast::WorldAttributes& attributes = body.text->attributes;
  const auto parts = parts_.find(number);
  const MadeShape shape = body.is_character()     ? Characters(expressions_, work_).make(number, scope)
                          : parts != parts_.end() ? make_compound(body, parts->second)
                                                  : shapes_.make(attributes, scope);
  BodyDescription made = description_of(attributes, shape, scope);
  made.traits = traits_of(attributes, scope);
  made.character = body.is_character();
  if (made.character) made.fixed = made.driven = made.traits.sensor = true;
  made.name = body.name;
  made.first_state = expressions_.workspace.declared.bases[body.base].first;
  made.span = body.span;
  work_.made.bodies.back() = std::move(made);
  const NodeId zero = graph_.constant(0);
  NodePoint position{zero, zero, zero};
  if (const ast::Expression* at = attribute(attributes, "at")) {
    position = numbers_.point(*at, scope, work_.length, "a position");
  } else if (shape.shape.kind != ShapeDescription::Kind::hull && shape.shape.kind != ShapeDescription::Kind::compound) {
    report_.fail("E225", body.span, fmt::format("where is `{}`?", body.name), {}, "add at (0, 0)");
  }
  const Turn turn = turns_.turn_of(attributes, scope);
  if (shape.centre != std::array<double, 3>{} &&
      turn.orientation[0].valid()) {  // the corners of a hull, and parts, are where `at` is the origin
    const auto& [x, y, z] = shape.centre;
    const NodePoint centre =
        turned(graph_, {graph_.constant(x), graph_.constant(y), graph_.constant(z)}, turn.orientation, text_.dimension);
    for (std::size_t axis = 0; axis < text_.axes() && position[axis].valid() && centre[axis].valid(); ++axis)
      position[axis] = graph_.add(position[axis], centre[axis]);
  }
  set_start(number, position, velocity_of(attributes, scope), turn);
}

void Bodies::make_pattern(const PatternText& pattern) {
  Scope scope = pattern.scope;
  const ast::WorldAttributes& attributes = pattern.text->attributes;
  const MadeShape shape = shapes_.make(attributes, scope);
  BodyDescription shared = description_of(attributes, shape, scope);
  shared.traits = traits_of(attributes, scope);
  shared.span = pattern.span;
  for (std::size_t k = 0; k < pattern.count; ++k) {
    BodyDescription& body = work_.made.bodies[pattern.first + k];
    shared.name = std::move(body.name);
    shared.first_state = body.first_state;
    body = shared;
  }
  const NodePoint velocity = velocity_of(attributes, scope);
  const Turn turn = turns_.turn_of(attributes, scope);
  if (pattern.text->pattern == ast::Pattern::random) return place_random(pattern, velocity, turn);
  if (!attribute(attributes, "from")) {
    report_.fail("E225", pattern.text->name.span, "where does the pattern begin?", {},
                 "add from (0, 0): its first body");
    return;
  }
  if (pattern.text->pattern == ast::Pattern::grid) return place_grid(pattern, velocity, turn);
  place_stack(pattern, shape.height, velocity, turn);
}

/// The first axis counts fastest.
void Bodies::place_grid(const PatternText& pattern, const NodePoint& velocity, const Turn& turn) {
  Scope scope = pattern.scope;
  const ast::WorldAttributes& attributes = pattern.text->attributes;
  Graph& g = graph_;
  const NodePoint from = numbers_.point(*attribute(attributes, "from"), scope, work_.length, "a position");
  const ast::Expression* apart = attribute(attributes, "spacing");
  if (!apart) {
    report_.fail("E225", pattern.text->name.span, "how far apart are the bodies of the grid?", {},
                 text_.dimension == 2 ? "add spacing (1, 1)" : "add spacing (1, 1, 1)");
    return;
  }
  const NodePoint spacing = numbers_.point(*apart, scope, work_.length, "the spacing of a grid");
  NodeId jitter = g.constant(0);
  long seed = 1;
  if (const ast::Expression* text = attribute(attributes, "jitter"))
    jitter = numbers_.number(*text, scope, work_.length, "the jitter", Sort::not_negative);
  if (const ast::Expression* text = attribute(attributes, "seed"))
    seed = expressions_.indices.whole_number(*text, scope, "a seed").value_or(1);
  if (!from[0].valid() || !spacing[0].valid() || !jitter.valid()) return;
  Random random(static_cast<std::uint64_t>(seed));
  std::array<long, 3> counts{1, 1, 1}, at{};
  std::ranges::copy(pattern.counts, counts.begin());
  std::size_t body = pattern.first;
  for (at[2] = 0; at[2] < counts[2]; ++at[2])
    for (at[1] = 0; at[1] < counts[1]; ++at[1])
      for (at[0] = 0; at[0] < counts[0]; ++at[0]) {
        NodePoint position{};
        for (std::size_t axis = 0; axis < text_.axes(); ++axis) {
          const NodeId way = g.multiply(g.constant(static_cast<double>(at[axis])), spacing[axis]);
          const NodeId moved = g.multiply(g.constant(random.between(-1, 1)), jitter);
          position[axis] = g.add(g.add(from[axis], way), moved);
        }
        set_start(body++, position, velocity, turn);
      }
}

/// One on the other, touching.
void Bodies::place_stack(const PatternText& pattern, NodeId height, const NodePoint& velocity, const Turn& turn) {
  Scope scope = pattern.scope;
  Graph& g = graph_;
  const NodePoint from =
      numbers_.point(*attribute(pattern.text->attributes, "from"), scope, work_.length, "a position");
  if (!from[0].valid() || !height.valid()) return;
  for (std::size_t k = 0; k < pattern.count; ++k) {
    NodePoint position = from;
    NodeId& up = position[text_.axes() - 1];
    up = g.add(up, g.multiply(g.constant(static_cast<double>(k)), height));
    set_start(pattern.first + k, position, velocity, turn);
  }
}

/// Where they fall without touching each other: numbers, so that what they depend on decides the model.
void Bodies::place_random(const PatternText& pattern, const NodePoint& velocity, const Turn& turn) {
  const ast::WorldAttributes& attributes = pattern.text->attributes;
  Graph& g = graph_;
  Scope scope = pattern.scope, constant_scope = scope;
  constant_scope.constant = "a box of bodies at random";
  RandomPlacement wanted{.dimension = text_.axes(), .count = pattern.count};
  const auto corner = [&](const ast::Expression& text, std::array<double, 3>& to) {
    const NodePoint point = numbers_.point(text, constant_scope, work_.length, "the corner of a box");
    for (std::size_t axis = 0; axis < text_.axes(); ++axis) {
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
    return expressions_.values.constant(*text, scope, measured, fmt::format("the {} of bodies at random", name));
  };
  const auto radius = number("radius", work_.length, 0.5),
             speed = number("speed", expressions_.workspace.time.per_time(work_.length), 0);
  const ast::Expression* seed_text = attribute(attributes, "seed");
  const auto seed = seed_text ? expressions_.indices.whole_number(*seed_text, scope, "a seed") : std::optional(1L);
  if (!boxed || !radius || !speed || !seed || !(*radius > 0) || !std::isfinite(*radius)) return;
  wanted.radius = *radius;
  Random random(static_cast<std::uint64_t>(*seed));
  const std::vector<std::array<double, 3>> places = place_at_random(wanted, random);
  if (places.size() < pattern.count) {
    report_.fail("E225", pattern.span, fmt::format("there is no place for {} bodies", pattern.count),
                 fmt::format("{} found one", places.size()), "take a larger box, fewer or smaller bodies, or a grid");
    return;
  }
  for (std::size_t k = 0; k < pattern.count; ++k) {
    NodePoint position{}, way = velocity;
    const std::array<double, 3> direction = *speed != 0 ? random.direction(text_.axes()) : std::array<double, 3>{};
    for (std::size_t axis = 0; axis < text_.axes(); ++axis) {
      position[axis] = g.constant(places[k][axis]);
      if (velocity[axis].valid()) way[axis] = g.add(velocity[axis], g.constant(*speed * direction[axis]));
    }
    set_start(pattern.first + k, position, way, turn);
  }
}

}  // namespace continuo::model::detail
