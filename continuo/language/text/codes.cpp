// Searches the register of codes.
#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include <continuo/language/text/codes.hpp>

namespace continuo::model {

const Code* find_code(std::string_view code) {
  std::string wanted(code);
  std::transform(wanted.begin(), wanted.end(), wanted.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  for (const std::span<const Code> family : {syntax_codes(), check_codes(), numerical_codes()}) {
    const auto found = std::find_if(family.begin(), family.end(), [&](const Code& c) { return c.code == wanted; });
    if (found != family.end()) return &*found;
  }
  return nullptr;
}

}  // namespace continuo::model
