// continuo/symbolic/units/units_parse.cpp
// unit    = product end
// product = factor { ("*" | "." | "/" | space) factor }
// factor  = ( number | name | "(" product ")" ) [ ("^" | "**") exponent | digits straight after a name ]
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include <continuo/symbolic/units/units.hpp>
#include <continuo/symbolic/units/units_database.hpp>

namespace continuo::model {

namespace {

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  Result<Unit> read() {
    skip_spaces();
    if (at_end()) {
      suggestion_ = "1";
      return invalid_input("the unit is empty");
    }
    auto unit = product(0);
    if (unit && !at_end()) fail("`" + std::string(text_.substr(at_)) + "` is left over in the unit `" + whole() + "`");
    if (!problem_.empty()) return invalid_input(problem_);
    return *std::move(unit);
  }
  /// Of the text that was read; empty where there is none.
  const std::string& suggestion() const { return suggestion_; }

 private:
  static constexpr int deepest = 50;

  std::string whole() const { return std::string(text_); }
  bool at_end() const { return at_ == text_.size(); }
  char peek() const { return at_end() ? '\0' : text_[at_]; }
  void skip_spaces() {
    while (std::isspace(static_cast<unsigned char>(peek()))) ++at_;
  }
  std::optional<Unit> fail(std::string problem) {
    if (problem_.empty()) problem_ = std::move(problem);
    return std::nullopt;
  }
  static bool is_letter(char c) {
    const auto byte = static_cast<unsigned char>(c);  // bytes above 127: the letters of UTF-8, as in µm
    return std::isalpha(byte) || byte >= 128 || c == '_' || c == '%' || c == '\'' || c == '"';
  }

  std::optional<Unit> product(int depth) {
    auto unit = factor(depth);
    while (unit) {
      skip_spaces();
      const char c = peek();
      if (at_end() || c == ')') return unit;
      const bool times = c == '*' || c == '.', over = c == '/';
      if (times || over) ++at_;
      skip_spaces();
      const auto next = factor(depth);
      if (!next) return std::nullopt;
      unit = over ? *unit / *next : *unit * *next;
    }
    return unit;
  }

  std::optional<Unit> factor(int depth) {
    if (depth > deepest) return fail("brackets too deep in a unit");
    const char c = peek();
    bool digits_may_follow = false;
    std::optional<Unit> unit;
    if (c == '(') {
      ++at_;
      skip_spaces();
      unit = product(depth + 1);
      if (!unit) return unit;
      if (peek() != ')') return fail("a bracket is not closed in the unit `" + whole() + "`");
      ++at_;
    } else if (std::isdigit(static_cast<unsigned char>(c))) {
      unit = number();
    } else if (is_letter(c)) {
      unit = named();
      digits_may_follow = true;
    } else {
      return fail(at_end() ? "the unit `" + whole() + "` ends too early"
                           : "`" + std::string(1, c) + "` is not expected in the unit `" + whole() + "`");
    }
    return unit ? raised(*unit, digits_may_follow) : unit;
  }

  std::optional<Unit> number() {
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc{} || !(value > 0)) return fail("a number in the unit `" + whole() + "` is not positive");
    std::string symbol(text_.data() + at_, end);
    at_ = static_cast<std::size_t>(end - text_.data());
    return value == 1 ? Unit() : Unit(std::move(symbol), {}, value);
  }

  std::optional<Unit> named() {
    const std::size_t begin = at_;
    while (is_letter(peek())) ++at_;
    const std::string name(text_.substr(begin, at_ - begin));
    if (auto unit = detail::usual_unit(name)) return unit;
    Result<Unit> unit = detail::database_unit(name);
    if (unit) return *std::move(unit);
    if (problem_.empty()) suggestion_ = detail::nearest_usual_name(name);
    return fail(unit.status().message);
  }

  std::optional<Unit> raised(const Unit& base, bool digits_may_follow) {
    bool explicit_power = false;
    if (peek() == '^') {
      ++at_;
      explicit_power = true;
    } else if (text_.substr(at_, 2) == "**") {
      at_ += 2;
      explicit_power = true;
    }
    const bool sign_and_digit = (peek() == '-' || peek() == '+') && at_ + 1 < text_.size() &&
                                std::isdigit(static_cast<unsigned char>(text_[at_ + 1]));
    const bool digit = std::isdigit(static_cast<unsigned char>(peek())) != 0;
    if (!explicit_power && !(digits_may_follow && (digit || sign_and_digit))) return base;
    const auto exponent = read_exponent();
    const auto unit = exponent ? power(base, *exponent) : std::nullopt;
    return unit ? unit : fail("the exponent in the unit `" + whole() + "` cannot be used");
  }

  std::optional<double> signed_number() {
    if (peek() == '+') ++at_;
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc{}) return std::nullopt;
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }

  std::optional<double> read_exponent() {
    if (peek() != '(') return signed_number();
    ++at_;
    auto value = signed_number();
    if (value && peek() == '/') {
      ++at_;
      const auto divisor = signed_number();
      if (!divisor || *divisor == 0) return std::nullopt;
      value = *value / *divisor;
    }
    if (peek() != ')') return std::nullopt;
    ++at_;
    return value;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::string problem_, suggestion_;
};

}  // namespace

Result<Unit> parse_unit(std::string_view text) {
  return Reader(text).read();
}

std::string suggested_unit(std::string_view text) {
  Reader reader(text);
  return reader.read() ? std::string() : reader.suggestion();
}

}  // namespace continuo::model
