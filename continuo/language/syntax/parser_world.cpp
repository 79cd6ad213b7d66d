// `world { ... }`, `force on ...` and `torque on ...`. Their words are no reserved words: they mean something here and
// are names elsewhere.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <continuo/language/syntax/parser_core.hpp>
#include <continuo/language/text/words.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

using ast::Expression;
using Word = std::string_view;

constexpr std::array<Word, 27> item_words = {
    "dimension", "gravity", "material",  "combine",   "attraction", "drag",  "mode",   "wall", "container",
    "body",      "bodies",  "character", "spring",    "springs",    "hinge", "slider", "weld", "ball",
    "distance",  "rope",    "wheel",     "universal", "gear",       "pull",  "part",   "fix",  "ignore"};

/// Lists one after the other.
template <std::size_t... Sizes>
constexpr auto joined(const std::array<Word, Sizes>&... lists) {
  std::array<Word, (Sizes + ...)> all{};
  std::size_t end = 0;
  const auto append = [&](const auto& list) {
    for (const Word word : list) all[end++] = word;
  };
  (append(lists), ...);
  return all;
}

constexpr std::array<Word, 3> material_words = {"restitution", "friction", "rolling"};
constexpr std::array<Word, 4> wall_words = {"restitution", "friction", "rolling", "thin"};
constexpr std::array<Word, 8> mesh_words = {"at",          "angle",    "axis",    "scale",
                                            "restitution", "friction", "rolling", "thin"};
constexpr std::array<Word, 8> chain_words = {"at",          "angle",    "scale",   "closed",
                                             "restitution", "friction", "rolling", "thin"};
constexpr auto heights_words = joined(mesh_words, std::array<Word, 2>{"from", "spacing"});
constexpr std::array<Word, 2> attraction_words = {"softening", "opening"};
constexpr std::array<Word, 2> drag_words = {"linear", "quadratic"};
constexpr std::array<Word, 2> exact_words = {"tolerance", "contact_time"};
constexpr std::array<Word, 7> fast_words = {"step",  "substeps",    "integrator", "threads",
                                            "hertz", "sleep_after", "sleep_speed"};
// What bodies have, alone and in patterns.
constexpr std::array<Word, 23> matter_words = {
    "velocity",     "angle",    "axis",     "spin",     "radius",      "mass",          "density",       "restitution",
    "friction",     "rolling",  "group",    "fixed",    "driven",      "sensor",        "gravity_scale", "damping",
    "spin_damping", "locked_x", "locked_y", "locked_z", "locked_turn", "locked_turn_x", "locked_turn_y"};
constexpr auto body_words = joined(std::array<Word, 5>{"at", "box", "capsule", "hull", "rounding"}, matter_words);
constexpr auto grid_words =
    joined(std::array<Word, 7>{"from", "spacing", "jitter", "seed", "box", "capsule", "rounding"}, matter_words);
constexpr auto random_words = joined(std::array<Word, 2>{"speed", "seed"}, matter_words);
constexpr auto stack_words = joined(std::array<Word, 4>{"from", "box", "capsule", "rounding"}, matter_words);
constexpr std::array<Word, 8> character_words = {"at", "radius", "height", "steepest", "step", "walk", "jump", "group"};
constexpr std::array<Word, 8> part_words = {"at", "axis", "angle", "radius", "box", "capsule", "hull", "rounding"};
constexpr std::array<Word, 3> spring_words = {"stiffness", "length", "damping"};
constexpr std::array<Word, 4> springs_words = {"stiffness", "length", "damping", "diagonal"};

bool is_one_of(Word word, std::span<const Word> words) {
  return std::ranges::find(words, word) != words.end();
}

bool is_flag(Word word) {
  constexpr std::array<Word, 14> flags = {"fixed",       "driven",        "diagonal",      "thin",         "closed",
                                          "collide",     "sensor",        "locked_x",      "locked_y",     "locked_z",
                                          "locked_turn", "locked_turn_x", "locked_turn_y", "locked_turn_z"};
  return is_one_of(word, flags);
}
bool takes_point(Word word) {
  constexpr std::array<Word, 7> points = {"at", "velocity", "from", "spacing", "box", "axis", "axle"};
  return is_one_of(word, points);
}
bool takes_name(Word word) {
  return word == "group" || word == "integrator";
}

}  // namespace

