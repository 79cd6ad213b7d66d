// An animated GIF, written picture by picture: a palette for all of them, and of each picture the rectangle that has
// changed.
//
//   Gif gif(file, palette_of(samples), width, height);
//   for (const Image& image : images) gif.add(image, 4);   // hundredths of a second
//   gif.end();
#pragma once
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <span>
#include <vector>

#include <apps/continuo/pictures/png.hpp>

namespace continuo::app {

/// At most 256 colours, 0xRRGGBB, that stand for those of the pictures: by median cut (P. Heckbert, "Color image
/// quantization for frame buffer display", Computer Graphics 16 (1982) 297-307).
std::vector<std::uint32_t> palette_of(std::span<const Image> samples);

class Gif {
 public:
  Gif(std::ostream& file, std::vector<std::uint32_t> palette, std::size_t width, std::size_t height);

  /// Shows the picture, of the size that was announced, for so many hundredths of a second.
  void add(const Image& image, int hundredths);
  void end();

 private:
  std::uint8_t nearest(std::uint32_t color);
  void write_number(std::size_t number);  // of 16 bits
  void write_pixels(std::size_t left, std::size_t top, std::size_t right, std::size_t bottom);

  std::ostream& file_;
  std::vector<std::uint32_t> palette_;
  std::size_t width_, height_;
  std::vector<int> known_;  // the number of each colour of 15 bits, -1: not sought yet
  std::vector<std::uint8_t> now_, before_;
};

}  // namespace continuo::app
