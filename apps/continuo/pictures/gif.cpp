// Writes GIF89a: CompuServe, "Graphics Interchange Format, version 89a" (1990), with LZW of its appendix F.
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <apps/continuo/pictures/gif.hpp>

namespace continuo::app {
namespace {

constexpr std::size_t most_colors = 256;
constexpr std::size_t shades = 1U << 15;  // five bits of each colour tell shades apart

std::size_t shade_of(std::uint32_t color) {
  return (color >> 19 & 31U) << 10 | (color >> 11 & 31U) << 5 | (color >> 3 & 31U);
}
int channel(std::uint32_t color, unsigned number) {
  return static_cast<int>(color >> (16 - 8 * number) & 255U);
}

/// A colour and how many pixels have it.
struct Counted {
  std::uint32_t color;
  std::size_t count;
};

/// Colours that become one, unless the box is divided.
struct Box {
  std::vector<Counted> colors;

  std::size_t count() const {
    std::size_t sum = 0;
    for (const Counted& each : colors) sum += each.count;
    return sum;
  }
  /// The channel with the greatest extent, and that extent.
  std::pair<unsigned, int> widest() const {
    std::pair<unsigned, int> found{0, 0};
    for (const unsigned k : {0U, 1U, 2U}) {
      const auto [low, high] =
          std::ranges::minmax(colors, {}, [k](const Counted& each) { return channel(each.color, k); });
      const int extent = channel(high.color, k) - channel(low.color, k);
      if (extent > found.second) found = {k, extent};
    }
    return found;
  }
  std::uint32_t mean() const {
    std::uint32_t color = 0;
    for (const unsigned k : {0U, 1U, 2U}) {
      std::size_t sum = 0;
      for (const Counted& each : colors) sum += each.count * static_cast<std::size_t>(channel(each.color, k));
      color = color << 8 | static_cast<std::uint32_t>((sum + count() / 2) / count());
    }
    return color;
  }
};

/// The half with the greater values of the widest channel leaves the box.
Box take_half(Box& box) {
  const unsigned k = box.widest().first;
  std::ranges::sort(box.colors, {}, [k](const Counted& each) { return channel(each.color, k); });
  const std::size_t half = box.count() / 2;
  std::size_t kept = 1, sum = box.colors.front().count;
  while (kept + 1 < box.colors.size() && sum + box.colors[kept].count <= half) sum += box.colors[kept++].count;
  Box other{{box.colors.begin() + static_cast<std::ptrdiff_t>(kept), box.colors.end()}};
  box.colors.resize(kept);
  return other;
}

/// Codes of growing width, in blocks of up to 255 bytes.
class Codes {
 public:
  explicit Codes(std::ostream& file) : file_(file) {}
  void put(std::uint32_t code, unsigned bits) {
    waiting_ |= code << count_;
    for (count_ += bits; count_ >= 8; count_ -= 8, waiting_ >>= 8) byte(static_cast<char>(waiting_ & 255U));
  }
  void end() {
    if (count_ > 0) byte(static_cast<char>(waiting_ & 255U));
    if (!block_.empty()) flush();
    file_.put('\0');
  }

 private:
  void byte(char value) {
    block_ += value;
    if (block_.size() == 255) flush();
  }
  void flush() {
    file_.put(static_cast<char>(block_.size()));
    file_.write(block_.data(), static_cast<std::streamsize>(block_.size()));
    block_.clear();
  }

  std::ostream& file_;
  std::string block_;
  std::uint32_t waiting_ = 0;
  unsigned count_ = 0;
};

/// The text that a code stands for, longer by one: by its first code and its last pixel.
class Words {
 public:
  Words() : next_(4096 * most_colors, 0) {}
  std::uint16_t& after(std::uint32_t code, std::uint8_t pixel) { return next_[code * most_colors + pixel]; }
  void clear() { std::ranges::fill(next_, std::uint16_t{0}); }

