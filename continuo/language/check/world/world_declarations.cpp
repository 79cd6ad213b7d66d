// continuo/language/check/world/world_declarations.cpp
// The bodies of a world by name: what they are called, the states they make, `ball.x` and `world.kinetic`.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <continuo/language/check/expressions/indices.hpp>
#include <continuo/language/syntax/format.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

struct Member {
  std::string_view name;
  int order;
};
constexpr std::array<Member, 3> plane_members = {{{"x", 2}, {"y", 2}, {"angle", 2}}};
constexpr std::array<Member, 10> space_members = {{{"x", 2},
                                                   {"y", 2},
                                                   {"z", 2},
                                                   {"q_w", 1},
                                                   {"q_x", 1},
                                                   {"q_y", 1},
                                                   {"q_z", 1},
                                                   {"spin_x", 1},
                                                   {"spin_y", 1},
                                                   {"spin_z", 1}}};

std::span<const Member> members_of(int dimension) {
  if (dimension == 2) return plane_members;
  return space_members;
}

}  // namespace

void Checker::declare_world() {
  const ast::Statement* first = nullptr;
  for (const ast::Statement& statement : tree_.statements) {
    if (!std::holds_alternative<ast::World>(statement.node)) continue;
    if (first) {
      const Span head{statement.span.begin, statement.span.begin + 5};
      auto* said = fail("E262", head, "`world` stands twice", {}, "put all bodies into one");
      if (said) said->related.push_back({{first->span.begin, first->span.begin + 5}, "first here"});
      continue;
    }
    first = &statement;
  }
  if (!first) return;
  world_.text = &std::get<ast::World>(first->node);
  world_.span = {first->span.begin, first->span.begin + 5};
  Scope scope;
  for (const ast::WorldItem& item : world_.text->items) {
    const auto* setting = std::get_if<ast::WorldSetting>(&item.node);
    if (!setting || setting->word.text != "dimension") continue;
    const auto dimension = whole_number(*setting->value, scope, "the dimension");
    if (!dimension) continue;
    if (*dimension == 2 || *dimension == 3) {
      world_.dimension = static_cast<int>(*dimension);
    } else {
      fail("E227", setting->value->span, "a world has 2 or 3 dimensions", fmt::format("this is {}", *dimension));
    }
  }
  declare_world_items(world_.text->items, scope);
  if (world_.bodies.empty() && errors_ == 0) {
    fail("E225", world_.span, "there is no body in the world", {}, "add one: body ball at (0, 10) radius 0.5");
  }
}

void Checker::declare_world_items(const std::vector<ast::WorldItem>& items, Scope& scope) {
  for (const ast::WorldItem& item : items) {
    if (const auto* family = std::get_if<ast::WorldFamily>(&item.node)) {
      for_each_index(family->index, family->range, scope, [&] { declare_world_items(family->body, scope); });
      continue;
    }
    if (const auto* body = std::get_if<ast::WorldBody>(&item.node)) {
      const auto indices = indices_of(body->name, scope);
      if (!indices) continue;
      const std::size_t before = world_.bodies.size();
      declare_body(body->name.text, *indices, body->name.span);
      if (world_.bodies.size() == before) continue;
      world_.bodies.back().text = body;
      world_.bodies.back().scope = scope;
    } else if (const auto* bodies = std::get_if<ast::WorldBodies>(&item.node)) {
      declare_pattern(*bodies, scope, item.span);
    } else {
      world_.items.push_back({&item, scope, item.span});
    }
  }
}

