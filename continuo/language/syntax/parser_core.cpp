// Moves of the parser over tokens, its messages, and how it goes on after an error.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <continuo/language/syntax/blackboard.hpp>
#include <continuo/language/syntax/parser_core.hpp>
#include <continuo/language/text/words.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

/// Words that begin a statement which stands in no block: met in one, the block was never closed.
constexpr std::array<std::string_view, 16> outer_words = {"model", "input",     "table",  "mode",  "start", "when",
                                                          "every", "initially", "run",    "plot",  "draw",  "check",
                                                          "at",    "param",     "output", "energy"};

bool ends_value(TokenKind kind) {
  return kind == TokenKind::name || kind == TokenKind::number || kind == TokenKind::close_round ||
         kind == TokenKind::close_index || kind == TokenKind::prime || kind == TokenKind::unit;
}

bool begins_value(TokenKind kind) {
  return kind == TokenKind::name || kind == TokenKind::number || kind == TokenKind::open_round;
}

}  // namespace

Parser::Nesting::Nesting(Parser& parser) : parser_(parser) {
  if (++parser_.nesting_ <= deepest_nesting) return;
  --parser_.nesting_;
  parser_.fail(error("E107", parser_.current().span, "this is nested too deeply",
                     fmt::format("more than {} levels", deepest_nesting), "name parts of it with `let`"));
}

const Token& Parser::look(std::size_t ahead) {
  ++result_.looks;
  while (ahead_.size() <= ahead) {
    if (result_.tokens == most_tokens) {
      const auto end = static_cast<std::uint32_t>(source_.text().size());
      report(error("E108", ahead_.empty() ? Span{end, end} : ahead_.front().span, "the model is too long",
                   fmt::format("reading stops here, after {} words and signs", most_tokens),
                   "put data into a table (`table NAME from \"file.csv\"`), repeated equations into a family (`for`)"));
      throw ReadingStopped{};
    }
    ahead_.push_back(lexer_.next());
    ++result_.tokens;
  }
  return ahead_[ahead];
}

const Token& Parser::look_past_line_ends() {
  std::size_t ahead = 0;
  while (look(ahead).kind == TokenKind::line_end) ++ahead;
  return look(ahead);
}

Token Parser::advance() {
  Token token = current();
  ahead_.pop_front();
  if (token.goes_on && token.span.begin != item_begin_)
    continuation_ = Span{token.goes_on_from, token.goes_on_from + 1};
  if (token.kind != TokenKind::line_end) {
    last_end_ = token.span.end;
    last_span_ = token.span;
  }
  last_kind_ = token.kind;
  return token;
}

bool Parser::at_word(std::string_view word) {
  return at(TokenKind::name) && spelled(current()) == word;
}

bool Parser::at_statement_end() {
  const TokenKind kind = current().kind;
  return kind == TokenKind::line_end || kind == TokenKind::semicolon || kind == TokenKind::end ||
         kind == TokenKind::close_brace;
}

bool Parser::accept(TokenKind kind) {
  if (!at(kind)) return false;
  advance();
  return true;
}

bool Parser::accept_word(std::string_view word) {
  if (!at_word(word)) return false;
  advance();
  return true;
}

Token Parser::expect(TokenKind kind, std::string_view wanted) {
  if (!at(kind)) unexpected(wanted);
  return advance();
}

void Parser::expect_word(std::string_view word, std::string_view wanted) {
  if (accept_word(word)) return;
  std::string help;
  if (at(TokenKind::name)) help = did_you_mean(spelled(current()), std::array{word});
  unexpected(wanted, help);
}

void Parser::skip_line_ends() {
  while (accept(TokenKind::line_end)) {
  }
}

void Parser::report(Diagnostic diagnostic) {
  const bool is_error = diagnostic.severity == Severity::error;
  result_.diagnostics.push_back(std::move(diagnostic));
  if (is_error && ++errors_ >= most_errors) throw ReadingStopped{};
}

