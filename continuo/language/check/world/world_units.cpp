// continuo/language/check/world/world_units.cpp
// Units of the states of bodies, from the unit of length.
#include <string_view>

#include <continuo/language/check/world/world_numbers.hpp>
#include <continuo/language/check/world/world_units.hpp>

namespace continuo::model::detail {

namespace {

/// The unit of the first position that has one.
Measured stated_length(Expressions& expressions, WorldAtWork& work) {
  Report silent = expressions.report.silent();
  Expressions trial(expressions.workspace, silent);
  const WorldNumbers numbers(trial, work);
  const WorldText& world = expressions.workspace.declared.world;
  Measured found = Measured::unknown();
  const auto look = [&](const ast::Expression& point, const Scope& outer) {
    if (found.is_known()) return;
    Scope scope = outer;
    const auto terms = numbers.components(point, scope, 1);
    if (!terms.empty() && terms.front().value.measured.is_known()) found = terms.front().value.measured;
  };
  const auto look_in = [&](const ast::WorldAttributes& attributes, const Scope& scope) {
    for (const ast::WorldAttribute& attribute : attributes) {
      if (attribute.name.text == "at" || attribute.name.text == "from") look(attribute.value, scope);
      if (attribute.name.text != "hull") continue;
      for (const ast::Expression& corner : std::get<ast::List>(attribute.value.node).items) look(corner, scope);
    }
  };
  const ast::WorldBody* last = nullptr;
  for (const BodyText& body : world.bodies) {
    if (found.is_known() || !body.text || body.text == last) continue;
    last = body.text;  // of a family the first
    look_in(body.text->attributes, body.scope);
  }
  for (const PatternText& pattern : world.patterns) {
    look_in(pattern.text->attributes, pattern.scope);
    if (pattern.text->lower) look(*pattern.text->lower, pattern.scope);
  }
  return found;
}

}  // namespace

void measure_world(Expressions& expressions, WorldAtWork& work) {
  if (!expressions.workspace.declared.world.text) return;
  work.length = stated_length(expressions, work);
  if (work.length.is_known()) work.mass = Measured::known(*parse_unit("kg"));
  const Measured length = work.length, none = Measured::unknown();
  const Measured pure = length.is_known() ? Measured::known(Unit()) : none;
  const Measured momentum = product(work.mass, expressions.workspace.time.per_time(length));
  const Measured force = expressions.workspace.time.per_time(momentum);
  const Measured energy = product(momentum, expressions.workspace.time.per_time(length));
  for (const Base& base : expressions.workspace.declared.bases) {
    if (!base.in_world) continue;
    const std::string_view member = std::string_view(base.name).substr(base.name.rfind('.') + 1);
    Measured measured = length;
    if (base.family == "world") {
      measured = member == "collisions" ? none : member.starts_with("momentum") ? momentum : energy;
    } else if (base.is_measure && (member.starts_with("force") || member == "motor_force")) {
      measured = force;
    } else if (base.is_measure && (member.starts_with("torque") || member == "motor_torque")) {
      measured = energy;
    } else if (member == "angle" || member == "on_ground" || member.starts_with("q_")) {
      measured = pure;
    } else if (member.starts_with("spin")) {
      measured = expressions.workspace.time.per_time(pure);
    }
    for (int k = 0; k < base.order; ++k) {
      expressions.workspace.units.set(base.first + static_cast<std::size_t>(k),
                                      k == 0 ? measured : expressions.workspace.time.per_time(measured));
    }
  }
}

}  // namespace continuo::model::detail
