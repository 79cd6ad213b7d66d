// Splits text into tokens, with a message for each character that begins none.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include <continuo/language/syntax/blackboard.hpp>
#include <continuo/language/syntax/lexer.hpp>
#include <continuo/language/text/unicode.hpp>

namespace continuo::model {

namespace {

constexpr std::size_t longest_name = 200;  // names are shown in messages and as columns

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// After these a line goes on. The words `and`, `or`, `not`, `then`, `else` are names here; the parser handles them.
bool goes_on_after(TokenKind kind) {
  switch (kind) {
    case TokenKind::comma:
    case TokenKind::open_round:
    case TokenKind::open_index:
    case TokenKind::colon:
    case TokenKind::dots:
    case TokenKind::define:
    case TokenKind::assign:
    case TokenKind::plus:
    case TokenKind::minus:
    case TokenKind::star:
    case TokenKind::slash:
    case TokenKind::caret:
    case TokenKind::less:
    case TokenKind::less_equal:
    case TokenKind::greater:
    case TokenKind::greater_equal:
    case TokenKind::equal:
    case TokenKind::not_equal:
      return true;
    default:
      return false;
  }
}

struct Sign {
  std::string_view text;
  TokenKind kind;
};

// Longest first.
constexpr std::array signs = {
    Sign{":=", TokenKind::assign},     Sign{"==", TokenKind::equal},         Sign{"!=", TokenKind::not_equal},
    Sign{"<=", TokenKind::less_equal}, Sign{">=", TokenKind::greater_equal}, Sign{"..", TokenKind::dots},
    Sign{"'", TokenKind::prime},       Sign{"(", TokenKind::open_round},     Sign{")", TokenKind::close_round},
    Sign{"{", TokenKind::open_brace},  Sign{"}", TokenKind::close_brace},    Sign{"]", TokenKind::close_index},
    Sign{",", TokenKind::comma},       Sign{";", TokenKind::semicolon},      Sign{":", TokenKind::colon},
    Sign{"=", TokenKind::define},      Sign{"+", TokenKind::plus},           Sign{"-", TokenKind::minus},
    Sign{"*", TokenKind::star},        Sign{"/", TokenKind::slash},          Sign{"^", TokenKind::caret},
    Sign{"<", TokenKind::less},        Sign{">", TokenKind::greater},        Sign{".", TokenKind::dot},
};

// What other languages and word processors write; read as the sign of ours after the message.
struct Foreign {
  std::string_view text, ours;
};
constexpr std::array foreign = {
    Foreign{"...", "a range is written 0..10"},
    Foreign{"**", "a power is written x^2"},
    Foreign{"&&", "write `and`"},
    Foreign{"||", "write `or`"},
    Foreign{"//", "a comment begins with `#`"},
    Foreign{"/*", "a comment begins with `#` and ends with its line"},
    Foreign{"+=", "write x := x + ..."},
    Foreign{"-=", "write x := x - ..."},
    Foreign{"*=", "write x := x*..."},
    Foreign{"<>", "write `!=`"},
    Foreign{"!", "write `not`"},
    Foreign{"%", "a remainder is written mod(a, b), a comment begins with `#`"},
    Foreign{"\xE2\x80\x99", "a prime is the straight quote, as in x'"},
    Foreign{"\xE2\x80\x98", "a prime is the straight quote, as in x'"},
    Foreign{"\xE2\x80\xB2", "a prime is the straight quote, as in x'"},
    Foreign{"\xE2\x80\xB3", "two primes are two straight quotes, as in x''"},
    Foreign{"`", "a prime is the straight quote, as in x'"},
    Foreign{"\xC2\xB4", "a prime is the straight quote, as in x'"},
    Foreign{"\xE2\x80\x9C", "a text stands in straight quotes, as in \"w\""},
    Foreign{"\xE2\x80\x9D", "a text stands in straight quotes, as in \"w\""},
    Foreign{"\xE2\x88\x92", "write the minus of the keyboard, `-`"},
    Foreign{"\xE2\x80\x93", "write the minus of the keyboard, `-`"},
    Foreign{"\xC2\xB7", "write `*`"},
    Foreign{"\xC3\x97", "write `*`"},
    Foreign{"\xE2\x8B\x85", "write `*`"},
    Foreign{"\xC3\xB7", "write `/`"},
    Foreign{"\xC2\xB2", "a square is written x^2"},
    Foreign{"\xC2\xB3", "a cube is written x^3"},
    Foreign{"\xE2\x89\xA4", "write `<=`"},
    Foreign{"\xE2\x89\xA5", "write `>=`"},
    Foreign{"\xE2\x89\xA0", "write `!=`"},
    Foreign{"\xE2\x80\xA6", "a range is written 0..10"},
    Foreign{"\xC2\xA0", "this is a no-break space; write an ordinary one"},
    Foreign{"\xE3\x80\x80", "this is a wide space; write an ordinary one"},
    Foreign{"\xE2\x80\x89", "this is a thin space; write an ordinary one"},
    Foreign{"\xE2\x80\xAF", "this is a narrow no-break space; write an ordinary one"},
    Foreign{"\xE2\x80\x94", "write the minus of the keyboard, `-`"},
    Foreign{"\xE2\x80\x90", "write the minus of the keyboard, `-`"},
    Foreign{"\xE2\x80\x91", "write the minus of the keyboard, `-`"},
    Foreign{"\xE2\x88\x97", "write `*`"},
    Foreign{"\xE2\x88\x99", "write `*`"},
    Foreign{"\xE2\x80\xA2", "write `*`"},
    Foreign{"\xE2\x88\x95", "write `/`"},
    Foreign{"\xE2\x81\x84", "write `/`"},
    Foreign{"\xE2\x88\x9A", "a square root is written sqrt(x)"},
    Foreign{"\xC2\xB1", "a value has one sign: write `+` or `-`, or multiply by a parameter that is 1 or -1"},
    Foreign{"\xC2\xB0", "an angle in degrees has its unit in brackets, as in 30 [deg]"},
    Foreign{"\xE2\x88\x9E", "there is no infinite number; write a large one, such as 1e300"},
    Foreign{"?", "a choice is written: if c then a else b"},
    Foreign{"|", "an absolute value is written abs(x)"},
};

std::size_t name_size(std::string_view text, std::size_t at) {
  std::size_t end = at;
  for (CodePoint c = decode(text, end); c.size > 0; c = decode(text, end)) {
    if (end == at ? !begins_name(c.value) : !continues_name(c.value)) break;
    end += c.size;
  }
  return end - at;
}

}  // namespace

Lexer::Lexer(const Source& source) : source_(source), text_(source.text()) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text_.starts_with(byte_order_mark)) at_ = byte_order_mark.size();
}

