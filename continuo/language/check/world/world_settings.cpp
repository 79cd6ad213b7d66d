// continuo/language/check/world/world_settings.cpp
// What a world holds beside its bodies: gravity, walls, the mode; and `force on`. Springs are in
// springs.cpp.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <continuo/language/check/expressions/indices.hpp>
#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/syntax/format.hpp>
#include <continuo/language/text/words.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

const ast::List* list_in(const ast::Expression& expression, const ast::Unit** unit) {
  if (const auto* quantity = std::get_if<ast::Quantity>(&expression.node)) {
    *unit = &quantity->unit;
    return std::get_if<ast::List>(&quantity->value->node);
  }
  return std::get_if<ast::List>(&expression.node);
}

bool fits(Sort sort, double value) {
  if (!std::isfinite(value)) return false;
  if (sort == Sort::any) return true;
  if (sort == Sort::positive) return value > 0;
  return value >= 0 && (sort != Sort::fraction || value <= 1);
}

std::string_view demand(Sort sort) {
  switch (sort) {
    case Sort::positive:
      return "must be greater than 0";
    case Sort::not_negative:
      return "must not be negative";
    case Sort::fraction:
      return "goes from 0 to 1";
    case Sort::any:
      break;
  }
  return "must be a finite number";
}

}  // namespace

/// The numbers of a point, each with the unit that stands behind the bracket; at least `count`.
std::vector<Term> Checker::components(const ast::Expression& expression, Scope& scope, std::size_t count) {
  const ast::Unit* unit = nullptr;
  const ast::List* list = list_in(expression, &unit);
  if (!list || list->items.size() < count) return {};
  std::optional<Unit> stated;
  if (unit) {
    stated = unit_of(*unit);
    if (!stated) return {};
  }
  std::vector<Term> terms;
  for (const ast::Expression& item : list->items) {
    Value value = number_of(item, scope);
    if (value.bad) return {};
    if (stated) {
      const auto factor = factor_between(value.measured, Measured::known(*stated));
      if (!factor) {
        fail("E201", item.span, "units do not match",
             fmt::format("{} is {}, not {}", quote(item.span), unit_text(value.measured), to_text(*stated)));
        return {};
      }
      value.node = model_.graph.multiply(value.node, model_.graph.constant(*factor));
      value.measured = Measured::known(*stated);
    }
    terms.push_back({item, value});
  }
  return terms;
}

NodePoint Checker::world_point(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                               std::string_view what, bool parameters_only) {
  const ast::Unit* unit = nullptr;
  const ast::List* list = list_in(expression, &unit);
  if (list && list->items.size() != world_.axes()) {
    fail("E227", expression.span,
         fmt::format("{} has {} components in {} dimensions", what, world_.dimension, world_.dimension),
         fmt::format("here are {}", list->items.size()),
         world_.dimension == 2 ? "write `dimension 3` in the world for bodies in space"
                               : "the world says `dimension 3`");
    return {};
  }
  NodePoint point{};
  const std::vector<Term> terms = components(expression, scope, world_.axes());
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (parameters_only && !only_parameters(terms[i].value.node, terms[i].text.span, what)) return {};
    if (!factor_between(terms[i].value.measured, wanted)) {
      fail("E201", expression.span, "units do not match",
           fmt::format("{} is {}, {} is {}", quote(terms[i].text.span), unit_text(terms[i].value.measured), what,
                       unit_text(wanted)));
      return {};
    }
    point[i] = in_unit(terms[i].text, terms[i].value, wanted, what);
    if (parameters_only) world_.to_judge.push_back({point[i], Sort::any, terms[i].text.span, std::string(what)});
  }
  return point;
}

NodeId Checker::world_number(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                             std::string_view what, Sort sort) {
  const Value value = number_of(expression, scope);
  if (value.bad || !only_parameters(value.node, expression.span, what)) return {};
  const NodeId node = in_unit(expression, value, wanted, what);
  world_.to_judge.push_back({node, sort, expression.span, std::string(what)});
  return node;
}

/// Everything at once: what many bodies share is computed once.
void Checker::judge_world() {
  std::vector<NodeId> nodes;
  std::vector<const ToJudge*> judged;
  for (const ToJudge& one : world_.to_judge) {
    if (!one.node.valid()) continue;
    nodes.push_back(one.node);
    judged.push_back(&one);
  }
  const std::vector<double> values = evaluate(model_, nodes, registers_);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const ToJudge& one = *judged[i];
    if (fits(one.sort, values[i])) continue;
    fail("E225", one.span, fmt::format("{} {}", one.what, demand(one.sort)), fmt::format("this is {:g}", values[i]));
  }
}

