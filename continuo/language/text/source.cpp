// Lines and columns of places in a text.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <continuo/language/text/source.hpp>

namespace continuo::model {

namespace {

bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

}  // namespace

Source::Source(std::string name, std::string text) : name_(std::move(name)), text_(std::move(text)) {
  line_starts_.push_back(0);
  for (std::size_t i = text_.find('\n'); i != std::string::npos; i = text_.find('\n', i + 1))
    line_starts_.push_back(static_cast<std::uint32_t>(i + 1));
}

std::string_view Source::slice(Span span) const {
  const std::size_t begin = std::min<std::size_t>(span.begin, text_.size());
  const std::size_t end = std::clamp<std::size_t>(span.end, begin, text_.size());
  return std::string_view(text_).substr(begin, end - begin);
}

Place Source::place(std::uint32_t offset) const {
  offset = std::min(offset, static_cast<std::uint32_t>(text_.size()));
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  const auto start = static_cast<std::ptrdiff_t>(*std::prev(after));
  const auto first = text_.begin() + start;
  const auto characters = std::count_if(first, text_.begin() + static_cast<std::ptrdiff_t>(offset),
                                        [](char byte) { return !continues_character(byte); });
  return {static_cast<int>(after - line_starts_.begin()), static_cast<int>(characters) + 1};
}

std::uint32_t Source::line_start(int number) const {
  if (number < 1) return 0;
  if (number > line_count()) return static_cast<std::uint32_t>(text_.size());
  return line_starts_[static_cast<std::size_t>(number - 1)];
}

std::string_view Source::line(int number) const {
  if (number < 1 || number > line_count()) return {};
  std::string_view line = slice({line_start(number), line_start(number + 1)});
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
  return line;
}

std::optional<Source> read_source(const std::string& path) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  const auto size = std::filesystem::file_size(path, code);  // fails on a pipe, which is read to its end instead
  if (!code && size > Source::largest_size) return std::nullopt;
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad() || text.size() > Source::largest_size) return std::nullopt;
  return Source(path, std::move(text));
}

}  // namespace continuo::model