void Checker::declare_pattern(const ast::WorldBodies& bodies, Scope& scope, Span span) {
  PatternText pattern{&bodies, scope, span, {}, world_.bodies.size(), 1};
  if (bodies.counts.size() > world_.axes()) {
    fail("E227", bodies.counts.back().span,
         fmt::format("a grid in {} dimensions has at most {} counts", world_.dimension, world_.dimension));
    lost_.insert(bodies.name.text);
    return;
  }
  for (const ast::Expression& text : bodies.counts) {
    const auto count = whole_number(text, scope, "a number of bodies");
    if (count && *count < 1)
      fail("E221", text.span, "a number of bodies is 1 or more", fmt::format("this is {}", *count));
    if (!count || *count < 1) {
      lost_.insert(bodies.name.text);
      return;
    }
    pattern.counts.push_back(*count);
    pattern.count *= static_cast<std::size_t>(*count);
    if (pattern.count > most_written_out) pattern.count = most_written_out + 1;
  }
  for (std::size_t k = 1; k <= pattern.count && count_written_out(span); ++k) {
    declare_body(bodies.name.text, {static_cast<long>(k)}, bodies.name.span);
    if (world_.bodies.size() < pattern.first + k) return;  // a taken name, or too many: said already
  }
  world_.patterns.push_back(std::move(pattern));
}

void Checker::declare_body(const std::string& name, const std::vector<long>& indices, Span span) {
  constexpr std::size_t most_bodies = 50'000;  // each is six or thirteen states with names of their own
  if (world_.bodies.size() >= most_bodies) {
    fail("E221", world_.span, "the world is too large", fmt::format("more than {} bodies", most_bodies),
         "take fewer, or build it in C++, where millions are fine: docs/bodies.md");
    return;
  }
  const std::string key = indexed(name, indices);
  if (name == "world") {
    fail("E214", span, "`world` has a meaning of its own", "world.kinetic is the energy of all bodies",
         "take another name");
    return;
  }
  if (!declare(key, key, {Symbol::Kind::body, world_.bodies.size(), span}, name, indices)) return;
  world_.bodies.push_back({nullptr, {}, span, key, bases_.size()});
  for (const Member& member : members_of(world_.dimension))
    add_world_base(key + "." + std::string(member.name), name, member.order, span);
}

void Checker::add_world_base(const std::string& name, const std::string& family, int order, Span span) {
  symbols_.try_emplace(name, Symbol{Symbol::Kind::base, bases_.size(), span});
  bases_.push_back({.name = name, .family = family, .order = order, .span = span, .in_world = true});
}

/// Behind the states of the equations.
void Checker::declare_measures() {
  if (!world_.text) return;
  for (const std::string& name : world_measures(world_.dimension))
    add_world_base("world." + name, "world", 1, world_.span);
}

// ---- units ----------------------------------------------------------------------------------------------------------

/// The unit of the first position that has one.
Measured Checker::stated_length() {
  const auto outer = std::exchange(silent_, true);
  Measured found = Measured::unknown();
  const auto look = [&](const ast::Expression& point, Scope& scope) {
    if (found.is_known()) return;
    const auto terms = components(point, scope, 1);
    if (!terms.empty() && terms.front().value.measured.is_known()) found = terms.front().value.measured;
  };
  const auto look_in = [&](const ast::WorldAttributes& attributes, Scope& scope) {
    for (const ast::WorldAttribute& attribute : attributes) {
      if (attribute.name.text == "at" || attribute.name.text == "from") look(attribute.value, scope);
    }
  };
  const ast::WorldBody* last = nullptr;
  for (BodyText& body : world_.bodies) {
    if (found.is_known() || !body.text || body.text == last) continue;
    last = body.text;  // of a family the first
    look_in(body.text->attributes, body.scope);
  }
  for (PatternText& pattern : world_.patterns) {
    look_in(pattern.text->attributes, pattern.scope);
    if (pattern.text->lower) look(*pattern.text->lower, pattern.scope);
  }
  silent_ = outer;
  return found;
}

void Checker::measure_world() {
  if (!world_.text) return;
  world_.length = stated_length();
  if (world_.length.is_known()) world_.mass = Measured::known(*parse_unit("kg").unit);
  const Measured length = world_.length, none = Measured::unknown();
  const Measured pure = length.is_known() ? Measured::known(Unit()) : none;
  const Measured momentum = product(world_.mass, per_time(length));
  const Measured energy = product(momentum, per_time(length));
  for (const Base& base : bases_) {
    if (!base.in_world) continue;
    const std::string_view member = std::string_view(base.name).substr(base.name.rfind('.') + 1);
    Measured measured = length;
    if (base.family == "world") {
      measured = member == "collisions" ? none : member.starts_with("momentum") ? momentum : energy;
    } else if (member == "angle" || member.starts_with("q_")) {
      measured = pure;
    } else if (member.starts_with("spin")) {
      measured = per_time(pure);
    }
    for (int k = 0; k < base.order; ++k) {
      measures_[base.first + static_cast<std::size_t>(k)] = k == 0 ? measured : per_time(measured);
      measure_progress_[base.first + static_cast<std::size_t>(k)] = Progress::done;
    }
  }
}

