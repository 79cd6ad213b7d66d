// LU factorization with pivots against known solutions, from which the right-hand sides are computed.
#include <algorithm>
#include <array>
#include <complex>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <tests/numerics/random_number.hpp>

#include <continuo/numerics/dense_lu.hpp>

namespace continuo::dense_lu_test {
namespace {

// The greatest |x_i - known_i| of a random system of n equations.
template <class Number, std::size_t N>
double error_of_random_system(std::size_t n, unsigned seed) {
  std::mt19937 engine(seed);
  DenseLU<Number, N> lu(n);
  std::vector<Number> known(n), b(n, Number{});
  for (Number& value : known) value = random_number<Number>(engine);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const Number entry = random_number<Number>(engine);
      lu.matrix()[i * n + j] = entry;
      b[i] += entry * known[j];
    }
  }
  EXPECT_TRUE(lu.factor());
  lu.solve(b.data());
  double worst = 0;
  for (std::size_t i = 0; i < n; ++i) worst = std::max(worst, static_cast<double>(magnitude(b[i] - known[i])));
  return worst;
}

// The error is the condition number times epsilon; of random matrices of this size the condition exceeds 1e4 less than
// once in a thousand (A. Edelman, 1988: P(kappa > n x) < 2 / x).
TEST(DenseLU, SolvesRandomSystems) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    EXPECT_LT((error_of_random_system<double, 3>(3, seed)), 1e-11);
    EXPECT_LT((error_of_random_system<double, 8>(8, seed)), 1e-11);
    EXPECT_LT((error_of_random_system<double, 20>(20, seed)), 1e-11);
    EXPECT_LT((error_of_random_system<ComplexNumber<double>, 11>(11, seed)), 1e-11);
    EXPECT_LT((error_of_random_system<double, run_time_size>(17, seed)), 1e-11);
    EXPECT_LT((error_of_random_system<ComplexNumber<double>, 5>(5, seed)), 1e-11);
    EXPECT_LT((error_of_random_system<ComplexNumber<double>, run_time_size>(11, seed)), 1e-11);
  }
}

TEST(DenseLU, TakesAPivotWhereTheDiagonalIsZero) {
  DenseLU<double, 2> lu(2);
  lu.matrix() = {0, 2, 1, 0};
  ASSERT_TRUE(lu.factor());
  std::array<double, 2> b{4, 3};
  lu.solve(b.data());
  EXPECT_EQ(b, (std::array<double, 2>{3, 2}));
}

TEST(DenseLU, ReportsSingularMatricesAndMatricesThatAreNotFinite) {
  DenseLU<double, 2> lu(2);
  lu.matrix() = {1, 2, 2, 4};
  EXPECT_FALSE(lu.factor());
  lu.matrix() = {0, 0, 0, 1};
  EXPECT_FALSE(lu.factor());
  lu.matrix() = {std::numeric_limits<double>::quiet_NaN(), 0, 0, 1};
  EXPECT_FALSE(lu.factor());
  lu.matrix() = {std::numeric_limits<double>::infinity(), 0, 0, 1};
  EXPECT_FALSE(lu.factor());
}

// The greatest residual of the solution, relative to the greatest component of the solution, of which each equation has
// at most n terms with entries below 1.5.
template <class Number, std::size_t N>
double residual(DenseLU<Number, N>& lu, const std::array<Number, N * N>& matrix) {
  lu.matrix() = matrix;
  if (!lu.factor()) return std::numeric_limits<double>::infinity();
  std::array<Number, N> b{};
  for (std::size_t i = 0; i < N; ++i) b[i] = Number(static_cast<double>(i % 3) + 1);
  std::array<Number, N> x = b;
  lu.solve(x.data());
  double greatest = 0, worst = 0;
  for (const Number& value : x) greatest = std::max(greatest, static_cast<double>(magnitude(value)));
  for (std::size_t i = 0; i < N; ++i) {
    Number sum = b[i];
    for (std::size_t j = 0; j < N; ++j) sum -= matrix[i * N + j] * x[j];
    worst = std::max(worst, static_cast<double>(magnitude(sum)));
  }
  return worst / (1.5 * static_cast<double>(N) * greatest);
}

// With partial pivoting the residual is a few roundings. Where old pivots are kept, factors may reach 100 instead of 1,
// and entries grow by that factor in each of the few eliminations in which they take part: 1e4 is two in a row.
constexpr double listed_bound = 1e4 * std::numeric_limits<double>::epsilon();

