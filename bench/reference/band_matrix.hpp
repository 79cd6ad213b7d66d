// bench/reference/band_matrix.hpp
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace continuo::bench {

/// A square matrix whose entries lie at most `band` places beside the diagonal (a full one: size - 1), solved by
/// Gaussian elimination with row exchanges. These bring in up to `band` further entries to the right.
template <class Real>
class BandMatrix {
 public:
  BandMatrix(std::size_t size, std::size_t band)
      : size_(size), band_(band), entries_(size * (3 * band + 1)), exchange_(size) {}

  Real& operator()(std::size_t row, std::size_t column) { return entries_[place(row, column)]; }
  const Real& operator()(std::size_t row, std::size_t column) const { return entries_[place(row, column)]; }

  void clear() { std::fill(entries_.begin(), entries_.end(), Real(0)); }

  void factor() {
    for (std::size_t k = 0; k < size_; ++k) eliminate(k);
  }

  /// b becomes the solution.
  void solve(std::vector<Real>& b) const {
    for (std::size_t k = 0; k < size_; ++k) {
      std::swap(b[k], b[exchange_[k]]);
      for (std::size_t row = k + 1; row < past(k, band_); ++row) b[row] -= (*this)(row, k) * b[k];
    }
    for (std::size_t k = size_; k-- > 0;) {
      for (std::size_t column = k + 1; column < past(k, 2 * band_); ++column) b[k] -= (*this)(k, column) * b[column];
      b[k] /= (*this)(k, k);
    }
  }

 private:
  std::size_t size_, band_;
  std::vector<Real> entries_;
  std::vector<std::size_t> exchange_;

  std::size_t place(std::size_t row, std::size_t column) const { return row * (3 * band_ + 1) + column + band_ - row; }
  std::size_t past(std::size_t k, std::size_t reach) const { return std::min(size_, k + reach + 1); }

  void eliminate(std::size_t k) {
    using std::abs;
    const std::size_t end = past(k, 2 * band_);
    std::size_t pivot = k;
    for (std::size_t row = k + 1; row < past(k, band_); ++row) {
      if (abs((*this)(row, k)) > abs((*this)(pivot, k))) pivot = row;
    }
    exchange_[k] = pivot;
    if (pivot != k) {
      for (std::size_t column = k; column < end; ++column) std::swap((*this)(k, column), (*this)(pivot, column));
    }
    const Real* const upper = &(*this)(k, k);
    for (std::size_t row = k + 1; row < past(k, band_); ++row) {
      Real* const lower = &(*this)(row, k);
      const Real factor = lower[0] / upper[0];
      lower[0] = factor;
      if (factor == 0) continue;
      for (std::size_t i = 1; i < end - k; ++i) lower[i] -= factor * upper[i];
    }
  }
};

}  // namespace continuo::bench
