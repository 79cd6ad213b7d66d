// continuo/language/check/world/queries.cpp
// What a query is about is found first, then the nodes of its gaps or ways are joined.
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/body_names.hpp>
#include <continuo/language/check/world/queries.hpp>
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

bool is_query(std::string_view name) {
  return std::ranges::find(queries, name, &Query::name) != queries.end();
}

Value Queries::query(const ast::Call& node, Span span, Scope& scope) const {
  const Query& query = *std::ranges::find(queries, node.callee.text, &Query::name);
  if (scope.is_constant()) return expressions_.lookup.not_constant(span, node.callee.text, scope);
  if (work_.stage != Stage::made) {
    report_.fail("E224", span, fmt::format("`{}` asks where bodies are", query.name),
                 text_.text ? "they are not known here yet" : "the model has no world",
                 text_.text ? "parameters, the world and initial values come before them"
                            : "write one: world { body ball at (0, 10) }");
    return expressions_.operations.bad();
  }
  if (node.arguments.size() < query.first) {
    report_.fail("E216", span, fmt::format("`{}` needs more to go by", query.name), {},
                 fmt::format("as in {}", query.example));
    return expressions_.operations.bad();
  }
  const auto pairs = pairs_of(node, query.first, span, scope);
  return !pairs                   ? expressions_.operations.bad()
         : query.name == "ray"    ? cast_ray(*pairs, node, scope)
         : query.name == "within" ? count_within(*pairs, node, scope)
                                  : least_gap(*pairs);
}

std::optional<Queries::ThingPairs> Queries::pairs_of(const ast::Call& node, std::size_t first, Span span,
                                                     Scope& scope) const {
  const ast::Expression& asking = node.arguments[0];
  const auto from = things(asking, scope);
  if (!from) return std::nullopt;
  if (from->front().is_wall() || from->front().is_mesh()) {
    report_.fail("E225", asking.span, "a body or a point stands first", "this is a wall");
    return std::nullopt;
  }
  std::vector<Thing> to;
  for (std::size_t i = first; i < node.arguments.size(); ++i) {
    const auto some = things(node.arguments[i], scope);
    if (!some) return std::nullopt;
    to.insert(to.end(), some->begin(), some->end());
  }
  if (node.arguments.size() == first) {
    for (std::size_t i = 0; i < text_.bodies.size(); ++i) to.push_back(thing_of(i));
    for (std::size_t w = 0; w < work_.made.walls.size(); ++w) to.push_back({.wall = w});
    for (std::size_t m = 0; m < work_.made.meshes.size(); ++m) to.push_back({.mesh = m});
  }
  if (node.callee.text == "ray" && !replace_by_facets(to, span)) return std::nullopt;
  for (const std::vector<Thing>* things : {&*from, &std::as_const(to)})
    if (!are_balls(*things, node.callee.text, span)) return std::nullopt;
  ThingPairs pairs;
  for (const Thing& a : *from) {
    for (const Thing& b : to) {
      if (a.body != no_body && a.body == b.body) continue;
      if (!expressions_.indices.count_written_out(span)) return std::nullopt;
      pairs.emplace_back(a, b);
    }
  }
  if (!pairs.empty()) return pairs;
  report_.fail("E225", span, "there is nothing to look at", "a body does not look at itself",
               "name another body, a wall or a point");
  return std::nullopt;
}

/// A ray meets the facets of meshes; E225 where these are too many to be written out.
bool Queries::replace_by_facets(std::vector<Thing>& things, Span span) const {
  constexpr std::size_t most = 10'000;
  std::vector<Thing> replaced;
  for (const Thing& thing : things) {
    if (!thing.is_mesh()) {
      replaced.push_back(thing);
      continue;
    }
    const MeshDescription& mesh = work_.made.meshes[thing.mesh];
    if (std::max({mesh.points.size(), mesh.corners.size(), mesh.triangles.size()}) > most) {
      report_.fail("E225", span, fmt::format("a ray looks at {} facets of a mesh at most", most),
                   fmt::format("`{}` has more", mesh.name),
                   "name what it looks at, as in ray(car, (1, 0), 5, wall), or a coarser mesh");
      return false;
    }
    const std::vector<Thing> facets = lines_.facets_of(thing.mesh);
    if (facets.empty()) return false;  // its file could not be read, which is said
    replaced.insert(replaced.end(), facets.begin(), facets.end());
  }
  things = std::move(replaced);
  return true;
}

