// Parses the settings of a model: run, plot, draw, check.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <continuo/language/syntax/blackboard.hpp>
#include <continuo/language/syntax/parser_core.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

using ast::Expression;
using Words = std::span<const std::string_view>;

constexpr std::array<std::string_view, 7> run_parts = {"output", "method", "step", "tol", "abs", "max", "realtime"};

constexpr std::array<std::string_view, 1> floor_attributes = {"color"};
constexpr std::array<std::string_view, 4> ball_attributes = {"radius", "color", "label", "drag"};
constexpr std::array<std::string_view, 4> spring_attributes = {"turns", "width", "color", "label"};
constexpr std::array<std::string_view, 3> rod_attributes = {"width", "color", "label"};
constexpr std::array<std::string_view, 4> rope_attributes = {"length", "width", "color", "label"};
constexpr std::array<std::string_view, 3> arrow_attributes = {"scale", "color", "label"};
constexpr std::array<std::string_view, 3> trail_attributes = {"length", "width", "color"};
constexpr std::array<std::string_view, 5> box_attributes = {"size", "angle", "color", "label", "drag"};
constexpr std::array<std::string_view, 2> text_attributes = {"size", "color"};

struct ShapeRule {
  std::string_view name;
  ast::ShapeKind kind;
  int points;
  Words attributes;
};
const std::array<ShapeRule, 9> shapes = {{
    {"floor", ast::ShapeKind::floor, 0, floor_attributes},
    {"ball", ast::ShapeKind::ball, 1, ball_attributes},
    {"spring", ast::ShapeKind::spring, 2, spring_attributes},
    {"rod", ast::ShapeKind::rod, 2, rod_attributes},
    {"rope", ast::ShapeKind::rope, 2, rope_attributes},
    {"arrow", ast::ShapeKind::arrow, 2, arrow_attributes},
    {"trail", ast::ShapeKind::trail, 1, trail_attributes},
    {"box", ast::ShapeKind::box, 1, box_attributes},
    {"text", ast::ShapeKind::text, 1, text_attributes},
}};

}  // namespace

ast::Run Parser::parse_run() {
  ast::Run run;
  const std::uint32_t begin = current().span.begin;
  const bool is_pair =
      at(TokenKind::open_round) && look(1).kind == TokenKind::number && look(2).kind == TokenKind::comma;
  if (at(TokenKind::unit) || is_pair) unexpected("the start of the run", help_for_run(begin));
  Expression first = parse_sum_of_terms();
  if (!at(TokenKind::dots)) {
    std::string help = help_for_run(begin);
    if (help.empty()) help = fmt::format("write run 0..{}", source_.slice(first.span));
    unexpected("`..` and the end of the run", std::move(help));
  }
  run.interval = parse_range_from(std::move(first));
  while (true) {
    const bool comma = accept(TokenKind::comma);
    if (parse_run_part(run)) continue;
    if (comma && current().goes_on) {
      const Span sign{current().goes_on_from, current().goes_on_from + 1};
      fail(error("E110", sign, "a part of the run is missing after `,`", "",
                 "parts are output, method, step, tol, abs, max step, max steps and realtime"));
    }
    if (comma && !at_statement_end() && at(TokenKind::name))
      left_over({"output", "method", "step", "tol", "abs", "max", "realtime"});
    if (comma) unexpected("a part of the run after the comma: output, method, step, tol, abs, max or realtime");
    break;
  }
  if (at_word("dt") || at_word("by") || at_word("every"))
    unexpected("the end of the statement",
               "rows in equal intervals are written run 0..10 output 0.1, steps of one size run 0..10 step 0.1");
  expect_statement_end({"output", "method", "step", "tol", "abs", "max", "realtime"});
  return run;
}

