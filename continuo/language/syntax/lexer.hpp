// continuo/language/syntax/lexer.hpp
// Text to tokens, one at a time. What a `[` opens is decided here: directly after a name (or its primes) an index,
// anywhere else a unit, which is one token with all that stands in the brackets.
//
//   Lexer lexer(source);
//   for (Token token = lexer.next(); token.kind != TokenKind::end; token = lexer.next()) ...
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include <continuo/language/text/diagnostic.hpp>
#include <continuo/language/text/source.hpp>

namespace continuo::model {

enum class TokenKind {
  end,
  line_end,  // not after an operator, a comma or an open bracket: there the line goes on
  name,      // also the words of the language
  number,
  text,
  unit,        // [m/s]
  prime,       // '
  open_index,  // [ directly after a name
  close_index,
  open_round,
  close_round,
  open_brace,
  close_brace,
  comma,
  semicolon,
  colon,
  dots,    // ..
  dot,     // . before the member of a body: ball.x
  define,  // =
  assign,  // :=
  plus,
  minus,
  star,
  slash,
  caret,
  less,
  less_equal,
  greater,
  greater_equal,
  equal,      // ==
  not_equal,  // !=
  bad,        // no token; `problem` says why
};

struct Token {
  TokenKind kind = TokenKind::end;
  Span span;
  bool after_space = true;         // white space or a line end before it
  std::uint32_t goes_on_from = 0;  // begin of the token that made the line before go on, where one did
  bool goes_on = false;
  double number = 0;                  // of a number
  std::optional<Diagnostic> problem;  // of a bad token
};

class Lexer {
 public:
  explicit Lexer(const Source& source);

  /// After the last token, `end` for ever.
  [[nodiscard]] Token next();

 private:
  [[nodiscard]] Token scan();
  [[nodiscard]] Token scan_number();
  [[nodiscard]] Token scan_text();
  [[nodiscard]] Token scan_unit();
  [[nodiscard]] Token scan_sign();
  [[nodiscard]] Token scan_unknown();
  [[nodiscard]] Token make(TokenKind kind, std::size_t size);
  [[nodiscard]] Token bad(std::size_t size, std::string code, std::string message, std::string label, std::string help);
  bool skip_blanks();

  const Source& source_;
  std::string_view text_;
  std::size_t at_ = 0;
  TokenKind before_ = TokenKind::line_end;
  Span before_span_;
};

/// The comment block before the first statement, `# ` taken off each line; ends at the first empty line or statement.
[[nodiscard]] std::string heading_of(std::string_view text);

/// What a text token says, its escapes `\" \\ \n \t` resolved.
[[nodiscard]] std::string unescape(std::string_view token);

/// The token in words for messages: "`=`", "the number `3`", "the end of the line".
[[nodiscard]] std::string describe(const Token& token, const Source& source);

}  // namespace continuo::model
