// Parses operators by their strength, and looks for indices among brackets.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/syntax/parser_core.hpp>
#include <continuo/language/text/words.hpp>

namespace continuo::model::detail {

namespace {

using ast::BinaryOperator;
using ast::Expression;

/// Whether a word of the text is one of the indices, or the text is a number: then an index was meant, not a unit.
bool looks_like_index(std::string_view text, std::span<const std::string> indices) {
  constexpr std::string_view blanks = " \t";
  if (!text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos) return text != "1";
  const std::size_t first = std::min(text.find_first_not_of(blanks), text.size());
  const std::size_t size = std::min(text.find_first_of(" \t+-*/^.,", first), text.size()) - first;
  return std::find(indices.begin(), indices.end(), text.substr(first, size)) != indices.end();
}

bool is_comparison(BinaryOperator op) {
  return op >= BinaryOperator::less && op <= BinaryOperator::not_equal;
}

}  // namespace

std::optional<Parser::Operator> Parser::operator_at(const Token& token) {
  switch (token.kind) {
    case TokenKind::plus:
      return Operator{BinaryOperator::add, Level::additive};
    case TokenKind::minus:
      return Operator{BinaryOperator::subtract, Level::additive};
    case TokenKind::star:
      return Operator{BinaryOperator::multiply, Level::multiplicative};
    case TokenKind::slash:
      return Operator{BinaryOperator::divide, Level::multiplicative};
    case TokenKind::less:
      return Operator{BinaryOperator::less, Level::comparison};
    case TokenKind::less_equal:
      return Operator{BinaryOperator::less_equal, Level::comparison};
    case TokenKind::greater:
      return Operator{BinaryOperator::greater, Level::comparison};
    case TokenKind::greater_equal:
      return Operator{BinaryOperator::greater_equal, Level::comparison};
    case TokenKind::equal:
      return Operator{BinaryOperator::equal, Level::comparison};
    case TokenKind::not_equal:
      return Operator{BinaryOperator::not_equal, Level::comparison};
    case TokenKind::name:
      if (spelled(token) == "and") return Operator{BinaryOperator::logical_and, Level::logical_and};
      if (spelled(token) == "or") return Operator{BinaryOperator::logical_or, Level::logical_or};
      return std::nullopt;
    default:
      return std::nullopt;
  }
}

Tree Parser::grow(Expression::Node node, Span span, int height) {
  if (height + 1 > tallest_tree) {
    fail(error("E107", span, "this expression is too long", fmt::format("more than {} operations deep", tallest_tree),
               "name parts of it with `let`, or write a sum as sum(i in 1..N: ...)"));
  }
  return {{std::move(node), span}, height + 1};
}

void Parser::require_single(const Expression& expression) {
  if (!std::holds_alternative<ast::List>(expression.node)) return;
  fail(error("E121", expression.span, "a list cannot be calculated with", "",
             "a list gives the values of an indexed parameter: param m[1..3] = (1, 2, 3)\n"
             "the decimal sign is a point: 9.8, not 9,8"));
}

/// Inside round brackets a line may also end before an operator, a comma or the closing bracket.
void Parser::go_on_inside_brackets() {
  if (round_brackets_ == 0 || !at(TokenKind::line_end)) return;
  const Token& token = look_past_line_ends();
  const bool goes_on = operator_at(token) || token.kind == TokenKind::close_round || token.kind == TokenKind::comma ||
                       token.kind == TokenKind::caret || token.kind == TokenKind::colon ||
                       token.kind == TokenKind::dots ||
                       (token.kind == TokenKind::name &&
                        (spelled(token) == "then" || spelled(token) == "else" || spelled(token) == "where"));
  if (goes_on) skip_line_ends();
}

Tree Parser::parse_tree(Level lowest) {
  const Nesting nesting(*this);
  return parse_chain(lowest);
}

Tree Parser::parse_chain(Level lowest) {
  Tree left = parse_prefix();
  std::optional<Span> compared;
  while (true) {
    go_on_inside_brackets();
    const auto found = operator_at(current());
    if (!found || found->level < lowest) {
      lift_unit(left.expression);
      return left;
    }
    if (found->level < Level::multiplicative) lift_unit(left.expression);
    const Token sign = advance();
    skip_line_ends();
    if (is_comparison(found->op)) {
      if (compared) {
        fail(error("E117", sign.span, "comparisons cannot be chained", "", "write a < b and b < c for a < b < c"));
      }
      compared = sign.span;
    } else if (found->level < Level::comparison) {
      compared.reset();
    }
    Tree right = parse_tree(static_cast<Level>(static_cast<int>(found->level) + 1));
    require_single(left.expression);
    require_single(right.expression);
    const Span span = cover(left.expression.span, right.expression.span);
    const int height = std::max(left.height, right.height);
    left = grow(ast::Binary{found->op, std::move(left.expression), std::move(right.expression)}, span, height);
  }
}

Tree Parser::parse_prefix() {
  const Token& token = current();
  const std::uint32_t begin = token.span.begin;
  if (token.kind == TokenKind::name && spelled(token) == "not") {
    advance();
    skip_line_ends();
    Tree operand = parse_tree(Level::comparison);
    require_single(operand.expression);
    return grow(ast::Unary{ast::UnaryOperator::logical_not, std::move(operand.expression)}, since(begin),
                operand.height);
  }
  if (token.kind == TokenKind::minus || token.kind == TokenKind::plus) {
    const Nesting nesting(*this);
    const bool negates = advance().kind == TokenKind::minus;
    Tree operand = parse_prefix();
    require_single(operand.expression);
    if (!negates) return operand;
    const Span span{begin, operand.expression.span.end};
    return grow(ast::Unary{ast::UnaryOperator::negate, std::move(operand.expression)}, span, operand.height);
  }
  return parse_power(true);
}

Tree Parser::parse_power(bool with_unit) {
  Tree base = parse_primary(with_unit);
  go_on_inside_brackets();
  if (!at(TokenKind::caret)) return base;
  require_single(base.expression);
  const Nesting nesting(*this);
  advance();
  // An exponent has no unit: in 2*pi^2 [m] the unit follows the power.
  const std::uint32_t begin = current().span.begin;
  bool negated = false;
  while (at(TokenKind::minus) || at(TokenKind::plus)) negated ^= advance().kind == TokenKind::minus;
  Tree exponent = parse_power(false);
  require_single(exponent.expression);
  if (negated) {
    const Span span{begin, exponent.expression.span.end};
    exponent = grow(ast::Unary{ast::UnaryOperator::negate, std::move(exponent.expression)}, span, exponent.height);
  }
  const Span span = cover(base.expression.span, exponent.expression.span);
  const int height = std::max(base.height, exponent.height);
  Tree power = grow(ast::Binary{BinaryOperator::power, std::move(base.expression), std::move(exponent.expression)},
                    span, height);
  return with_unit ? with_unit_after(std::move(power)) : power;
}

void Parser::value_missing() {
  const Token& token = current();
  if (token.problem) fail(*token.problem);
  std::string help;
  if (token.kind == TokenKind::unit)
    help = "a unit follows its number, as in 3 [m]; brackets of expressions and lists are round: (x + 1), (1, 2, 3)";
  if (token.kind == TokenKind::open_brace) help = "brackets of expressions are round: (x + 1)";
  if (token.kind == TokenKind::prime) help = "a prime follows its name, as in x'";
  if (token.kind == TokenKind::star && last_kind_ == TokenKind::open_round)
    fail(error("E127", cover(last_span_, token.span), "`(*` is not a sign of the language", "",
               "a comment begins with `#` and ends with its line"));
  if (token.kind == TokenKind::caret || token.kind == TokenKind::star || token.kind == TokenKind::slash)
    help = "this sign stands between two values";
  if (token.kind == TokenKind::text) {
    fail(error("E122", token.span, "a text cannot be calculated with", "", "a name is written without quotes"));
  }
  if (token.goes_on) {
    // The sign at the end of the line before is where the fault is.
    const Span sign{token.goes_on_from, token.goes_on_from + 1};
    fail(error("E110", sign, fmt::format("a value is missing after `{}`", source_.slice(sign)), "", ""));
  }
  unexpected("a value", std::move(help));
}

Tree Parser::parse_primary(bool with_unit) {
  const Token& token = current();
  Tree value;
  if (token.kind == TokenKind::number) {
    value = {{ast::Number{token.number}, token.span}, 1};
    advance();
  } else if (token.kind == TokenKind::open_round) {
    value = parse_round();
  } else if (at_word("if")) {
    return parse_conditional();
  } else if (at_word("sum") && look(1).kind == TokenKind::open_round) {
    value = parse_sum();
  } else if (token.kind == TokenKind::name) {
    value = parse_name_or_call();
  } else {
    value_missing();
  }
  return with_unit ? with_unit_after(std::move(value)) : value;
}

Tree Parser::with_unit_after(Tree value) {
  if (!at(TokenKind::unit)) return value;
  const std::string_view text = source_.slice({current().span.begin + 1, current().span.end - 1});
  if (const auto* name = std::get_if<ast::Name>(&value.expression.node); name && looks_like_index(text, indices_)) {
    fail(error("E128", current().span, "this reads as a unit, not as an index", "there is a space before it",
               fmt::format("write {}[{}] without a space", name->text, text)));
  }
  const Token token = advance();
  ast::Unit unit{std::string(text), token.span};
  if (auto* list = std::get_if<ast::List>(&value.expression.node)) {  // (1, 2) [kg] is (1 [kg], 2 [kg])
    for (Expression& item : list->items) {
      const Span span = item.span;
      if (std::holds_alternative<ast::Quantity>(item.node)) continue;
      Expression number = std::move(item);
      item = {ast::Quantity{std::move(number), unit}, span};
    }
    value.expression.span = since(value.expression.span.begin);
    ++value.height;
    return value;
  }
  const Span span = since(value.expression.span.begin);
  return grow(ast::Quantity{std::move(value.expression), std::move(unit)}, span, value.height);
}

/// A bracketed expression, or a list. Its span holds the brackets.
Tree Parser::parse_round() {
  const Token open = advance();
  ++round_brackets_;
  std::vector<Expression> items;
  int height = 0;
  bool list = false;
  do {
    if (list && at(TokenKind::close_round)) break;  // (1, 2, 3,)
    Tree item = parse_tree(Level::logical_or);
    height = std::max(height, item.height);
    items.push_back(std::move(item.expression));
    go_on_inside_brackets();
    list = list || at(TokenKind::comma);
  } while (accept(TokenKind::comma));
  if (!at(TokenKind::close_round)) {
    const Token& token = current();
    if (token.problem) fail(*token.problem);
    if (at_statement_end() || at(TokenKind::open_brace))
      fail(error("E113", open.span, "this bracket is not closed", "opened here", "close it with `)`"));
    left_over({"and", "or", "then", "else"});
  }
  advance();
  --round_brackets_;
  const Span span = since(open.span.begin);
  if (!list) {
    items.front().span = span;
    return {std::move(items.front()), height};
  }
  for (const Expression& item : items) require_single(item);
  return grow(ast::List{std::move(items)}, span, height);
}

Tree Parser::parse_conditional() {
  const std::uint32_t begin = advance().span.begin;
  Tree condition = parse_tree(Level::logical_or);
  require_single(condition.expression);
  const auto next_word = [this](std::string_view word) {
    if (at(TokenKind::line_end) && look_past_line_ends().kind == TokenKind::name &&
        spelled(look_past_line_ends()) == word)
      skip_line_ends();
    if (at(TokenKind::define)) {
      fail(error("E120", current().span, "`=` cannot compare", "", "write `==` for is equal to"));
    }
    expect_word(word, fmt::format("`{}` (a choice is written: if condition then a else b)", word));
    skip_line_ends();
  };
  next_word("then");
  Tree when_true = parse_tree(Level::logical_or);
  next_word("else");
  Tree when_false = parse_tree(Level::logical_or);
  require_single(when_true.expression);
  require_single(when_false.expression);
  const int height = std::max({condition.height, when_true.height, when_false.height});
  return grow(ast::Conditional{std::move(condition.expression), std::move(when_true.expression),
                               std::move(when_false.expression)},
              since(begin), height);
}

Tree Parser::parse_sum() {
  const Token word = advance();
  const Token open = advance();
  ++round_brackets_;
  Tree sum = parse_sum_over(word.span.begin);
  go_on_inside_brackets();
  if (!at(TokenKind::close_round)) {
    if (at_statement_end())
      fail(error("E113", open.span, "this bracket is not closed", "opened here", "close it with `)`"));
    left_over({});
  }
  advance();
  --round_brackets_;
  sum.expression.span = since(word.span.begin);
  return sum;
}

/// `i in 1..N, j in 1..M: u[i,j]` is a sum of sums.
Tree Parser::parse_sum_over(std::uint32_t begin) {
  int height = 0;
  auto [index, range] = parse_index(&height);
  indices_.push_back(index.text);
  std::optional<ValuePtr<Expression>> condition;
  go_on_inside_brackets();
  if (accept(TokenKind::comma)) {
    const Nesting nesting(*this);
    go_on_inside_brackets();
    Tree inner = parse_sum_over(current().span.begin);
    indices_.pop_back();
    return grow(ast::Sum{std::move(index), std::move(range), std::nullopt, std::move(inner.expression)}, since(begin),
                std::max(height, inner.height));
  }
  if (accept_word("where") || accept_word("if")) {
    Tree tree = parse_tree(Level::logical_or);
    require_single(tree.expression);
    height = std::max(height, tree.height);
    condition = std::move(tree.expression);
    go_on_inside_brackets();
  }
  if (!at(TokenKind::colon)) unexpected("`:` and what is summed, as in sum(j in 1..N: m[j])");
  advance();
  Tree body = parse_tree(Level::logical_or);
  require_single(body.expression);
  indices_.pop_back();
  return grow(ast::Sum{std::move(index), std::move(range), std::move(condition), std::move(body.expression)},
              since(begin), std::max(height, body.height));
}

Tree Parser::parse_name_or_call() {
  const Token& token = current();
  const std::string_view word = spelled(token);
  if (is_reserved(word) && word != "energy") {
    if (token.goes_on) value_missing();
    if (word == "then" || word == "else" || word == "in" || word == "from" || word == "and" || word == "or")
      unexpected("a value");
  }
  int height = 1;
  ast::Name name = parse_name("a value", &height);
  if (at(TokenKind::open_round)) return parse_arguments(std::move(name), height);
  const Span span = name.span;
  return grow(std::move(name), span, height);
}

Tree Parser::parse_arguments(ast::Name callee, int height) {
  const Token open = advance();
  const bool takes_numbers = is_function(callee.text);
  ++round_brackets_;
  std::vector<Expression> arguments;
  go_on_inside_brackets();
  while (!at(TokenKind::close_round)) {
    Tree argument = parse_tree(Level::logical_or);
    if (takes_numbers) require_single(argument.expression);  // a ray has a direction, too
    height = std::max(height, argument.height);
    arguments.push_back(std::move(argument.expression));
    go_on_inside_brackets();
    if (accept(TokenKind::comma) || at(TokenKind::close_round)) continue;
    if (const Token& token = current(); token.problem) fail(*token.problem);
    if (at_statement_end() || at(TokenKind::open_brace))
      fail(error("E113", open.span, "this bracket is not closed", "opened here", "close it with `)`"));
    left_over({});
  }
  advance();
  --round_brackets_;
  const Span span = since(callee.span.begin);
  if (callee.text == "sum") {
    fail(error("E110", span, "a sum names its index", "", "write sum(j in 1..N: m[j])"));
  }
  return grow(ast::Call{std::move(callee), std::move(arguments)}, span, height);
}

}  // namespace continuo::model::detail
