// continuo/language/check/world/queries.cpp
// `ray(car, (1, 0), 5)`. They are written out body by body, and so stand wherever expressions do: in outputs,
// conditions of events, forces, checks.
#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include <continuo/language/check/expressions/indices.hpp>
#include <continuo/language/check/world/attributes.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

/// Behind its first arguments stand the things that are looked at; without them it is everything else.
struct Query {
  std::string_view name;
  std::size_t first;
  std::string_view example;
};
constexpr std::array<Query, 3> queries = {{
    {"distance", 1, "distance(ball, floor), or distance(ball) to whatever is nearest"},
    {"within", 2, "within(ball, 0.5): how many others are no further away"},
    {"ray", 3, "ray(car, (1, 0), 5): from where, in which direction, how far at most"},
}};

}  // namespace

bool Checker::asks_the_world(const ast::Name& callee, const Scope& scope) const {
  return callee.primes == 0 && callee.indices.empty() && callee.member.empty() &&
         std::ranges::find(queries, callee.text, &Query::name) != queries.end() && !find(callee.text, scope.mode) &&
         !families_.contains(callee.text);
}

Value Checker::query(const ast::Call& node, Span span, Scope& scope) {
  const Query& query = *std::ranges::find(queries, node.callee.text, &Query::name);
  if (scope.is_constant()) return not_constant(span, node.callee.text, scope);
  if (!world_.is_made) {
    fail("E224", span, fmt::format("`{}` asks where bodies are", query.name),
         world_.text ? "they are not known here yet" : "the model has no world",
         world_.text ? "parameters, the world and initial values come before them"
                     : "write one: world { body ball at (0, 10) }");
    return bad();
  }
  if (node.arguments.size() < query.first) {
    fail("E216", span, fmt::format("`{}` needs more to go by", query.name), {}, fmt::format("as in {}", query.example));
    return bad();
  }
  const auto pairs = pairs_of(node, query.first, span, scope);
  return !pairs                   ? bad()
         : query.name == "ray"    ? cast_ray(*pairs, node, scope)
         : query.name == "within" ? count_within(*pairs, node, scope)
                                  : least_gap(*pairs);
}

std::optional<Pairs> Checker::pairs_of(const ast::Call& node, std::size_t first, Span span, Scope& scope) {
  const ast::Expression& asking = node.arguments[0];
  const auto from = things(asking, scope);
  if (!from) return std::nullopt;
  if (from->front().is_wall()) {
    fail("E225", asking.span, "a body or a point stands first", "this is a wall");
    return std::nullopt;
  }
  std::vector<Thing> to;
  for (std::size_t i = first; i < node.arguments.size(); ++i) {
    const auto some = things(node.arguments[i], scope);
    if (!some) return std::nullopt;
    to.insert(to.end(), some->begin(), some->end());
  }
  if (node.arguments.size() == first) {
    for (std::size_t i = 0; i < world_.bodies.size(); ++i) to.push_back(thing_of(i));
    for (std::size_t w = 0; w < world_.made.walls.size(); ++w) to.push_back({.wall = w});
  }
  Pairs pairs;
  for (const Thing& a : *from) {
    for (const Thing& b : to) {
      if (a.body != no_body && a.body == b.body) continue;
      if (!count_written_out(span)) return std::nullopt;
      pairs.emplace_back(a, b);
    }
  }
  if (!pairs.empty()) return pairs;
  fail("E225", span, "there is nothing to look at", "a body does not look at itself",
       "name another body, a wall or a point");
  return std::nullopt;
}

std::optional<std::vector<Thing>> Checker::things(const ast::Expression& text, Scope& scope) {
  if (const auto* name = std::get_if<ast::Name>(&text.node)) return things_named(*name, scope);
  if (is_point(text)) {
    const NodePoint point = world_point(text, scope, world_.length, "a point", false);
    return point[0].valid() ? std::optional(std::vector<Thing>{{.point = point}}) : std::nullopt;
  }
  fail("E225", text.span, "a body, a wall or a point stands here", fmt::format("{} is none", quote(text.span)),
       world_.dimension == 2 ? "a point is written (1, 2)" : "a point is written (1, 2, 3)");
  return std::nullopt;
}

