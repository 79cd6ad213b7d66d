// Banded LU against solutions that are known because the right-hand side was made from them.
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/numerics/banded_lu.hpp>

namespace continuo {
namespace {

template <class Number>
Number random_number(std::mt19937& engine) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  if constexpr (std::is_same_v<Number, ComplexNumber<double>>) {
    return {uniform(engine), uniform(engine)};
  } else {
    return Number(uniform(engine));
  }
}

/// The greatest residual of the solution, relative to the greatest component of the solution times the entries of a
/// row, all below 1.5: what elimination with pivots keeps at some roundings per entry of a row, whatever the condition
/// of the matrix (N. J. Higham, "Accuracy and Stability of Numerical Algorithms", 9.3; growth stays small in practice).
template <class Number>
double residual_of_random_system(std::size_t n, std::size_t lower, std::size_t upper, unsigned seed) {
  std::mt19937 engine(seed);
  BandedLU<Number> lu(n, lower, upper);
  lu.clear();
  std::vector<std::vector<Number>> rows(n, std::vector<Number>(n, Number{}));
  std::vector<Number> b(n);
  for (std::size_t i = 0; i < n; ++i) {
    b[i] = random_number<Number>(engine);
    for (std::size_t j = i < lower ? 0 : i - lower; j < std::min(n, i + upper + 1); ++j)
      lu(i, j) = rows[i][j] = random_number<Number>(engine);
  }
  EXPECT_TRUE(lu.factor());
  auto x = b;
  lu.solve(x.data());
  double greatest = 0, worst = 0;
  for (const Number& value : x) greatest = std::max(greatest, static_cast<double>(magnitude(value)));
  for (std::size_t i = 0; i < n; ++i) {
    Number sum = b[i];
    for (std::size_t j = 0; j < n; ++j) sum -= rows[i][j] * x[j];
    worst = std::max(worst, static_cast<double>(magnitude(sum)));
  }
  return worst / (1.5 * static_cast<double>(std::min(n, lower + upper + 1)) * greatest);
}

TEST(BandedLU, SolvesRandomSystemsThatNeedPivots) {
  constexpr double bound = 100 * std::numeric_limits<double>::epsilon();
  for (unsigned seed = 0; seed < 10; ++seed) {
    for (const auto& [n, lower, upper] : std::vector<std::array<std::size_t, 3>>{
             {1, 0, 0},
             {2, 1, 1},
             {30, 1, 1},
             {30, 2, 1},
             {30, 1, 3},
             {30, 0, 2},
             {30, 2, 0},
             {40, 5, 7},
             {6, 5, 5},
             // from both ends, with and without a row in the middle that neither sees
             {32, 1, 1},
             {33, 1, 1},
             {32, 2, 2},
             {33, 2, 1},
             {40, 3, 3},
             {41, 1, 3},
             {64, 4, 4},
             {65, 4, 0},
             {501, 2, 2}}) {
      EXPECT_LT(residual_of_random_system<double>(n, lower, upper, seed), bound) << n << ' ' << lower << ' ' << upper;
      EXPECT_LT(residual_of_random_system<ComplexNumber<double>>(n, lower, upper, seed), bound)
          << n << ' ' << lower << ' ' << upper;
      EXPECT_LT(residual_of_random_system<long double>(n, lower, upper, seed), bound);
    }
  }
}

// Factors of a matrix that needed pivots must leave nothing behind for one that does not.
TEST(BandedLU, CanBeFilledAgain) {
  BandedLU<double> lu(3, 1, 1);
  for (int round = 0; round < 2; ++round) {
    lu.clear();
    lu(0, 1) = 1, lu(1, 0) = 1, lu(1, 2) = 1, lu(2, 2) = 2;  // zero in the corner
    ASSERT_TRUE(lu.factor());
    std::vector<double> b{2, 4, 6};  // x = (1, 2, 3)
    lu.solve(b.data());
    EXPECT_EQ(b, (std::vector<double>{1, 2, 3}));
    lu.clear();
    for (std::size_t i = 0; i < 3; ++i) lu(i, i) = 2;
    ASSERT_TRUE(lu.factor());
    b = {2, 4, 6};
    lu.solve(b.data());
    EXPECT_EQ(b, (std::vector<double>{1, 2, 3}));
  }
}

// Two rows that are the same, wherever they are: near the ends, in the middle, among those both ends have left over.
TEST(BandedLU, FindsASingularMatrixAnywhere) {
  for (const std::size_t n : {std::size_t{40}, std::size_t{41}}) {
    for (std::size_t row = 0; row + 1 < n; ++row) {
      BandedLU<double> lu(n, 2, 2);
      lu.clear();
      for (std::size_t i = 0; i < n; ++i) lu(i, i) = 1;
      lu(row, row + 1) = lu(row + 1, row) = 1;
      EXPECT_FALSE(lu.factor()) << n << ' ' << row;
      lu(row, row + 1) = 2;
      EXPECT_TRUE(lu.factor()) << n << ' ' << row;
      std::vector<double> b(n, 1);  // x = 1 but for the pair: x + 2 y = 1, x + y = 1
      b[row] = 3, b[row + 1] = 2;
      lu.solve(b.data());
      EXPECT_EQ(b, std::vector<double>(n, 1)) << n << ' ' << row;
    }
  }
}

TEST(BandedLU, SaysWhatIsSingularOrNotFinite) {
  BandedLU<double> lu(2, 1, 1);
  lu.clear();
  lu(0, 0) = 1, lu(0, 1) = 2, lu(1, 0) = 2, lu(1, 1) = 4;
  EXPECT_FALSE(lu.factor());
  lu.clear();
  lu(0, 0) = std::numeric_limits<double>::quiet_NaN(), lu(1, 1) = 1;
  EXPECT_FALSE(lu.factor());
}

}  // namespace
}  // namespace continuo