/// For `run 0,10`, `0 to 10`, `0:10`, `0:0.1:10`, `[0, 10]`, `(0, 10)`, `0-10`, `until 10`: the range that was meant.
std::string Parser::help_for_run(std::uint32_t begin) {
  std::string text(source_.text().substr(begin, source_.text().find_first_of("\n;#{", begin) - begin));
  for (const std::string_view word :
       {" to ", " until ", " till ", ":", ",", "[", "]", "(", ")", "until ", "to ", "for "})
    for (std::size_t i = text.find(word); i != std::string::npos; i = text.find(word))
      text.replace(i, word.size(), "\n");
  if (text.find_first_of("eE") == std::string::npos) std::ranges::replace(text, '-', '\n');
  std::vector<std::string> numbers;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = std::min(text.find('\n', i), text.size());
    std::string number = text.substr(i, end - i);
    number.erase(0, number.find_first_not_of(" \t\r"));
    number.erase(number.find_last_not_of(" \t\r") + 1);
    if (!number.empty() && number.find_first_not_of("0123456789.eE-+") != std::string::npos) return {};
    if (!number.empty()) numbers.push_back(std::move(number));
    i = end + 1;
  }
  if (numbers.size() == 1) return fmt::format("write run 0..{}", numbers[0]);
  if (numbers.size() == 2) return fmt::format("write run {}..{}", numbers[0], numbers[1]);
  if (numbers.size() == 3) return fmt::format("write run {}..{} output {}", numbers[0], numbers[2], numbers[1]);
  return {};
}

bool Parser::parse_run_part(ast::Run& run) {
  if (!at(TokenKind::name)) return false;
  const std::string word(spelled(current()));
  if (std::find(run_parts.begin(), run_parts.end(), word) == run_parts.end()) return false;
  const bool given = (word == "output" && run.output) || (word == "method" && run.method) ||
                     (word == "step" && run.step) || (word == "tol" && run.relative_tolerance) ||
                     (word == "abs" && !run.absolute_tolerance.empty()) || (word == "realtime" && run.realtime);
  if (given) fail(error("E124", current().span, fmt::format("`{}` is given twice", word), "", "keep one of them"));
  advance();
  if (word == "max") {
    parse_limit_of_steps(run);
  } else if (word == "output") {
    run.output = parse_output_times();
  } else if (word == "method") {
    run.method = parse_identifier("the name of a method, as in `method dop853`");
  } else if (word == "step") {
    run.step = parse_sum_of_terms();
  } else if (word == "realtime") {
    run.realtime = true;
  } else {
    parse_tolerances(run, word == "tol");
  }
  return true;
}

/// `max step 0.01`: none is longer; `max steps 10000`: there are no more.
void Parser::parse_limit_of_steps(ast::Run& run) {
  const bool length = at_word("step");
  if (!length && !at_word("steps"))
    unexpected("`step` or `steps`",
               "write max step 0.01 for the longest step, max steps 10000 for how many there may be");
  std::optional<Expression>& limit = length ? run.max_step : run.max_steps;
  if (limit) {
    fail(error("E124", current().span, fmt::format("`max {}` is given twice", spelled(current())), "",
               "keep one of them"));
  }
  advance();
  limit = parse_sum_of_terms();
}

ast::OutputTimes Parser::parse_output_times() {
  if (accept_word("steps")) return ast::OutputSteps{};
  if (!at_word("log") || look(1).kind == TokenKind::open_round) return ast::OutputEvery{parse_sum_of_terms()};
  advance();
  ast::OutputLogarithmic output;
  output.per_decade = parse_sum_of_terms();
  expect_word("per", "`per decade`, as in output log 10 per decade from 1e-3");
  expect_word("decade", "`decade`, as in output log 10 per decade from 1e-3");
  expect_word("from", "`from` and the first time, as in output log 10 per decade from 1e-3");
  output.from = parse_sum_of_terms();
  return output;
}

void Parser::parse_tolerances(ast::Run& run, bool relative) {
  if (relative) {
    run.relative_tolerance = parse_value();
    return;
  }
  Expression value = parse_value_or_list();
  if (auto* list = std::get_if<ast::List>(&value.node)) {
    run.absolute_tolerance = std::move(list->items);
  } else {
    run.absolute_tolerance.push_back(std::move(value));
  }
}

