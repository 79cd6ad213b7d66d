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
#include <cstddef>
#include <cstdint>

namespace continuo {

struct ContactBlocks {
  std::uint32_t half = 1;  // as many places has half a block
  std::uint32_t count = 1;

  /// Blocks for so many bodies, of which the fullest layer has `in_layer`: half a block is a layer and an eighth, for
  /// the next row of cells. Multiples of four share out evenly. Fewer than 256 bodies are not worth a block.
  static ContactBlocks of(std::size_t bodies, std::size_t in_layer) {
    const std::size_t smallest = std::max<std::size_t>({2 * (in_layer + in_layer / 8 + 1), 256, bodies / 4096});
    std::size_t count = std::max<std::size_t>(bodies / smallest, 1);
    if (count > 4) count -= count % 4;
    const std::size_t half = (bodies + 2 * count - 1) / (2 * count);
    return {static_cast<std::uint32_t>(std::max<std::size_t>(half, 1)), static_cast<std::uint32_t>(count)};
  }

  /// The groups of contacts between two that move: within block g, across the end of block g, the rest.
  std::size_t across(std::size_t block) const { return count + block; }
  std::size_t rest() const { return 2 * std::size_t{count}; }
  std::size_t groups() const { return rest() + 1; }
  /// Of places a < b.
  std::size_t group_of(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t half_of_a = a / half, half_of_b = b / half, block = half_of_a / 2;
    if (half_of_b / 2 == block) return block;
    return half_of_b == half_of_a + 1 ? across(block) : rest();
  }
  std::size_t block_of(std::uint32_t place) const { return place / (2 * half); }
  /// The block whose stand-ins a group of any kind may use: no two that are solved at once have the same.
  std::size_t stand_ins_of(std::size_t group) const { return group % count; }

  /// Half a block's places fall into 16 bins; a group's into 32, those of its second half last.
  std::uint32_t bin_of(std::uint32_t place) const { return place % half / ((half + 15) / 16); }
  /// The half of a block with which a group that is not the rest begins.
  std::size_t first_half(std::size_t group) const { return group < count ? 2 * group : 2 * (group - count) + 1; }
  std::uint32_t bit_of(std::size_t group, std::uint32_t place) const {
    if (group == rest()) return ~std::uint32_t{0};
    return 1u << (bin_of(place) + (place / half == first_half(group) ? 0 : 16));
  }

  std::uint32_t first(std::size_t block) const { return static_cast<std::uint32_t>(2 * half * block); }
  std::uint32_t last(std::size_t block, std::size_t bodies) const {
    return static_cast<std::uint32_t>(std::min(2 * half * (block + 1), bodies));
  }
};

}  // namespace continuo