/// A body, all bodies of a family, a wall, all walls of a container.
std::optional<std::vector<Thing>> Checker::things_named(const ast::Name& name, Scope& scope) {
  const bool is_word = name.primes == 0 && name.member.empty() && name.indices.empty();
  std::vector<Thing> found;
  if (is_word) {
    const auto family = families_.find(name.text);
    if (family != families_.end() && family->second.kind == Symbol::Kind::body) {
      const std::string begin = name.text + "[";
      for (std::size_t i = 0; i < world_.bodies.size(); ++i)
        if (world_.bodies[i].name.starts_with(begin)) found.push_back(thing_of(i));
    }
    const Symbol* symbol = find(name.text, Scope::no_mode);
    if (!symbol || symbol->kind != Symbol::Kind::body) {
      for (std::size_t w = 0; w < world_.made.walls.size(); ++w)
        if (world_.made.walls[w].name == name.text) found.push_back({.wall = w});
    }
  }
  if (!found.empty()) return found;
  std::vector<std::string> walls;
  for (const WallDescription& wall : world_.made.walls) walls.push_back(wall.name);
  const std::string near = is_word && !find(name.text, Scope::no_mode) ? did_you_mean(name.text, walls) : std::string();
  if (!near.empty()) {
    fail("E223", name.span, fmt::format("there is no wall `{}`", name.text), {}, near);
    return std::nullopt;
  }
  const auto body = body_named(name, scope);
  return body ? std::optional(std::vector<Thing>{thing_of(*body)}) : std::nullopt;
}

Thing Checker::thing_of(std::size_t body) {
  Thing thing{.body = body};
  const auto first = model_.layout.states + static_cast<std::uint32_t>(world_.made.bodies[body].first_state);
  for (std::size_t axis = 0; axis < world_.axes(); ++axis)
    thing.point[axis] = model_.graph.variable(first + 2 * static_cast<std::uint32_t>(axis));
  return thing;
}

Value Checker::least_gap(const Pairs& pairs) {
  NodeId least{};
  for (const auto& [a, b] : pairs) {
    const NodeId gap = gap_between(a, b);
    least = least.valid() ? model_.graph.apply(Op::minimum, least, gap) : gap;
  }
  return {least, world_.length};
}

Value Checker::count_within(const Pairs& pairs, const ast::Call& node, Scope& scope) {
  Graph& g = model_.graph;
  const NodeId reach = length_in(node.arguments[1], scope, "a distance");
  if (!reach.valid()) return bad();
  NodeId count = g.constant(0);
  for (const auto& [a, b] : pairs)
    count = g.add(count, g.select(g.less_equal(gap_between(a, b), reach), g.constant(1), g.constant(0)));
  return {count, Measured::known(Unit())};
}

/// How far it is to the first surface in a direction; the reach where none is nearer.
Value Checker::cast_ray(const Pairs& pairs, const ast::Call& node, Scope& scope) {
  Graph& g = model_.graph;
  const Thing& from = pairs.front().first;
  const bool is_one = std::ranges::all_of(
      pairs, [&](const auto& pair) { return pair.first.body == from.body && pair.first.point == from.point; });
  const ast::Expression& text = node.arguments[1];
  if (!is_one) {
    fail("E225", node.arguments[0].span, "a ray begins at one body or point", "these are several");
    return bad();
  }
  if (!is_point(text)) {
    fail("E225", text.span, "a ray has a direction", fmt::format("{} is none", quote(text.span)),
         world_.dimension == 2 ? "of any length, as in (cos(a), sin(a))" : "of any length, as in (0, 0, -1)");
    return bad();
  }
  const NodePoint towards =
      world_point(text, scope, measure_of_direction(text, scope), "the direction of a ray", false);
  const NodeId reach = length_in(node.arguments[2], scope, "the reach of a ray");
  if (!towards[0].valid() || !reach.valid()) return bad();
  // A direction of length 0 is none: what is met is what the ray starts in.
  const NodeId size = g.apply(Op::maximum, length_of(towards), g.constant(std::numeric_limits<double>::min()));
  NodePoint direction{};
  for (std::size_t axis = 0; axis < world_.axes(); ++axis) direction[axis] = g.divide(towards[axis], size);
  NodeId nearest = reach;
  for (const auto& [a, b] : pairs) {
    const NodeId way = b.is_wall() ? way_to_wall(world_.made.walls[b.wall], a.point, direction, reach)
                                   : way_to_body(b, from_to(a.point, b.point), direction, reach);
    nearest = g.apply(Op::minimum, nearest, way);
  }
  return {nearest, world_.length};
}

