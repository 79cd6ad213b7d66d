// Parses events, schedules and their actions.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <continuo/language/syntax/parser_core.hpp>
#include <continuo/language/text/words.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

using ast::Expression;

constexpr std::array<std::string_view, 3> direction_words = {"falls", "rises", "crosses"};

/// Whether it can be true or false; names and calls may not, and a call of `if` may.
bool is_condition(const Expression& expression) {
  if (const auto* binary = std::get_if<ast::Binary>(&expression.node)) return binary->op >= ast::BinaryOperator::less;
  if (const auto* unary = std::get_if<ast::Unary>(&expression.node))
    return unary->op == ast::UnaryOperator::logical_not;
  return std::holds_alternative<ast::Conditional>(expression.node);
}

}  // namespace

ast::When Parser::parse_when() {
  ast::When event;
  const std::uint32_t begin = last_span_.begin;
  event.subject = {ast::Missing{}, last_span_};
  try {
    event.subject = parse_expression();
    parse_direction(event);
    if (accept_word("in")) event.mode = parse_identifier("the name of a mode");
    if (!at(TokenKind::open_brace) && !at(TokenKind::line_end))
      left_over({"in", "through", "falls", "rises", "crosses"});
  } catch (const StatementFailed&) {
    recover_to_block();  // the actions are read all the same, for their own faults
  }
  event.head = since(begin);
  event.actions = parse_actions("`{` with the actions of the event");
  event.limit_actions = parse_limit_actions();
  return event;
}

/// `then { ... }`, or `then go rest`: at the limit of an event that accumulates.
std::optional<std::vector<ast::Action>> Parser::parse_limit_actions() {
  const Token& next = look_past_line_ends();
  if (next.kind != TokenKind::name || spelled(next) != "then") return std::nullopt;
  skip_line_ends();
  advance();
  const std::string_view wanted = "`{` with the actions at the limit, or `go` and a mode";
  if (!at_word("go")) return parse_actions(wanted);
  std::vector<ast::Action> actions;
  actions.push_back(parse_action());
  return actions;
}

void Parser::parse_direction(ast::When& event) {
  if (at(TokenKind::define) || at(TokenKind::assign)) {
    const auto* name = std::get_if<ast::Name>(&event.subject.node);
    fail(error("E120", current().span, fmt::format("{} cannot compare", describe(current(), source_)), "",
               name && name->text == "t" ? "at a time: at 3 { ... }"
                                         : "an event is a crossing: when h falls through 0 { ... }"));
  }
  const bool condition = is_condition(event.subject);
  if (!at(TokenKind::name) || at_word("in")) {
    if (condition) return;
    if (current().problem) fail(*current().problem);
    if (!at(TokenKind::open_brace) && !at_word("in")) left_over({});
    fail(error("E125", event.subject.span, "when does this happen?", "this is a number, neither true nor false",
               fmt::format("write when {0} falls through 0 {{ ... }}, or a condition as in when {0} < 0 {{ ... }}",
                           source_.slice(event.subject.span))));
  }
  const std::string_view word = spelled(current());
  if (word == "falls") {
    event.direction = Direction::falls;
  } else if (word == "rises") {
    event.direction = Direction::rises;
  } else if (word == "crosses") {
    event.direction = Direction::crosses;
  } else {
    std::string help = did_you_mean(word, direction_words);
    if (help.empty()) help = "write falls, rises or crosses: when h falls through 0 { ... }";
    if (word == "then" || word == "do")
      help = fmt::format("what happens stands in braces: when {} {{ ... }}", source_.slice(event.subject.span));
    fail(error("E125", current().span, fmt::format("`{}` is no direction", word), "", help));
  }
  if (condition) {
    fail(error("E125", current().span,
               fmt::format("a condition does not {}", word == "falls"   ? "fall"
                                                      : word == "rises" ? "rise"
                                                                        : "cross"),
               "", "leave the word out: the event is that the condition becomes true"));
  }
  advance();
  if (!accept_word("through") && at(TokenKind::name) && look(1).kind != TokenKind::open_brace) {
    const std::string help = did_you_mean(spelled(current()), std::array<std::string_view, 1>{"through"});
    constexpr std::array<std::string_view, 9> others{"below", "above", "to", "under", "over",
                                                     "thru",  "past",  "by", "beyond"};
    const bool other = std::ranges::any_of(others, [this](std::string_view known) { return at_word(known); });
    if (!help.empty() || other)
      fail(error("E125", current().span, fmt::format("`{}` is not known here", spelled(current())), "",
                 "write `through`"));
  }
  if (at(TokenKind::open_brace) || at_word("in") || at(TokenKind::line_end)) {
    unexpected("the value that is crossed",
               fmt::format("write: when {} {} through 0", source_.slice(event.subject.span), word));
  }
  event.level = parse_sum_of_terms();
}

