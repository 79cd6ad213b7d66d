// Elimination by a list, of random matrices: what is left of the equations is held against the rounding of one
// elimination, in long double. Matrices whose rows differ by sixty powers of ten, blocks, and changing values.
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/numerics/elimination/sparse_elimination.hpp>
#include <continuo/numerics/sparse_lu.hpp>

namespace continuo::sparse_elimination_test {
namespace {

using Exact = std::complex<long double>;

Exact exact(double x) {
  return x;
}
Exact exact(const ComplexNumber<double>& z) {
  return {z.re, z.im};
}

/// Of some entries a row, in one to four blocks that are written in a random order.
SparsePattern random_pattern(std::size_t size, std::mt19937& engine) {
  std::vector<std::uint32_t> order(size);
  for (std::uint32_t i = 0; i < size; ++i) order[i] = i;
  std::ranges::shuffle(order, engine);
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(engine); };
  const std::size_t blocks = 1 + below(4);
  std::vector<MatrixPlace> places;
  for (std::size_t k = 0; k < 3 * size; ++k) {
    const std::size_t i = below(size), j = below(size);
    if (i * blocks / size <= j * blocks / size) places.push_back({order[i], order[j]});
  }
  return {size, places};
}

template <class Number>
Number random_number(std::mt19937& engine) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  if constexpr (std::is_same_v<Number, double>) {
    return uniform(engine);
  } else {
    const double re = uniform(engine);
    return {re, uniform(engine)};
  }
}

template <class Number>
Number times(const Number& x, double scale) {
  if constexpr (std::is_same_v<Number, double>) {
    return x * scale;
  } else {
    return {x.re * scale, x.im * scale};
  }
}

/// The greatest part of |A| |x| + |b| that is left of a row of A x = b.
template <class Number>
double residual(const SparsePattern& pattern, std::span<const Number> values, const std::vector<Number>& x,
                const std::vector<Number>& b) {
  std::vector<Exact> left(x.size());
  std::vector<long double> size(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) left[i] = exact(b[i]), size[i] = std::abs(left[i]);
  for (std::size_t j = 0; j < x.size(); ++j)
    for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p) {
      const Exact product = exact(values[p]) * exact(x[j]);
      left[pattern.row(p)] -= product;
      size[pattern.row(p)] += std::abs(product);
    }
  long double most = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (size[i] > 0) most = std::max(most, std::abs(left[i]) / size[i]);
  return static_cast<double>(most);
}

template <class Number>
class SparseEliminationOf : public testing::Test {};
using Numbers = testing::Types<double, ComplexNumber<double>>;
TYPED_TEST_SUITE(SparseEliminationOf, Numbers);

