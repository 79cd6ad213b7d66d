// continuo/numerics/sparse_lu.hpp
// LU factorization of sparse matrices of one pattern, by KLU of SuiteSparse (T. Davis, E. Palamadai Natarajan, ACM TOMS
// 37 (2010)): the pattern is analysed once, the pivots of one matrix serve the next ones as long as they are good.
//
//   SparseLU<double> lu(pattern);
//   fill(lu.values());                 // in the order of the pattern
//   if (lu.factor()) lu.solve(b);
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/numerics/complex_number.hpp>
#include <continuo/numerics/sparse_pattern.hpp>

namespace continuo {

/// The factors of matrices of one pattern, which a sparse solver keeps.
template <class Number>
class SparseFactors {
 public:
  /// Frees the factors.
  virtual ~SparseFactors() = default;
  /// Factors for the same pattern, of no matrix yet.
  [[nodiscard]] virtual std::unique_ptr<SparseFactors> for_same_pattern() const = 0;
  /// Factors the matrix with these entries, with pivots of its own. False where it is singular or not finite.
  [[nodiscard]] virtual bool choose_pivots(Number* values) = 0;
  /// Factors it with the pivots of the last `choose_pivots`. False where they are not good for it.
  [[nodiscard]] virtual bool refactor(Number* values) = 0;
  /// b becomes the solution.
  virtual void solve(Number* b) = 0;
};

/// A sparse solver: it analyses a pattern, for real and for complex matrices.
struct SparseSolver {
  /// For real matrices.
  std::unique_ptr<SparseFactors<double>> (*analyse_real)(const SparsePattern&);
  /// For complex matrices.
  std::unique_ptr<SparseFactors<ComplexNumber<double>>> (*analyse_complex)(const SparsePattern&);
};

/// KLU. A program is linked with it if it names it; one without sparse matrices does not.
extern const SparseSolver klu;
/// Whether KLU is there where a program is compiled.
#if __has_include(<suitesparse/klu.h>)
inline constexpr bool klu_is_installed = true;
#else
inline constexpr bool klu_is_installed = false;
#endif

/// Number is double or ComplexNumber<double>. A copy decomposes to the same bits as the original.
template <class Number>
class SparseLU {
 public:
  /// Allocates for matrices of this pattern, and analyses it.
  explicit SparseLU(const SparsePattern& pattern, const SparseSolver& solver = klu)
      : values_(pattern.entries()), factors_(analyse(pattern, solver)) {}
  /// A copy, which decomposes to the same bits. The pivots of the original come from the matrix kept in
  /// `pivot_values_`; what it has decomposed since is in `values_`.
  SparseLU(const SparseLU& other)
      : values_(other.values_), pivot_values_(other.pivot_values_), factors_(other.factors_->for_same_pattern()) {
    if (pivot_values_.empty()) return;
    static_cast<void>(factors_->choose_pivots(pivot_values_.data()));
    static_cast<void>(factors_->refactor(values_.data()));
  }
  SparseLU(SparseLU&&) noexcept = default;
  /// Takes the place of another one.
  SparseLU& operator=(SparseLU other) noexcept {
    std::swap(values_, other.values_);
    std::swap(pivot_values_, other.pivot_values_);
    std::swap(factors_, other.factors_);
    return *this;
  }
  /// Frees the factors.
  ~SparseLU() = default;

  /// The entries, in the order of the pattern, to be filled before each call of `factor`.
  [[nodiscard]] std::span<Number> values() { return values_; }
  /// False where the matrix is singular or not finite.
  [[nodiscard]] bool factor() {
    if (!pivot_values_.empty() && factors_->refactor(values_.data())) return true;
    pivot_values_.clear();
    if (!factors_->choose_pivots(values_.data())) return false;
    pivot_values_ = values_;
    // To the same bits as a copy, which can only refactor.
    return factors_->refactor(values_.data());
  }
  /// b becomes the solution.
  void solve(Number* b) { factors_->solve(b); }

  /// For checkpoints: the pivots in use, by the matrix that they were chosen for.
  template <class Archive>
  void transfer(Archive& archive) {
    bool has_pivots = !pivot_values_.empty();
    archive(has_pivots);
    if constexpr (Archive::reads) pivot_values_.resize(has_pivots ? values_.size() : 0);
    if (has_pivots) archive(pivot_values_);
    if constexpr (Archive::reads) {
      if (has_pivots && !factors_->choose_pivots(pivot_values_.data())) pivot_values_.clear();
    }
  }
  /// Decomposes the matrix as the last `factor` before a checkpoint has: without other pivots.
  void factor_with_known_pivots() {
    if (!pivot_values_.empty()) static_cast<void>(factors_->refactor(values_.data()));
  }

 private:
  [[nodiscard]] static std::unique_ptr<SparseFactors<Number>> analyse(const SparsePattern& pattern,
                                                                      const SparseSolver& solver) {
    if constexpr (std::is_same_v<Number, double>) {
      return solver.analyse_real(pattern);
    } else {
      return solver.analyse_complex(pattern);
    }
  }

  std::vector<Number> values_;
  std::vector<Number> pivot_values_;  // of the matrix whose pivots are in use; empty before the first
  std::unique_ptr<SparseFactors<Number>> factors_;
};

}  // namespace continuo