/// `world` before a brace, `force` and `torque` before `on`: anywhere else they are names.
bool Parser::at_world_word(Context context) {
  const bool world = at_word("world"), force = at_word("force") || at_word("torque");
  if (!world && !force) return false;
  const Token& next = look(1);
  const bool block = world && (next.kind == TokenKind::open_brace ||
                               (next.kind == TokenKind::line_end && look(2).kind == TokenKind::open_brace));
  const bool on = force && next.kind == TokenKind::name && spelled(next) == "on";
  if (!block && !on) return false;
  if (context == Context::mode || (block && context != Context::top)) require_allowed(spelled(current()), context);
  return true;
}

ast::Statement::Node Parser::parse_world_or_force() {
  const bool world = at_word("world"), torque = at_word("torque");
  advance();
  if (world) return parse_world();
  return parse_force(torque);
}

ast::World Parser::parse_world() {
  ast::World world;
  read_block("`{` with what is in the world", [&] { world.items.push_back(parse_world_item()); });
  expect_statement_end();
  return world;
}

ast::Force Parser::parse_force(bool is_torque) {
  advance();  // on
  ast::Force force;
  force.is_torque = is_torque;
  force.body = parse_name(is_torque ? "the name of a body, as in torque on ball = 2"
                                    : "the name of a body, as in force on ball = (0, -1)");
  expect(TokenKind::define, is_torque ? "`=` and the torque: a number in the plane, (0, 0, 2) in space"
                                      : "`=` and the components of the force, as in (0, -1)");
  if (!is_torque && !at(TokenKind::open_round)) unexpected("the components of the force, as in (0, -1)");
  force.value = is_torque ? parse_tree(Level::logical_or).expression : parse_point_with_unit();
  expect_statement_end();
  return force;
}

/// A bracket with two or three numbers and, if it stands there, their unit.
Expression Parser::parse_point_with_unit() {
  Expression point = parse_point();
  if (!at(TokenKind::unit)) return point;
  const Token token = advance();
  const std::string_view spelled_unit = spelled(token);
  ast::Unit unit{std::string(spelled_unit.substr(1, spelled_unit.size() - 2)), token.span};
  const Span span = since(point.span.begin);
  return {ast::Quantity{std::move(point), std::move(unit)}, span};
}

ast::WorldItem Parser::parse_world_item() {
  const Nesting nesting(*this);
  const std::uint32_t begin = current().span.begin;
  ast::WorldItem item;
  if (accept_word("for")) {
    item.node = parse_world_family();
    item.span = since(begin);
    return item;
  }
  if (!at(TokenKind::name)) unexpected("something of a world: body, wall, gravity, ...");
  const std::string word(spelled(current()));
  if (word == "force" || word == "torque") {
    fail(error("E123", current().span, fmt::format("a {} stands outside of the world", word), "",
               fmt::format("write it before or after the braces: {}",
                           word == "force" ? "force on ball = (0, -1)" : "torque on ball = 2")));
  }
  if (!is_one_of(word, item_words)) {
    std::string help = did_you_mean(word, item_words);
    if (help.empty()) help = fmt::format("a world holds: {}, for", fmt::join(item_words, ", "));
    fail(error("E125", current().span, fmt::format("nothing in a world begins with `{}`", word), "", help));
  }
  ast::Identifier name{word, advance().span};
  if (word == "wall") {
    item.node = parse_world_wall();
  } else if (word == "container") {
    item.node = parse_world_container();
  } else if (word == "body" || word == "character") {
    item.node = parse_world_body(word == "character");
  } else if (word == "bodies") {
    item.node = parse_world_bodies();
  } else if (word == "spring") {
    item.node = parse_world_spring();
  } else if (word == "springs") {
    item.node = parse_world_springs();
  } else if (is_one_of(word, joint_kinds)) {
    item.node = parse_world_joint(std::move(name));
  } else if (word == "part") {
    item.node = parse_world_part();
  } else if (word == "fix") {
    item.node = parse_world_fix();
  } else if (word == "ignore") {
    item.node = parse_world_ignore();
  } else {
    item.node = parse_world_setting(std::move(name));
  }
  item.span = since(begin);
  expect_statement_end();
  return item;
}

ast::WorldBody Parser::parse_world_body(bool is_character) {
  ast::WorldBody body;
  body.is_character = is_character;
  body.name = parse_name(is_character ? "the name of the character" : "the name of the body");
  if (body.name.primes > 0 || !body.name.member.empty())
    fail(error("E129", body.name.span, "the name of a body has no primes and no point", "", ""));
  body.attributes = is_character ? parse_world_attributes("a character", character_words)
                                 : parse_world_attributes("a body", body_words);
  return body;
}