Token Lexer::make(TokenKind kind, std::size_t size) {
  Token token;
  token.kind = kind;
  token.span = {static_cast<std::uint32_t>(at_), static_cast<std::uint32_t>(at_ + size)};
  at_ += size;
  return token;
}

Token Lexer::bad(std::size_t size, std::string code, std::string message, std::string label, std::string help) {
  Token token = make(TokenKind::bad, size);
  token.problem = error(std::move(code), token.span, std::move(message), std::move(label), std::move(help));
  return token;
}

/// Whether there was anything to skip.
bool Lexer::skip_blanks() {
  const std::size_t from = at_;
  while (at_ < text_.size()) {
    const char c = text_[at_];
    if (c == ' ' || c == '\t' || (c == '\r' && (at_ + 1 >= text_.size() || text_[at_ + 1] == '\n'))) {
      ++at_;
    } else if (c == '#') {
      at_ = std::min(text_.find('\n', at_), text_.size());
    } else {
      break;
    }
  }
  return at_ > from;
}

Token Lexer::next() {
  bool space = skip_blanks();
  bool crossed = false;
  while (at_ < text_.size() && text_[at_] == '\n' && goes_on_after(before_)) {
    ++at_;
    skip_blanks();
    space = crossed = true;
  }
  if (before_ == TokenKind::line_end) space = true;
  const std::size_t begin = at_;
  Token token = scan();
  token.after_space = space || begin == 0;
  token.goes_on = crossed;
  token.goes_on_from = before_span_.begin;
  // A `[` is an index only where a name stands directly before it.
  before_ = token.kind;
  before_span_ = token.span;
  return token;
}

