// Parses the statements of a model.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <continuo/language/syntax/blackboard.hpp>
#include <continuo/language/syntax/parser_core.hpp>
#include <continuo/language/text/unicode.hpp>
#include <continuo/language/text/words.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model {

namespace detail {

namespace {

using ast::Expression;
using ast::Statement;

/// Words people bring along from other languages, and what is said here instead.
struct Habit {
  std::string_view word, help;
};
constexpr std::array habits = {
    Habit{"const", "write `param`"},
    Habit{"constant", "write `param`"},
    Habit{"parameter", "write `param`"},
    Habit{"var", "a state needs no declaration, its equation is enough: x' = ..."},
    Habit{"variable", "a state needs no declaration, its equation is enough: x' = ..."},
    Habit{"state", "a state needs no declaration, its equation is enough: x' = ..."},
    Habit{"double", "a state needs no declaration, its equation is enough: x' = ..."},
    Habit{"Real", "a state needs no declaration, its equation is enough: x' = ..."},
    Habit{"init", "an initial value is written x(0) = ..."},
    Habit{"initial", "an initial value is written x(0) = ..., actions at the start `initially { ... }`"},
    Habit{"equation", "an equation needs no word before it: x' = ..."},
    Habit{"function", "name an expression with `let`"},
    Habit{"def", "name an expression with `let`"},
    Habit{"event", "an event is written: when h falls through 0 { ... }"},
    Habit{"simulate", "write `run 0..10`"},
    Habit{"body", "bodies stand in a world: world { body ball at (0, 10) radius 0.5 }"},
    Habit{"bodies", "bodies stand in a world: world { bodies gas random 100 in (0, 0) to (20, 20) }"},
    Habit{"spring", "springs between bodies stand in a world: world { spring ball to anchor stiffness 40 }"},
    Habit{"wall", "walls stand in a world: world { wall (0, 1) at 0 }"},
    Habit{"container", "a container stands in a world: world { container (0, 0) to (20, 20) }"},
    Habit{"sweep", "many runs are asked for in a block: sweep { k from 1 to 10 count 50 }"},
    Habit{"while", "an event is written: when h falls through 0 { ... }"},
    Habit{"method", "this is a part of the run statement: end its line with a comma to go on, or write it there"},
    Habit{"max", "this is a part of the run statement: end its line with a comma to go on, or write it there"},
    Habit{"tol", "this is a part of the run statement: end its line with a comma to go on, or write it there"},
    Habit{"step", "this is a part of the run statement: end its line with a comma to go on, or write it there"},
    Habit{"realtime", "this is a part of the run statement: end its line with a comma to go on, or write it there"},
};

bool is_derivative_call(std::string_view name) {
  return name == "der" || name == "d" || name == "diff" || name == "ddt" || name == "deriv";
}

/// The name in `der(x)` with a prime, in `der(der(x))` with two; nothing where it is no derivative.
std::string within_derivatives(const Expression& left) {
  const auto* call = std::get_if<ast::Call>(&left.node);
  if (!call || call->arguments.empty() || !is_derivative_call(call->callee.text)) return {};
  const Expression& inside = call->arguments.front();
  if (const auto* name = std::get_if<ast::Name>(&inside.node))
    return name->text + std::string(static_cast<std::size_t>(name->primes) + 1, '\'');
  const std::string deeper = within_derivatives(inside);
  return deeper.empty() ? deeper : deeper + "'";
}

constexpr std::array<std::string_view, 9> family_words = {"param", "let", "output", "energy", "unknown",
                                                          "guess", "for", "when",   "at"};
constexpr std::array<std::string_view, 2> mode_words = {"let", "for"};

}  // namespace

ParseResult Parser::parse_model() {
  const std::string& text = source_.text();
  try {
    if (const auto invalid = first_invalid_byte(text)) {
      const auto offset = static_cast<std::uint32_t>(*invalid);
      const bool utf16 = text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
      report(error("E101", {offset, offset + 1}, "this file is not UTF-8 text",
                   fmt::format("byte {} is 0x{:02X}", offset, static_cast<unsigned char>(text[offset])),
                   utf16 ? "it is UTF-16: save the file as UTF-8" : "save the file as UTF-8 in the editor"));
      return std::move(result_);
    }
    result_.model.heading = heading_of(text);
    while (!at(TokenKind::end)) {
      if (accept(TokenKind::line_end) || accept(TokenKind::semicolon)) continue;
      read_item([this] {
        if (at(TokenKind::close_brace)) {
          const Span span = advance().span;
          fail(error("E115", span, "this brace closes nothing", "", "remove it, or look for a missing `{` above"));
        }
        if (at_word("model")) return parse_model_name();
        result_.model.statements.push_back(parse_statement(Context::top));
      });
    }
    if (result_.model.statements.empty() && errors_ == 0) {
      report(error("E106", {0, 0}, "there is no model in this file", "",
                   "a model needs at least an equation, an initial value and a run:\nx' = -x; x(0) = 1; run 0..5"));
    }
  } catch (const ReadingStopped&) {
  }
  sort_by_place(result_.diagnostics);
  return std::move(result_);
}

ParsedExpression Parser::parse_only_expression() {
  ParsedExpression parsed;
  parsed.expression = {ast::Missing{}, {}};
  try {
    if (const auto invalid = first_invalid_byte(source_.text())) {
      const auto offset = static_cast<std::uint32_t>(*invalid);
      fail(error("E101", {offset, offset + 1}, "this is not UTF-8 text", "", ""));
    }
    skip_line_ends();
    parsed.expression = parse_value();
    skip_line_ends();
    if (!at(TokenKind::end)) left_over({"and", "or"});
  } catch (const StatementFailed&) {
  } catch (const ReadingStopped&) {
  }
  parsed.diagnostics = std::move(result_.diagnostics);
  return parsed;
}

void Parser::parse_model_name() {
  const Token word = advance();
  ast::Identifier name = parse_identifier("the name of the model");
  if (result_.model.name) {
    Diagnostic diagnostic = error("E124", name.span, "the model has two names", "", "a file holds one model");
    diagnostic.related.push_back({result_.model.name->span, "named here"});
    fail(std::move(diagnostic));
  }
  result_.model.name = std::move(name);
  expect_statement_end();
}

Statement Parser::parse_statement(Context context) {
  const Nesting nesting(*this);
  const Token& token = current();
  const std::uint32_t begin = token.span.begin;
  std::optional<Statement::Node> node;
  if (token.kind == TokenKind::name) {
    const std::string word(spelled(token));
    const auto words = statement_words();
    const TokenKind next = look(1).kind;
    const bool as_name = next == TokenKind::define || next == TokenKind::prime || next == TokenKind::open_index ||
                         (next == TokenKind::open_round && !look(1).after_space && word != "check");
    if (word == "plot" && next == TokenKind::open_round && as_name) {
      const Span span = advance().span;
      fail(error("E112", span, "`plot` has no brackets", "", "write plot x against t, or plot x"));
    } else if (at_world_word(context)) {
      node = parse_world_or_force();
    } else if (at_sweep()) {
      require_allowed(word, context);
      node = parse_sweep();
    } else if (is_reserved(word) && word != "if" && word != "not" && word != "sum" && as_name) {
      parse_identifier("a name");  // says what is wrong
    } else if (std::find(words.begin(), words.end(), word) != words.end()) {
      require_allowed(word, context);
      node = parse_worded(word, context);
    } else if (is_reserved(word) && word != "not" && word != "sum") {
      std::string help;
      if (word == "go" || word == "mark" || word == "stop")
        help = "it is an action: write it in an event, when ... { " + word + " ... }";
      if (word == "then")
        help = "it follows the `}` of a `when`: what happens where the times of that event close in on a limit";
      if (word == "if")
        help = "in an equation write x' = if c then a else b; actions stand in an event: when c { ... }";
      fail(error("E123", token.span, fmt::format("`{}` cannot stand here", word), "", help));
    } else if ((next == TokenKind::name && !operator_at(look(1))) || next == TokenKind::number ||
               next == TokenKind::text) {
      unknown_statement();
    }
  }
  if (!node) node = parse_equation();
  return {std::move(*node), since(begin)};
}

void Parser::unknown_statement() {
  const std::string_view word = spelled(current());
  const std::string_view next = spelled(look(1));
  if (next == "on") {
    fail(error("E111", current().span, fmt::format("no statement begins with `{}`", word), "",
               "what pulls on a body is written force on ball = (0, -1), what turns it torque on ball = 2"));
  }
  if (next == "falls" || next == "rises" || next == "crosses") {
    fail(error("E111", current().span, "an event begins with `when`", "",
               fmt::format("write when {} {} through 0 {{ ... }}", word, next)));
  }
  std::string help = did_you_mean(word, statement_words());
  for (const Habit& habit : habits)
    if (habit.word == word) help = habit.help;
  if (help.empty())
    help = fmt::format("a product is written {}*{}; `continuo explain E111` lists all statements", word, next);
  fail(error("E111", current().span, fmt::format("no statement begins with `{}`", word), "", help));
}

void Parser::require_allowed(std::string_view word, Context context) {
  if (context == Context::top) return;
  const auto among = [word](const auto& words) { return std::find(words.begin(), words.end(), word) != words.end(); };
  if (context == Context::family && among(family_words)) return;
  if (context == Context::mode && among(mode_words)) return;
  std::string help = "write it outside, before or after the braces";
  if (context == Context::mode && word == "when")
    help = "write the event outside, as: when h falls through 0 in NAME { ... }";
  fail(error("E123", current().span,
             fmt::format("`{}` cannot stand in a {}", word, context == Context::mode ? "mode" : "family"),
             context == Context::mode ? "a mode holds equations" : "a family holds what is repeated for each index",
             help));
}

std::optional<Statement::Node> Parser::parse_worded(std::string_view word, Context context) {
  advance();
  if (word == "for") return parse_family(context);
  if (word == "mode") return parse_mode();
  if (word == "when") return parse_when();
  if (word == "at") return parse_at();
  if (word == "every") return parse_every();
  if (word == "initially") return ast::Initially{parse_actions("`{` with the actions")};
  if (word == "draw") return parse_draw();
  Statement::Node node = parse_defining(word);
  return node;
}

Statement::Node Parser::parse_defining(std::string_view word) {
  if (word == "param") return ast::Parameters{parse_definitions(true)};
  if (word == "let") return ast::Lets{parse_definitions(false)};
  if (word == "output") return ast::Outputs{parse_definitions(false)};
  if (word == "energy") return ast::Energies{parse_definitions(false)};
  if (word == "input") return parse_input();
  if (word == "table") return parse_table();
  if (word == "unknown") return parse_unknown();
  if (word == "guess") return parse_guess();
  if (word == "run") return parse_run();
  if (word == "plot") return parse_plot();
  if (word == "check") return parse_check();
  expect_word("in", "`in` and the name of a mode, as in `start in flight`");
  ast::Start start{parse_identifier("the name of a mode")};
  expect_statement_end();
  return start;
}

std::vector<Statement> Parser::parse_statements(std::string_view wanted, Context context) {
  std::vector<Statement> statements;
  read_block(wanted, [&] { statements.push_back(parse_statement(context)); });
  return statements;
}

ast::Mode Parser::parse_mode() {
  ast::Mode mode;
  mode.name = parse_identifier("the name of the mode");
  mode.body = parse_statements("`{` with the equations of the mode", Context::mode);
  expect_statement_end();
  return mode;
}

/// `for i in 1..N, j in 1..M { ... }` is a family of families.
ast::Family Parser::parse_family(Context context) {
  return parse_indices<ast::Family>([&] {
    std::vector<Statement> body =
        parse_statements("`{` with what is repeated", context == Context::mode ? Context::mode : Context::family);
    expect_statement_end();
    return body;
  });
}

void Parser::explain_left_side(const Expression& left) {
  // d(0) = 3 is the start of a state d.
  if (const std::string primed = within_derivatives(left); !primed.empty())
    fail(error("E134", left.span, "a derivative is written with a prime", "",
               with_corrected_line("write " + primed + " on the left", source_, left.span, primed)));
  const auto* call = std::get_if<ast::Call>(&left.node);
  if (!call || call->callee.primes == 0 || call->arguments.size() != 1) return;
  const auto* time = std::get_if<ast::Name>(&call->arguments.front().node);
  if (!time || time->text != "t") return;
  const std::string_view primed = source_.slice(call->callee.span);
  fail(error("E134", left.span, "an equation holds at all times, which are not written", "",
             fmt::format("write {} = ..., and x for x(t)", primed)));
}

/// `dx/dt = ...`, `d^2x/dt^2 = ...`: before the signs in it are read.
void Parser::explain_derivative_by_time() {
  const std::uint32_t begin = current().span.begin;
  const auto found = derivative_by_time(std::string_view(source_.text()).substr(begin));
  if (!found) return;
  const std::size_t behind = source_.text().find_first_not_of(" \t", begin + found->size);
  if (behind == std::string::npos || source_.text()[behind] != '=') return;
  const Span span{begin, static_cast<std::uint32_t>(begin + found->size)};
  fail(error("E134", span, "a derivative is written with a prime", "",
             with_corrected_line("write " + found->primed + " on the left", source_, span, found->primed)));
}

Statement::Node Parser::parse_equation() {
  explain_derivative_by_time();
  if (at(TokenKind::minus) && look(1).kind == TokenKind::minus && !look(1).after_space)
    fail(error("E127", cover(current().span, look(1).span), "`--` is not a sign of the language", "",
               "a comment begins with `#`"));
  Expression left = parse_sum_of_terms();
  if (at(TokenKind::assign)) {
    fail(error("E118", current().span, "`:=` assigns, which happens only in events", "",
               "write `=` for an equation or an initial value, or put this into: when ... { }"));
  }
  if (at(TokenKind::equal)) fail(error("E118", current().span, "`==` compares", "", "write `=` for an equation"));
  if (!at(TokenKind::define)) {
    if (!at_statement_end()) left_over({"in"});
    fail(error("E131", left.span, "this says nothing", "an expression alone", "an equation has two sides: x' = ..."));
  }
  explain_left_side(left);
  advance();
  Expression right = parse_value();
  if (at_word("at")) {
    unexpected("the end of the statement", fmt::format("an initial value is written {}(0) = {}",
                                                       source_.slice(left.span), source_.slice(right.span)));
  }
  expect_statement_end();
  const auto* call = std::get_if<ast::Call>(&left.node);
  if (call && (!is_function(call->callee.text) || call->callee.primes > 0 || !call->callee.indices.empty()))
    return as_condition(std::move(left), std::move(right));
  return ast::Equation{std::move(left), std::move(right)};
}

ast::Condition Parser::as_condition(Expression left, Expression value) {
  auto& call = std::get<ast::Call>(left.node);
  if (call.arguments.size() != 1) {
    fail(error("E132", left.span, fmt::format("an initial value has one time, not {}", call.arguments.size()), "",
               fmt::format("an initial value is written {}(0) = ...", source_.slice(call.callee.span))));
  }
  return {std::move(call.callee), std::move(call.arguments.front()), std::move(value)};
}

}  // namespace detail

ParseResult parse(const Source& source) {
  return detail::Parser(source).parse_model();
}

ParsedExpression parse_expression(const Source& source) {
  return detail::Parser(source).parse_only_expression();
}

}  // namespace continuo::model