ast::WorldSetting Parser::parse_world_setting(ast::Identifier word) {
  ast::WorldSetting setting;
  const std::string& which = word.text;
  if (which == "dimension") {
    setting.value = parse_sum_of_terms();
  } else if (which == "gravity") {
    setting.value = parse_point_with_unit();
  } else if (which == "material") {
    setting.attributes = parse_world_attributes("a material", material_words);
  } else if (which == "combine") {
    setting.attributes = parse_world_attributes("`combine`", material_words, true);
  } else if (which == "attraction") {
    setting.value = parse_sum_of_terms();
    setting.attributes = parse_world_attributes("an attraction", attraction_words);
  } else if (which == "drag") {
    setting.attributes = parse_world_attributes("drag", drag_words);
  } else {  // mode
    const Span span = current().span;
    if (!at_word("exact") && !at_word("fast")) unexpected("`exact` or `fast`", "as in mode fast step 1/60");
    const bool fast = at_word("fast");
    ast::Name name;
    name.text = spelled(advance());
    name.span = span;
    setting.value = Expression{std::move(name), span};
    setting.attributes = fast ? parse_world_attributes("the fast mode", fast_words)
                              : parse_world_attributes("the exact mode", exact_words);
  }
  setting.word = std::move(word);
  return setting;
}

std::optional<ast::Identifier> Parser::parse_name_of_wall() {
  if (!at(TokenKind::name)) return std::nullopt;
  return parse_identifier("a name, or a point such as (0, 1)");
}

/// A word before a point is the name of a half-space, and `chain` as well; before a second point it is what is built.
decltype(ast::WorldItem::node) Parser::parse_world_wall() {
  const Token& next = look(1);
  const bool is_word = next.kind == TokenKind::name && (spelled(next) == "from" || spelled(next) == "for");
  const bool has_no_name = (at_word("mesh") && next.kind == TokenKind::text) ||
                           (at_word("heights") && (next.kind == TokenKind::text || is_word)) ||
                           (at_word("chain") && (next.kind == TokenKind::open_round || is_word));
  std::optional<ast::Identifier> name = has_no_name ? std::nullopt : parse_name_of_wall();
  if (at_word("mesh")) return parse_world_mesh(std::move(name));
  if (at_word("heights")) return parse_heights(std::move(name));
  if (!at_word("chain")) return parse_half_space(std::move(name), parse_point());
  ast::Identifier kind = parse_identifier("`chain`");
  if (!at(TokenKind::open_round)) return parse_chain(std::move(name), std::move(kind));
  Expression first = parse_point_with_unit();
  if (!name && at_word("at") && !std::holds_alternative<ast::Quantity>(first.node))
    return parse_half_space(std::move(kind), std::move(first));
  return parse_chain(std::move(name), std::move(kind), std::move(first));
}

ast::WorldWall Parser::parse_half_space(std::optional<ast::Identifier> name, Expression normal) {
  ast::WorldWall wall;
  wall.name = std::move(name);
  wall.normal = std::move(normal);
  expect_word("at", "`at` and how far it is from the origin, as in wall (0, 1) at 0");
  wall.offset = parse_sum_of_terms();
  wall.attributes = parse_world_attributes("a wall", wall_words);
  return wall;
}

ast::WorldMesh Parser::parse_world_mesh(std::optional<ast::Identifier> name) {
  ast::WorldMesh mesh;
  mesh.name = std::move(name);
  mesh.kind = parse_identifier("`mesh`");
  const Span span = current().span;
  mesh.corners = {ast::Text{parse_text("the name of a file, as in mesh \"hills.obj\"")}, span};
  mesh.attributes = parse_world_attributes("a mesh", mesh_words);
  return mesh;
}

/// What stands in braces behind `for` and these indices.
template <class Parse>
Expression Parser::parse_for_each(const std::vector<std::pair<ast::Identifier, ast::Range>>& families, Word what,
                                  Word end, Parse&& parse) {
  expect(TokenKind::open_brace, fmt::format("`{{` and {}", what));
  for (const auto& [index, range] : families) indices_.push_back(index.text);
  accept(TokenKind::line_end);
  Expression made = parse();
  for (std::size_t k = 0; k < families.size(); ++k) indices_.pop_back();
  accept(TokenKind::line_end);
  expect(TokenKind::close_brace, std::string(end));
  return made;
}

