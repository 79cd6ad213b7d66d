// How the entries of a band matrix lie in memory: diagonal by diagonal, the lowest first, each by rows. Along a
// diagonal the entries of a grid's points lie side by side, so that who fills them does it in a few plain loops.
#pragma once
#include <algorithm>
#include <cstddef>

namespace continuo {

/// The shape of a band matrix, and where its entries lie.
struct BandLayout {
  std::size_t size = 0, lower = 0, upper = 0;  // diagonals below and above the main one
  std::size_t stride = 0;                      // from one diagonal to the next

  BandLayout() = default;
  /// For entries at row - lower_ <= column <= row + upper_. A narrow band has as many diagonals above as below.
  BandLayout(std::size_t size_, std::size_t lower_, std::size_t upper_) : size(size_), lower(lower_), upper(upper_) {
    if (is_narrow()) lower = upper = std::max({lower_, upper_, std::size_t{1}});
    // An odd number of cache lines of eight numbers: entries of one row do not compete for their places in the cache.
    stride = 8 * ((size + 7) / 8 | 1);
  }

  /// Such a band is decomposed in registers, from both ends.
  [[nodiscard]] bool is_narrow() const {
    const std::size_t widest = std::max({lower, upper, std::size_t{1}});
    return widest <= greatest_narrow && size >= 8 * widest;
  }
  /// How many numbers; those no entry lies at are zero.
  [[nodiscard]] std::size_t numbers() const { return stride * (lower + upper + 1); }
  /// The index of entry (row, column), which must be in the band.
  [[nodiscard]] std::size_t place(std::size_t row, std::size_t column) const {
    return (lower + column - row) * stride + row;
  }

 private:
  static constexpr std::size_t greatest_narrow = 4;
};

}  // namespace continuo
