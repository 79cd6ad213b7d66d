// Almost block diagonal systems against a dense elimination with exchange of rows, and where that itself fails.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <random>
#include <span>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/boundary/almost_block_diagonal.hpp>

namespace continuo::boundary::almost_block_diagonal_test {
namespace {

/// Number as Eigen has it.
template <class Number>
using Plain = std::conditional_t<std::is_same_v<Number, double>, double, std::complex<double>>;
template <class Number>
using Matrix = Eigen::Matrix<Plain<Number>, Eigen::Dynamic, Eigen::Dynamic>;

double plain(double x) {
  return x;
}
std::complex<double> plain(const ComplexNumber<double>& z) {
  return {z.re, z.im};
}

struct Sizes {
  std::size_t n, k, intervals;
};

/// A system of random numbers, and the same as a dense matrix.
template <class Number>
struct Random {
  std::mt19937 random;
  std::normal_distribution<double> normal;

  explicit Random(unsigned seed) : random(seed) {}
  Number number() {
    if constexpr (std::is_same_v<Number, double>) {
      return normal(random);
    } else {
      const double re = normal(random);
      return {re, normal(random)};
    }
  }
  void fill(std::span<Number> numbers) {
    for (Number& entry : numbers) entry = number();
  }
};

template <class Number>
void put(Matrix<Number>& matrix, std::size_t row, std::size_t column, std::span<const Number> block, std::size_t rows) {
  const std::size_t columns = rows == 0 ? 0 : block.size() / rows;
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j)
      matrix(static_cast<Eigen::Index>(row + i), static_cast<Eigen::Index>(column + j)) = plain(block[i * columns + j]);
}

template <class Number>
Matrix<Number> dense(AlmostBlockDiagonal<Number>& system, const Sizes& s) {
  const auto size = static_cast<Eigen::Index>(system.unknowns());
  Matrix<Number> matrix = Matrix<Number>::Zero(size, size);
  const std::size_t p = (s.intervals + 1) * s.n, conditions = s.intervals * s.n;
  for (std::size_t i = 0; i < s.intervals; ++i) {
    put<Number>(matrix, i * s.n, i * s.n, system.left(i), s.n);
    put<Number>(matrix, i * s.n, (i + 1) * s.n, system.right(i), s.n);
    put<Number>(matrix, i * s.n, p, system.border(i), s.n);
  }
  put<Number>(matrix, conditions, 0, system.first_condition(), s.n + s.k);
  put<Number>(matrix, conditions, s.intervals * s.n, system.last_condition(), s.n + s.k);
  put<Number>(matrix, conditions, p, system.parameter_condition(), s.n + s.k);
  return matrix;
}

template <class Number>
void expect_solution(unsigned seed, const Sizes& s) {
  Random<Number> random(seed);
  AlmostBlockDiagonal<Number> system(s.n, s.k, s.intervals);
  for (std::size_t i = 0; i < s.intervals; ++i) {
    random.fill(system.left(i)), random.fill(system.right(i)), random.fill(system.border(i));
    // Rows of very different size, as those of stiff intervals.
    const double size = std::pow(10.0, 3 * random.normal(random.random));
    for (Number& entry : system.left(i)) entry *= size;
    for (Number& entry : system.right(i)) entry *= size;
    for (Number& entry : system.border(i)) entry *= size;
  }
  random.fill(system.first_condition()), random.fill(system.last_condition());
  random.fill(system.parameter_condition());
  const Matrix<Number> matrix = dense(system, s);
  Matrix<Number> solution(matrix.rows(), 1);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) solution(i) = plain(random.number());
  const Matrix<Number> right_side = matrix * solution;
  std::vector<Number> b(system.unknowns());
  for (std::size_t i = 0; i < b.size(); ++i) {
    if constexpr (std::is_same_v<Number, double>) {
      b[i] = right_side(static_cast<Eigen::Index>(i));
    } else {
      b[i] = {right_side(static_cast<Eigen::Index>(i)).real(), right_side(static_cast<Eigen::Index>(i)).imag()};
    }
  }
  ASSERT_TRUE(system.factor());
  system.solve(b);
  // The error of a backward stable elimination: rounding times the condition, of the matrix with rows of equal size.
  Matrix<Number> scaled = matrix;
  for (Eigen::Index i = 0; i < scaled.rows(); ++i) scaled.row(i) /= scaled.row(i).norm();
  const double condition = scaled.norm() * scaled.inverse().norm();
  double error = 0;
  for (std::size_t i = 0; i < b.size(); ++i)
    error = std::max(error, std::abs(plain(b[i]) - solution(static_cast<Eigen::Index>(i))));
  EXPECT_LT(error, 1e-15 * condition * solution.norm()) << "n " << s.n << " k " << s.k << " m " << s.intervals;
}

TEST(AlmostBlockDiagonal, SolvesRandomSystems) {
  unsigned seed = 0;
  for (const std::size_t n : std::vector<std::size_t>{1, 2, 5})
    for (const std::size_t k : std::vector<std::size_t>{0, 1, 3})
      for (const std::size_t intervals : std::vector<std::size_t>{1, 2, 3, 12}) {
        expect_solution<double>(++seed, {n, k, intervals});
        expect_solution<ComplexNumber<double>>(++seed, {n, k, intervals});
      }
}

/// Wright's example: the matrices of multiple shooting for x' = [[-1/6, 1], [1, -1/6]] x, for which elimination with
/// exchange of rows lets entries grow exponentially: no entry is ever exchanged.
TEST(AlmostBlockDiagonal, IsStableWhereExchangeOfRowsIsNot) {
  constexpr std::size_t intervals = 200;
  constexpr double h = 0.3;
  const double decay = std::exp(-h / 6), even = decay * std::cosh(h), odd = decay * std::sinh(h);
  AlmostBlockDiagonal<double> system(2, 0, intervals);
  for (std::size_t i = 0; i < intervals; ++i) {
    for (std::size_t e = 0; e < 4; ++e) {
      system.left(i)[e] = -(e % 3 == 0 ? even : odd);
      system.right(i)[e] = e % 3 == 0 ? 1 : 0;
    }
  }
  for (std::size_t e = 0; e < 4; ++e) {
    system.first_condition()[e] = e % 3 == 0 ? 1 : 0;
    system.last_condition()[e] = e % 3 == 0 ? 1 : 0;
  }
  const Matrix<double> matrix = dense(system, {2, 0, intervals});
  const Matrix<double> ones = Matrix<double>::Ones(matrix.rows(), 1), right_side = matrix * ones;
  std::vector<double> b(right_side.data(), right_side.data() + right_side.size());
  ASSERT_TRUE(system.factor());
  system.solve(b);
  for (const double x : b) EXPECT_NEAR(x, 1, 1e-11);
  const Matrix<double> exchanged = matrix.partialPivLu().solve(right_side);
  EXPECT_FALSE((exchanged - ones).cwiseAbs().maxCoeff() <= 1e-3) << "the example does not show what it is for";
}

TEST(AlmostBlockDiagonal, KnowsSingularMatrices) {
  // y' = 0 with y_0(0) and y_0(1) given twice.
  AlmostBlockDiagonal<double> system(2, 0, 4);
  for (std::size_t i = 0; i < 4; ++i)
    for (const std::size_t e : std::vector<std::size_t>{0, 3}) system.left(i)[e] = -1, system.right(i)[e] = 1;
  system.first_condition()[0] = 1;
  system.last_condition()[2] = 1;
  EXPECT_FALSE(system.factor());
}

}  // namespace
}  // namespace continuo::boundary::almost_block_diagonal_test
