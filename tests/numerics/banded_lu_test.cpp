// Banded LU factorization against known solutions, from which the right-hand sides are computed.
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <tests/numerics/random_number.hpp>

#include <continuo/numerics/banded_lu.hpp>

namespace continuo::banded_lu_test {
namespace {

/// A band that is filled entry by entry, and factorized as it is: BandedLU factorizes c M - J.
template <class Number>
class Band {
 public:
  using Real = typename BandedLU<Number>::Real;

  Band(std::size_t n, std::size_t lower, std::size_t upper)
      : layout_(n, lower, upper), entries_(layout_.numbers()), lu_(layout_) {}

  void clear() { std::ranges::fill(entries_, Real(0)); }
  void set(std::size_t row, std::size_t column, Real entry) { entries_[layout_.place(row, column)] = -entry; }
  bool factor(const Number& c = Number{}, std::span<const Real> mass = {}) { return lu_.factor(entries_, c, mass); }
  void solve(Number* b) { lu_.solve(b); }

 private:
  BandLayout layout_;
  std::vector<Real> entries_;
  BandedLU<Number> lu_;
};

/// Rows of a matrix c M - J, and their solution.
template <class Number>
double residual(const std::vector<std::vector<Number>>& rows, const std::vector<Number>& x,
                const std::vector<Number>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    Number sum = b[i];
    for (std::size_t j = 0; j < b.size(); ++j) sum -= rows[i][j] * x[j];
    worst = std::max(worst, static_cast<double>(magnitude(sum)));
  }
  return worst;
}

/// The greatest residual of the solution, relative to the greatest component of the solution times the entries of a
/// row, all below 1.5, or 1.5 times the shift. Elimination with pivots bounds it by some roundings per entry of a row,
/// whatever the condition of the matrix (N. J. Higham, "Accuracy and Stability of Numerical Algorithms", 9.3; growth
/// stays small in practice). c is a random number of size `shift` and M a random diagonal: with a large shift no rows
/// are exchanged.
template <class Number>
double residual_of_random_system(std::size_t n, std::size_t lower, std::size_t upper, unsigned seed, double shift = 1) {
  using Real = typename BandedLU<Number>::Real;
  std::mt19937 engine(seed);
  Band<Number> band(n, lower, upper);
  const Number c = Number(Real(shift)) * random_number<Number>(engine);
  std::vector<std::vector<Number>> rows(n, std::vector<Number>(n, Number{}));
  std::vector<Number> b(n);
  std::vector<Real> mass(n);
  for (std::size_t i = 0; i < n; ++i) {
    b[i] = random_number<Number>(engine);
    mass[i] = 1 + random_number<Real>(engine) / 4;
    for (std::size_t j = i < lower ? 0 : i - lower; j < std::min(n, i + upper + 1); ++j) {
      const Real entry = random_number<Real>(engine);
      band.set(i, j, entry);
      rows[i][j] = Number(entry);
    }
    rows[i][i] += c * Number(mass[i]);
  }
  EXPECT_TRUE(band.factor(c, mass));
  auto x = b;
  band.solve(x.data());
  double greatest = 0;
  for (const Number& value : x) greatest = std::max(greatest, static_cast<double>(magnitude(value)));
  const double entries = std::max(1.5, 1.5 * shift) * static_cast<double>(std::min(n, lower + upper + 1));
  return residual(rows, x, b) / (entries * greatest);
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
             // from both ends, with and without a row that is left over in the middle
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
      // with a dominant diagonal, as for short steps
      EXPECT_LT(residual_of_random_system<double>(n, lower, upper, seed, 1000), bound)
          << n << ' ' << lower << ' ' << upper;
      EXPECT_LT(residual_of_random_system<ComplexNumber<double>>(n, lower, upper, seed, 1000), bound);
    }
  }
}

// The factorization of a matrix with pivots must not affect that of a later matrix without them.
TEST(BandedLU, CanBeFilledAgain) {
  Band<double> lu(3, 1, 1);
  for (int round = 0; round < 2; ++round) {
    lu.clear();
    lu.set(0, 1, 1), lu.set(1, 0, 1), lu.set(1, 2, 1), lu.set(2, 2, 2);  // zero in the corner
    ASSERT_TRUE(lu.factor());
    std::vector<double> b{2, 4, 6};  // x = (1, 2, 3)
    lu.solve(b.data());
    EXPECT_EQ(b, (std::vector<double>{1, 2, 3}));
    lu.clear();
    for (std::size_t i = 0; i < 3; ++i) lu.set(i, i, 2);
    ASSERT_TRUE(lu.factor());
    b = {2, 4, 6};
    lu.solve(b.data());
    EXPECT_EQ(b, (std::vector<double>{1, 2, 3}));
  }
}

// Two equal rows, at any place: near the ends, in the middle, and among those left over by both ends.
TEST(BandedLU, FindsASingularMatrixAnywhere) {
  for (const std::size_t n : {std::size_t{40}, std::size_t{41}}) {
    for (std::size_t row = 0; row + 1 < n; ++row) {
      Band<double> lu(n, 2, 2);
      lu.clear();
      for (std::size_t i = 0; i < n; ++i) lu.set(i, i, 1);
      lu.set(row, row + 1, 1), lu.set(row + 1, row, 1);
      EXPECT_FALSE(lu.factor()) << n << ' ' << row;
      lu.set(row, row + 1, 2);
      EXPECT_TRUE(lu.factor()) << n << ' ' << row;
      std::vector<double> b(n, 1);  // x = 1 but for the pair: x + 2 y = 1, x + y = 1
      b[row] = 3, b[row + 1] = 2;
      lu.solve(b.data());
      EXPECT_EQ(b, std::vector<double>(n, 1)) << n << ' ' << row;
    }
  }
}

TEST(BandedLU, SaysWhatIsSingularOrNotFinite) {
  Band<double> lu(2, 1, 1);
  lu.clear();
  lu.set(0, 0, 1), lu.set(0, 1, 2), lu.set(1, 0, 2), lu.set(1, 1, 4);
  EXPECT_FALSE(lu.factor());
  lu.clear();
  lu.set(0, 0, std::numeric_limits<double>::quiet_NaN()), lu.set(1, 1, 1);
  EXPECT_FALSE(lu.factor());
}

}  // namespace
}  // namespace continuo::banded_lu_test
