// continuo/language/check/names/indexed_name.hpp
// A name with its indices as numbers: what an instance of `u[i-1,j]` stands for.
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace continuo::model::detail {

/// The numbers between the brackets of a name. They lie in the object itself: names are looked up by the million.
class IndexValues {
 public:
  static constexpr std::size_t most = 8;

  void push_back(long value) { values_[count_++] = value; }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] const long* begin() const { return values_.data(); }
  [[nodiscard]] const long* end() const { return values_.data() + count_; }
  [[nodiscard]] const long* data() const { return values_.data(); }

 private:
  std::array<long, most> values_;
  std::size_t count_ = 0;
};

/// `u[3]`, `a[1,2]`, `grain[3].x`. The texts are those of the syntax tree.
struct IndexedName {
  std::string_view name;
  IndexValues indices{};
  std::string_view member{};

  [[nodiscard]] std::string text() const;
};

/// "u[3]", "a[1,2]".
[[nodiscard]] std::string indexed(std::string_view name, std::span<const long> indices);

}  // namespace continuo::model::detail
