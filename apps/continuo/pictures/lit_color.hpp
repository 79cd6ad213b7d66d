// Colours of surfaces in the light, as numbers.
#pragma once
#include <cmath>
#include <cstdint>
#include <string_view>

#include <continuo/worlds/world_run.hpp>

namespace continuo::app {

inline constexpr std::uint32_t white = 0xFFFFFF, black = 0x000000, still = 0x8A8A8A;  // still: what does not move
inline constexpr worlds::Point sun = {-0.150, -0.418, 0.896};  // 0.67 of the way to us, 0.62 up, 0.4 to the left
inline constexpr std::string_view edge_color = "#8a8a8a";
inline constexpr std::string_view as_polygons = "using 1:2:3 with filledcurves closed fc rgb variable";

inline std::uint32_t mixed(std::uint32_t a, std::uint32_t b, double part) {
  std::uint32_t color = 0;
  for (const unsigned shift : {0U, 8U, 16U}) {
    const double from = a >> shift & 255U, to = b >> shift & 255U;
    color |= static_cast<std::uint32_t>(std::lround(from + part * (to - from))) << shift;
  }
  return color;
}

/// The colour of a face, by the cosine between its normal and the light.
inline std::uint32_t lit_by(std::uint32_t color, double lit) {
  return lit > 0.5 ? mixed(color, white, 0.5 * (lit - 0.5)) : mixed(color, black, 0.5 * (0.5 - lit));
}

}  // namespace continuo::app
