// Decodes UTF-8, and classifies letters by ranges of code points.
#include <algorithm>
#include <array>

#include <continuo/language/text/unicode.hpp>

namespace continuo::model {

namespace {

struct Interval {
  char32_t first, last;
};

// Blocks of letters from the Unicode character database, kept to scripts whose blocks are letters (nearly) throughout.
constexpr std::array letters = {
    Interval{0xAA, 0xAA},     Interval{0xB5, 0xB5},       Interval{0xBA, 0xBA},     Interval{0xC0, 0xD6},
    Interval{0xD8, 0xF6},     Interval{0xF8, 0x2C1},      Interval{0x370, 0x374},   Interval{0x376, 0x377},
    Interval{0x37B, 0x37D},   Interval{0x37F, 0x37F},     Interval{0x386, 0x386},   Interval{0x388, 0x3F5},
    Interval{0x3F7, 0x481},   Interval{0x48A, 0x52F},     Interval{0x531, 0x556},   Interval{0x561, 0x587},
    Interval{0x5D0, 0x5EA},   Interval{0x620, 0x64A},     Interval{0x904, 0x939},   Interval{0xE01, 0xE30},
    Interval{0x10A0, 0x10FF}, Interval{0x1E00, 0x1FBC},   Interval{0x210A, 0x2113}, Interval{0x211B, 0x211D},
    Interval{0x2124, 0x2124}, Interval{0x3041, 0x3096},   Interval{0x30A1, 0x30FA}, Interval{0x4E00, 0x9FFF},
    Interval{0xAC00, 0xD7A3}, Interval{0x1D400, 0x1D7CB},
};

// Combining marks, subscript digits and letters.
constexpr std::array continuations = {
    Interval{0x300, 0x36F},
    Interval{0x2080, 0x2089},
    Interval{0x2090, 0x209C},
};

template <std::size_t N>
bool contains(const std::array<Interval, N>& intervals, char32_t c) {
  return std::any_of(intervals.begin(), intervals.end(), [c](Interval i) { return i.first <= c && c <= i.last; });
}

bool ascii_letter(char32_t c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

}  // namespace

CodePoint decode(std::string_view text, std::size_t offset) {
  const auto byte = [&](std::size_t i) -> char32_t {
    return offset + i < text.size() ? static_cast<unsigned char>(text[offset + i]) : 0U;
  };
  const auto tail = [&](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
  const char32_t lead = byte(0);
  if (offset >= text.size()) return {};
  if (lead < 0x80) return {lead, 1};
  if (lead >= 0xC2 && lead <= 0xDF && tail(1)) return {(lead & 0x1FU) << 6U | (byte(1) & 0x3FU), 2};
  if (lead >= 0xE0 && lead <= 0xEF && tail(1) && tail(2)) {
    const char32_t c = (lead & 0xFU) << 12U | (byte(1) & 0x3FU) << 6U | (byte(2) & 0x3FU);
    const bool surrogate = c >= 0xD800 && c <= 0xDFFF;
    return c < 0x800 || surrogate ? CodePoint{} : CodePoint{c, 3};
  }
  if (lead >= 0xF0 && lead <= 0xF4 && tail(1) && tail(2) && tail(3)) {
    const char32_t c = (lead & 0x7U) << 18U | (byte(1) & 0x3FU) << 12U | (byte(2) & 0x3FU) << 6U | (byte(3) & 0x3FU);
    return c < 0x10000 || c > 0x10FFFF ? CodePoint{} : CodePoint{c, 4};
  }
  return {};
}

std::optional<std::size_t> first_invalid_byte(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    if (static_cast<unsigned char>(text[i]) < 0x80) {
      ++i;
      continue;
    }
    const CodePoint c = decode(text, i);
    if (c.size == 0) return i;
    i += c.size;
  }
  return std::nullopt;
}

bool begins_name(char32_t c) {
  return c < 0x80 ? ascii_letter(c) : contains(letters, c);
}

bool continues_name(char32_t c) {
  if (c < 0x80) return ascii_letter(c) || (c >= '0' && c <= '9');
  return contains(letters, c) || contains(continuations, c);
}

}  // namespace continuo::model
