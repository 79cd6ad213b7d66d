// The linear equations of the forces that keep constraints, of which most are those of joints: a mechanism of fifty
// hinges has a hundred, few of which share a body.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include <continuo/bodies/contacts/minimum_norm.hpp>

namespace continuo {

/// The equations of joints are symmetric and positive definite, and come first: they are eliminated without pivots, in
/// a small part of the time of an orthogonal decomposition. What is left, of contacts that slip, need not be symmetric
/// and is decomposed by MinimumNorm. Where equations depend on each other, or nearly so, all of them are.
template <class Real>
class ConstraintEquations {
 public:
  /// Factors a square matrix, given column by column, with a diagonal above 0. Symmetric rows do best at the beginning.
  void factor(std::size_t n, std::span<const Real> matrix) {
    n_ = n;
    order_.resize(n);
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    is_eliminated_ = scale(matrix) && eliminate(symmetric_part());
    if (!is_eliminated_) rest_.factor(n, matrix);
  }
  /// The number of equations that do not depend on each other.
  [[nodiscard]] std::size_t rank() const { return is_eliminated_ ? n_ : rest_.rank(); }
  /// The sign of the determinant, 0 where equations depend on each other.
  [[nodiscard]] int determinant_sign() const { return rest_.determinant_sign(); }
  /// The numbers of such columns, for as many of them as the rank.
  [[nodiscard]] std::span<const std::size_t> independent() const {
    return is_eliminated_ ? std::span<const std::size_t>(order_) : rest_.independent();
  }

  /// b becomes the solution, the shortest of all that leave the least residual.
  void solve(std::span<Real> b) {
    if (!is_eliminated_) return rest_.solve(b);
    for (std::size_t i = 0; i < n_; ++i) b[i] *= scale_[i];
    for (std::size_t k = 0; k < eliminated_; ++k)
      for (std::size_t i = k + 1; i < n_; ++i) b[i] -= at(i, k) * b[k];
    rest_.solve(b.subspan(eliminated_));
    for (std::size_t j = n_; j-- > 0;) {
      if (j < eliminated_) b[j] /= at(j, j);
      for (std::size_t i = 0; i < std::min(j, eliminated_); ++i) b[i] -= at(i, j) * b[j];
    }
    for (std::size_t i = 0; i < n_; ++i) b[i] *= scale_[i];
  }

 private:
  /// A pivot up to this, of equations scaled to a diagonal of ones, may be one that depends on those before it.
  [[nodiscard]] static Real least_pivot() { return std::is_same_v<Real, float> ? Real(1e-2) : Real(1e-6); }

  [[nodiscard]] Real& at(std::size_t i, std::size_t j) { return a_[j * n_ + i]; }

  /// Takes the matrix, scaled to a diagonal of ones. False where that cannot be.
  [[nodiscard]] bool scale(std::span<const Real> matrix) {
    a_.assign(matrix.begin(), matrix.end());
    scale_.resize(n_);
    for (std::size_t k = 0; k < n_; ++k) {
      if (!(at(k, k) > Real(0))) return false;
      scale_[k] = 1 / std::sqrt(at(k, k));
    }
    for (std::size_t j = 0; j < n_; ++j)
      for (std::size_t i = 0; i < n_; ++i) at(i, j) *= scale_[i] * scale_[j];
    return true;
  }
  /// The number of equations at the beginning that are symmetric but for rounding.
  [[nodiscard]] std::size_t symmetric_part() {
    constexpr Real rounding = 64 * std::numeric_limits<Real>::epsilon();
    for (std::size_t j = 0; j < n_; ++j)
      for (std::size_t i = 0; i < j; ++i)
        if (!(std::abs(at(i, j) - at(j, i)) <= rounding)) return j;
    return n_;
  }
  /// Eliminates up to `most` equations, and decomposes the rest. False where any may depend on others.
  [[nodiscard]] bool eliminate(std::size_t most) {
    for (eliminated_ = 0; eliminated_ < most; ++eliminated_) {
      const std::size_t k = eliminated_;
      if (!(at(k, k) > least_pivot())) return false;
      for (std::size_t i = k + 1; i < n_; ++i) at(i, k) /= at(k, k);
      for (std::size_t j = k + 1; j < n_; ++j) {
        const Real above = at(k, j);
        if (above == Real(0)) continue;
        Real* const column = &at(0, j);
        const Real* const pivots = &at(0, k);
        for (std::size_t i = k + 1; i < n_; ++i) column[i] -= pivots[i] * above;
      }
    }
    const std::size_t left = n_ - eliminated_;
    std::vector<Real> matrix;
    for (std::size_t j = eliminated_; j < n_; ++j) {
      if (!(std::abs(at(j, j)) > least_pivot())) return false;
      matrix.insert(matrix.end(), &at(eliminated_, j), &at(eliminated_, j) + left);
    }
    rest_.factor(left, matrix);
    return rest_.rank() == left;
  }

  std::size_t n_ = 0, eliminated_ = 0;
  bool is_eliminated_ = false;
  std::vector<Real> a_, scale_;
  std::vector<std::size_t> order_;
  MinimumNorm<Real> rest_;  // of all, where not eliminated
};

}  // namespace continuo