ast::Plot Parser::parse_plot() {
  ast::Plot plot;
  do {
    plot.curves.push_back(parse_sum_of_terms());
  } while (accept(TokenKind::comma));
  if (accept_word("against")) plot.against = parse_sum_of_terms();
  if (at_word("vs") || at_word("versus") || at_word("over"))
    unexpected("the end of the statement", with_corrected_line("write `against`", source_, current().span, "against"));
  expect_statement_end({"against"});
  return plot;
}

ast::Draw Parser::parse_draw() {
  ast::Draw draw;
  read_block("`{` with what is drawn", [&] { draw.items.push_back(parse_draw_item()); });
  return draw;
}

ast::DrawFamily Parser::parse_draw_family() {
  return parse_indices<ast::DrawFamily>([&] {
    std::vector<ast::DrawItem> body;
    read_block("`{` with what is drawn for each", [&] { body.push_back(parse_draw_item()); });
    return body;
  });
}

ast::DrawItem Parser::parse_draw_item() {
  const Nesting nesting(*this);
  const std::uint32_t begin = current().span.begin;
  if (accept_word("for")) {
    ast::DrawFamily family = parse_draw_family();
    return {std::move(family), since(begin)};
  }
  ast::Shape shape = parse_shape();
  return {std::move(shape), since(begin)};
}

ast::Shape Parser::parse_shape() {
  if (!at(TokenKind::name)) unexpected("a shape: floor, ball, spring, rod, rope, arrow, trail, box or text");
  const std::string_view word = spelled(current());
  const auto rule = std::find_if(shapes.begin(), shapes.end(), [&](const ShapeRule& r) { return r.name == word; });
  if (rule == shapes.end()) {
    std::vector<std::string_view> names;
    for (const ShapeRule& known : shapes) names.push_back(known.name);
    std::string help = did_you_mean(word, names);
    if (help.empty()) help = "shapes are floor, ball, spring, rod, rope, arrow, trail, box, text";
    fail(error("E125", current().span, fmt::format("no shape is called `{}`", word), "", help));
  }
  advance();
  ast::Shape shape;
  shape.kind = rule->kind;
  if (rule->kind == ast::ShapeKind::floor) shape.arguments.push_back(parse_sum_of_terms());
  for (int i = 0; i < rule->points; ++i) {
    if (i > 0) accept_word("to");
    shape.arguments.push_back(parse_point());
  }
  if (rule->kind == ast::ShapeKind::text) {
    const Span span = current().span;
    shape.arguments.push_back({ast::Text{parse_text("a text, as in text (0, 1) \"hello\"")}, span});
  }
  parse_attributes(shape, rule->attributes);
  return shape;
}

/// Parsed as one bracket, so that two points may follow each other: spring (0, 0) (x, y).
Expression Parser::parse_point() {
  if (!at(TokenKind::open_round)) unexpected("a point, as in (0, h)");
  Expression point = parse_round().expression;
  const auto* list = std::get_if<ast::List>(&point.node);
  if (list && (list->items.size() == 2 || list->items.size() == 3)) return point;
  fail(error("E132", point.span, "a point has two or three coordinates", "", "write it as (x, y) or (x, y, z)"));
}

void Parser::parse_attributes(ast::Shape& shape, Words known) {
  while (true) {
    accept(TokenKind::comma);
    if (!at(TokenKind::name)) break;
    const std::string word(spelled(current()));
    if (std::find(known.begin(), known.end(), word) == known.end()) {
      std::string help = did_you_mean(word, known);
      if (help.empty()) help = fmt::format("this shape has: {}", fmt::join(known, ", "));
      fail(error("E125", current().span, fmt::format("this shape has no `{}`", word), "", help));
    }
    for (const ast::Attribute& other : shape.attributes) {
      if (other.name.text == word)
        fail(error("E124", current().span, fmt::format("`{}` is given twice", word), "", "keep one of them"));
    }
    ast::Attribute attribute;
    attribute.name = {word, advance().span};
    if (word == "drag") {  // a word alone
      attribute.value = {ast::Text{}, attribute.name.span};
    } else if (word == "color" || word == "label") {
      const Span span = current().span;
      attribute.value = {ast::Text{parse_text("a text in quotes")}, span};
    } else if (shape.kind == ast::ShapeKind::box && word == "size") {
      attribute.value = parse_point();
    } else {
      attribute.value = parse_sum_of_terms();
    }
    shape.attributes.push_back(std::move(attribute));
  }
  expect_statement_end();
}