ast::At Parser::parse_at() {
  ast::At event;
  const std::uint32_t begin = last_span_.begin;
  event.time = {ast::Missing{}, last_span_};
  try {
    event.time = parse_sum_of_terms();
    if (at(TokenKind::define) || at(TokenKind::equal))
      fail(error("E110", current().span, "expected `{`, found " + describe(current(), source_), "",
                 "the time stands alone: at 3 { ... }"));
  } catch (const StatementFailed&) {
    recover_to_block();
  }
  event.head = since(begin);
  event.actions = parse_actions("`{` with what happens at this time");
  return event;
}

ast::Every Parser::parse_every() {
  ast::Every event;
  const std::uint32_t begin = last_span_.begin;
  event.period = {ast::Missing{}, last_span_};
  try {
    event.period = parse_sum_of_terms();
    if (accept_word("from")) event.from = parse_sum_of_terms();
    if (!at(TokenKind::open_brace) && !at(TokenKind::line_end)) left_over({"from"});
  } catch (const StatementFailed&) {
    recover_to_block();
  }
  event.head = since(begin);
  event.actions = parse_actions("`{` with what happens each time");
  return event;
}

std::vector<ast::Action> Parser::parse_actions(std::string_view wanted) {
  std::vector<ast::Action> actions;
  read_block(wanted, [&] { actions.push_back(parse_action()); });
  return actions;
}

ast::Action Parser::parse_action() {
  const Nesting nesting(*this);
  const std::uint32_t begin = current().span.begin;
  const auto done = [&](auto node) -> ast::Action {
    expect_statement_end({"else", "after"});
    return {std::move(node), since(begin)};
  };
  if (accept_word("if")) return done(parse_if());
  if (accept_word("go")) {
    accept_word("to");
    return done(ast::Go{parse_identifier("the name of a mode")});
  }
  if (accept_word("mark")) return done(ast::Mark{parse_text("a text, as in mark \"apex\"")});
  if (accept_word("stop")) return done(parse_stop());
  if (accept_word("for")) return done(parse_action_family());
  if (at_word("else")) {
    fail(error("E123", current().span, "this `else` has no `if`", "", "`else` follows the `}` of an `if`"));
  }
  const TokenKind second = look(1).kind;
  const bool two_values = second == TokenKind::name || second == TokenKind::text || second == TokenKind::number;
  if (at(TokenKind::name) && two_values && !is_reserved(spelled(current()))) {
    const std::string_view word = spelled(current());
    std::string help = did_you_mean(word, action_words());
    if (help.empty()) help = "actions are: x := value, if, go, mark, stop, for";
    fail(error("E111", current().span, fmt::format("no action begins with `{}`", word), "", help));
  }
  const auto words = statement_words();
  if (at(TokenKind::name) && std::find(words.begin(), words.end(), spelled(current())) != words.end()) {
    fail(error("E123", current().span, fmt::format("`{}` cannot stand among actions", spelled(current())), "",
               "write it outside of the event"));
  }
  return done(parse_assignment());
}

ast::Assignment Parser::parse_assignment() {
  Expression left = parse_sum_of_terms();
  auto* name = std::get_if<ast::Name>(&left.node);
  if (at(TokenKind::define) || at(TokenKind::equal)) {
    fail(error("E119", current().span, fmt::format("{} does not assign", describe(current(), source_)), "",
               "in an event write `:=`, as in h' := -h'"));
  }
  if (!at(TokenKind::assign)) {
    if (!at_statement_end()) left_over({});
    fail(error("E131", left.span, "this does nothing", "an expression alone", "an action assigns: h' := -h'"));
  }
  if (!name) {
    fail(error("E119", left.span, "only a name can be assigned to", "",
               "solve for the state, and write it alone on the left side"));
  }
  advance();
  return {std::move(*name), parse_value()};
}

ast::If Parser::parse_if() {
  const Nesting nesting(*this);
  Expression condition = parse_condition("");
  if (at_word("then")) {
    fail(error("E110", current().span, "expected `{`, found `then`", "",
               "actions stand in braces: if condition { ... } else { ... }"));
  }
  if (!at(TokenKind::open_brace) && !at(TokenKind::line_end)) left_over({"and", "or"});
  ast::If choice{std::move(condition), parse_actions("`{` with the actions"), {}};
  const Token& next = look_past_line_ends();
  if (next.kind != TokenKind::name || spelled(next) != "else") return choice;
  skip_line_ends();
  advance();
  if (at_word("if")) {
    const std::uint32_t begin = advance().span.begin;
    ast::If nested = parse_if();
    choice.otherwise.push_back({std::move(nested), since(begin)});
  } else {
    choice.otherwise = parse_actions("`{` with the actions");
  }
  return choice;
}

ast::Stop Parser::parse_stop() {
  ast::Stop stop;
  if (at(TokenKind::text)) stop.text = parse_text("a text");
  if (accept_word("after")) {
    stop.after = parse_sum_of_terms();
  } else if (at(TokenKind::name) && !at_word("else")) {
    unexpected("`after`, a text or the end of the action", fmt::format("write stop \"{}\"", spelled(current())));
  }
  return stop;
}

ast::ActionFamily Parser::parse_action_family() {
  return parse_indices<ast::ActionFamily>([&] { return parse_actions("`{` with the repeated actions"); });
}

}  // namespace continuo::model::detail
