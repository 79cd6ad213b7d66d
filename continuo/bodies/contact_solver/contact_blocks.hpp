// The division of contacts into groups that one thread solves in sequence. Bodies are sorted by cells, layer by layer
// along the longest axis, so that two bodies in contact are at most a little more than a layer apart in this order,
// which is divided into blocks of more than two layers. First, for all blocks at once, the contacts within each block
// are solved, colour by colour. Then, again at once, those across the end of each block follow: they lie between its
// middle and the middle of the next one, so that they share no body either. All other contacts, which exist where some
// bodies are much larger than the others, are left to one thread.
//
// So threads have to synchronize only after each of these stages, not after every colour, and the bodies of a block
// stay in the cache until all its colours are done. The blocks are the same for any number of threads.
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace continuo {

struct ContactBlocks {
  std::uint32_t half = 1;  // the places in half a block
  std::uint32_t count = 1;
  std::uint32_t bin_shift = 0;  // a bin has 2^bin_shift places

  /// Blocks for so many bodies, with `in_layer` bodies in the fullest layer. Half a block is at least a layer and an
  /// eighth, where the eighth is for the next row of cells. A multiple of four blocks can be divided evenly among
  /// threads. Fewer than 256 bodies are not worth a block.
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
  /// The group of a contact between places a < b, which are counted from the beginning of a's block. It needs no
  /// division, since it is called for every contact in every step.
  [[nodiscard]] std::size_t group_of(std::size_t block, std::uint32_t a, std::uint32_t b) const {
    if (b < 2 * half) return block;
    return a >= half && b < 3 * half ? across(block) : rest();
  }
  /// The block whose stand-ins a group of any kind may use: no two groups that are solved at once have the same.
  [[nodiscard]] std::size_t stand_ins_of(std::size_t group) const { return group % count; }

  /// Half a block's places fall into up to 32 bins; a group's into 64, those of its second half last.
  [[nodiscard]] std::uint32_t bin_of(std::uint32_t place_in_half) const { return place_in_half >> bin_shift; }
  /// The half of a block with which a group that is not the rest begins.
  [[nodiscard]] std::size_t first_half(std::size_t group) const {
    return group < count ? 2 * group : 2 * (group - count) + 1;
  }
  /// The bit of a place, which is counted from the beginning of the group's block.
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