Token Lexer::scan() {
  if (at_ >= text_.size()) return make(TokenKind::end, 0);
  const char c = text_[at_];
  if (c == '\n') return make(TokenKind::line_end, 1);
  if (is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]))) return scan_number();
  if (c == '"') return scan_text();
  if (c == '[') {
    const bool touches = at_ == before_span_.end;
    const bool indexable = before_ == TokenKind::name || before_ == TokenKind::prime;
    return touches && indexable ? make(TokenKind::open_index, 1) : scan_unit();
  }
  if (const std::size_t size = name_size(text_, at_); size > longest_name) {
    return bad(size, "E136", "this name is too long", fmt::format("it has {} bytes", size),
               fmt::format("names have at most {} bytes", longest_name));
  } else if (size > 0) {
    return make(TokenKind::name, size);
  }
  return scan_sign();
}

Token Lexer::scan_number() {
  std::size_t end = at_;
  const auto digits = [&] {
    while (end < text_.size() && is_digit(text_[end])) ++end;
  };
  const auto at = [&](std::size_t i) { return i < text_.size() ? text_[i] : '\0'; };
  digits();
  if (at(end) == '.' && at(end + 1) != '.') {  // `0..60` is a range
    ++end;
    digits();
  }
  if (at(end) == 'e' || at(end) == 'E') {
    const std::size_t sign = at(end + 1) == '+' || at(end + 1) == '-' ? 1 : 0;
    if (is_digit(at(end + 1 + sign))) {
      end += 1 + sign;
      digits();
    }
  }
  const std::string_view spelled = text_.substr(at_, end - at_);
  double value = 0;
  const auto read = std::from_chars(spelled.data(), spelled.data() + spelled.size(), value);
  if (read.ec == std::errc::result_out_of_range || !std::isfinite(value)) {
    return bad(spelled.size(), "E105", "this number does not fit", "numbers reach from about 1e-308 to 1e308",
               "choose a unit in which the number is smaller");
  }
  const CodePoint after = decode(text_, end);
  if (after.size > 0 && begins_name(after.value)) {
    const std::size_t letters = name_size(text_, end);
    const std::string_view word = text_.substr(end, letters);
    const Span number{static_cast<std::uint32_t>(at_), static_cast<std::uint32_t>(end)};
    return bad(spelled.size() + letters, "E116",
               fmt::format("an operator is missing between `{}` and `{}`", spelled, word), "",
               help_after_number(source_, number, word));
  }
  Token token = make(TokenKind::number, spelled.size());
  token.number = value;
  return token;
}

Token Lexer::scan_text() {
  const bool after_name = at_ == before_span_.end && (before_ == TokenKind::name || before_ == TokenKind::close_index);
  if (after_name) {
    return bad(1, "E129", "a double quote is not two primes", "one character, `\"`",
               "write two single quotes, as in x''");
  }
  // Without a search for the line's end first: many short texts in one long line would each look to its end.
  std::optional<Span> wrong;
  std::size_t i = at_ + 1;
  for (; i < text_.size() && text_[i] != '\n'; ++i) {
    if (text_[i] == '"') {
      if (!wrong) return make(TokenKind::text, i + 1 - at_);
      Token token = bad(i + 1 - at_, "E133", "a backslash in a text means one of \\\" \\\\ \\n \\t", "",
                        "write \\\\ for a backslash, or / between folders");
      token.problem->span = *wrong;
      return token;
    }
    if (text_[i] != '\\') continue;
    const char escaped = i + 1 < text_.size() ? text_[i + 1] : '\0';
    if (escaped == '\n') break;
    const bool known = escaped == '"' || escaped == '\\' || escaped == 'n' || escaped == 't';
    if (!known && !wrong) wrong = Span{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + 2)};
    ++i;
  }
  return bad(std::min(i, text_.size()) - at_, "E103", "this text has no end", "begins here",
             "close it with `\"` on the same line");
}

