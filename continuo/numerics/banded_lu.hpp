// LU decomposition with partial pivoting of a matrix whose entries lie near its diagonal. The numbers may be real or
// complex, of any scalar. Storage and algorithm as in LAPACK's gbtrf: each column keeps its band, with room above it
// for what pivoting moves there.
//
//   BandedLU<double> lu(n, lower, upper);
//   lu.clear();
//   lu(i, j) = ...;                     // for j - upper <= i <= j + lower
//   if (lu.factor()) lu.solve(b);
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <continuo/numerics/complex_number.hpp>

namespace continuo {

template <class Number>
class BandedLU {
 public:
  BandedLU() = default;
  BandedLU(std::size_t size, std::size_t lower, std::size_t upper)
      : size_(size),
        lower_(lower),
        upper_(upper),
        room_(std::min(lower + upper, size == 0 ? 0 : size - 1)),
        height_(room_ + lower + 1),
        entries_(size * height_),
        pivots_(size) {}

  std::size_t size() const { return size_; }

  void clear() { std::fill(entries_.begin(), entries_.end(), Number{}); }
  /// To be filled before `factor`, which overwrites it.
  Number& operator()(std::size_t row, std::size_t column) { return entries_[place(row, column)]; }
  /// Where (row, column) is among the entries, for who fills them many times.
  std::size_t place(std::size_t row, std::size_t column) const { return column * height_ + room_ + row - column; }
  Number* entries() { return entries_.data(); }

  /// False where a pivot is zero or not a number: the matrix is singular, or was not finite.
  bool factor() {
    std::size_t reach = 0;  // the last column that a pivot row so far has an entry in
    filled_ = 0;
    for (std::size_t k = 0; k < size_; ++k) {
      Number* const column = entries_.data() + place(k, k);
      const std::size_t below = std::min(lower_, size_ - 1 - k);
      std::size_t pivot = 0;
      auto greatest = magnitude(column[0]);
      for (std::size_t i = 1; i <= below; ++i) {
        if (const auto here = magnitude(column[i]); here > greatest) greatest = here, pivot = i;
      }
      if (!(greatest > 0) || !(greatest - greatest == 0)) return false;
      pivots_[k] = static_cast<std::uint32_t>(k + pivot);
      reach = std::max(reach, std::min(k + pivot + upper_, size_ - 1));
      filled_ = std::max(filled_, reach - k);
      if (pivot != 0) std::swap(column[0], column[pivot]);
      const Number inverse = reciprocal(column[0]);
      column[0] = inverse;
      for (std::size_t i = 1; i <= below; ++i) column[i] = column[i] * inverse;
      for (std::size_t j = k + 1; j <= reach; ++j) {
        Number* const other = entries_.data() + place(k, j);
        if (pivot != 0) std::swap(other[0], other[pivot]);
        const Number factor = other[0];
        if (factor == Number{}) continue;
        for (std::size_t i = 1; i <= below; ++i) other[i] -= column[i] * factor;
      }
    }
    return true;
  }

  /// b becomes the solution.
  void solve(Number* b) const {
    for (std::size_t k = 0; k < size_; ++k) {
      if (pivots_[k] != k) std::swap(b[k], b[pivots_[k]]);
      const Number* const column = entries_.data() + place(k, k);
      const std::size_t below = std::min(lower_, size_ - 1 - k);
      const Number factor = b[k];
      Number* const rest = b + k;
      for (std::size_t i = 1; i <= below; ++i) rest[i] -= column[i] * factor;
    }
    for (std::size_t k = size_; k-- > 0;) {
      const Number* const column = entries_.data() + place(k, k);
      const Number factor = b[k] = b[k] * column[0];
      const std::size_t above = std::min(filled_, k);
      Number* const rest = b + (k - above);
      const Number* const upper = entries_.data() + (place(k, k) - above);
      for (std::size_t i = 0; i < above; ++i) rest[i] -= upper[i] * factor;
    }
  }

 private:
  std::size_t size_ = 0, lower_ = 0, upper_ = 0;
  std::size_t room_ = 0, filled_ = 0;  // above the diagonal: what pivoting may need, what it did need
  std::size_t height_ = 0;
  std::vector<Number> entries_;
  std::vector<std::uint32_t> pivots_;
};

}  // namespace continuo
