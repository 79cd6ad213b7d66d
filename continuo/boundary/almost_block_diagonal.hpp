// Linear systems of two-point boundary-value problems: for each interval n equations that join the numbers at both its
// ends and k parameters, then n + k conditions on the numbers at both ends of the whole interval and the parameters.
//
//   left_i y_i + right_i y_(i+1) + border_i p = b_i,   first y_0 + last y_m + border p = b
//
// One node after the other is eliminated by reflections: unlike elimination with exchanges of rows these are stable for
// solutions that grow and solutions that decay (S. J. Wright, "Stable parallel algorithms for two-point boundary value
// problems", SIAM J. Sci. Stat. Comput. 13 (1992) 742-764; "A collection of problems for which Gaussian elimination
// with partial pivoting is unstable", SIAM J. Sci. Comput. 14 (1993) 231-238). The cost is some 20 n^3 products an
// interval.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include <continuo/numerics/dense_lu.hpp>

namespace continuo::boundary {

/// Number is double or ComplexNumber<double>.
template <class Number>
class AlmostBlockDiagonal {
 public:
  /// A matrix of zeros: n numbers at each end of an interval, k parameters, at least one interval.
  AlmostBlockDiagonal(std::size_t size, std::size_t parameters, std::size_t intervals);

  /// The number of equations and unknowns.
  [[nodiscard]] std::size_t unknowns() const { return (intervals_ + 1) * n_ + k_; }
  /// The blocks of an interval, n x n, n x n and n x k, row by row, to be filled before each call of `factor`.
  /// @{
  std::span<Number> left(std::size_t i) { return std::span(left_).subspan(i * n_ * n_, n_ * n_); }
  std::span<Number> right(std::size_t i) { return std::span(right_).subspan(i * n_ * n_, n_ * n_); }
  std::span<Number> border(std::size_t i) { return std::span(border_).subspan(i * n_ * k_, n_ * k_); }
  /// @}
  /// The blocks of the conditions, (n + k) x n, (n + k) x n and (n + k) x k, row by row, to be filled likewise.
  /// @{
  std::span<Number> first_condition() { return first_; }
  std::span<Number> last_condition() { return last_; }
  std::span<Number> parameter_condition() { return parameter_; }
  /// @}

  /// False where the matrix is singular to the digits of a double, or not finite.
  [[nodiscard]] bool factor();
  /// b, in the order of the intervals and then the conditions, becomes the solution: y_0, ..., y_m, then p.
  void solve(std::span<Number> b);

 private:
  /// Width of the rows in which a node is eliminated: the node, the next one, the first one, the parameters.
  [[nodiscard]] std::size_t width() const { return 3 * n_ + k_; }
  [[nodiscard]] std::size_t stack_size() const { return 2 * n_ * width(); }
  void begin_elimination();
  template <class Visit>
  decltype(auto) with_size(const Visit& visit);
  template <std::size_t N>
  [[nodiscard]] std::size_t size() const {
    return N == run_time_size ? n_ : N;
  }
  template <std::size_t K>
  [[nodiscard]] std::size_t parameters() const {
    return K == run_time_size ? k_ : K;
  }
  template <std::size_t N, std::size_t K>
  void scale_rows(std::size_t interval);
  template <std::size_t N, std::size_t K>
  void stack(std::size_t interval);
  template <std::size_t N, std::size_t K>
  void reflect_columns(Number* a, std::size_t c, double factor);
  template <std::size_t N, std::size_t K>
  bool reflect(std::size_t interval);
  template <std::size_t N, std::size_t K>
  bool eliminate();
  template <std::size_t N, std::size_t K>
  void carry_right_side(std::span<Number> b) const;
  template <std::size_t N, std::size_t K>
  void substitute(std::span<Number> b) const;
  bool factor_end();

  std::size_t n_, k_, intervals_;
  std::vector<Number> left_, right_, border_, first_, last_, parameter_;
  std::vector<double> row_scales_;  // of the equations of intervals
  std::vector<Number> carried_;     // n rows in the last node eliminated up to, the first node and the parameters
  std::vector<Number> stacks_;      // of each inner node: 2n rows; below and on the diagonal the reflections
  std::vector<Number> diagonals_;   // of each inner node: the diagonal after the reflections, inverted
  std::vector<double> reflection_factors_;
  std::vector<Number> sums_;
  DenseLU<Number> end_;  // of the first node, the last and the parameters
  std::vector<double> end_rows_, end_columns_;
  std::vector<Number> end_values_, pair_;
};

extern template class AlmostBlockDiagonal<double>;
extern template class AlmostBlockDiagonal<ComplexNumber<double>>;

}  // namespace continuo::boundary
