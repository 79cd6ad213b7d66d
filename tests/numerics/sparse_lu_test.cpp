// Sparse factorization against the dense one, which has tests of its own.
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/sparse_lu.hpp>

namespace continuo::sparse_lu_test {
namespace {

constexpr std::size_t size = 30;

// A band, some entries far off it.
SparsePattern pattern_of_test() {
  std::vector<MatrixPlace> places{{0, 29}, {25, 3}, {7, 19}};
  for (std::uint32_t i = 1; i < size; ++i) places.insert(places.end(), {{i, i - 1}, {i - 1, i}});
  return {size, places};
}

template <class Number>
void fill(SparseLU<Number>& lu, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (Number& value : lu.values()) value = Number(uniform(engine));
}

std::vector<double> right_hand_side() {
  std::vector<double> b(size);
  for (std::size_t i = 0; i < size; ++i) b[i] = static_cast<double>(i) - 3.5;
  return b;
}

std::vector<double> dense_solution(const SparsePattern& pattern, std::span<const double> values) {
  DenseLU<double> lu(size);
  for (std::size_t j = 0; j < size; ++j)
    for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p) lu.matrix()[pattern.row(p) * size + j] = values[p];
  EXPECT_TRUE(lu.factor());
  std::vector<double> b = right_hand_side();
  lu.solve(b.data());
  return b;
}

TEST(SparseLU, AgreesWithTheDenseOneForManyMatricesOfOnePattern) {
  const SparsePattern pattern = pattern_of_test();
  SparseLU<double> lu(pattern);
  for (unsigned seed = 1; seed < 20; ++seed) {
    fill(lu, seed);
    const std::vector<double> expected = dense_solution(pattern, lu.values());
    ASSERT_TRUE(lu.factor());
    std::vector<double> b = right_hand_side();
    lu.solve(b.data());
    // Pivots kept from another matrix may cost the ten digits that `least_pivot_growth` allows; in fact they cost far
    // fewer.
    for (std::size_t i = 0; i < size; ++i) EXPECT_NEAR(b[i], expected[i], 1e-6 * (1 + std::abs(expected[i])));
  }
}

TEST(SparseLU, ACopyGivesTheSameBitsNowAndLater) {
  SparseLU<double> lu(pattern_of_test());
  for (const unsigned seed : {1U, 2U}) {
    fill(lu, seed);
    ASSERT_TRUE(lu.factor());
  }
  SparseLU<double> copy = lu;
  for (const unsigned seed : {3U, 4U}) {
    std::vector<double> b = right_hand_side(), of_copy = b;
    lu.solve(b.data());
    copy.solve(of_copy.data());
    EXPECT_EQ(b, of_copy);
    for (SparseLU<double>* each : {&lu, &copy}) {
      fill(*each, seed);
      ASSERT_TRUE(each->factor());
    }
  }
}

TEST(SparseLU, SolvesComplexSystems) {
  // (2 + i) x = b on the diagonal, with x = 1 - i everywhere: b = 3 - i.
  SparseLU<ComplexNumber<double>> lu(SparsePattern(size, {}));
  for (auto& value : lu.values()) value = {2, 1};
  ASSERT_TRUE(lu.factor());
  std::vector<ComplexNumber<double>> b(size, {3, -1});
  lu.solve(b.data());
  for (const auto& x : b) {
    EXPECT_NEAR(x.re, 1, 1e-15);
    EXPECT_NEAR(x.im, -1, 1e-15);
  }
}

TEST(SparseLU, ReportsASingularMatrixAndRecovers) {
  SparseLU<double> lu(pattern_of_test());
  EXPECT_FALSE(lu.factor());  // all entries are zero
  fill(lu, 5);
  EXPECT_TRUE(lu.factor());
}

TEST(SparsePattern, KeepsTheDiagonalAndFindsItsEntries) {
  const SparsePattern pattern(3, std::vector<MatrixPlace>{{0, 2}, {0, 2}, {2, 1}});
  EXPECT_EQ(pattern.entries(), 5U);
  EXPECT_EQ(pattern.row(pattern.find(2, 1)), 2U);
  EXPECT_EQ(pattern.find(1, 0), pattern.entries());
  EXPECT_EQ(pattern.bandwidth().lower, 1U);
  EXPECT_EQ(pattern.bandwidth().upper, 2U);
}

TEST(ColumnGroups, OfATridiagonalMatrixAreThree) {
  std::vector<MatrixPlace> places;
  for (std::uint32_t i = 1; i < size; ++i) places.insert(places.end(), {{i, i - 1}, {i - 1, i}});
  const ColumnGroups groups(SparsePattern(size, places));
  EXPECT_EQ(groups.count(), 3U);
  std::size_t columns = 0;
  for (std::size_t g = 0; g < groups.count(); ++g) columns += groups.group(g).size();
  EXPECT_EQ(columns, size);
}

}  // namespace
}  // namespace continuo::sparse_lu_test
