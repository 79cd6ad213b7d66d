// continuo/language/text/source.hpp
// The text of a model, and places in it.
//
//   Source source("ball.sim", "model Ball\nh'' = -9.8\n");
//   Place place = source.place(11);           // line 2, column 1
//   std::string_view line = source.line(2);   // h'' = -9.8
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace continuo::model {

/// A stretch of the text: the bytes [begin, end).
struct Span {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;

  [[nodiscard]] bool empty() const { return begin == end; }
  bool operator==(const Span&) const = default;
};

/// The smallest span that holds both.
[[nodiscard]] constexpr Span cover(Span a, Span b) {
  return {a.begin < b.begin ? a.begin : b.begin, a.end > b.end ? a.end : b.end};
}

/// Where a person finds it: both count from 1, the column in characters (UTF-8 code points), not bytes.
struct Place {
  int line = 1;
  int column = 1;

  bool operator==(const Place&) const = default;
};

/// A text with its name; finds line and column of any byte. Holds any bytes, also those that are not UTF-8.
class Source {
 public:
  /// Longer texts are refused by `read_source`; spans are 32 bits wide.
  static constexpr std::size_t largest_size = std::size_t{1} << 30;

  Source(std::string name, std::string text);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] std::string_view slice(Span span) const;

  /// An offset beyond the end is taken as the end.
  [[nodiscard]] Place place(std::uint32_t offset) const;
  /// Without its line end; empty for a line that is not there.
  [[nodiscard]] std::string_view line(int number) const;
  [[nodiscard]] int line_count() const { return static_cast<int>(line_starts_.size()); }
  /// The offset at which the line begins.
  [[nodiscard]] std::uint32_t line_start(int number) const;

 private:
  std::string name_;
  std::string text_;
  std::vector<std::uint32_t> line_starts_;
};

/// Reads a file whole; nothing where it cannot be read or is larger than `Source::largest_size`.
[[nodiscard]] std::optional<Source> read_source(const std::string& path);

}  // namespace continuo::model
