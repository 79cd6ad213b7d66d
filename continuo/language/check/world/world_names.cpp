// continuo/language/check/world/world_names.cpp
// What expressions ask of a world; E223 and E224 where there is no such body or member.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/world/members.hpp>
#include <continuo/language/check/world/queries.hpp>
#include <continuo/language/check/world/world_names.hpp>
#include <continuo/language/syntax/format.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

/// `ball.x`, `grain[3].y'`, `ball.mass`, `world.kinetic`.
Value WorldNames::member(const ast::Name& name, Scope& scope, Expressions& expressions) const {
  const auto indexed_name = expressions.indices.name_of(name, scope);
  if (!indexed_name) return expressions.operations.bad();
  const std::string key = indexed_name->text();
  if (const Symbol* symbol = declared_.symbols.find_of_world(key)) {
    if (scope.is_constant()) return expressions.lookup.not_constant(name.span, key, scope);
    return expressions.lookup.derivative(name, symbol->index, scope);
  }
  ast::Name owner = name;
  owner.member.clear();
  owner.primes = 0;
  const IndexedName owner_name{name.text, indexed_name->indices};
  const std::string owner_key = owner_name.text();
  const Symbol* symbol = declared_.symbols.find(owner_name, scope.mode);
  if (symbol && symbol->kind == Symbol::Kind::body) return own_of_body(name, symbol->index, scope, expressions);
  if (symbol && symbol->kind == Symbol::Kind::joint) return no_member_of_joint(name, symbol->index, expressions);
  if (expressions.report.is_silent()) return expressions.operations.bad();
  if (name.text == "world") return no_member_of_world(name, key, expressions);
  if (symbol) {
    expressions.report.fail("E224", name.span, fmt::format("`{}` is no body", owner_key), {},
                            "only bodies and joints of a world have a point");
    return expressions.operations.bad();
  }
  if (declared_.symbols.family(name.text) || declared_.symbols.is_lost(name.text))
    return expressions.lookup.unknown_name(owner, owner_key);
  std::vector<std::string> names;
  for (const BodyText& body : declared_.world.bodies) names.push_back(body.name);
  const std::string near = did_you_mean(name.text, names);
  expressions.report.fail("E223", name.span, fmt::format("there is no body `{}`", owner_key), {},
                          near.empty() ? fmt::format("declare it: world {{ body {} at (0, 0) }}", owner_key) : near);
  return expressions.operations.bad();
}

Value WorldNames::own_of_body(const ast::Name& name, std::size_t body, Scope& scope, Expressions& expressions) const {
  const bool known = name.member == "radius" || name.member == "mass";
  if (known && name.primes == 0) {
    if (work_.stage == Stage::declared) {
      expressions.report.fail("E224", name.span, fmt::format("`{}` is not known yet", to_text(name)),
                              "parameters and the world come before it",
                              "name it by a parameter: param r = 0.5, and radius r");
      return expressions.operations.bad();
    }
    const BodyDescription& made = work_.made.bodies[body];
    if (!made.radius.valid() || !made.mass.valid()) return expressions.operations.bad();
    return name.member == "mass" ? Value{.node = made.mass, .measured = work_.mass}
                                 : Value{.node = made.radius, .measured = work_.length};
  }
  if (declared_.world.dimension == 2 && name.member == "spin" && name.primes == 0) {
    ast::Name rate = name;
    rate.member = "angle";
    rate.primes = 1;
    const Symbol* angle = declared_.symbols.find_of_world(declared_.world.bodies[body].name + ".angle");
    return expressions.lookup.derivative(rate, angle->index, scope);
  }
  std::vector<std::string> names;
  for (const Member& member : members_of(declared_.world.dimension)) {
    for (int k = 0; k < member.order; ++k) names.push_back(with_primes(member.name, k));
  }
  if (declared_.world.dimension == 2) names.emplace_back("spin");
  names.insert(names.end(), {"radius", "mass"});
  if (declared_.world.bodies[body].is_character())
    for (const std::string& measure : character_measures()) names.push_back(measure);
  const std::string& owner = declared_.world.bodies[body].name;
  std::size_t without_name = 0;
  for (const JointText& joint : declared_.world.joints) {
    if (joint.is_named() || joint.name != owner) continue;
    const std::vector<std::string> of_joint =
        joint_measures(joint.text->kind.text, declared_.world.dimension, false, joint.has_motor());
    if (++without_name == 1) names.insert(names.end(), of_joint.begin(), of_joint.end());
    if (joint.base != JointText::no_base || std::ranges::find(of_joint, name.member) == of_joint.end()) continue;
    expressions.report.fail("E224", name.span, fmt::format("`{}` has several joints", owner),
                            fmt::format("whose {}?", name.member),
                            fmt::format("give the joint a name: {} pin: {} to ..., and read pin.{}",
                                        joint.text->kind.text, owner, name.member));
    return expressions.operations.bad();
  }
  const std::string near = did_you_mean(name.member, names);
  std::string all;
  for (const std::string& one : names) all += (all.empty() ? "" : ", ") + one;
  expressions.report.fail("E224", name.span, fmt::format("a body has no `{}`", with_primes(name.member, name.primes)),
                          {}, near.empty() ? "it has " + all : near);
  return expressions.operations.bad();
}

Value WorldNames::no_member_of_joint(const ast::Name& name, std::size_t joint, Expressions& expressions) const {
  const JointText& text = declared_.world.joints[joint];
  const std::string& kind = text.text->kind.text;
  const std::vector<std::string> names = joint_measures(kind, declared_.world.dimension, true, text.has_motor());
  const std::string near = did_you_mean(name.member, names);
  expressions.report.fail("E224", name.span,
                          fmt::format("a {} has no `{}`", kind, with_primes(name.member, name.primes)), {},
                          near.empty() ? "it has " + listed(names) : near);
  return expressions.operations.bad();
}

Value WorldNames::no_member_of_world(const ast::Name& name, const std::string& key, Expressions& expressions) const {
  std::vector<std::string> names;
  if (declared_.world.text) names = world_measures(declared_.world.dimension);
  const std::string near = did_you_mean(name.member, names);
  expressions.report.fail("E224", name.span, fmt::format("there is no `{}`", key), {},
                          !declared_.world.text ? "the model has no world: world { body ball at (0, 10) }"
                          : near.empty()        ? "of the world there are " + listed(names)
                                                : near);
  return expressions.operations.bad();
}

bool WorldNames::is_query(const ast::Name& callee, const Scope& scope) const {
  return callee.primes == 0 && callee.indices.empty() && callee.member.empty() && detail::is_query(callee.text) &&
         !declared_.symbols.find({callee.text}, scope.mode) && !declared_.symbols.family(callee.text);
}

Value WorldNames::query(const ast::Call& node, Span span, Scope& scope, Expressions& expressions) const {
  return Queries(expressions, work_).query(node, span, scope);
}

}  // namespace continuo::model::detail
