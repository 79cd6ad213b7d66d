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
#include <vector>

#include <continuo/numerics/complex_number.hpp>
#include <continuo/numerics/sparse_pattern.hpp>

namespace continuo {

/// Number is double or ComplexNumber<double>. A copy decomposes to the same bits as the original.
template <class Number>
class SparseLU {
 public:
  /// Allocates for matrices of this pattern, and analyses it.
  explicit SparseLU(const SparsePattern& pattern);
  /// A copy, which decomposes to the same bits.
  SparseLU(const SparseLU& other);
  SparseLU(SparseLU&&) noexcept;
  /// Takes the place of another one.
  SparseLU& operator=(SparseLU other) noexcept;
  /// Frees the factors.
  ~SparseLU();

  /// The entries, in the order of the pattern, to be filled before each call of `factor`.
  [[nodiscard]] std::span<Number> values() { return values_; }
  /// False where the matrix is singular or not finite.
  [[nodiscard]] bool factor();
  /// b becomes the solution.
  void solve(Number* b);

 private:
  struct Factors;
  [[nodiscard]] bool choose_pivots();

  std::vector<Number> values_;
  std::vector<Number> pivot_values_;  // of the matrix whose pivots are in use; empty before the first
  std::unique_ptr<Factors> factors_;
};

extern template class SparseLU<double>;
extern template class SparseLU<ComplexNumber<double>>;

}  // namespace continuo
