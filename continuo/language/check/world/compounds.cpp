// continuo/language/check/world/compounds.cpp
// Bodies of several parts, and traits: members of Bodies.
#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/bodies.hpp>
#include <continuo/language/check/world/body_names.hpp>
#include <continuo/language/described_shape.hpp>
#include <continuo/shapes/solid.hpp>

namespace continuo::model::detail {

namespace {

/// Whether a body with parts has a shape of its own beside them.
bool has_shape(const ast::WorldAttributes& attributes) {
  constexpr std::array<std::string_view, 4> words = {"radius", "box", "capsule", "hull"};
  return std::ranges::any_of(words, [&](std::string_view word) { return attribute(attributes, word) != nullptr; });
}

}  // namespace

void Bodies::find_parts() {
  for (const auto& item : text_.items) {
    const auto* part = std::get_if<ast::WorldPart>(&item.text->node);
    if (!part) continue;
    Scope scope = item.scope;
    const auto body = body_named(part->of, scope, expressions_);
    if (!body) continue;
    if (text_.bodies[*body].is_character()) {
      report_.fail("E225", part->of.span, "a character has no parts", "it is a capsule");
    } else if (text_.bodies[*body].text) {
      parts_[*body].push_back(&item);
    } else {
      report_.fail("E225", part->of.span, "the bodies of a pattern have no parts", {},
                   "declare it alone: body hammer at (0, 5)");
    }
  }
}

/// Its numbers are constants, so that the volume and the centre of mass are made here.
MadeShape Bodies::make_compound(const BodyText& body, const std::vector<const Placed<ast::WorldItem>*>& parts) {
  ShapeDescription shape;
  shape.kind = ShapeDescription::Kind::compound;
  const auto add = [&](const ast::WorldAttributes& attributes, Scope scope, bool has_place) {
    scope.constant = "a part of a body";
    auto part = part_of(attributes, scope, has_place);
    if (part) shape.parts.push_back(*std::move(part));
    return part.has_value();
  };
  bool is_whole = !has_shape(body.text->attributes) || add(body.text->attributes, body.scope, false);
  for (const auto* part : parts)
    is_whole = add(std::get<ast::WorldPart>(part->text->node).attributes, part->scope, true) && is_whole;
  MadeShape unmeasured;
  unmeasured.shape = shape;
  if (!is_whole) return unmeasured;
  return text_.dimension == 2 ? measured_compound<2>(std::move(shape), body.span)
                              : measured_compound<3>(std::move(shape), body.span);
}

/// Nothing where it is no shape, which is said.
std::optional<PartDescription> Bodies::part_of(const ast::WorldAttributes& attributes, Scope& scope, bool has_place) {
  PartDescription part;
  const MadeShape made = shapes_.make(attributes, scope);
  part.shape = made.shape;
  if (!made.volume.valid()) return std::nullopt;
  if (!has_place) return part;
  if (const ast::Expression* at = attribute(attributes, "at")) {
    const NodePoint place = numbers_.point(*at, scope, work_.length, "the place of a part");
    for (std::size_t axis = 0; axis < text_.axes(); ++axis) {
      const auto value = place[axis].valid() ? graph_.value(place[axis]) : std::nullopt;
      if (!value) return std::nullopt;
      part.position[axis] = *value;
    }
  }
  const Turn turn = turns_.turn_of(attributes, scope);
  for (std::size_t k = 0; k < (text_.dimension == 2 ? 1U : 4U); ++k) {
    const auto value = turn.orientation[k].valid() ? graph_.value(turn.orientation[k]) : std::nullopt;
    if (!value) return std::nullopt;
    part.orientation[k] = *value;
  }
  return part;
}

template <int Dim>
MadeShape Bodies::measured_compound(ShapeDescription shape, Span span) {
  MadeShape made;
  std::vector<double> values;
  for (const NodeId node : shape_nodes(shape, Dim)) values.push_back(graph_.value(node).value_or(0));
  made.shape = std::move(shape);
  std::span<const double> left = values;
  for (const PartDescription& part : made.shape.parts) {  // what is wrong with one alone is judged with its numbers
    const std::size_t count = shape_nodes(part.shape, Dim).size();
    if (!continuo::solid<double, Dim>(described_shape<Dim>(part.shape, left.first(count)))) return made;
    left = left.subspan(count);
  }
  const auto solid = continuo::solid<double, Dim>(described_shape<Dim>(made.shape, values));
  if (!solid) {
    report_.fail("E225", span, "these parts make no body", solid.status().message);
    return made;
  }
  made.radius = graph_.constant(solid->reach);
  made.volume = graph_.constant(solid->volume);
  for (std::size_t axis = 0; axis < solid->centre.size(); ++axis) made.centre[axis] = solid->centre[axis];
  return made;
}

TraitsDescription Bodies::traits_of(const ast::WorldAttributes& attributes, Scope& scope) {
  TraitsDescription traits;
  traits.sensor = attribute(attributes, "sensor") != nullptr;
  const bool plane = text_.dimension == 2;
  constexpr unsigned all_turns = 8 + 16 + 32;
  constexpr std::array<std::pair<std::string_view, unsigned>, 7> held = {{{"locked_x", 1},
                                                                          {"locked_y", 2},
                                                                          {"locked_z", 4},
                                                                          {"locked_turn", all_turns},
                                                                          {"locked_turn_x", 8},
                                                                          {"locked_turn_y", 16},
                                                                          {"locked_turn_z", 32}}};
  for (const auto& [word, bits] : held) {
    const ast::Expression* flag = attribute(attributes, word);
    if (!flag) continue;
    if (plane && bits != 1 && bits != 2 && bits != all_turns)
      report_.fail("E227", flag->span, fmt::format("`{}` exists in space only", word), {},
                   "the plane has locked_x, locked_y and locked_turn");
    traits.locked = static_cast<std::uint8_t>(traits.locked | bits);
  }
  const Measured rate = expressions_.workspace.time.per_time(Measured::known(Unit())), none = Measured::unknown();
  const auto number = [&](std::string_view word, const Measured& wanted, std::string_view what, Sort sort) {
    const ast::Expression* text = attribute(attributes, word);
    return text ? numbers_.number(*text, scope, wanted, what, sort) : NodeId{};
  };
  traits.gravity_scale = number("gravity_scale", Measured::known(Unit()), "the scale of gravity", Sort::any);
  traits.damping = number("damping", work_.length.is_known() ? rate : none, "the damping", Sort::not_negative);
  traits.spin_damping =
      number("spin_damping", work_.length.is_known() ? rate : none, "the damping of the spin", Sort::not_negative);
  return traits;
}

}  // namespace continuo::model::detail
