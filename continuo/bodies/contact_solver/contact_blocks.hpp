// Which contacts are solved in a row, by one thread. Bodies are sorted by cells, layer by layer along the longest axis,
// so what touches stands within little more than a layer in their order, which is cut into blocks of more than two.
// First all blocks at once: of each the contacts within it, colour by colour. Then, at once again, those across the end
// of each block: they lie between its middle and that of the next, so that they share no body either. What is neither,
// where some bodies are much larger than the others, is left for one thread.
//
// That needs a meeting of all threads after every one of these, not after every colour; and a block's bodies stay in
// the cache until all its colours are done. The blocks are the same for any number of threads.
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace continuo {

struct ContactBlocks {
  std::uint32_t half = 1;  // as many places has half a block
  std::uint32_t count = 1;
  std::uint32_t bin_shift = 0;  // a bin has 2^bin_shift places

  /// Blocks for so many bodies, of which the fullest layer has `in_layer`: half a block is a layer and an eighth, for
  /// the next row of cells. Multiples of four share out evenly. Fewer than 256 bodies are not worth a block.
  [[nodiscard]] static ContactBlocks of(std::size_t bodies, std::size_t in_layer) {
    const std::size_t smallest = std::max<std::size_t>({2 * (in_layer + in_layer / 8 + 1), 256, bodies / 4096});
    std::size_t count = std::max<std::size_t>(bodies / smallest, 1);
    if (count > 4) count -= count % 4;
    const auto half = static_cast<std::uint32_t>(std::max<std::size_t>((bodies + 2 * count - 1) / (2 * count), 1));
    const auto bits = static_cast<int>(std::bit_width(half - 1));  // of whichever type the library has it
    return {half, static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(std::max(bits - 5, 0))};
  }

  /// The groups of contacts between two that move: within block g, across the end of block g, the rest.
  [[nodiscard]] std::size_t across(std::size_t block) const { return count + block; }
  [[nodiscard]] std::size_t rest() const { return 2 * std::size_t{count}; }
  [[nodiscard]] std::size_t groups() const { return rest() + 1; }
  /// Of places a < b, counted from where a's block begins: no division, for every contact asks in every step.
  [[nodiscard]] std::size_t group_of(std::size_t block, std::uint32_t a, std::uint32_t b) const {
    if (b < 2 * half) return block;
    return a >= half && b < 3 * half ? across(block) : rest();
  }
  /// The block whose stand-ins a group of any kind may use: no two that are solved at once have the same.
  [[nodiscard]] std::size_t stand_ins_of(std::size_t group) const { return group % count; }

  /// Half a block's places fall into up to 32 bins; a group's into 64, those of its second half last.
  [[nodiscard]] std::uint32_t bin_of(std::uint32_t place_in_half) const { return place_in_half >> bin_shift; }
  /// The half of a block with which a group that is not the rest begins.
  [[nodiscard]] std::size_t first_half(std::size_t group) const {
    return group < count ? 2 * group : 2 * (group - count) + 1;
  }
  /// Of a place that is counted from where the group's block begins.
  [[nodiscard]] std::uint64_t bit_of(std::size_t group, std::uint32_t place) const {
    if (group == rest()) return ~std::uint64_t{0};
    const std::uint32_t in_group = group < count ? place : place - half;
    return std::uint64_t{1} << (in_group < half ? bin_of(in_group) : 32 + bin_of(in_group - half));
  }

  [[nodiscard]] std::uint32_t first(std::size_t block) const { return static_cast<std::uint32_t>(2 * half * block); }
  [[nodiscard]] std::uint32_t last(std::size_t block, std::size_t bodies) const {
    return static_cast<std::uint32_t>(std::min(2 * half * (block + 1), bodies));
  }
};

}  // namespace continuo