void Checker::make_world() {
  if (!world_.text) return;
  WorldDescription& made = world_.made;
  made.dimension = world_.dimension;
  made.span = world_.span;
  const auto text = [](const Measured& measured) { return measured.is_known() ? to_text(measured.unit) : ""; };
  made.length_unit = text(world_.length);
  made.mass_unit = text(world_.mass);
  made.first_measure = bases_[find("world.kinetic", Scope::no_mode)->index].first;
  made.energy_unit = model_.states[made.first_measure].unit;
  Graph& g = model_.graph;
  world_.material = {g.constant(0), g.constant(0.5), g.constant(0)};
  for (NodeId& component : made.gravity) component = g.constant(0);
  for (auto& item : world_.items) {  // what others build upon
    if (const auto* setting = std::get_if<ast::WorldSetting>(&item.text->node))
      read_world_setting(*setting, item.scope);
    if (const auto* ignore = std::get_if<ast::WorldIgnore>(&item.text->node)) read_ignore(*ignore, item.span);
  }
  for (BodyText& body : world_.bodies) make_body(body);
  for (PatternText& pattern : world_.patterns) make_pattern(pattern);
  world_.bodies_are_made = true;
  for (auto& item : world_.items) {
    if (const auto* wall = std::get_if<ast::WorldWall>(&item.text->node)) {
      read_wall(*wall, item.scope, item.span);
    } else if (const auto* container = std::get_if<ast::WorldContainer>(&item.text->node)) {
      read_container(*container, item.scope, item.span);
    } else if (const auto* spring = std::get_if<ast::WorldSpring>(&item.text->node)) {
      read_spring(*spring, item.scope, item.span);
    } else if (const auto* springs = std::get_if<ast::WorldSprings>(&item.text->node)) {
      read_springs(*springs, item.scope, item.span);
    } else if (const auto* fix = std::get_if<ast::WorldFix>(&item.text->node)) {
      for (const ast::Name& name : fix->bodies) {
        if (const auto body = body_named(name, item.scope)) made.bodies[*body].fixed = true;
      }
    }
  }
  for (std::size_t i = made.first_measure; i < model_.states.size(); ++i) model_.states[i].initial = g.constant(0);
  for (State& state : model_.states) {  // of bodies that could not be read
    if (state.in_world && !state.initial.valid()) state.initial = g.constant(0);
  }
  judge_world();
  world_.is_made = true;
}

MaterialDescription Checker::material_of(const ast::WorldAttributes& attributes, Scope& scope) {
  MaterialDescription material = world_.material;
  const Measured pure = Measured::known(Unit());
  if (const auto* e = attribute(attributes, "restitution"))
    material.restitution = world_number(*e, scope, pure, "restitution", Sort::fraction);
  if (const auto* f = attribute(attributes, "friction"))
    material.friction = world_number(*f, scope, pure, "friction", Sort::not_negative);
  if (const auto* r = attribute(attributes, "rolling"))
    material.rolling = world_number(*r, scope, pure, "rolling resistance", Sort::not_negative);
  return material;
}

void Checker::read_world_setting(const ast::WorldSetting& setting, Scope& scope) {
  WorldDescription& made = world_.made;
  const std::string& word = setting.word.text;
  const auto given = [&](std::string_view name) { return attribute(setting.attributes, name); };
  for (const auto& other : world_.items) {
    const auto* before = std::get_if<ast::WorldSetting>(&other.text->node);
    if (before == &setting) break;
    if (!before || before->word.text != word) continue;
    if (auto* said = fail("E262", setting.word.span, fmt::format("`{}` stands twice in the world", word)))
      said->related.push_back({before->word.span, "first here"});
    return;
  }
  const Measured per_mass_time = per_time(world_.mass);
  const Measured area = product(world_.length, world_.length);
  if (word == "gravity") {
    made.gravity = world_point(*setting.value, scope, per_time(world_.length, 2), "gravity");
  } else if (word == "material") {
    world_.material = material_of(setting.attributes, scope);
  } else if (word == "attraction") {
    const Measured constant = quotient(product(per_time(world_.length, 2), area), world_.mass);
    made.attraction = world_number(*setting.value, scope, constant, "the constant of attraction", Sort::any);
    const NodeId zero = model_.graph.constant(0);
    const auto *softening = given("softening"), *opening = given("opening");
    made.softening = softening ? world_number(*softening, scope, world_.length, "softening", Sort::not_negative) : zero;
    made.opening =
        opening ? world_number(*opening, scope, Measured::unknown(), "the opening angle", Sort::not_negative) : zero;
  } else if (word == "drag") {
    const auto *linear = given("linear"), *quadratic = given("quadratic");
    const NodeId zero = model_.graph.constant(0);
    made.drag_linear = linear ? world_number(*linear, scope, per_mass_time, "linear drag", Sort::not_negative) : zero;
    made.drag_quadratic = quadratic ? world_number(*quadratic, scope, quotient(world_.mass, world_.length),
                                                   "quadratic drag", Sort::not_negative)
                                    : zero;
    if (!linear && !quadratic)
      fail("E225", setting.word.span, "drag of what kind?", {}, "write drag linear 0.1, or drag quadratic 0.02");
  } else if (word == "combine") {
    read_combinations(setting);
  } else if (word == "mode") {
    read_world_mode(setting, scope);
  }
}

