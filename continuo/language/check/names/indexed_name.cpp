// continuo/language/check/names/indexed_name.cpp
// The text of a name with its indices.
#include <array>
#include <charconv>

#include <continuo/language/check/names/indexed_name.hpp>

namespace continuo::model::detail {

std::string indexed(std::string_view name, std::span<const long> indices) {
  std::string text(name);
  std::array<char, 24> digits;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    digits.front() = i == 0 ? '[' : ',';
    text.append(digits.data(), std::to_chars(digits.begin() + 1, digits.end(), indices[i]).ptr);
  }
  if (!indices.empty()) text += ']';
  return text;
}

std::string IndexedName::text() const {
  std::string whole = indexed(name, indices);
  if (!member.empty()) whole.append(".").append(member);
  return whole;
}

}  // namespace continuo::model::detail
