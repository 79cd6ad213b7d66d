// continuo/language/check/world/world_declarations.cpp
// A body makes six states in the plane, thirteen in space.
#include <algorithm>
#include <map>
#include <string>

#include <fmt/format.h>

#include <continuo/language/check/world/members.hpp>
#include <continuo/language/check/world/world_declarations.hpp>

namespace continuo::model::detail {

void WorldDeclarations::find_world(const ast::Model& tree) {
  const ast::Statement* first = nullptr;
  for (const ast::Statement& statement : tree.statements) {
    if (!std::holds_alternative<ast::World>(statement.node)) continue;
    if (first) {
      const Span head{statement.span.begin, statement.span.begin + 5};
      auto* said = report_.fail("E262", head, "`world` stands twice", {}, "put all bodies into one");
      if (said) said->related.push_back({{first->span.begin, first->span.begin + 5}, "first here"});
      continue;
    }
    first = &statement;
  }
  if (!first) return;
  world_.text = &std::get<ast::World>(first->node);
  world_.span = {first->span.begin, first->span.begin + 5};
}

void WorldDeclarations::read_dimension(Scope& scope) {
  for (const ast::WorldItem& item : world_.text->items) {
    const auto* setting = std::get_if<ast::WorldSetting>(&item.node);
    if (!setting || setting->word.text != "dimension") continue;
    const auto dimension = expressions_.indices.whole_number(*setting->value, scope, "the dimension");
    if (!dimension) continue;
    if (*dimension == 2 || *dimension == 3) {
      world_.dimension = static_cast<int>(*dimension);
    } else {
      report_.fail("E227", setting->value->span, "a world has 2 or 3 dimensions",
                   fmt::format("this is {}", *dimension));
    }
  }
}

void WorldDeclarations::declare(const ast::Model& tree) {
  find_world(tree);
  if (!world_.text) return;
  Scope scope;
  read_dimension(scope);
  declare_items(world_.text->items, scope);
  if (world_.bodies.empty() && report_.errors() == 0) {
    report_.fail("E225", world_.span, "there is no body in the world", {}, "add one: body ball at (0, 10) radius 0.5");
  }
}

void WorldDeclarations::declare_items(const std::vector<ast::WorldItem>& items, Scope& scope) {
  for (const ast::WorldItem& item : items) {
    if (const auto* family = std::get_if<ast::WorldFamily>(&item.node)) {
      expressions_.indices.for_each_kept_index(family->index, family->range, scope,
                                               [&](std::size_t) { declare_items(family->body, scope); });
      continue;
    }
    if (const auto* body = std::get_if<ast::WorldBody>(&item.node)) {
      const auto indices = expressions_.indices.indices_of(body->name, scope);
      if (!indices) continue;
      if (!declare_body(body->name.text, *indices, body->name.span)) continue;
      world_.bodies.back().text = body;
      world_.bodies.back().scope = scope;
    } else if (const auto* bodies = std::get_if<ast::WorldBodies>(&item.node)) {
      declare_pattern(*bodies, scope, item.span);
    } else if (const auto* joint = std::get_if<ast::WorldJoint>(&item.node)) {
      declare_joint(*joint, scope, item.span);
    } else {
      world_.items.push_back({&item, scope, item.span});
    }
  }
}

void WorldDeclarations::declare_pattern(const ast::WorldBodies& bodies, Scope& scope, Span span) {
  PatternText pattern{&bodies, scope, span, {}, world_.bodies.size(), 1};
  if (bodies.counts.size() > world_.axes()) {
    report_.fail("E227", bodies.counts.back().span,
                 fmt::format("a grid in {} dimensions has at most {} counts", world_.dimension, world_.dimension));
    declared_.symbols.lose(bodies.name.text);
    return;
  }
  for (const ast::Expression& text : bodies.counts) {
    const auto count = expressions_.indices.whole_number(text, scope, "a number of bodies");
    if (count && *count < 1)
      report_.fail("E221", text.span, "a number of bodies is 1 or more", fmt::format("this is {}", *count));
    if (!count || *count < 1) {
      declared_.symbols.lose(bodies.name.text);
      return;
    }
    pattern.counts.push_back(*count);
    pattern.count *= static_cast<std::size_t>(*count);
    if (pattern.count > most_written_out) pattern.count = most_written_out + 1;
  }
  for (std::size_t k = 1; k <= pattern.count && expressions_.indices.count_written_out(span); ++k) {
    if (!declare_body(bodies.name.text, std::array{static_cast<long>(k)}, bodies.name.span)) return;  // said already
  }
  world_.patterns.push_back(std::move(pattern));
}

bool WorldDeclarations::declare_body(const std::string& name, std::span<const long> indices, Span span) {
  constexpr std::size_t most_bodies = 50'000;  // each is six or thirteen states with names of their own
  if (world_.bodies.size() >= most_bodies) {
    report_.fail("E221", world_.span, "the world is too large", fmt::format("more than {} bodies", most_bodies),
                 "take fewer, or build it in C++, where millions are fine: docs/bodies.md");
    return false;
  }
  const std::string key = indexed(name, indices);
  if (name == "world") {
    report_.fail("E214", span, "`world` has a meaning of its own", "world.kinetic is the energy of all bodies",
                 "take another name");
    return false;
  }
  if (!declared_.symbols.declare(name, indices, Scope::no_mode, {Symbol::Kind::body, world_.bodies.size(), span},
                                 report_))
    return false;
  world_.bodies.push_back({nullptr, {}, span, key, declared_.bases.size()});
  for (const Member& member : members_of(world_.dimension))
    add_base(key + "." + std::string(member.name), name, member.order, span);
  return true;
}

void WorldDeclarations::declare_joint(const ast::WorldJoint& joint, Scope& scope, Span span) {
  const ast::Name& name = joint.name ? *joint.name : joint.first;
  const auto indices = expressions_.indices.indices_of(name, scope);
  if (!indices) return;
  if (joint.name && !declared_.symbols.declare(name.text, *indices, Scope::no_mode,
                                               {Symbol::Kind::joint, world_.joints.size(), name.span}, report_))
    return;
  world_.joints.push_back({&joint, scope, span, indexed(name.text, *indices), name.text});
}

void WorldDeclarations::add_base(const std::string& name, std::string_view family, int order, Span span) {
  declared_.symbols.add(name, Symbol{Symbol::Kind::base, declared_.bases.size(), span});
  declared_.bases.push_back({.name = name, .family = family, .order = order, .span = span, .in_world = true});
}

/// Behind the states of the equations.
void WorldDeclarations::declare_measures() {
  if (!world_.text) return;
  for (const std::string& name : world_measures(world_.dimension)) add_measure("world." + name, "world", world_.span);
  std::map<std::string, int> without_name;  // of a first body
  for (const JointText& joint : world_.joints)
    if (!joint.is_named()) ++without_name[joint.name];
  for (JointText& joint : world_.joints) {
    if (!joint.is_named() && without_name[joint.name] > 1) continue;  // which of them would `door.torque` mean?
    joint.base = declared_.bases.size();
    for (const std::string& member :
         joint_measures(joint.text->kind.text, world_.dimension, joint.is_named(), joint.has_motor()))
      add_measure(joint.name + "." + member, joint.family, joint.span);
  }
  for (const BodyText& body : world_.bodies)
    for (const std::string& member : body.is_character() ? character_measures() : std::vector<std::string>())
      add_measure(body.name + "." + member, body.text->name.text, body.span);
}

void WorldDeclarations::add_measure(const std::string& name, std::string_view family, Span span) {
  add_base(name, family, 1, span);
  declared_.bases.back().is_measure = true;
}

}  // namespace continuo::model::detail
