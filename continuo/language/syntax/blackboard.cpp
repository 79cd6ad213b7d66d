// Reads what was meant by notations that the language does not have.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <continuo/language/syntax/blackboard.hpp>
#include <continuo/language/text/unicode.hpp>

namespace continuo::model {

namespace {

constexpr std::size_t longest_line = 90;

bool is_decimal_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::size_t size_of_name(std::string_view text) {
  std::size_t size = 0;
  for (CodePoint c = decode(text, 0); c.size > 0; c = decode(text, size)) {
    if (size == 0 ? !begins_name(c.value) : !continues_name(c.value)) break;
    size += c.size;
  }
  return size;
}

/// The order in `2`, `^2` or a small raised digit, which is removed; 1 where there is none.
int take_order(std::string_view& text) {
  constexpr std::array<std::pair<std::string_view, int>, 2> raised{{{"\xC2\xB2", 2}, {"\xC2\xB3", 3}}};
  for (const auto& [sign, order] : raised)
    if (text.starts_with(sign)) return text.remove_prefix(sign.size()), order;
  const std::size_t caret = text.starts_with('^') ? 1 : 0;
  if (text.size() <= caret || text[caret] < '2' || text[caret] > '9') return 1;
  const int order = text[caret] - '0';
  text.remove_prefix(caret + 1);
  return order;
}

void skip_blanks(std::string_view& text) {
  while (text.starts_with(' ') || text.starts_with('\t')) text.remove_prefix(1);
}

std::string with_primes(std::string_view name, int order) {
  return fmt::format("{}{}", name, std::string(static_cast<std::size_t>(order), '\''));
}

}  // namespace

std::string with_corrected_line(std::string help, const Source& source, Span span, std::string_view instead) {
  const Place place = source.place(span.begin);
  const std::string_view line = source.line(place.line);
  const std::size_t begin = span.begin - source.line_start(place.line), end = begin + (span.end - span.begin);
  if (end > line.size()) return help;
  const std::string_view behind = line.substr(end);
  const std::string corrected =
      fmt::format("{}{}{}", line.substr(0, begin), instead, behind.substr(0, behind.find('#')));
  if (trimmed(corrected).size() > longest_line) return help;
  return fmt::format("{}: {}", help, trimmed(corrected));
}

std::optional<WrittenDerivative> derivative_by_time(std::string_view text) {
  const std::size_t all = text.size();
  if (!text.starts_with('d')) return std::nullopt;
  text.remove_prefix(1);
  const int order = take_order(text);
  const std::size_t size = size_of_name(text);
  const std::string_view name = text.substr(0, size);
  text.remove_prefix(size);
  skip_blanks(text);
  if (name.empty() || !text.starts_with('/')) return std::nullopt;
  text.remove_prefix(1);
  skip_blanks(text);
  if (!text.starts_with("dt")) return std::nullopt;
  text.remove_prefix(2);
  if (take_order(text) != order || size_of_name(text) > 0) return std::nullopt;
  return WrittenDerivative{with_primes(name, order), all - text.size()};
}

std::optional<std::string> derivative_in_name(std::string_view name) {
  struct Ending {
    std::string_view text;
    int order;
  };
  // The last two are combining characters: a dot and two dots above the letter before.
  constexpr std::array<Ending, 7> endings{
      {{"_ddot", 2}, {"_dot", 1}, {"ddot", 2}, {"dot", 1}, {"_t", 1}, {"\xCC\x87", 1}, {"\xCC\x88", 2}}};
  for (const auto& [text, order] : endings)
    if (name.size() > text.size() && name.ends_with(text))
      return with_primes(name.substr(0, name.size() - text.size()), order);
  struct Dotted {
    std::string_view letter, base;
    int order;
  };
  constexpr std::array<Dotted, 6> dotted{{{"\xE1\xBA\x8B", "x", 1},
                                          {"\xE1\xBA\x8D", "x", 2},
                                          {"\xE1\xBA\x8F", "y", 1},
                                          {"\xC3\xBF", "y", 2},
                                          {"\xC5\xBC", "z", 1},
                                          {"\xE1\xB9\xAB", "t", 1}}};
  for (const auto& [letter, base, order] : dotted)
    if (name == letter) return with_primes(base, order);
  if (name.size() > 3 && name.starts_with('d') && name.ends_with("dt"))
    return with_primes(name.substr(1, name.size() - 3), 1);
  if (name.size() > 1 && name.starts_with('d')) return with_primes(name.substr(1), 1);
  return std::nullopt;
}

std::string help_with_commas(const Source& source, std::uint32_t at) {
  const std::string& text = source.text();
  const auto belongs = [&](std::size_t i) { return is_decimal_digit(text[i]) || text[i] == ','; };
  std::size_t begin = at, end = at;
  while (begin > 0 && belongs(begin - 1)) --begin;
  while (end < text.size() && belongs(end)) ++end;
  std::vector<std::string> groups{""};
  for (std::size_t i = begin; i < end; ++i) {
    if (text[i] == ',')
      groups.emplace_back();
    else
      groups.back() += text[i];
  }
  const bool whole = std::ranges::none_of(groups, [](const std::string& group) { return group.empty(); });
  if (groups.size() < 2 || !whole) return {};
  const bool thousands =
      std::all_of(groups.begin() + 1, groups.end(), [](const auto& group) { return group.size() == 3; });
  const Span span{static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  if (thousands && groups.size() > 2) {
    const std::string joined = fmt::format("{}", fmt::join(groups, ""));
    return with_corrected_line("a number has no separators between its digits", source, span, joined);
  }
  if (groups.size() > 2) return {};
  const std::string point = groups[0] + "." + groups[1];
  if (thousands)
    return fmt::format("the decimal sign is a point, {}; thousands are not separated, {}{}", point, groups[0],
                       groups[1]);
  return with_corrected_line("the decimal sign is a point", source, span, point);
}

std::string help_after_number(const Source& source, Span number, std::string_view word) {
  const std::string_view spelled = source.slice(number);
  const Span both{number.begin, static_cast<std::uint32_t>(number.end + word.size())};
  const auto digits_behind = [](std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, is_decimal_digit);
  };
  if ((word[0] == 'd' || word[0] == 'D') && digits_behind(word.substr(1)))
    return with_corrected_line("a power of ten is written with e", source, both,
                               fmt::format("{}e{}", spelled, word.substr(1)));
  if (word == "e" || word == "E")
    return fmt::format("digits are missing behind the e: {}e3 for {}*10^3", spelled, spelled);
  if (word[0] == '_' && digits_behind(word.substr(1)))
    return with_corrected_line("a number has no separators between its digits", source, both,
                               fmt::format("{}{}", spelled, word.substr(1)));
  if (word == "i" || word == "j")
    return fmt::format("numbers are real: real and imaginary part are two states; a product is written {}*{}", spelled,
                       word);
  return fmt::format("write {}*{}, or {} [{}] if it is a unit", spelled, word, spelled, word);
}

}  // namespace continuo::model
