// continuo/language/check/world/forces.cpp
// Forces and torques may depend on everything but measures of the world.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/world/body_names.hpp>
#include <continuo/language/check/world/forces.hpp>

namespace continuo::model::detail {

/// After the equations: they may stand in a force.
void Forces::make(const Model& model) {
  for (const Placed<ast::Force>& force : text_.forces) {
    Scope scope = force.scope;
    const auto body = body_named(force.text->body, scope, expressions_);
    if (!body) continue;
    if (work_.made.bodies[*body].fixed)
      report_.warn(
          "E294", force.text->body.span,
          fmt::format("`{}` {}", work_.made.bodies[*body].name,
                      work_.made.bodies[*body].character ? "walks: no force moves it" : "is fixed: nothing moves it"),
          {}, "leave out what acts on it, or let it go");
    if (force.text->is_torque) {
      make_torque(force, *body);
      continue;
    }
    const Measured wanted = product(work_.mass, expressions_.workspace.time.per_time(work_.length, 2));
    const NodePoint components = numbers_.point(force.text->value, scope, wanted, "a force", false);
    if (components[0].valid()) work_.made.forces.push_back({*body, components, force.span});
  }
  if (text_.text) refuse_measures(model);
}

void Forces::refuse_measures(NodeId node, Span span, bool may_ask_characters) {
  const Layout& layout = expressions_.workspace.layout;
  const std::size_t first = layout.states + work_.made.first_measure;
  const std::size_t end =
      may_ask_characters ? layout.states + work_.made.characters.front().first_measure : layout.unknowns;
  for (const std::uint32_t variable : variables_of(expressions_.workspace.graph, node)) {
    if (variable < first || variable >= end) continue;
    report_.fail("E226", span, "nothing can be moved by a measure of the world",
                 fmt::format("`{}` is computed for results only", name_of_variable(expressions_.workspace, variable)),
                 "write it with the bodies it is made of");
  }
}

void Forces::refuse_measures(const Model& model) {
  for (const auto* loads : {&work_.made.forces, &work_.made.torques}) {
    for (const ForceDescription& load : *loads)
      for (const NodeId component : load.components)
        if (component.valid()) refuse_measures(component, load.span);
  }
  for (const JointDescription& joint : work_.made.joints)
    for (const NodeId drive : {joint.motor_speed, joint.target[0], joint.target[1], joint.target[2]})
      if (drive.valid()) refuse_measures(drive, joint.span);
  for (const CharacterDescription& character : work_.made.characters)
    for (const NodeId wish : {character.walk[0], character.walk[1], character.jump})
      if (wish.valid()) refuse_measures(wish, character.span, true);
  for (const Mode& mode : model.modes) {
    for (std::size_t i = 0; i < std::min(mode.derivatives.size(), model.states.size()); ++i) {
      if (!model.states[i].in_world) refuse_measures(mode.derivatives[i], model.states[i].span);
    }
  }
}

/// In the plane one number, in space three.
void Forces::make_torque(const Placed<ast::Force>& torque, std::size_t body) {
  Scope scope = torque.scope;
  const ast::Expression& text = torque.text->value;
  const Measured wanted =
      product(work_.mass, product(work_.length, expressions_.workspace.time.per_time(work_.length, 2)));
  NodePoint components{};
  if (text_.dimension == 3) {
    components = numbers_.in_space(text, scope, wanted, "a torque", false);
  } else if (std::holds_alternative<ast::List>(text.node)) {
    components[0] = numbers_.in_plane(text, scope, wanted, "a torque");
  } else if (const Value value = expressions_.values.number_of(text, scope); !value.bad) {
    components[0] = expressions_.operations.in_unit(text, value, wanted, "a torque");
  }
  if (components[0].valid()) work_.made.torques.push_back({body, components, torque.span});
}

}  // namespace continuo::model::detail