// Other numbers at the same places, of any size: the old pivots are sometimes kept, sometimes chosen again, and
// sometimes the list is not used.
template <class Number>
void solve_sparse_systems_of_one_pattern(unsigned seed) {
  constexpr std::size_t N = 20;
  std::mt19937 engine(seed);
  std::array<bool, N * N> filled;
  std::bernoulli_distribution often(0.1);
  for (std::size_t i = 0; i < N * N; ++i) filled[i] = i % (N + 1) == 0 || often(engine);
  DenseLU<Number, N> lu(N);
  for (int round = 0; round < 100; ++round) {
    std::array<Number, N * N> matrix{};
    for (std::size_t i = 0; i < N * N; ++i)
      if (filled[i]) matrix[i] = random_number<Number>(engine);
    EXPECT_LT((residual<Number, N>(lu, matrix)), listed_bound) << seed << ' ' << round;
  }
}
TEST(DenseLU, SolvesSparseSystemsOfOnePattern) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    solve_sparse_systems_of_one_pattern<double>(seed);
    solve_sparse_systems_of_one_pattern<ComplexNumber<double>>(seed);
  }
}

// I + 1/2 P for a cyclic shift P, then with a new entry each time, then with nothing on the diagonal.
TEST(DenseLU, LearnsPlacesAndForgetsPivots) {
  constexpr std::size_t N = 9;
  std::array<double, N * N> matrix{};
  for (std::size_t i = 0; i < N; ++i) matrix[i * N + i] = 1, matrix[i * N + (i + 1) % N] = 0.5;
  DenseLU<double, N> lu(N);
  EXPECT_LT((residual<double, N>(lu, matrix)), listed_bound);
  for (std::size_t i = 0; i < N; ++i) {
    matrix[i * N + (i + 5) % N] = 0.25;
    EXPECT_LT((residual<double, N>(lu, matrix)), listed_bound);
  }
  for (const double diagonal : {1e-3, 1e-14, 0.0, 1.0, 0.0}) {
    for (std::size_t i = 0; i < N; ++i) matrix[i * N + i] = diagonal;
    EXPECT_LT((residual<double, N>(lu, matrix)), listed_bound) << diagonal;
  }
}

TEST(DenseLU, ReportsSingularSparseMatricesAndGoesOn) {
  constexpr std::size_t N = 12;
  DenseLU<double, N> lu(N);
  std::array<double, N * N> matrix{};
  for (std::size_t i = 0; i < N; ++i) matrix[i * N + i] = 2, matrix[i * N] = 1;
  for (int round = 0; round < 300; ++round) {  // any number of failures
    matrix[5 * N + 5] = 0;
    lu.matrix() = matrix;
    ASSERT_FALSE(lu.factor());
    matrix[5 * N + 5] =
        round % 2 == 0 ? std::numeric_limits<double>::quiet_NaN() : std::numeric_limits<double>::infinity();
    lu.matrix() = matrix;
    ASSERT_FALSE(lu.factor());
    matrix[5 * N + 5] = 2;
    ASSERT_LT((residual<double, N>(lu, matrix)), listed_bound);
  }
}

// An arrow matrix with its full row and column first: elimination in that order fills every entry, in the reverse order
// none.
TEST(EliminationList, LeavesZeros) {
  constexpr std::size_t N = 15;
  std::array<double, N * N> matrix{};
  for (std::size_t i = 0; i < N; ++i) matrix[i * N + i] = 3, matrix[i] = matrix[i * N] = 1;
  detail::EliminationList<N> list;
  ASSERT_EQ(list.choose(matrix, 0.1), detail::EliminationList<N>::Result::done);
  EXPECT_EQ(list.values(), 3 * N - 2);
  matrix.fill(1);
  for (std::size_t i = 0; i < N; ++i) matrix[i * N + i] = 3;
  EXPECT_EQ(list.choose(matrix, 0.1), detail::EliminationList<N>::Result::too_many);
}

TEST(ComplexNumber, ReciprocalAgreesWithTheStandardLibrary) {
  for (const ComplexNumber<double> z : {ComplexNumber<double>{3, -4}, {1e200, 1e-200}, {1e-3, 2e200}, {0, 5}}) {
    const std::complex<double> expected = 1.0 / std::complex<double>(z.re, z.im);
    const ComplexNumber<double> inverse = reciprocal(z);
    EXPECT_NEAR(inverse.re, expected.real(), 4e-16 * std::abs(expected));
    EXPECT_NEAR(inverse.im, expected.imag(), 4e-16 * std::abs(expected));
  }
}

}  // namespace
}  // namespace continuo::dense_lu_test