// ---- lookup ---------------------------------------------------------------------------------------------------------

void Checker::refuse_equation_of_body(const ast::Name& name) {
  const bool world = name.text == "world";
  ast::Name body = name;
  body.primes = 0;
  body.member.clear();
  fail("E226", name.span, world ? "the world is only looked at" : fmt::format("`{}` is moved by forces", to_text(body)),
       fmt::format("`{}` has no equation", to_text(name)),
       world ? "" : fmt::format("write force on {} = (..., ...), or torque on {} = ...", to_text(body), to_text(body)));
}

/// `ball.x`, `grain[3].y'`, `ball.mass`, `world.kinetic`.
Value Checker::member(const ast::Name& name, Scope& scope) {
  const auto key = key_of(name, scope);
  if (!key) return bad();
  if (const Symbol* symbol = find(*key, Scope::no_mode)) {
    if (scope.is_constant()) return not_constant(name.span, *key, scope);
    return derivative(name, symbol->index, scope);
  }
  ast::Name owner = name;
  owner.member.clear();
  owner.primes = 0;
  const auto owner_key = key_of(owner, scope);
  const Symbol* symbol = owner_key ? find(*owner_key, scope.mode) : nullptr;
  if (symbol && symbol->kind == Symbol::Kind::body) return own_of_body(name, symbol->index);
  if (silent_) return bad();
  if (name.text == "world") {
    std::vector<std::string> names;
    if (world_.text) names = world_measures(world_.dimension);
    const std::string near = did_you_mean(name.member, names);
    fail("E224", name.span, fmt::format("there is no `{}`", *key), {},
         !world_.text   ? "the model has no world: world { body ball at (0, 10) }"
         : near.empty() ? "of the world there are " + listed(names)
                        : near);
    return bad();
  }
  if (symbol) {
    fail("E224", name.span, fmt::format("`{}` is no body", *owner_key), {}, "only bodies of a world have a point");
    return bad();
  }
  if (families_.contains(name.text) || lost_.contains(name.text)) return unknown_name(owner, *owner_key);
  std::vector<std::string> names;
  for (const BodyText& body : world_.bodies) names.push_back(body.name);
  const std::string near = did_you_mean(name.text, names);
  fail("E223", name.span, fmt::format("there is no body `{}`", *owner_key), {},
       near.empty() ? fmt::format("declare it: world {{ body {} at (0, 0) }}", *owner_key) : near);
  return bad();
}

Value Checker::own_of_body(const ast::Name& name, std::size_t body) {
  const bool known = name.member == "radius" || name.member == "mass";
  if (known && name.primes == 0) {
    if (!world_.bodies_are_made) {
      fail("E224", name.span, fmt::format("`{}` is not known yet", to_text(name)),
           "parameters and the world come before it", "name it by a parameter: param r = 0.5, and radius r");
      return bad();
    }
    const BodyDescription& made = world_.made.bodies[body];
    if (!made.radius.valid() || !made.mass.valid()) return bad();
    return name.member == "mass" ? Value{.node = made.mass, .measured = world_.mass}
                                 : Value{.node = made.radius, .measured = world_.length};
  }
  std::vector<std::string> names;
  for (const Member& member : members_of(world_.dimension)) {
    for (int k = 0; k < member.order; ++k) names.push_back(with_primes(member.name, k));
  }
  names.insert(names.end(), {"radius", "mass"});
  const std::string near = did_you_mean(name.member, names);
  std::string all;
  for (const std::string& one : names) all += (all.empty() ? "" : ", ") + one;
  fail("E224", name.span, fmt::format("a body has no `{}`", with_primes(name.member, name.primes)), {},
       near.empty() ? "it has " + all : near);
  return bad();
}

}  // namespace continuo::model::detail