/// E225 where a surface is meant that has no formula here.
bool Queries::are_balls(const std::vector<Thing>& things, std::string_view query, Span span) const {
  const bool is_ray = query == "ray";
  const auto other = std::ranges::find_if(things, [&](const Thing& thing) {
    if (thing.is_mesh()) return !is_ray;
    return thing.body != no_body && work_.made.bodies[thing.body].shape.kind != ShapeDescription::Kind::ball;
  });
  if (other == things.end()) return true;
  const std::string& name =
      other->is_mesh() ? work_.made.meshes[other->mesh].name : work_.made.bodies[other->body].name;
  report_.fail("E225", span, fmt::format("`{}` knows balls, walls{} and points", query, is_ray ? ", meshes" : ""),
               fmt::format("`{}` is none of these", name),
               other->is_mesh() ? "name the balls and walls that are meant, or cast a ray"
                                : "name the balls that are meant, or a point of the body");
  return false;
}

std::optional<std::vector<Thing>> Queries::things(const ast::Expression& text, Scope& scope) const {
  if (const auto* name = std::get_if<ast::Name>(&text.node)) return things_named(*name, scope);
  if (is_point(text)) {
    const NodePoint point = numbers_.point(text, scope, work_.length, "a point", false);
    return point[0].valid() ? std::optional(std::vector<Thing>{{.point = point}}) : std::nullopt;
  }
  report_.fail("E225", text.span, "a body, a wall or a point stands here",
               fmt::format("{} is none", report_.quote(text.span)),
               text_.dimension == 2 ? "a point is written (1, 2)" : "a point is written (1, 2, 3)");
  return std::nullopt;
}

/// A body, all bodies of a family, a wall, all walls of a container.
std::optional<std::vector<Thing>> Queries::things_named(const ast::Name& name, Scope& scope) const {
  const bool is_word = name.primes == 0 && name.member.empty() && name.indices.empty();
  std::vector<Thing> found;
  if (is_word) {
    if (expressions_.workspace.declared.symbols.is_family_of_bodies(name.text)) {
      const std::string begin = name.text + "[";
      for (std::size_t i = 0; i < text_.bodies.size(); ++i)
        if (text_.bodies[i].name.starts_with(begin)) found.push_back(thing_of(i));
    }
    const Symbol* symbol = expressions_.workspace.declared.symbols.find({name.text}, Scope::no_mode);
    if (!symbol || symbol->kind != Symbol::Kind::body) {
      for (std::size_t w = 0; w < work_.made.walls.size(); ++w)
        if (work_.made.walls[w].name == name.text) found.push_back({.wall = w});
      for (std::size_t m = 0; m < work_.made.meshes.size(); ++m)
        if (work_.made.meshes[m].name == name.text) found.push_back({.mesh = m});
    }
  }
  if (!found.empty()) return found;
  std::vector<std::string> walls;
  for (const WallDescription& wall : work_.made.walls) walls.push_back(wall.name);
  for (const MeshDescription& mesh : work_.made.meshes) walls.push_back(mesh.name);
  const std::string near = is_word && !expressions_.workspace.declared.symbols.find({name.text}, Scope::no_mode)
                               ? did_you_mean(name.text, walls)
                               : std::string();
  if (!near.empty()) {
    report_.fail("E223", name.span, fmt::format("there is no wall `{}`", name.text), {}, near);
    return std::nullopt;
  }
  const auto body = body_named(name, scope, expressions_);
  return body ? std::optional(std::vector<Thing>{thing_of(*body)}) : std::nullopt;
}