/// The unit of its first component that has one.
Measured Checker::measure_of_direction(const ast::Expression& text, Scope& scope) {
  const bool outer = std::exchange(silent_, true);
  const std::vector<Term> terms = components(text, scope, world_.axes());
  silent_ = outer;
  const auto known = std::ranges::find_if(terms, [](const Term& term) { return term.value.measured.is_known(); });
  return known == terms.end() ? Measured::unknown() : known->value.measured;
}

/// Between surfaces; below 0 where they overlap.
NodeId Checker::gap_between(const Thing& a, const Thing& b) {
  Graph& g = model_.graph;
  NodeId gap;
  if (b.is_wall()) {
    const WallDescription& wall = world_.made.walls[b.wall];
    gap = g.divide(g.subtract(inner_product(wall.normal, a.point), wall.offset), length_of(wall.normal));
    if (wall.thin) gap = g.apply(Op::absolute, gap);
  } else {
    gap = length_of(from_to(a.point, b.point));
  }
  for (const Thing* thing : {&a, &b})
    if (thing->body != no_body) gap = g.subtract(gap, world_.made.bodies[thing->body].radius);
  return gap;
}

/// A ray along the unit vector d from 0 enters the sphere of radius r round c at s - w and leaves it at s + w, where
/// s = c.d and w^2 = r^2 - |c - s d|^2; 0 where it starts inside. A point has no size: no ray meets it.
NodeId Checker::way_to_body(const Thing& body, const NodePoint& centre, const NodePoint& d, NodeId reach) {
  Graph& g = model_.graph;
  if (body.body == no_body) return reach;
  const NodeId radius = world_.made.bodies[body.body].radius, along = inner_product(centre, d), zero = g.constant(0);
  NodePoint across{};
  for (std::size_t axis = 0; axis < world_.axes(); ++axis)
    across[axis] = g.subtract(centre[axis], g.multiply(along, d[axis]));
  const NodeId square = g.subtract(g.multiply(radius, radius), inner_product(across, across));
  const NodeId width = g.apply(Op::square_root, g.apply(Op::maximum, square, zero));
  const NodeId is_met = g.apply(Op::logical_and, g.less_equal(zero, square), g.less_equal(zero, g.add(along, width)));
  return g.select(is_met, g.apply(Op::maximum, g.subtract(along, width), zero), reach);
}

/// From the height h before a wall, at the rate f towards it: h/f; 0 from behind it. Before a thin one is where the ray
/// starts.
NodeId Checker::way_to_wall(const WallDescription& wall, const NodePoint& from, const NodePoint& d, NodeId reach) {
  Graph& g = model_.graph;
  const NodeId zero = g.constant(0);
  NodeId height = g.subtract(inner_product(wall.normal, from), wall.offset);
  NodeId rate = g.negate(inner_product(wall.normal, d));
  if (wall.thin) {
    rate = g.select(g.less(height, zero), g.negate(rate), rate);
    height = g.apply(Op::absolute, height);
  }
  const NodeId comes = g.less(zero, rate);
  const NodeId way = g.select(comes, g.divide(height, g.select(comes, rate, g.constant(1))), reach);
  return g.select(g.less_equal(height, zero), zero, way);
}

NodeId Checker::length_in(const ast::Expression& text, Scope& scope, std::string_view what) {
  const Value value = number_of(text, scope);
  return value.bad ? NodeId{} : in_unit(text, value, world_.length, what);
}

NodeId Checker::length_of(const NodePoint& v) {
  Graph& g = model_.graph;
  const NodeId length = g.apply(Op::hypotenuse, v[0], v[1]);
  return world_.dimension == 2 ? length : g.apply(Op::hypotenuse, length, v[2]);
}
NodeId Checker::inner_product(const NodePoint& v, const NodePoint& w) {
  Graph& g = model_.graph;
  NodeId sum = g.multiply(v[0], w[0]);
  for (std::size_t axis = 1; axis < world_.axes(); ++axis) sum = g.add(sum, g.multiply(v[axis], w[axis]));
  return sum;
}
NodePoint Checker::from_to(const NodePoint& from, const NodePoint& to) {
  NodePoint difference{};
  for (std::size_t axis = 0; axis < world_.axes(); ++axis)
    difference[axis] = model_.graph.subtract(to[axis], from[axis]);
  return difference;
}

}  // namespace continuo::model::detail
