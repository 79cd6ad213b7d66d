// Linear systems whose equations may depend on each other, as those of joints that hold a body twice: the solution is
// the shortest of all that leave the least residual.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace continuo {

/// A complete orthogonal decomposition by Householder reflections with column pivoting (G. H. Golub, C. F. Van Loan,
/// "Matrix Computations", 4th ed., 5.4 and 5.5). Rows and columns are scaled to a diagonal of ones first, so that the
/// units of the rows do not matter. Factoring costs some 4/3 n^3 products, a solution 2 n^2.
template <class Real>
class MinimumNorm {
 public:
  /// Factors a square matrix, given column by column, with a diagonal above 0.
  void factor(std::size_t n, std::span<const Real> matrix) {
    n_ = n;
    a_.assign(matrix.begin(), matrix.end());
    scale_.resize(n), order_.resize(n), diagonal_.resize(n), beta_.resize(n), right_beta_.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
      const Real size = std::abs(at(k, k));
      scale_[k] = size > Real(0) ? 1 / std::sqrt(size) : Real(0);
    }
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) at(i, j) *= scale_[i] * scale_[j];
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    reduce();
    for (std::size_t i = rank_; i-- > 0 && rank_ < n;) reduce_right(i);
  }
  /// The number of equations that do not depend on each other.
  [[nodiscard]] std::size_t rank() const { return rank_; }
  /// The sign of the determinant, 0 where equations depend on each other.
  [[nodiscard]] int determinant_sign() const { return rank_ == n_ ? sign_ : 0; }
  /// The numbers of such columns, for as many of them as the rank.
  [[nodiscard]] std::span<const std::size_t> independent() const { return std::span(order_).first(rank_); }

  /// b becomes the solution.
  void solve(std::span<Real> b) {
    for (std::size_t i = 0; i < n_; ++i) b[i] *= scale_[i];
    for (std::size_t k = 0; k < rank_; ++k) {
      Real sum(0);
      for (std::size_t i = k; i < n_; ++i) sum += at(i, k) * b[i];
      for (std::size_t i = k; i < n_; ++i) b[i] -= beta_[k] * sum * at(i, k);
    }
    for (std::size_t i = rank_; i-- > 0;) {
      for (std::size_t j = i + 1; j < rank_; ++j) b[i] -= at(i, j) * b[j];
      b[i] /= diagonal_[i];
    }
    std::fill(b.begin() + static_cast<std::ptrdiff_t>(rank_), b.end(), Real(0));
    for (std::size_t i = 0; i < rank_ && rank_ < n_; ++i) {
      Real sum = b[i];
      for (std::size_t j = rank_; j < n_; ++j) sum += at(i, j) * b[j];
      b[i] -= right_beta_[i] * sum;
      for (std::size_t j = rank_; j < n_; ++j) b[j] -= right_beta_[i] * sum * at(i, j);
    }
    in_order_.resize(n_);
    for (std::size_t k = 0; k < n_; ++k) in_order_[order_[k]] = b[k];
    for (std::size_t k = 0; k < n_; ++k) b[k] = in_order_[k] * scale_[k];
  }

 private:
  [[nodiscard]] Real& at(std::size_t i, std::size_t j) { return a_[j * n_ + i]; }

  /// Q^T A P = R. The reflection of column k replaces its lower part; the diagonal of R is kept beside it.
  void reduce() {
    // What depends on others leaves the rounding of the sums; what does not is far above it.
    const Real least =
        std::sqrt(std::numeric_limits<Real>::epsilon() * std::sqrt(std::numeric_limits<Real>::epsilon()));
    sign_ = 1;
    for (rank_ = 0; rank_ < n_; ++rank_) {
      const std::size_t k = rank_;
      std::size_t pivot = k;
      Real greatest(-1);
      for (std::size_t j = k; j < n_; ++j) {
        Real sum(0);
        for (std::size_t i = k; i < n_; ++i) sum += at(i, j) * at(i, j);
        if (sum > greatest) greatest = sum, pivot = j;
      }
      const Real size = std::sqrt(greatest);
      if (!(size > least)) return;
      if (pivot != k) {
        std::swap(order_[k], order_[pivot]);
        std::swap_ranges(&at(0, k), &at(0, k) + n_, &at(0, pivot));
        sign_ = -sign_;
      }
      diagonal_[k] = at(k, k) > Real(0) ? -size : size;
      if (diagonal_[k] > Real(0)) sign_ = -sign_;  // the determinant of a reflection is -1
      at(k, k) -= diagonal_[k];
      beta_[k] = -1 / (diagonal_[k] * at(k, k));
      for (std::size_t j = k + 1; j < n_; ++j) {
        Real sum(0);
        for (std::size_t i = k; i < n_; ++i) sum += at(i, k) * at(i, j);
        for (std::size_t i = k; i < n_; ++i) at(i, j) -= beta_[k] * sum * at(i, k);
      }
    }
  }
  /// Reflects row i and those above it so that nothing is left of row i in the columns beyond the rank. The vector of
  /// the reflection is scaled to begin with 1.
  void reduce_right(std::size_t i) {
    Real sum = diagonal_[i] * diagonal_[i];
    for (std::size_t j = rank_; j < n_; ++j) sum += at(i, j) * at(i, j);
    const Real size = diagonal_[i] > Real(0) ? -std::sqrt(sum) : std::sqrt(sum), first = diagonal_[i] - size;
    for (std::size_t j = rank_; j < n_; ++j) at(i, j) /= first;
    right_beta_[i] = -first / size;
    diagonal_[i] = size;
    for (std::size_t row = 0; row < i; ++row) {
      Real along = at(row, i);
      for (std::size_t j = rank_; j < n_; ++j) along += at(i, j) * at(row, j);
      at(row, i) -= right_beta_[i] * along;
      for (std::size_t j = rank_; j < n_; ++j) at(row, j) -= right_beta_[i] * along * at(i, j);
    }
  }

  std::size_t n_ = 0, rank_ = 0;
  int sign_ = 1;
  std::vector<Real> a_, scale_, diagonal_, beta_, right_beta_, in_order_;
  std::vector<std::size_t> order_;
};

}  // namespace continuo
