// The singular values of a small square matrix, real or complex, and what follows from them where it is singular: its
// pseudo-inverse and the projector onto what it makes zero. Internal to two_point.
//
//   const SingularValues<double> of(a, n);
//   const std::vector<double> inverse = of.pseudo_inverse();
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <continuo/boundary/number_size.hpp>

namespace continuo::boundary {

/// A = sum_j a_j v_j^H, with orthonormal v_j and orthogonal a_j, whose norms are the singular values. Found by rotating
/// pairs of columns of A until all are orthogonal: M. R. Hestenes, "Inversion of matrices by biorthogonalization and
/// related results", J. SIAM 6 (1958) 51-90.
template <class Number>
class SingularValues {
 public:
  /// Of the matrix A, n x n, row by row, of finite numbers.
  SingularValues(std::span<const Number> matrix, std::size_t n) : n_(n), a_(n * n), v_(n * n), sizes_(n) {
    for (const Number& entry : matrix) scale_ = std::max(scale_, size_of(entry));
    if (scale_ < std::numeric_limits<double>::min()) scale_ = 1;
    for (std::size_t i = 0; i < n; ++i) {
      v_[i * n + i] = Number(1);
      for (std::size_t j = 0; j < n; ++j) a_[j * n + i] = matrix[i * n + j] * (1 / scale_);
    }
    for (std::size_t sweep = 0; sweep < most_sweeps && rotate_all(); ++sweep) {
    }
    for (std::size_t j = 0; j < n; ++j) sizes_[j] = norm(&a_[j * n]);
  }

  /// A^+: of the singular values that are more than rounding.
  [[nodiscard]] std::vector<Number> pseudo_inverse() const {
    std::vector<Number> result(n_ * n_);
    for (std::size_t j = 0; j < n_; ++j)
      if (is_kept(j)) add_product(&v_[j * n_], &a_[j * n_], 1 / sizes_[j] / sizes_[j] / scale_, result);
    return result;
  }
  /// I - A^+ A.
  [[nodiscard]] std::vector<Number> null_projector() const {
    std::vector<Number> result(n_ * n_);
    for (std::size_t i = 0; i < n_; ++i) result[i * n_ + i] = Number(1);
    for (std::size_t j = 0; j < n_; ++j)
      if (is_kept(j)) add_product(&v_[j * n_], &v_[j * n_], -1, result);
    return result;
  }

 private:
  static constexpr std::size_t most_sweeps = 60;  // some six are enough

  [[nodiscard]] double rounding() const { return std::numeric_limits<double>::epsilon() * static_cast<double>(n_); }
  [[nodiscard]] double norm(const Number* column) const {
    double sum = 0;
    for (std::size_t i = 0; i < n_; ++i) sum += squared_size(column[i]);
    return std::sqrt(sum);
  }
  [[nodiscard]] bool is_kept(std::size_t j) const { return sizes_[j] > rounding() * std::ranges::max(sizes_); }
  /// result += factor column row^H.
  void add_product(const Number* column, const Number* row, double factor, std::vector<Number>& result) const {
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t k = 0; k < n_; ++k) result[i * n_ + k] += column[i] * conjugate(row[k]) * factor;
  }
  /// Whether there was a pair to rotate.
  bool rotate_all() {
    bool rotates = false;
    for (std::size_t p = 0; p < n_; ++p)
      for (std::size_t q = p + 1; q < n_; ++q) rotates = rotate(p, q) || rotates;
    return rotates;
  }
  /// By the angle whose tangent t makes the columns orthogonal: t^2 + 2 zeta t = 1, the smaller root.
  bool rotate(std::size_t p, std::size_t q) {
    Number* const first = &a_[p * n_];
    Number* const last = &a_[q * n_];
    Number product{};
    for (std::size_t i = 0; i < n_; ++i) product += conjugate(first[i]) * last[i];
    const double of_first = norm(first), of_last = norm(last), size = size_of(product);
    if (!(size > rounding() * of_first * of_last)) return false;
    const double zeta = (of_last - of_first) * (of_last + of_first) / (2 * size);
    const double t = std::copysign(1.0, zeta) / (std::abs(zeta) + std::hypot(1.0, zeta));
    const double cosine = 1 / std::hypot(1.0, t), sine = cosine * t;
    const Number phase = conjugate(product) * (1 / size);
    for (auto* numbers : {&a_, &v_})
      for (std::size_t i = 0; i < n_; ++i) {
        Number& one = (*numbers)[p * n_ + i];
        Number& other = (*numbers)[q * n_ + i];
        const Number turned = other * phase;
        other = one * sine + turned * cosine;
        one = one * cosine - turned * sine;
      }
    return true;
  }

  std::size_t n_;
  double scale_ = 0;           // of the entries, by which they are divided
  std::vector<Number> a_, v_;  // column by column
  std::vector<double> sizes_;
};

}  // namespace continuo::boundary
