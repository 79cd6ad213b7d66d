// continuo/language/check/world/springs.cpp
// Springs between bodies by name, and between the neighbours of a pattern.
#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/check/expressions/indices.hpp>
#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/syntax/format.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

/// The bodies of a pattern that stand side by side along an axis, and along the diagonals if wanted: by number.
std::vector<std::pair<std::size_t, std::size_t>> neighbours(const PatternText& pattern, bool diagonal) {
  std::array<long, 3> counts{1, 1, 1};
  std::ranges::copy(pattern.counts, counts.begin());
  std::vector<std::array<long, 3>> ways{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (diagonal) {
    for (const auto& way : {std::array<long, 3>{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}})
      ways.push_back(way);
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (long i = 0; i < static_cast<long>(pattern.count); ++i) {
    const std::array<long, 3> at{i % counts[0], i / counts[0] % counts[1], i / counts[0] / counts[1]};
    for (const auto& way : ways) {
      const std::array<long, 3> to{at[0] + way[0], at[1] + way[1], at[2] + way[2]};
      bool inside = true;
      for (std::size_t k = 0; k < 3; ++k) inside = inside && to[k] >= 0 && to[k] < counts[k];
      if (!inside) continue;
      pairs.emplace_back(pattern.first + static_cast<std::size_t>(i),
                         pattern.first + static_cast<std::size_t>(to[0] + counts[0] * (to[1] + counts[1] * to[2])));
    }
  }
  return pairs;
}

}  // namespace

std::optional<std::size_t> Checker::body_named(const ast::Name& name, Scope& scope) {
  const auto key = key_of(name, scope);
  if (!key) return std::nullopt;
  const Symbol* symbol = name.primes == 0 && name.member.empty() ? find(*key, Scope::no_mode) : nullptr;
  if (symbol && symbol->kind == Symbol::Kind::body) return symbol->index;
  const auto family = families_.find(name.text);
  if (family != families_.end() && family->second.kind == Symbol::Kind::body && !symbol && name.member.empty()) {
    unknown_name(name, *key);  // the index is wrong, or missing
    return std::nullopt;
  }
  if (lost_.contains(name.text)) return std::nullopt;
  std::vector<std::string> names;
  for (const BodyText& body : world_.bodies) names.push_back(body.name);
  const std::string near = did_you_mean(*key, names);
  fail("E223", name.span, fmt::format("there is no body `{}`", to_text(name)), {},
       !near.empty()   ? near
       : names.empty() ? fmt::format("the model has no world: world {{ body {} at (0, 0) }}", name.text)
                       : "the bodies are " + listed(names));
  return std::nullopt;
}

void Checker::add_spring(SpringDescription spring, const ast::WorldAttributes& attributes, Scope& scope) {
  Graph& g = model_.graph;
  const Measured stiffness = per_time(world_.mass, 2);
  const auto *k = attribute(attributes, "stiffness"), *length = attribute(attributes, "length"),
             *damping = attribute(attributes, "damping");
  if (!k) {
    fail("E225", spring.span, "a spring needs its stiffness", {}, "add stiffness 40");
    return;
  }
  spring.stiffness = world_number(*k, scope, stiffness, "the stiffness", Sort::not_negative);
  spring.damping =
      damping ? world_number(*damping, scope, per_time(world_.mass), "the damping", Sort::not_negative) : g.constant(0);
  if (length) {
    spring.length = world_number(*length, scope, world_.length, "the length of a spring", Sort::not_negative);
  } else {  // as long as it is at the start
    const std::size_t a = world_.made.bodies[spring.a].first_state;
    for (std::size_t axis = 0; axis < world_.axes(); ++axis) {
      const NodeId from = model_.states[a + 2 * axis].initial;
      const NodeId to = spring.b == no_body
                            ? spring.point[axis]
                            : model_.states[world_.made.bodies[spring.b].first_state + 2 * axis].initial;
      if (!from.valid() || !to.valid()) return;
      const NodeId apart = g.subtract(to, from);
      spring.length =
          spring.length.valid() ? g.apply(Op::hypotenuse, spring.length, apart) : g.apply(Op::absolute, apart);
    }
  }
  world_.made.springs.push_back(spring);
}

void Checker::read_spring(const ast::WorldSpring& text, Scope& scope, Span span) {
  SpringDescription spring{
      .a = no_body, .b = no_body, .point = {}, .stiffness = {}, .length = {}, .damping = {}, .span = span};
  const auto a = body_named(text.a, scope);
  if (const auto* name = std::get_if<ast::Name>(&text.b)) {
    const auto b = body_named(*name, scope);
    if (!a || !b) return;
    spring.b = *b;
    if (*a == *b) {
      fail("E225", span, "a spring has two ends", "both are the same body");
      return;
    }
  } else {
    spring.point = world_point(std::get<ast::Expression>(text.b), scope, world_.length, "the end of a spring");
    if (!a || !spring.point[0].valid()) return;
  }
  spring.a = *a;
  add_spring(spring, text.attributes, scope);
}

/// Between neighbours along each axis of a grid, or one and the next of a stack.
void Checker::read_springs(const ast::WorldSprings& text, Scope& scope, Span span) {
  const auto pattern =
      std::ranges::find(world_.patterns, text.pattern.text, [](const PatternText& p) { return p.text->name.text; });
  if (pattern == world_.patterns.end()) {
    if (lost_.contains(text.pattern.text)) return;
    std::vector<std::string> names;
    for (const PatternText& known : world_.patterns) names.push_back(known.text->name.text);
    const std::string near = did_you_mean(text.pattern.text, names);
    fail("E223", text.pattern.span, fmt::format("there are no bodies `{}` of a pattern", text.pattern.text), {},
         near.empty() ? "between single bodies write spring a to b" : near);
    return;
  }
  if (pattern->text->pattern == ast::Pattern::random) {
    fail("E225", text.pattern.span, "bodies at random have no neighbours", {},
         "write each spring: spring a[1] to a[2]");
    return;
  }
  const bool diagonal = attribute(text.attributes, "diagonal") != nullptr;
  const ast::Expression* length = attribute(text.attributes, "length");
  if (diagonal && length) {
    fail("E225", length->span, "diagonal springs are longer than the others", {},
         "leave `length` out: each is as long as the distance at the start");
    return;
  }
  for (const auto& [a, b] : neighbours(*pattern, diagonal)) {
    add_spring({.a = a, .b = b, .point = {}, .stiffness = {}, .length = {}, .damping = {}, .span = span},
               text.attributes, scope);
  }
}

}  // namespace continuo::model::detail