Thing Queries::thing_of(std::size_t body) const {
  Thing thing{.body = body};
  const auto first =
      expressions_.workspace.layout.states + static_cast<std::uint32_t>(work_.made.bodies[body].first_state);
  for (std::size_t axis = 0; axis < text_.axes(); ++axis)
    thing.point[axis] = graph_.variable(first + 2 * static_cast<std::uint32_t>(axis));
  return thing;
}

Value Queries::least_gap(const ThingPairs& pairs) const {
  NodeId least{};
  for (const auto& [a, b] : pairs) {
    const NodeId gap = lines_.gap_between(a, b);
    least = least.valid() ? graph_.apply(Op::minimum, least, gap) : gap;
  }
  return {least, work_.length};
}

Value Queries::count_within(const ThingPairs& pairs, const ast::Call& node, Scope& scope) const {
  Graph& g = graph_;
  const NodeId reach = length_in(node.arguments[1], scope, "a distance");
  if (!reach.valid()) return expressions_.operations.bad();
  NodeId count = g.constant(0);
  for (const auto& [a, b] : pairs)
    count = g.add(count, g.select(g.less_equal(lines_.gap_between(a, b), reach), g.constant(1), g.constant(0)));
  return {count, Measured::known(Unit())};
}

/// How far it is to the first surface in a direction; the reach where none is nearer.
Value Queries::cast_ray(const ThingPairs& pairs, const ast::Call& node, Scope& scope) const {
  Graph& g = graph_;
  const Thing& from = pairs.front().first;
  const bool is_one = std::ranges::all_of(
      pairs, [&](const auto& pair) { return pair.first.body == from.body && pair.first.point == from.point; });
  const ast::Expression& text = node.arguments[1];
  if (!is_one) {
    report_.fail("E225", node.arguments[0].span, "a ray begins at one body or point", "these are several");
    return expressions_.operations.bad();
  }
  if (!is_point(text)) {
    report_.fail("E225", text.span, "a ray has a direction", fmt::format("{} is none", report_.quote(text.span)),
                 text_.dimension == 2 ? "of any length, as in (cos(a), sin(a))" : "of any length, as in (0, 0, -1)");
    return expressions_.operations.bad();
  }
  const NodePoint towards =
      numbers_.point(text, scope, measure_of_direction(text, scope), "the direction of a ray", false);
  const NodeId reach = length_in(node.arguments[2], scope, "the reach of a ray");
  if (!towards[0].valid() || !reach.valid()) return expressions_.operations.bad();
  // A direction of length 0 is none: what is met is what the ray starts in.
  const NodeId size = g.apply(Op::maximum, lines_.length_of(towards), g.constant(std::numeric_limits<double>::min()));
  NodePoint direction{};
  for (std::size_t axis = 0; axis < text_.axes(); ++axis) direction[axis] = g.divide(towards[axis], size);
  NodeId nearest = reach;
  for (const auto& [a, b] : pairs) {
    const NodeId way = lines_.way_to(b, a.point, direction, reach);
    nearest = g.apply(Op::minimum, nearest, way);
  }
  return {nearest, work_.length};
}

/// The unit of its first component that has one.
Measured Queries::measure_of_direction(const ast::Expression& text, const Scope& scope) const {
  Report silent = report_.silent();
  Expressions trial(expressions_.workspace, silent);
  Scope inner = scope;
  const std::vector<Term> terms = WorldNumbers(trial, work_).components(text, inner, text_.axes());
  const auto known = std::ranges::find_if(terms, [](const Term& term) { return term.value.measured.is_known(); });
  return known == terms.end() ? Measured::unknown() : known->value.measured;
}

NodeId Queries::length_in(const ast::Expression& text, Scope& scope, std::string_view what) const {
  const Value value = expressions_.values.number_of(text, scope);
  return value.bad ? NodeId{} : expressions_.operations.in_unit(text, value, work_.length, what);
}

}  // namespace continuo::model::detail