void Parser::fail(Diagnostic diagnostic) {
  report(std::move(diagnostic));
  throw StatementFailed{};
}

std::string Parser::continuation_help() {
  const std::optional<Span> from =
      current().goes_on ? Span{current().goes_on_from, current().goes_on_from + 1} : continuation_;
  if (!from) return {};
  return fmt::format("line {} ends with `{}`, so it goes on over the line end", source_.place(from->begin).line,
                     source_.slice(*from));
}

void Parser::unexpected(std::string_view wanted, std::string help) {
  const Token& token = current();
  if (token.problem) fail(*token.problem);
  if (help.empty()) help = continuation_help();
  // The end of a line is shown where the line stops, not at the start of the next.
  Span span = token.span;
  if (token.kind == TokenKind::line_end || token.kind == TokenKind::end) span = {last_end_, last_end_};
  fail(
      error("E110", span, fmt::format("expected {}, found {}", wanted, describe(token, source_)), "", std::move(help)));
}

void Parser::left_over(std::initializer_list<std::string_view> words) {
  const Token& token = current();
  if (token.problem) fail(*token.problem);
  const std::string found = describe(token, source_);
  if (token.kind == TokenKind::name) {
    const std::string help = did_you_mean(spelled(token), std::span(words.begin(), words.size()));
    if (!help.empty()) fail(error("E125", token.span, found + " is not known here", "", help));
  }
  if (token.kind == TokenKind::close_round) fail(error("E113", token.span, "this bracket closes nothing", "", ""));
  if (token.kind == TokenKind::unit) {
    fail(error("E128", token.span, "a unit cannot stand here", "",
               "one unit follows a number or a bracket; write an index without a space before it, as in u[i]"));
  }
  if (token.kind == TokenKind::prime) {
    if (last_kind_ == TokenKind::number && look(1).kind == TokenKind::number)
      fail(error("E129", token.span, "a prime follows a name", "", "a number has no separators between its digits"));
    fail(error("E129", token.span, "a prime follows its name without a space", "", "write it as in x'"));
  }
  const bool word = token.kind == TokenKind::name && is_reserved(spelled(token));
  if (ends_value(last_kind_) && begins_value(token.kind) && !token.goes_on && !word) {
    if (const std::string help = argument_help(); !help.empty())
      fail(error("E116", token.span, fmt::format("a bracket is missing before {}", found), "", help));
    fail(error("E116", token.span, fmt::format("an operator is missing before {}", found), "", product_help()));
  }
  if (token.kind == TokenKind::comma) {
    const std::string help = last_kind_ == TokenKind::number ? help_with_commas(source_, token.span.begin) : "";
    unexpected("the end of the statement", help.empty() ? "separate statements with `;`" : help);
  }
  if (token.kind == TokenKind::name && found == "`if`")
    unexpected("the end of the statement", "a choice is written: if c then a else b");
  if (token.kind == TokenKind::define || token.kind == TokenKind::assign) {
    std::string help = continuation_help();
    if (help.empty()) help = "a statement ends with its line or with `;`";
    fail(error("E110", token.span, fmt::format("a second {} in one statement", found), "", help));
  }
  unexpected("the end of the statement", "a statement ends with its line or with `;`");
}

/// `sin x`, `sin^2(x)`: what the function is of stands in brackets.
std::string Parser::argument_help() {
  const std::string_view text = source_.text();
  const std::uint32_t begin = current().span.begin;
  if (last_kind_ == TokenKind::name && is_function(source_.slice(last_span_))) {
    // Up to where a sum, a bracket, a comma or the statement ends.
    const std::size_t end = std::min(text.find_first_of("+-),;\n#{}[<>=", begin), text.size());
    std::string_view argument = text.substr(begin, end - begin);
    argument = argument.substr(0, argument.find_last_not_of(" \t\r") + 1);
    if (argument.starts_with('(')) return {};
    const std::string call = fmt::format("{}({})", source_.slice(last_span_), argument);
    const Span all{last_span_.begin, static_cast<std::uint32_t>(begin + argument.size())};
    return with_corrected_line("a function has brackets", source_, all, call);
  }
  if (last_kind_ == TokenKind::number && current().kind == TokenKind::open_round && last_span_.begin > 0 &&
      text[last_span_.begin - 1] == '^') {
    std::size_t first = last_span_.begin - 1;
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
    while (first > 0 && is_letter(text[first - 1])) --first;
    const std::string_view function = text.substr(first, last_span_.begin - 1 - first);
    if (!is_function(function)) return {};
    return fmt::format("the power stands behind the bracket: {}(...)^{}", function, source_.slice(last_span_));
  }
  return {};
}

