// continuo/language/text/codes.hpp
// The register of every code Continuo raises, with the explanation `continuo explain` prints.
// E1xx: the text cannot be read; E2xx: it can be read but does not make a model; E3xx: the numbers failed.
#pragma once
#include <span>
#include <string_view>

namespace continuo::model {

struct Code {
  std::string_view code;         // "E101"
  std::string_view title;        // one line
  std::string_view explanation;  // what it means, an example that raises it, how to fix it
};

/// Each family in order of its codes.
[[nodiscard]] std::span<const Code> syntax_codes();     // E1xx, codes_syntax.cpp
[[nodiscard]] std::span<const Code> check_codes();      // E2xx, codes_check.cpp
[[nodiscard]] std::span<const Code> numerical_codes();  // E3xx, codes_numerical.cpp

/// The entry of a code ("E201", also "e201"), or null.
[[nodiscard]] const Code* find_code(std::string_view code);

}  // namespace continuo::model