void Checker::read_combinations(const ast::WorldSetting& setting) {
  CombineRuleDescription& combine_rule = world_.made.combine_rule;
  if (setting.attributes.empty())
    fail("E225", setting.word.span, "combine what?", {},
         "write combine restitution minimum, or combine friction average");
  for (const ast::WorldAttribute& text : setting.attributes) {
    const std::string& name = std::get<ast::Name>(text.value.node).text;
    if (std::ranges::find(combinations, name) == combinations.end()) {
      fail("E225", text.value.span, fmt::format("surfaces do not combine by `{}`", name), {},
           fmt::format("they combine by {}", fmt::join(combinations, ", ")));
      continue;
    }
    const std::string& word = text.name.text;
    (word == "restitution" ? combine_rule.restitution
     : word == "friction"  ? combine_rule.friction
                           : combine_rule.rolling) = name;
  }
}

void Checker::read_world_mode(const ast::WorldSetting& setting, Scope& scope) {
  WorldMode& mode = world_.made.mode;
  mode.fast = std::get<ast::Name>(setting.value->node).text == "fast";
  const auto number = [&](std::string_view name, const Measured& wanted, std::string_view what, Sort sort) {
    const ast::Expression* text = attribute(setting.attributes, name);
    return text ? world_number(*text, scope, wanted, what, sort) : NodeId{};
  };
  const auto count = [&](std::string_view name, int otherwise) {
    const ast::Expression* text = attribute(setting.attributes, name);
    if (!text) return otherwise;
    const auto value = whole_number(*text, scope, fmt::format("the number of {}", name));
    if (!value) return otherwise;
    if (*value >= 1 && *value <= 1000) return static_cast<int>(*value);
    fail("E225", text->span, fmt::format("the number of {} goes from 1 to 1000", name),
         fmt::format("this is {}", *value));
    return otherwise;
  };
  const Measured time = time_or_number(), none = Measured::unknown();
  mode.tolerance = number("tolerance", none, "the tolerance", Sort::positive);
  mode.contact_time = number("contact_time", time, "the contact time", Sort::not_negative);
  mode.step = number("step", time, "the step", Sort::positive);
  mode.hertz = number("hertz", none, "the frequency of contacts", Sort::positive);
  mode.sleep_after = number("sleep_after", time, "the time to fall asleep", Sort::not_negative);
  mode.sleep_speed = number("sleep_speed", per_time(world_.length), "the speed of sleep", Sort::not_negative);
  mode.substeps = count("substeps", mode.substeps);
  mode.threads = count("threads", mode.threads);
  if (const ast::Expression* text = attribute(setting.attributes, "integrator")) {
    const std::vector<std::string> names{"semi_implicit_euler", "implicit_euler", "central_difference",
                                         "explicit_euler"};
    mode.integrator = std::get<ast::Name>(text->node).text;
    if (std::ranges::find(names, mode.integrator) == names.end()) {
      const std::string near = did_you_mean(mode.integrator, names);
      fail("E260", text->span, fmt::format("there is no integrator `{}`", mode.integrator), {},
           near.empty() ? "there are " + listed(names) : near);
    }
  }
}

void Checker::read_wall(const ast::WorldWall& wall, Scope& scope, Span span) {
  WallDescription made{.name = {},
                       .normal = {},
                       .offset = {},
                       .material = material_of(wall.attributes, scope),
                       .thin = attribute(wall.attributes, "thin") != nullptr,
                       .span = span};
  made.name = wall.name ? wall.name->text : fmt::format("wall {}", world_.made.walls.size() + 1);
  made.normal = world_point(wall.normal, scope, Measured::unknown(), "the normal of a wall");
  made.offset = world_number(wall.offset, scope, world_.length, "the place of a wall", Sort::any);
  NodeId square = model_.graph.constant(0);
  for (std::size_t axis = 0; axis < world_.axes() && made.normal[axis].valid(); ++axis)
    square = model_.graph.add(square, model_.graph.multiply(made.normal[axis], made.normal[axis]));
  if (made.normal[0].valid())
    world_.to_judge.push_back({square, Sort::positive, wall.normal.span, "the length of a normal"});
  world_.made.walls.push_back(std::move(made));
}

