// LU with pivots: solutions are compared with ones that are known because b was made from them.
#include <array>
#include <complex>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/numerics/dense_lu.hpp>

namespace continuo {
namespace {

template <class Number>
Number random_number(std::mt19937& engine) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  if constexpr (std::is_same_v<Number, double>) {
    return uniform(engine);
  } else {
    return {uniform(engine), uniform(engine)};
  }
}

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

TEST(ComplexNumber, ReciprocalAgreesWithTheStandardLibrary) {
  for (const ComplexNumber<double> z : {ComplexNumber<double>{3, -4}, {1e200, 1e-200}, {1e-3, 2e200}, {0, 5}}) {
    const std::complex<double> expected = 1.0 / std::complex<double>(z.re, z.im);
    const ComplexNumber<double> inverse = reciprocal(z);
    EXPECT_NEAR(inverse.re, expected.real(), 4e-16 * std::abs(expected));
    EXPECT_NEAR(inverse.im, expected.imag(), 4e-16 * std::abs(expected));
  }
}

}  // namespace
}  // namespace continuo