ast::AtEvent Parser::parse_event_reference(bool after) {
  ast::AtEvent event;
  event.after = after;
  expect_word("event", "`event` and its number, as in `event 3`");
  if (at(TokenKind::define) || at_statement_end())
    unexpected("the number of the event", "events are counted from 1, as in `event 1`");
  event.number = parse_sum_of_terms();
  if (accept_word("of")) event.event = parse_text("an event, as in of \"h falls\"");
  return event;
}

ast::Moment Parser::parse_moment() {
  if (accept_word("before")) return parse_event_reference(false);
  if (accept_word("after")) return parse_event_reference(true);
  if (!accept_word("at")) return ast::AtEnd{};
  if (accept_word("end")) return ast::AtEnd{};
  if (at_word("event")) return parse_event_reference(false);
  return ast::AtTime{parse_sum_of_terms()};
}

ast::Measure Parser::parse_measure() {
  const auto two_words = [this](std::string_view first, std::string_view second) {
    if (!at_word(first) || look(1).kind != TokenKind::name || spelled(look(1)) != second) return false;
    advance();
    advance();
    return true;
  };
  if (two_words("energy", "drift")) return ast::EnergyDrift{};
  if (two_words("time", "of")) {
    if (accept_word("end")) return ast::TimeOfEnd{};
    return ast::TimeOfEvent{parse_event_reference(false)};
  }
  if (two_words("count", "of")) {
    if (accept_word("events")) return ast::CountOfEvents{};
    return ast::CountOfEvents{parse_text("`events` or an event, as in count of \"h falls\"")};
  }
  if (at_word("always") && look(1).kind != TokenKind::define) {
    advance();
    return ast::AlwaysValueOf{parse_sum_of_terms()};
  }
  Expression expression = parse_sum_of_terms();
  return ast::ValueOf{std::move(expression), parse_moment()};
}

ast::Check Parser::parse_check() {
  ast::Check check;
  const std::uint32_t begin = current().span.begin;
  check.measure = parse_measure();
  check.measure_span = since(begin);
  const bool always = std::holds_alternative<ast::AlwaysValueOf>(check.measure);
  const Token& sign = current();
  switch (sign.kind) {
    case TokenKind::define:
      check.relation = ast::Relation::equal;
      break;
    case TokenKind::less:
      check.relation = ast::Relation::less;
      break;
    case TokenKind::less_equal:
      check.relation = ast::Relation::less_equal;
      break;
    case TokenKind::greater:
      check.relation = ast::Relation::greater;
      break;
    case TokenKind::greater_equal:
      check.relation = ast::Relation::greater_equal;
      break;
    case TokenKind::equal:
      fail(error("E126", sign.span, "a check is written with `=`", "", "write check h(1) = 5.1 within 1e-9"));
    default:
      if (sign.kind != TokenKind::close_round && sign.kind != TokenKind::unit)
        unexpected("`=`, `<`, `<=`, `>` or `>=` and the value expected",
                   "write check h(1) = 5.1 within 1e-9, or check energy drift < 1e-8");
      left_over({"at", "before", "after"});
  }
  advance();
  check.value = parse_sum_of_terms();
  const bool exact = std::holds_alternative<ast::CountOfEvents>(check.measure);
  const bool equality = check.relation == ast::Relation::equal;
  if (at_word("within")) {
    if (!equality || exact) {
      fail(error("E126", current().span, "this check takes no tolerance", "",
                 exact ? "a count is exact" : "only `=` is within something"));
    }
    advance();
    check.tolerance = parse_sum_of_terms();
  } else if (equality && !exact && at_statement_end()) {
    fail(error("E126", since(begin), "this check needs a tolerance", "",
               fmt::format("write check {} within 1e-9", source_.slice(since(begin)))));
  }
  expect_statement_end({"within"});
  if (always && equality && !check.tolerance) unexpected("`within`");
  return check;
}

}  // namespace continuo::model::detail