 private:
  std::vector<std::uint16_t> next_;
};

}  // namespace

std::vector<std::uint32_t> palette_of(std::span<const Image> samples) {
  // The first colour of each shade stands for it, so that plain areas keep theirs.
  std::map<std::size_t, Counted> found;
  for (const Image& image : samples)
    for (const std::uint32_t color : image.pixels)
      ++found.try_emplace(shade_of(color), Counted{color, 0}).first->second.count;
  std::vector<Box> boxes(1);
  for (const auto& [shade, each] : found) boxes.front().colors.push_back(each);
  if (boxes.front().colors.empty()) return {0};
  while (boxes.size() < most_colors) {
    const auto largest = std::ranges::max_element(boxes, {}, [](const Box& box) {
      return static_cast<double>(box.widest().second) * static_cast<double>(std::min<std::size_t>(box.count(), 10'000));
    });
    if (largest->widest().second == 0) break;
    Box half = take_half(*largest);
    boxes.push_back(std::move(half));
  }
  std::vector<std::uint32_t> palette;
  for (const Box& box : boxes) palette.push_back(box.mean());
  return palette;
}

Gif::Gif(std::ostream& file, std::vector<std::uint32_t> palette, std::size_t width, std::size_t height)
    : file_(file), palette_(std::move(palette)), width_(width), height_(height), known_(shades, -1) {
  file_ << "GIF89a";
  write_number(width);
  write_number(height);
  file_.write("\xF7\0\0", 3);  // a palette of 256 colours for all pictures
  for (std::size_t i = 0; i < most_colors; ++i) {
    const std::uint32_t color = i < palette_.size() ? palette_[i] : 0;
    for (const unsigned k : {0U, 1U, 2U}) file_.put(static_cast<char>(channel(color, k)));
  }
  file_.write("\x21\xFF\x0BNETSCAPE2.0\x03\x01\0\0\0", 19);  // again and again
}

void Gif::write_number(std::size_t number) {
  file_.put(static_cast<char>(number & 255U));
  file_.put(static_cast<char>(number >> 8 & 255U));
}

std::uint8_t Gif::nearest(std::uint32_t color) {
  int& known = known_[shade_of(color)];
  if (known >= 0) return static_cast<std::uint8_t>(known);
  int least = 0;
  for (std::size_t i = 0; i < palette_.size(); ++i) {
    int distance = 0;
    for (const unsigned k : {0U, 1U, 2U}) {
      const int apart = channel(color, k) - channel(palette_[i], k);
      distance += apart * apart;
    }
    if (known < 0 || distance < least) known = static_cast<int>(i), least = distance;
  }
  return static_cast<std::uint8_t>(known);
}

void Gif::add(const Image& image, int hundredths) {
  now_.resize(image.pixels.size());
  for (std::size_t i = 0; i < now_.size(); ++i) now_[i] = nearest(image.pixels[i]);
  std::size_t left = width_, right = 0, top = height_, bottom = 0;
  for (std::size_t y = 0; y < height_; ++y)
    for (std::size_t x = 0; x < width_; ++x) {
      if (!before_.empty() && now_[y * width_ + x] == before_[y * width_ + x]) continue;
      left = std::min(left, x), right = std::max(right, x + 1);
      top = std::min(top, y), bottom = std::max(bottom, y + 1);
    }
  if (left >= right) left = 0, right = 1, top = 0, bottom = 1;  // nothing has changed: it lasts longer
  file_.write("\x21\xF9\x04\x04", 4);                           // what is there stays there
  write_number(static_cast<std::size_t>(hundredths));
  file_.write("\0\0", 2);
  file_.put(',');
  for (const std::size_t number : {left, top, right - left, bottom - top}) write_number(number);
  file_.put('\0');
  write_pixels(left, top, right, bottom);
  before_ = now_;
}

void Gif::write_pixels(std::size_t left, std::size_t top, std::size_t right, std::size_t bottom) {
  constexpr unsigned least_bits = 8;
  constexpr std::uint32_t clear = 1U << least_bits, end = clear + 1, last_code = 4095;
  file_.put(static_cast<char>(least_bits));
  Codes codes(file_);
  Words words;
  std::uint32_t next = end + 1, code = now_[top * width_ + left];
  unsigned bits = least_bits + 1;
  codes.put(clear, bits);
  for (std::size_t y = top; y < bottom; ++y)
    for (std::size_t x = left; x < right; ++x) {
      if (y == top && x == left) continue;
      const std::uint8_t pixel = now_[y * width_ + x];
      std::uint16_t& longer = words.after(code, pixel);
      if (longer != 0) {
        code = longer;
        continue;
      }
      codes.put(code, bits);
      code = pixel;
      if (next > last_code) {
        codes.put(clear, bits);
        words.clear();
        next = end + 1;
        bits = least_bits + 1;
        continue;
      }
      longer = static_cast<std::uint16_t>(next);
      if (next == 1U << bits) ++bits;
      ++next;
    }
  codes.put(code, bits);
  codes.put(end, bits);
  codes.end();
}

void Gif::end() {
  file_.put(';');
}

}  // namespace continuo::app
