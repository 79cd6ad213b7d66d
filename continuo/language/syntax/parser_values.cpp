// Parses the operands of expressions: numbers, names, calls, sums, choices.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/syntax/format.hpp>
#include <continuo/language/syntax/parser_core.hpp>
#include <continuo/language/text/words.hpp>

namespace continuo::model::detail {

namespace {

using ast::Expression;

/// The quantity the expression ends with, unless a bracket closes after it. On the way to it only numbers may stand.
Expression* last_quantity(Expression& expression, std::uint32_t end) {
  if (expression.span.end != end) return nullptr;
  if (auto* quantity = std::get_if<ast::Quantity>(&expression.node))
    return quantity->unit.span.end == end && is_plain_number(*quantity->value) ? &expression : nullptr;
  if (auto* unary = std::get_if<ast::Unary>(&expression.node)) {
    const bool is_number = unary->op == ast::UnaryOperator::negate;  // a condition, `not 3 [s]`, has no unit
    return is_number ? last_quantity(*unary->operand, end) : nullptr;
  }
  auto* binary = std::get_if<ast::Binary>(&expression.node);
  if (!binary || binary->op > ast::BinaryOperator::power) return nullptr;  // a comparison has no unit
  Expression* found = last_quantity(*binary->right, end);
  return found && is_plain_number(*binary->left) ? found : nullptr;
}

void note_height(int height, int* highest) {
  if (highest) *highest = std::max(*highest, height);
}

}  // namespace

/// `1/2 [m]` is read as 1/(2 [m]); a person means half a metre. Where numbers alone end with one unit, the unit is
/// moved from the last of them to the whole. A bracket round the last part keeps it there: 1/(2 [m]).
void Parser::lift_unit(Expression& expression) {
  if (std::holds_alternative<ast::Quantity>(expression.node)) return;
  const Span span = expression.span;
  Expression* last = last_quantity(expression, span.end);
  if (!last) return;
  auto& quantity = std::get<ast::Quantity>(last->node);
  ast::Unit unit = std::move(quantity.unit);
  Expression number = std::move(*quantity.value);
  *last = std::move(number);
  Expression value = std::move(expression);
  expression = {ast::Quantity{std::move(value), std::move(unit)}, span};
}

Expression Parser::parse_expression(int* height) {
  Tree tree = parse_tree(Level::logical_or);
  require_single(tree.expression);
  note_height(tree.height, height);
  return std::move(tree.expression);
}

Expression Parser::parse_sum_of_terms(int* height) {
  Tree tree = parse_tree(Level::additive);
  require_single(tree.expression);
  note_height(tree.height, height);
  return std::move(tree.expression);
}

Expression Parser::parse_value() {
  Expression expression = parse_value_or_list();
  require_single(expression);
  return expression;
}

Expression Parser::parse_value_or_list() {
  Expression expression = parse_tree(Level::logical_or).expression;
  return expression;
}

Expression Parser::parse_condition(std::string_view where) {
  Expression condition = parse_expression();
  if (at(TokenKind::define) || at(TokenKind::assign)) {
    fail(error("E120", current().span, fmt::format("{} cannot compare", describe(current(), source_)),
               std::string(where), "write `==` for is equal to"));
  }
  return condition;
}

ast::Identifier Parser::parse_identifier(std::string_view wanted) {
  if (!at(TokenKind::name)) unexpected(wanted);
  const std::string word(spelled(current()));
  if (is_reserved(word)) {
    fail(error("E112", current().span, fmt::format("`{}` is a word of the language and cannot be a name", word), "",
               fmt::format("choose another name, such as `{}_`", word)));
  }
  return {word, advance().span};
}

ast::Name Parser::parse_name(std::string_view wanted, int* height) {
  if (at_word("energy") || at_word("sum")) return parse_indices_and_primes(advance(), height);
  if (!at(TokenKind::name)) unexpected(wanted);
  if (is_reserved(spelled(current()))) parse_identifier(wanted);  // says what is wrong
  return parse_indices_and_primes(advance(), height);
}

ast::Name Parser::parse_indices_and_primes(const Token& token, int* height) {
  ast::Name name;
  name.text = spelled(token);
  name.span = token.span;
  if (at(TokenKind::open_index)) {
    const Token open = advance();
    do {
      name.indices.push_back(parse_expression(height));
    } while (accept(TokenKind::comma));
    close_index(open);
  }
  if (at(TokenKind::dot) && !current().after_space) {
    advance();
    if (!at(TokenKind::name) || current().after_space)
      unexpected(fmt::format("what of `{}` is meant, as in {}.x", name.text, name.text));
    name.member = spelled(advance());
  }
  while (at(TokenKind::prime) && !current().after_space) {
    const Token prime = advance();
    if (++name.primes > most_primes) {
      fail(error("E129", prime.span, fmt::format("more than {} primes", most_primes), "", ""));
    }
  }
  name.span = since(token.span.begin);
  if (at(TokenKind::open_index) && name.primes > 0) {
    fail(error("E129", current().span, "the primes come after the index", "",
               fmt::format("write {}[i]{}; a unit needs a space before it", name.text,
                           std::string(static_cast<std::size_t>(name.primes), '\''))));
  }
  return name;
}

void Parser::close_index(const Token& open) {
  if (accept(TokenKind::close_index)) return;
  if (current().problem) fail(*current().problem);
  if (current().kind == TokenKind::name || current().kind == TokenKind::number) left_over({});
  fail(error("E113", open.span, "this index bracket is not closed", "opened here",
             fmt::format("close it with `]` before {}", describe(current(), source_))));
}

ast::Range Parser::parse_range(int* height) {
  Expression first = parse_sum_of_terms(height);
  return parse_range_from(std::move(first), height);
}

ast::Range Parser::parse_range_from(Expression first, int* height) {
  go_on_inside_brackets();
  if (!at(TokenKind::dots)) unexpected("`..`", "a range is written from..to, as in 0..10");
  advance();
  return range_between(std::move(first), parse_sum_of_terms(height));
}

ast::Range Parser::range_between(Expression first, Expression last) {
  const std::uint32_t begin = first.span.begin;
  std::optional<ast::Unit> unit;
  if (auto* quantity = std::get_if<ast::Quantity>(&last.node);
      quantity && !std::holds_alternative<ast::Quantity>(first.node)) {
    unit = std::move(quantity->unit);
    Expression value = std::move(*quantity->value);
    last = std::move(value);
  }
  const Span span{begin, last.span.end};
  return {std::move(first), std::move(last), std::move(unit), span};
}

std::string Parser::parse_text(std::string_view wanted) {
  if (!at(TokenKind::text)) {
    std::string help;
    if (at(TokenKind::prime)) help = "a text stands in double quotes";
    if (at(TokenKind::name)) help = fmt::format("write \"{}\"", spelled(current()));
    unexpected(wanted, std::move(help));
  }
  return unescape(spelled(advance()));
}

std::pair<ast::Identifier, ast::Range> Parser::parse_index(int* height) {
  ast::Identifier index = parse_identifier("the name of an index, as in `i in 1..N`");
  expect_word("in", "`in` and a range, as in `i in 1..N`");
  return {std::move(index), parse_range(height)};
}

}  // namespace continuo::model::detail