Token Lexer::scan_unit() {
  constexpr std::size_t longest = 256;  // bounds the search: many brackets in one long line would each look to its end
  const std::string_view rest = text_.substr(at_, longest);
  const std::size_t close = rest.find(']');
  if (close < rest.find('\n')) return make(TokenKind::unit, close + 1);
  return bad(1, "E104", "this unit bracket has no end", "", "close it with `]` on the same line, as in 9.8 [m/s^2]");
}

Token Lexer::scan_sign() {
  const std::string_view rest = text_.substr(at_, 3);
  const bool three_dots = rest == "...";  // no range up to .5
  for (const Sign& sign : signs) {
    if (!three_dots && sign.text.size() == 2 && rest.starts_with(sign.text)) return make(sign.kind, 2);
  }
  for (const Foreign& sign : foreign) {
    if (rest.starts_with(sign.text)) {
      const bool comment = sign.text == "//" || sign.text == "/*";
      const std::size_t size = comment ? std::min(text_.find('\n', at_), text_.size()) - at_ : sign.text.size();
      return bad(size, "E127", fmt::format("`{}` is not a sign of the language", sign.text), "",
                 std::string(sign.ours));
    }
  }
  for (const Sign& sign : signs) {
    if (rest.starts_with(sign.text)) return make(sign.kind, sign.text.size());
  }
  return scan_unknown();
}

Token Lexer::scan_unknown() {
  const CodePoint c = decode(text_, at_);
  const std::size_t size = std::max<std::size_t>(c.size, 1);
  const bool shown = c.value > 0x20 && c.value != 0x7F && (c.value < 0x80 || c.value >= 0xA0);
  const bool invisible = !shown || c.value == 0xAD || (c.value >= 0x200B && c.value <= 0x200F) || c.value == 0x2060 ||
                         c.value == 0xFEFF || c.value == 0x2028 || c.value == 0x2029;
  const std::string name = invisible ? fmt::format("the character U+{:04X}", static_cast<unsigned>(c.value))
                                     : fmt::format("`{}`", text_.substr(at_, size));
  std::string help;
  if (c.value == '\r') {
    help = "lines end with this sign alone, as on old computers: save the file with the line ends of Unix or Windows";
  } else if (invisible) {
    help = "it cannot be seen: delete what is between its neighbours and write them again";
  } else if (c.value >= 0xFF01 && c.value <= 0xFF5E) {  // a whole block of Unicode repeats the signs of ASCII
    help = fmt::format("this is a wide character; write `{}`", static_cast<char>(c.value - 0xFEE0));
  }
  return bad(size, "E102", name + " has no meaning here", "", std::move(help));
}

std::string heading_of(std::string_view text) {
  std::string heading;
  bool begun = false;
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos && !begun) continue;
    if (first == std::string_view::npos || line[first] != '#') break;
    line.remove_prefix(first + 1);
    if (line.starts_with(' ')) line.remove_prefix(1);
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
    if (begun) heading += '\n';
    heading += line;
    begun = true;
  }
  return heading;
}

std::string unescape(std::string_view token) {
  std::string text;
  for (std::size_t i = 1; i + 1 < token.size(); ++i) {
    if (token[i] == '\\' && i + 2 < token.size()) {
      ++i;
      text += token[i] == 'n' ? '\n' : token[i] == 't' ? '\t' : token[i];
    } else {
      text += token[i];
    }
  }
  return text;
}

std::string describe(const Token& token, const Source& source) {
  constexpr std::size_t longest = 40;
  std::string spelled(source.slice(token.span));
  if (spelled.size() > longest) {
    std::size_t cut = longest;
    while (cut > 0 && (static_cast<unsigned char>(spelled[cut]) & 0xC0U) == 0x80U) --cut;
    spelled = spelled.substr(0, cut) + "...";
  }
  switch (token.kind) {
    case TokenKind::end:
      return "the end of the file";
    case TokenKind::line_end:
      return "the end of the line";
    case TokenKind::number:
      return "the number `" + spelled + "`";
    case TokenKind::text:
      return "the text " + spelled;
    case TokenKind::unit:
      return "the unit " + spelled;
    default:
      return "`" + spelled + "`";
  }
}

}  // namespace continuo::model
