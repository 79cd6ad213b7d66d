// Linear complementarity problems of any matrix, as those of contacts with friction, by pivots.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace continuo {

/// Finds z with z >= 0, w = M z + q >= 0 and z . w = 0 by C. E. Lemke's pivots along the ray of a covering vector
/// (R. W. Cottle, J.-S. Pang, R. E. Stone, "The Linear Complementarity Problem", 1992, algorithm 4.4.5; ties by their
/// lexicographic rule, 4.9, so that degenerate pivots do not go in circles). It finds one for every P-matrix and, where
/// M is copositive and q is in the dual cone of the solutions of q = 0, as with sticking friction (J. S. Pang,
/// J. C. Trinkle, "Complementarity formulations and existence of solutions of dynamic multi-rigid-body contact problems
/// with Coulomb friction", 1996). A pivot costs some 4 n^2 products; n to 3 n of them are usual.
template <class Real>
class Lemke {
 public:
  /// M column by column, n x n, and q, both best of the size of 1. All of `cover` is above 0.
  Lemke(std::span<const Real> m, std::span<const Real> q, std::span<const Real> cover)
      : n_(q.size()), columns_(2 * n_ + 2), table_(n_ * columns_), basis_(n_) {
    std::iota(basis_.begin(), basis_.end(), std::size_t{0});
    for (std::size_t i = 0; i < n_; ++i) {
      at(i, i) = Real(1);
      for (std::size_t j = 0; j < n_; ++j) at(i, n_ + j) = -m[j * n_ + i];
      at(i, artificial()) = -cover[i];
      at(i, constants()) = q[i];
    }
  }

  /// A solution z; nothing where the pivots end on a ray, as where there is none, or where rounding keeps them from an
  /// end.
  [[nodiscard]] std::optional<std::vector<Real>> solve() {
    std::size_t leaves = n_;
    for (std::size_t i = 0; i < n_; ++i)
      if (at(i, constants()) < Real(0) && (leaves == n_ || is_before(leaves, i, artificial()))) leaves = i;
    std::size_t enters = artificial();
    for (std::size_t round = 0; leaves < n_ && round < 50 * n_ + 50; ++round) {
      const std::size_t left = basis_[leaves];
      pivot(leaves, enters);
      if (left == artificial()) return solution();
      enters = left < n_ ? left + n_ : left - n_;
      leaves = row_that_leaves(enters);
      if (leaves == n_) return {};
    }
    if (leaves < n_) return {};
    return solution();
  }

 private:
  /// What is smaller is the rounding of a 0.
  static constexpr Real least = std::is_same_v<Real, float> ? Real(1e-5) : Real(1e-11);

  [[nodiscard]] Real& at(std::size_t row, std::size_t column) { return table_[row * columns_ + column]; }
  [[nodiscard]] std::size_t artificial() const { return 2 * n_; }
  [[nodiscard]] std::size_t constants() const { return 2 * n_ + 1; }

  /// Whether row i, divided by its entry in the column, is lexicographically less than row k. The first columns, of w,
  /// are the inverse of the basis.
  [[nodiscard]] bool is_before(std::size_t i, std::size_t k, std::size_t column) {
    const Real by_i = 1 / at(i, column), by_k = 1 / at(k, column);
    const auto differs = [&](std::size_t place, Real& difference) {
      const Real first = at(i, place) * by_i, second = at(k, place) * by_k;
      difference = first - second;
      return std::abs(difference) > least * (std::abs(first) + std::abs(second) + std::abs(by_i) + std::abs(by_k));
    };
    Real difference(0);
    if (differs(constants(), difference)) return difference < Real(0);
    for (std::size_t place = 0; place < n_; ++place)
      if (differs(place, difference)) return difference < Real(0);
    return false;
  }
  /// The row that bounds the variable that enters; the artificial one leaves wherever it may. n where none does.
  [[nodiscard]] std::size_t row_that_leaves(std::size_t enters) {
    std::size_t found = n_, last = n_;
    for (std::size_t i = 0; i < n_; ++i) {
      if (!(at(i, enters) > least)) continue;
      if (found == n_ || is_before(i, found, enters)) found = i;
      if (basis_[i] == artificial()) last = i;
    }
    if (found == n_ || last == n_ || last == found) return found;
    const Real lowest = at(found, constants()) / at(found, enters), own = at(last, constants()) / at(last, enters);
    return own - lowest <= least * (1 + std::abs(own)) ? last : found;
  }
  void pivot(std::size_t row, std::size_t column) {
    const Real by = 1 / at(row, column);
    for (std::size_t j = 0; j < columns_; ++j) at(row, j) *= by;
    at(row, column) = Real(1);
    for (std::size_t i = 0; i < n_; ++i) {
      const Real factor = at(i, column);
      if (i == row || factor == Real(0)) continue;
      for (std::size_t j = 0; j < columns_; ++j) at(i, j) -= factor * at(row, j);
      at(i, column) = Real(0);
    }
    basis_[row] = column;
  }
  [[nodiscard]] std::vector<Real> solution() {
    std::vector<Real> z(n_);
    for (std::size_t i = 0; i < n_; ++i)
      if (basis_[i] >= n_ && basis_[i] < artificial()) z[basis_[i] - n_] = std::max(Real(0), at(i, constants()));
    return z;
  }

  std::size_t n_, columns_;
  std::vector<Real> table_;  // row by row: w, z, the artificial variable, the constants
  std::vector<std::size_t> basis_;
};

}  // namespace continuo
