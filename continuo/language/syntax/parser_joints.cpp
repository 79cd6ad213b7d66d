// Joints in `world { ... }`: what they connect, and values that only they and hulls have.
#include <array>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/syntax/parser_core.hpp>
#include <continuo/language/text/words.hpp>

namespace continuo::model::detail {

namespace {

using ast::Expression;
using Word = std::string_view;

constexpr std::array<Word, 11> hinge_words = {
    "at", "axis", "limits", "motor", "torque", "spring", "damping", "rest", "breaks_at", "breaks_at_torque", "collide"};
constexpr std::array<Word, 11> slider_words = {
    "at", "axis", "limits", "motor", "force", "spring", "damping", "rest", "breaks_at", "breaks_at_torque", "collide"};
constexpr std::array<Word, 12> wheel_words = {
    "at",      "axis", "axle",      "limits",           "motor",  "torque", "spring",
    "damping", "rest", "breaks_at", "breaks_at_torque", "collide"};
constexpr std::array<Word, 4> weld_words = {"at", "breaks_at", "breaks_at_torque", "collide"};
constexpr std::array<Word, 3> ball_words = {"at", "breaks_at", "collide"};
constexpr std::array<Word, 7> distance_words = {"ends", "limits", "spring", "damping", "rest", "breaks_at", "collide"};
constexpr std::array<Word, 4> rope_words = {"ends", "length", "breaks_at", "collide"};
constexpr std::array<Word, 6> universal_words = {"at", "axis", "axle", "breaks_at", "breaks_at_torque", "collide"};
constexpr std::array<Word, 5> gear_words = {"axis", "axle", "ratio", "breaks_at_torque", "collide"};
constexpr std::array<Word, 4> pull_words = {"at", "spring", "damping", "force"};

std::span<const Word> words_of(Word kind) {
  if (kind == "hinge") return hinge_words;
  if (kind == "slider") return slider_words;
  if (kind == "wheel") return wheel_words;
  if (kind == "weld") return weld_words;
  if (kind == "ball") return ball_words;
  if (kind == "distance") return distance_words;
  if (kind == "rope") return rope_words;
  if (kind == "universal") return universal_words;
  if (kind == "pull") return pull_words;
  return gear_words;
}

}  // namespace

ast::WorldJoint Parser::parse_world_joint(ast::Identifier kind) {
  ast::WorldJoint joint;
  const std::string& word = kind.text;
  joint.first = parse_name(fmt::format("the name of a body, as in {} door to frame", word));
  if (accept(TokenKind::colon)) {
    joint.name = std::move(joint.first);
    if (joint.name->primes > 0 || !joint.name->member.empty())
      fail(error("E129", joint.name->span, "the name of a joint has no primes and no point", "", ""));
    joint.first = parse_name(fmt::format("the name of a body, as in {} knee: shin to thigh", word));
  }
  if (accept_word("to")) {
    if (at(TokenKind::open_round)) {
      joint.second = parse_point_with_unit();
    } else {
      joint.second = parse_name("a body or a point");
    }
  }
  joint.attributes = parse_world_attributes(fmt::format("a {}", word), words_of(word));
  joint.kind = std::move(kind);
  return joint;
}

/// Points one after the other. A unit is that of all points before it that have none.
Expression Parser::parse_points(Word example, std::optional<Expression> first) {
  const std::uint32_t begin = first ? first->span.begin : current().span.begin;
  if (!first && !at(TokenKind::open_round)) unexpected("points", std::string(example));
  ast::List points;
  std::size_t without_unit = 0;
  // Nothing in a world begins with a bracket: a line that does goes on with the points.
  const auto goes_on = [&] {
    std::size_t next = 0;
    while (look(next).kind == TokenKind::line_end) ++next;
    return look(next).kind == TokenKind::open_round;
  };
  while (first || goes_on()) {
    while (!first && accept(TokenKind::line_end)) {
    }
    points.items.push_back(first ? *std::exchange(first, std::nullopt) : parse_point_with_unit());
    const auto* quantity = std::get_if<ast::Quantity>(&points.items.back().node);
    if (!quantity) continue;
    const ast::Unit unit = quantity->unit;
    for (std::size_t i = without_unit; i + 1 < points.items.size(); ++i) {
      const Span span = points.items[i].span;
      points.items[i] = {ast::Quantity{std::move(points.items[i]), unit}, span};
    }
    without_unit = points.items.size();
  }
  return {std::move(points), since(begin)};
}

/// `-90..90 [deg]`: two numbers, with their unit.
Expression Parser::parse_limits() {
  const std::uint32_t begin = current().span.begin;
  ast::Range range = parse_range();
  ast::List ends;
  ends.items.push_back(std::move(*range.first));
  ends.items.push_back(std::move(*range.last));
  const Span span = range.span;
  if (!range.unit) return {std::move(ends), span};
  return {ast::Quantity{Expression{std::move(ends), span}, std::move(*range.unit)}, since(begin)};
}

/// `at most 5 [N m]`.
Expression Parser::parse_most(Word word) {
  const std::string wanted = fmt::format("`at most` and the greatest {0}, as in {0} at most 5", word);
  expect_word("at", wanted);
  expect_word("most", wanted);
  return parse_sum_of_terms();
}

}  // namespace continuo::model::detail