void Checker::read_container(const ast::WorldContainer& container, Scope& scope, Span span) {
  const NodePoint lower = world_point(container.lower, scope, world_.length, "the corner of a container");
  const NodePoint upper = world_point(container.upper, scope, world_.length, "the corner of a container");
  if (!lower[0].valid() || !upper[0].valid()) return;
  Graph& g = model_.graph;
  const MaterialDescription material = material_of(container.attributes, scope);
  const std::string name = container.name ? container.name->text : fmt::format("wall {}", world_.made.walls.size() + 1);
  for (std::size_t axis = 0; axis < world_.axes(); ++axis) {
    world_.to_judge.push_back({g.subtract(upper[axis], lower[axis]), Sort::positive,
                               cover(container.lower.span, container.upper.span), "the size of a container"});
    for (const double side : {1.0, -1.0}) {
      WallDescription wall{.name = name, .normal = {}, .offset = {}, .material = material, .span = span};
      for (std::size_t k = 0; k < world_.axes(); ++k) wall.normal[k] = g.constant(k == axis ? side : 0);
      wall.offset = side > 0 ? lower[axis] : g.negate(upper[axis]);
      world_.made.walls.push_back(std::move(wall));
    }
  }
}

void Checker::read_ignore(const ast::WorldIgnore& ignore, Span) {
  std::array<std::uint32_t, 2> numbers{};
  std::size_t k = 0;
  for (const ast::Identifier* name : {&ignore.a, &ignore.b}) {
    const auto known = std::ranges::find(world_.groups, name->text);
    if (known == world_.groups.end()) {
      if (world_.groups.size() == 32) {
        fail("E225", name->span, "there are more than 31 groups");
        return;
      }
      world_.groups.push_back(name->text);
      numbers[k++] = static_cast<std::uint32_t>(world_.groups.size() - 1);
    } else {
      numbers[k++] = static_cast<std::uint32_t>(known - world_.groups.begin());
    }
  }
  world_.made.ignored.emplace_back(numbers[0], numbers[1]);
}

/// In the plane one number, in space three.
void Checker::make_torque(Placed<ast::Force>& torque, std::size_t body) {
  const ast::Expression& text = torque.text->value;
  const Measured wanted = product(world_.mass, product(world_.length, per_time(world_.length, 2)));
  NodePoint components{};
  if (world_.dimension == 3) {
    components = turn_in_space(text, torque.scope, wanted, "a torque", false);
  } else if (std::holds_alternative<ast::List>(text.node)) {
    components[0] = turn_in_plane(text, torque.scope, wanted, "a torque");
  } else if (const Value value = number_of(text, torque.scope); !value.bad) {
    components[0] = in_unit(text, value, wanted, "a torque");
  }
  if (components[0].valid()) world_.made.torques.push_back({body, components, torque.span});
}

/// After the equations: they may stand in a force.
void Checker::make_forces() {
  for (Placed<ast::Force>& force : world_.forces) {
    const auto body = body_named(force.text->body, force.scope);
    if (!body) continue;
    if (world_.made.bodies[*body].fixed)
      warn("E294", force.text->body.span,
           fmt::format("`{}` is fixed: nothing moves it", world_.made.bodies[*body].name), {},
           "leave out what acts on it, or let it go");
    if (force.text->is_torque) {
      make_torque(force, *body);
      continue;
    }
    const Measured wanted = product(world_.mass, per_time(world_.length, 2));
    const NodePoint components = world_point(force.text->value, force.scope, wanted, "a force", false);
    if (components[0].valid()) world_.made.forces.push_back({*body, components, force.span});
  }
  if (!world_.text) return;
  const auto only_look = [&](NodeId node, Span span) {
    for (const std::uint32_t variable : variables_of(model_.graph, node)) {
      const std::size_t first = model_.layout.states + world_.made.first_measure;
      if (variable < first || variable >= model_.layout.unknowns) continue;
      fail("E226", span, "nothing can be moved by a measure of the world",
           fmt::format("`{}` is computed for results only", name_of(variable)),
           "write it with the bodies it is made of");
    }
  };
  for (const auto* loads : {&world_.made.forces, &world_.made.torques}) {
    for (const ForceDescription& load : *loads)
      for (const NodeId component : load.components)
        if (component.valid()) only_look(component, load.span);
  }
  for (const Mode& mode : model_.modes) {
    for (std::size_t i = 0; i < std::min(mode.derivatives.size(), model_.states.size()); ++i) {
      if (!model_.states[i].in_world) only_look(mode.derivatives[i], model_.states[i].span);
    }
  }
}

}  // namespace continuo::model::detail