/// For two values side by side, of which the second is the current token: most often a product is meant.
std::string Parser::product_help() {
  const std::string_view left = source_.slice(last_span_), right = spelled(current());
  const TokenKind kind = current().kind;
  if (kind == TokenKind::name && look(1).kind == TokenKind::define)
    return "separate definitions with a comma, statements with `;`";
  if (kind == TokenKind::number && last_kind_ == TokenKind::number && right.size() == 3)
    return with_corrected_line("a number has no blanks between its digits", source_,
                               {last_span_.begin, current().span.end}, fmt::format("{}{}", left, right));
  if (kind == TokenKind::number && last_kind_ == TokenKind::number)
    return fmt::format("a number has no blanks and one point, as in {}", left);
  const bool short_name = last_kind_ == TokenKind::name || last_kind_ == TokenKind::number;
  if (!short_name || left.size() + right.size() > 60) return "write `*` for a product";
  const std::string product = fmt::format("write {}*{}", left, kind == TokenKind::open_round ? "(...)" : right);
  if (last_kind_ != TokenKind::number || kind != TokenKind::name) return product + " for a product";
  // A unit goes on with powers, products and quotients: N/m, m/s^2.
  const std::string_view rest = std::string_view(source_.text()).substr(current().span.begin, 40);
  const std::string_view unit = rest.substr(0, rest.find_first_of(" \t\r\n,;#)}"));
  return fmt::format("{}, or {} [{}] if it is a unit", product, left, unit);
}

void Parser::expect_statement_end(std::initializer_list<std::string_view> words) {
  if (last_kind_ == TokenKind::close_brace || at_statement_end()) return;
  left_over(words);
}

bool Parser::at_unclosed_block() {
  if (!at(TokenKind::name)) return false;
  const std::uint32_t begin = current().span.begin;
  if (begin > 0 && source_.text()[begin - 1] != '\n') return false;
  if (at_word("mode") && look(1).kind == TokenKind::name && look(2).kind != TokenKind::open_brace) {
    const std::string_view which = spelled(look(1));  // of a world
    if (which == "exact" || which == "fast") return false;
  }
  return std::find(outer_words.begin(), outer_words.end(), spelled(current())) != outer_words.end();
}

void Parser::recover() {
  // What a line that goes on lacks was found missing at the next one: that is a statement of its own.
  if (current().goes_on && at(TokenKind::name)) return;
  int depth = 0;
  for (;; advance()) {
    const Token& token = current();
    switch (token.kind) {
      case TokenKind::end:
        return;
      case TokenKind::open_brace:
        ++depth;
        break;
      case TokenKind::close_brace:
        if (depth == 0) return;
        if (--depth > 0) break;
        advance();
        // The block of an `if` that failed may have a second one.
        if (look_past_line_ends().kind == TokenKind::name && spelled(look_past_line_ends()) == "else") {
          skip_line_ends();
          break;
        }
        return;
      case TokenKind::line_end:
      case TokenKind::semicolon:
        if (depth == 0) return;
        break;
      default:
        if (at_unclosed_block()) return;
        break;
    }
  }
}

void Parser::recover_to_block() {
  while (!at_statement_end() && !at(TokenKind::open_brace)) advance();
  if (!at(TokenKind::open_brace)) throw StatementFailed{};
}

}  // namespace continuo::model::detail
