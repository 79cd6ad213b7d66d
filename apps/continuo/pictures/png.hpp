// The pixels of a PNG as gnuplot writes it: eight bits a colour, not interlaced.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace continuo::app {

struct Image {
  std::size_t width = 0, height = 0;
  std::vector<std::uint32_t> pixels;  // 0xRRGGBB, row after row from the top
};

/// Nothing where the bytes are no such picture.
std::optional<Image> read_png(const std::string& bytes);

}  // namespace continuo::app
