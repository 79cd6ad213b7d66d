// Inflates a PNG and undoes its filters: ISO/IEC 15948:2004, "Portable Network Graphics (PNG)", clauses 9 and 10.
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include <apps/continuo/pictures/png.hpp>
#include <zlib.h>

namespace continuo::app {
namespace {

constexpr std::string_view signature("\x89PNG\r\n\x1A\n", 8);
constexpr std::uint32_t most_pixels = 100'000'000;

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t k = 0; k < 4; ++k) number = number << 8 | static_cast<unsigned char>(bytes[at + k]);
  return number;
}

/// What of a picture comes before its pixels.
struct Head {
  std::uint32_t width = 0, height = 0;
  std::size_t channels = 0;
};

std::optional<Head> head_of(const std::string& bytes) {
  constexpr std::size_t least = 33;
  if (bytes.size() < least || !bytes.starts_with(signature) || bytes.compare(12, 4, "IHDR") != 0) return std::nullopt;
  Head head{number_at(bytes, 16), number_at(bytes, 20), 0};
  const char depth = bytes[24], kind = bytes[25], interlaced = bytes[28];
  head.channels = kind == 2 ? 3 : kind == 6 ? 4 : 0;
  const bool fits = head.width > 0 && head.height > 0 && head.width < most_pixels / head.height;
  return depth == 8 && interlaced == 0 && head.channels > 0 && fits ? std::optional(head) : std::nullopt;
}

/// The data of all chunks IDAT, inflated.
std::optional<std::vector<std::uint8_t>> data_of(const std::string& bytes, std::size_t size) {
  std::string packed;
  for (std::size_t at = signature.size(); at + 12 <= bytes.size();) {
    const std::size_t length = number_at(bytes, at);
    if (length > bytes.size() - at - 12) return std::nullopt;
    if (bytes.compare(at + 4, 4, "IDAT") == 0) packed.append(bytes, at + 8, length);
    at += length + 12;
  }
  std::vector<std::uint8_t> data(size);
  uLongf length = size;
  const int result = uncompress(data.data(), &length, reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  return result == Z_OK && length == size ? std::optional(std::move(data)) : std::nullopt;
}

/// Of the bytes to the left, above, and to the left above, the one nearest to left + above - corner.
int paeth(int left, int above, int corner) {
  const int guess = left + above - corner;
  const int to_left = std::abs(guess - left), to_above = std::abs(guess - above), to_corner = std::abs(guess - corner);
  if (to_left <= to_above && to_left <= to_corner) return left;
  return to_above <= to_corner ? above : corner;
}

/// Undoes the filter of one row; `above` is the row before, zeros for the first. False where there is no such filter.
bool unfilter(std::uint8_t filter, std::size_t channels, const std::vector<std::uint8_t>& above,
              std::vector<std::uint8_t>& row) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    const int left = i < channels ? 0 : row[i - channels], up = above[i],
              corner = i < channels ? 0 : above[i - channels];
    const std::array<int, 5> guesses = {0, left, up, (left + up) / 2, paeth(left, up, corner)};
    if (filter >= guesses.size()) return false;
    row[i] = static_cast<std::uint8_t>(row[i] + guesses[filter]);
  }
  return true;
}

}  // namespace

std::optional<Image> read_png(const std::string& bytes) {
  const auto head = head_of(bytes);
  if (!head) return std::nullopt;
  const std::size_t row_bytes = head->width * head->channels;
  const auto data = data_of(bytes, head->height * (row_bytes + 1));
  if (!data) return std::nullopt;
  Image image{head->width, head->height, {}};
  image.pixels.reserve(image.width * image.height);
  std::vector<std::uint8_t> above(row_bytes), row(row_bytes);
  for (std::size_t y = 0; y < image.height; ++y) {
    const auto begin = data->begin() + static_cast<std::ptrdiff_t>(y * (row_bytes + 1));
    row.assign(begin + 1, begin + 1 + static_cast<std::ptrdiff_t>(row_bytes));
    if (!unfilter(*begin, head->channels, above, row)) return std::nullopt;
    for (std::size_t x = 0; x < image.width; ++x) {
      const std::uint8_t* const pixel = &row[x * head->channels];
      image.pixels.push_back(static_cast<std::uint32_t>(pixel[0]) << 16 | static_cast<std::uint32_t>(pixel[1]) << 8 |
                             pixel[2]);
    }
    above = row;
  }
  return image;
}

}  // namespace continuo::app