// Rows are scaled by powers of two, so the residual of a row is one against its own entries. An elimination of n rows
// whose multipliers are at most L leaves some n eps L (J. H. Wilkinson, 1963): L is a thousand for fresh pivots and ten
// thousand for kept ones.
TYPED_TEST(SparseEliminationOf, RandomMatricesLeaveTheRoundingOfTheirPivots) {
  using Number = TypeParam;
  std::mt19937 engine(7);
  std::size_t solved = 0, kept = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t size = std::uniform_int_distribution<std::size_t>(1, 60)(engine);
    const SparsePattern pattern = random_pattern(size, engine);
    SparseLU<Number> lu(pattern);
    std::vector<double> row_scale(size);
    for (double& scale : row_scale) scale = std::pow(10.0, std::uniform_real_distribution<double>(-30, 30)(engine));
    for (int matrix = 0; matrix < 4; ++matrix) {
      for (std::size_t p = 0; p < pattern.entries(); ++p)
        lu.values()[p] = times(random_number<Number>(engine), row_scale[pattern.row(p)]);
      const std::vector<Number> values(lu.values().begin(), lu.values().end());
      ASSERT_TRUE(lu.factor()) << trial;
      std::vector<Number> b(size);
      for (std::size_t i = 0; i < size; ++i) b[i] = times(random_number<Number>(engine), row_scale[i]);
      std::vector<Number> x = b;
      lu.solve(x.data());
      const double most =
          static_cast<double>(size) * std::numeric_limits<double>::epsilon() * (matrix == 0 ? 1e3 : 1e4);
      ASSERT_LT(residual<Number>(pattern, values, x, b), most) << trial << ' ' << matrix << " size " << size;
      ++solved;
      kept += matrix > 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(solved, 1200u);
  EXPECT_GT(kept, 0u);
}

TYPED_TEST(SparseEliminationOf, IsRefusedWhereAPivotIsZeroOrNoNumber) {
  using Number = TypeParam;
  const SparsePattern pattern(2, std::vector<MatrixPlace>{{0, 1}, {1, 0}});
  const std::vector<std::int32_t> order{0, 1}, blocks{0, 2};
  const auto plan = std::make_shared<const detail::EliminationPlan>(pattern.starts(), pattern.rows(),
                                                                    detail::PivotOrder{order, order, blocks});
  ASSERT_TRUE(plan->is_listed());
  detail::SparseElimination<Number> elimination;
  elimination.follow(plan);
  const auto factor = [&](double a, double b, double c, double d) {  // columns (a, b) and (c, d)
    const std::vector<Number> values{a, b, c, d};
    elimination.scale_by(values.data());
    return elimination.factor(values.data());
  };
  EXPECT_TRUE(factor(1, 2, 3, 4));
  EXPECT_FALSE(factor(0, 2, 3, 4));     // the first pivot is zero
  EXPECT_FALSE(factor(1, 2, 2, 4));     // singular
  EXPECT_FALSE(factor(1e-9, 2, 3, 4));  // the multiplier is 2e9
  EXPECT_FALSE(factor(std::nan(""), 2, 3, 4));
  EXPECT_FALSE(factor(1, 2, 3, std::numeric_limits<double>::infinity()));
}

TEST(SparseElimination, IsNotPlannedBelowItsBlocksOrWhereItIsLong) {
  const SparsePattern pattern(2, std::vector<MatrixPlace>{{0, 1}, {1, 0}});
  const std::vector<std::int32_t> order{0, 1}, two_blocks{0, 1, 2};
  EXPECT_FALSE(detail::EliminationPlan(pattern.starts(), pattern.rows(), {order, order, two_blocks}).is_listed());
  std::vector<MatrixPlace> all;
  std::vector<std::int32_t> long_order;
  for (std::uint32_t i = 0; i < 100; ++i) {
    long_order.push_back(static_cast<std::int32_t>(i));
    for (std::uint32_t j = 0; j < 100; ++j) all.push_back({i, j});
  }
  const SparsePattern full(100, all);
  const std::vector<std::int32_t> one_block{0, 100};
  EXPECT_FALSE(detail::EliminationPlan(full.starts(), full.rows(), {long_order, long_order, one_block}).is_listed());
}

// What one factorization has found out about a pattern serves the next one, with other pivots in between as well, and
// several threads at once: the solutions are those of a pattern of which nothing is known, to the bit.
TEST(SparseElimination, SharesWhatIsKnownOfAPattern) {
  std::mt19937 engine(5);
  const SparsePattern shared = random_pattern(40, engine);
  std::vector<std::vector<double>> matrices(12, std::vector<double>(shared.entries()));
  for (auto& matrix : matrices)
    for (double& value : matrix) value = std::ldexp(random_number<double>(engine), static_cast<int>(engine() % 20));
  const auto solution = [](const SparsePattern& pattern, const std::vector<double>& matrix) {
    SparseLU<double> lu(pattern);
    std::ranges::copy(matrix, lu.values().begin());
    std::vector<double> x(pattern.size(), 1.0);
    if (!lu.factor()) return std::vector<double>{};
    lu.solve(x.data());
    return x;
  };
  std::vector<std::vector<double>> alone, together(matrices.size());
  for (const auto& matrix : matrices) {
    std::vector<MatrixPlace> places;
    for (std::size_t j = 0; j < shared.size(); ++j)
      for (std::size_t p = shared.begin(j); p < shared.end(j); ++p)
        places.push_back({static_cast<std::uint32_t>(shared.row(p)), static_cast<std::uint32_t>(j)});
    alone.push_back(solution(SparsePattern(shared.size(), places), matrix));
  }
  std::vector<std::thread> threads;
  for (std::size_t part = 0; part < 3; ++part)
    threads.emplace_back([&, part] {
      for (std::size_t round = 0; round < 20; ++round)
        for (std::size_t i = part; i < matrices.size(); i += 3) together[i] = solution(shared, matrices[i]);
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(together, alone);
  EXPECT_TRUE(std::ranges::any_of(alone, [](const auto& x) { return !x.empty(); }));
}

}  // namespace
}  // namespace continuo::sparse_elimination_test
