// continuo/language/text/unicode.hpp
// The little of Unicode a lexer needs: well-formed UTF-8 and what a letter is.
#pragma once
#include <cstddef>
#include <optional>
#include <string_view>

namespace continuo::model {

struct CodePoint {
  char32_t value = 0;
  std::size_t size = 0;  // bytes; 0 where the text is not well-formed UTF-8 or at its end
};

/// The code point that begins at `offset` (Unicode 15, table 3-7: no surrogates, no overlong forms).
[[nodiscard]] CodePoint decode(std::string_view text, std::size_t offset);

/// The offset of the first byte that is not part of well-formed UTF-8.
[[nodiscard]] std::optional<std::size_t> first_invalid_byte(std::string_view text);

/// May begin a name: an ASCII letter, `_`, or a letter of the common scripts.
[[nodiscard]] bool begins_name(char32_t c);
/// May go on with one: also digits, subscripts and combining marks.
[[nodiscard]] bool continues_name(char32_t c);

}  // namespace continuo::model