ast::WorldMesh Parser::parse_heights(std::optional<ast::Identifier> name) {
  ast::WorldMesh heights;
  heights.name = std::move(name);
  heights.kind = parse_identifier("`heights`");
  const Span span = current().span;
  if (accept_word("for")) {
    heights.families.push_back(parse_index());
    expect(TokenKind::comma, "`,` and a second index, as in for i in 0..9, j in 0..9 { sin(i)*sin(j) }");
    heights.families.push_back(parse_index());
    heights.corners = parse_for_each(heights.families, "the height for each, as in { sin(i)*sin(j) }", "`}`",
                                     [&] { return parse_tree(Level::additive).expression; });
  } else {
    heights.corners = {ast::Text{parse_text("the name of a file, as in heights \"hills.csv\", or `for`")}, span};
  }
  heights.attributes = parse_world_attributes("a field of heights", heights_words);
  return heights;
}

/// Behind `chain` and, where it begins with a point, behind that.
ast::WorldMesh Parser::parse_chain(std::optional<ast::Identifier> name, ast::Identifier kind,
                                   std::optional<Expression> first) {
  constexpr Word example = "as in chain (0, 0) (4, 0) (6, 1)";
  ast::WorldMesh chain;
  chain.name = std::move(name);
  chain.kind = std::move(kind);
  if (!first && accept_word("from")) {
    const Span span = current().span;
    chain.corners = {ast::Text{parse_text("the name of a file, as in chain from \"hills.csv\"")}, span};
  } else if (!first && accept_word("for")) {
    chain.families.push_back(parse_index());
    chain.corners =
        parse_for_each(chain.families, "the points for each, as in for k in 0..9 { (k, h[k]) }",
                       "a further point, or `}`", [&] { return parse_points("as in for k in 0..9 { (k, h[k]) }"); });
  } else {
    chain.corners = parse_points(example, std::move(first));
  }
  chain.attributes = parse_world_attributes("a chain", chain_words);
  return chain;
}

ast::WorldContainer Parser::parse_world_container() {
  ast::WorldContainer container;
  container.name = parse_name_of_wall();
  container.lower = parse_point_with_unit();
  expect_word("to", "`to` and the other corner, as in container (0, 0) to (20, 20)");
  container.upper = parse_point_with_unit();
  container.attributes = parse_world_attributes("a container", material_words);
  return container;
}

ast::WorldBodies Parser::parse_world_bodies() {
  constexpr std::array<Word, 3> patterns = {"grid", "random", "stack"};
  ast::WorldBodies bodies;
  bodies.name = parse_identifier("the name of the bodies");
  const std::string word(at(TokenKind::name) ? spelled(current()) : Word());
  if (!is_one_of(word, patterns)) {
    std::string help = word.empty() ? std::string() : did_you_mean(word, patterns);
    if (help.empty()) help = fmt::format("as in bodies {} grid 10 x 5 from (0, 0) spacing (1, 1)", bodies.name.text);
    unexpected("a pattern: grid, random or stack", help);
  }
  advance();
  bodies.counts.push_back(parse_sum_of_terms());
  if (word == "grid") {
    bodies.pattern = ast::Pattern::grid;
    while (accept_word("x")) bodies.counts.push_back(parse_sum_of_terms());
    bodies.attributes = parse_world_attributes("a grid", grid_words);
  } else if (word == "random") {
    bodies.pattern = ast::Pattern::random;
    expect_word("in", "`in` and a box, as in random 100 in (0, 0) to (20, 20)");
    bodies.lower = parse_point_with_unit();
    expect_word("to", "`to` and the other corner of the box");
    bodies.upper = parse_point_with_unit();
    bodies.attributes = parse_world_attributes("this pattern", random_words);
  } else {
    bodies.pattern = ast::Pattern::stack;
    bodies.attributes = parse_world_attributes("a stack", stack_words);
  }
  return bodies;
}

ast::WorldSpring Parser::parse_world_spring() {
  ast::WorldSpring spring;
  spring.a = parse_name("the name of a body, as in spring ball to anchor");
  expect_word("to", "`to` and a body or a point, as in spring ball to (0, 5)");
  if (at(TokenKind::open_round)) {
    spring.b = parse_point_with_unit();
  } else {
    spring.b = parse_name("a body or a point");
  }
  spring.attributes = parse_world_attributes("a spring", spring_words);
  return spring;
}

