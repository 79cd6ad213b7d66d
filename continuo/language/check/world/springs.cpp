// continuo/language/check/world/springs.cpp
// A spring has its stiffness, and a length of its own or that at the start.
#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/body_names.hpp>
#include <continuo/language/check/world/springs.hpp>
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

void Springs::add_spring(SpringDescription spring, const ast::WorldAttributes& attributes, Scope& scope) {
  Graph& g = graph_;
  const Measured stiffness = expressions_.workspace.time.per_time(work_.mass, 2);
  const auto *k = attribute(attributes, "stiffness"), *length = attribute(attributes, "length"),
             *damping = attribute(attributes, "damping");
  if (!k) {
    report_.fail("E225", spring.span, "a spring needs its stiffness", {}, "add stiffness 40");
    return;
  }
  spring.stiffness = numbers_.number(*k, scope, stiffness, "the stiffness", Sort::not_negative);
  spring.damping = damping ? numbers_.number(*damping, scope, expressions_.workspace.time.per_time(work_.mass),
                                             "the damping", Sort::not_negative)
                           : g.constant(0);
  if (length) {
    spring.length = numbers_.number(*length, scope, work_.length, "the length of a spring", Sort::not_negative);
  } else {  // as long as it is at the start
    spring.length = length_at_start(spring);
    if (!spring.length.valid()) return;
  }
  work_.made.springs.push_back(spring);
}

NodeId Springs::length_at_start(const SpringDescription& spring) const {
  Graph& g = graph_;
  NodeId length;
  const std::size_t a = work_.made.bodies[spring.a].first_state;
  for (std::size_t axis = 0; axis < text_.axes(); ++axis) {
    const NodeId from = states_[a + 2 * axis].initial;
    const NodeId to =
        spring.b == no_body ? spring.point[axis] : states_[work_.made.bodies[spring.b].first_state + 2 * axis].initial;
    if (!from.valid() || !to.valid()) return {};
    const NodeId apart = g.subtract(to, from);
    length = length.valid() ? g.apply(Op::hypotenuse, length, apart) : g.apply(Op::absolute, apart);
  }
  return length;
}

void Springs::add(const ast::WorldSpring& text, Scope& scope, Span span) {
  SpringDescription spring{
      .a = no_body, .b = no_body, .point = {}, .stiffness = {}, .length = {}, .damping = {}, .span = span};
  const auto a = body_named(text.a, scope, expressions_);
  if (const auto* name = std::get_if<ast::Name>(&text.b)) {
    const auto b = body_named(*name, scope, expressions_);
    if (!a || !b) return;
    spring.b = *b;
    if (*a == *b) {
      report_.fail("E225", span, "a spring has two ends", "both are the same body");
      return;
    }
  } else {
    spring.point = numbers_.point(std::get<ast::Expression>(text.b), scope, work_.length, "the end of a spring");
    if (!a || !spring.point[0].valid()) return;
  }
  spring.a = *a;
  add_spring(spring, text.attributes, scope);
}

/// Between neighbours along each axis of a grid, or one and the next of a stack.
void Springs::add(const ast::WorldSprings& text, Scope& scope, Span span) {
  const auto pattern =
      std::ranges::find(text_.patterns, text.pattern.text, [](const PatternText& p) { return p.text->name.text; });
  if (pattern == text_.patterns.end()) {
    if (expressions_.workspace.declared.symbols.is_lost(text.pattern.text)) return;
    std::vector<std::string> names;
    for (const PatternText& known : text_.patterns) names.push_back(known.text->name.text);
    const std::string near = did_you_mean(text.pattern.text, names);
    report_.fail("E223", text.pattern.span, fmt::format("there are no bodies `{}` of a pattern", text.pattern.text), {},
                 near.empty() ? "between single bodies write spring a to b" : near);
    return;
  }
  if (pattern->text->pattern == ast::Pattern::random) {
    report_.fail("E225", text.pattern.span, "bodies at random have no neighbours", {},
                 "write each spring: spring a[1] to a[2]");
    return;
  }
  const bool diagonal = attribute(text.attributes, "diagonal") != nullptr;
  const ast::Expression* length = attribute(text.attributes, "length");
  if (diagonal && length) {
    report_.fail("E225", length->span, "diagonal springs are longer than the others", {},
                 "leave `length` out: each is as long as the distance at the start");
    return;
  }
  for (const auto& [a, b] : neighbours(*pattern, diagonal)) {
    add_spring({.a = a, .b = b, .point = {}, .stiffness = {}, .length = {}, .damping = {}, .span = span},
               text.attributes, scope);
  }
}

}  // namespace continuo::model::detail
