// Sizes of characters are numbers of parameters; what they wish may depend on everything.
#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/characters.hpp>

namespace continuo::model::detail {

/// Without numbers it has the proportions of a person: six times as high as its radius, on slopes up to 45 degrees.
MadeShape Characters::make(std::size_t body, Scope& scope) {
  constexpr double usual_radius = 0.3, usual_height = 6, usual_slope = 0.7853981633974483;
  const BodyText& text = text_.bodies[body];
  const auto length = [&](std::string_view word, std::string_view what, Sort sort, NodeId otherwise) {
    const ast::Expression* given = attribute(text.text->attributes, word);
    return given ? numbers_.number(*given, scope, work_.length, what, sort) : otherwise;
  };
  CharacterDescription made{.body = body, .span = text.span};
  made.radius = length("radius", "the radius of a character", Sort::positive, graph_.constant(usual_radius));
  if (!made.radius.valid()) return {};
  made.height = length("height", "the height of a character", Sort::positive,
                       graph_.multiply(graph_.constant(usual_height), made.radius));
  made.highest_step = length("step", "the highest step of a character", Sort::not_negative, made.radius);
  const ast::Expression* slope = attribute(text.text->attributes, "steepest");
  made.steepest =
      slope ? numbers_.number(*slope, scope, Measured::known(Unit()), "the steepest slope of a character", Sort::slope)
            : graph_.constant(usual_slope);
  if (!made.height.valid() || !made.highest_step.valid() || !made.steepest.valid()) return {};
  const NodeId middle = graph_.subtract(made.height, graph_.multiply(graph_.constant(2), made.radius));
  if (const ast::Expression* height = attribute(text.text->attributes, "height"))
    numbers_.expect(middle, Sort::positive, height->span, "the height of a character, less two radii,");
  made.jump = graph_.constant(0);
  made.walk = {made.jump, made.jump, {}};
  const Symbol* measure = expressions_.workspace.declared.symbols.find_of_world(text.name + ".on_ground");
  if (measure) made.first_measure = expressions_.workspace.declared.bases[measure->index].first;
  work_.made.characters.push_back(made);
  return shapes_.capsule(made.radius, middle);
}

void Characters::make_wishes() {
  for (CharacterDescription& character : work_.made.characters) {
    const BodyText& text = text_.bodies[character.body];
    Scope scope = text.scope;
    if (const ast::Expression* walk = attribute(text.text->attributes, "walk"))
      std::ranges::copy(numbers_.level(*walk, scope, speed_unit(), "the velocity of a character", false),
                        character.walk.begin());
    const ast::Expression* jump = attribute(text.text->attributes, "jump");
    if (!jump) continue;
    const Value speed = expressions_.values.number_of(*jump, scope);
    if (!speed.bad)
      character.jump = expressions_.operations.in_unit(*jump, speed, speed_unit(), "the speed at which it jumps");
  }
}

Measured Characters::speed_unit() const {
  return expressions_.workspace.time.per_time(work_.length);
}

}  // namespace continuo::model::detail