ast::WorldSprings Parser::parse_world_springs() {
  ast::WorldSprings springs;
  expect_word("of", "`of` and the name of bodies, as in springs of chain stiffness 100");
  springs.pattern = parse_identifier("the name of bodies that a pattern made");
  springs.attributes = parse_world_attributes("a spring", springs_words);
  return springs;
}

ast::WorldPart Parser::parse_world_part() {
  ast::WorldPart part;
  expect_word("of", "`of` and the name of a body, as in part of hammer at (0.5, 0) box (0.2, 0.5)");
  part.of = parse_name("the name of a body");
  part.attributes = parse_world_attributes("a part", part_words);
  return part;
}

ast::WorldFix Parser::parse_world_fix() {
  ast::WorldFix fix;
  do {
    fix.bodies.push_back(parse_name("the name of a body"));
  } while (accept(TokenKind::comma));
  return fix;
}

ast::WorldIgnore Parser::parse_world_ignore() {
  ast::WorldIgnore ignore;
  ignore.a = parse_identifier("the name of a group");
  expect_word("with", "`with` and the name of a group, as in ignore pegs with pegs");
  ignore.b = parse_identifier("the name of a group");
  return ignore;
}

ast::WorldFamily Parser::parse_world_family() {
  return parse_indices<ast::WorldFamily>([&] {
    std::vector<ast::WorldItem> body;
    read_block("`{` with what is repeated", [&] { body.push_back(parse_world_item()); });
    expect_statement_end();
    return body;
  });
}

ast::WorldAttributes Parser::parse_world_attributes(Word of, std::span<const Word> known, bool all_names) {
  ast::WorldAttributes attributes;
  while (true) {
    accept(TokenKind::comma);
    if (!at(TokenKind::name)) break;
    const std::string word(spelled(current()));
    if (!is_one_of(word, known)) {
      std::string help = did_you_mean(word, known);
      if (help.empty()) help = fmt::format("{} has: {}", of, fmt::join(known, ", "));
      report(error("E125", current().span, fmt::format("{} has no `{}`", of, word), "", help));
      skip_to_attribute(known);
      continue;
    }
    if (std::ranges::any_of(attributes, [&](const auto& other) { return other.name.text == word; }))
      report(error("E124", current().span, fmt::format("`{}` is given twice", word), "", "keep one of them"));
    ast::WorldAttribute attribute;
    attribute.name = {word, advance().span};
    if (is_flag(word)) {
      attribute.value = {ast::Missing{}, attribute.name.span};
    } else if (all_names || takes_name(word)) {
      if (all_names && !at(TokenKind::name))
        unexpected(fmt::format("a name after `{}`", word), fmt::format("one of {}", fmt::join(combinations, ", ")));
      attribute.value = parse_world_name(word);
    } else {
      attribute.value = parse_world_value(word);
    }
    attributes.push_back(std::move(attribute));
  }
  if (!at_statement_end()) left_over({});
  return attributes;
}

/// Past a word that is none, and whatever was meant as its value: to the next word that is one, or nearly.
void Parser::skip_to_attribute(std::span<const Word> known) {
  advance();
  for (; !at_statement_end() && !at(TokenKind::open_brace); advance()) {
    if (!at(TokenKind::name)) continue;
    const Word word = spelled(current());
    if (is_one_of(word, known) || !did_you_mean(word, known).empty()) return;
  }
}

Expression Parser::parse_world_value(Word word) {
  if (takes_point(word)) return parse_point_with_unit();
  if (word == "hull") return parse_points("as in hull (0, 0) (1, 0) (0, 1)");
  if (word == "ends") return parse_points("as in ends (0, 0) (0, 5): where it holds the first and the second");
  if (word == "limits") return parse_limits();
  if (word == "torque" || word == "force") return parse_most(word);
  if (word == "spin" || word == "angle" || word == "walk")
    return parse_tree(Level::additive).expression;  // in space a list
  return parse_sum_of_terms();
}

Expression Parser::parse_world_name(Word word) {
  const ast::Identifier name = parse_identifier(fmt::format("a name after `{}`", word));
  ast::Name value;
  value.text = name.text;
  value.span = name.span;
  return {std::move(value), name.span};
}

}  // namespace continuo::model::detail
