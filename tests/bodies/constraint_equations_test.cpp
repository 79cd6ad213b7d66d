// The equations of constraints are solved as those of an orthogonal decomposition, whether they depend on each other,
// are symmetric, or not.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_rigid/constraint_equations.hpp>

namespace continuo::constraint_equations_test {
namespace {

struct Equations {
  std::size_t n = 0;
  std::vector<double> matrix;  // column by column
  /// Those of rows of forces on bodies with few neighbours: the first `n - slipping` symmetric, the others with
  /// friction. Of the symmetric ones, `dependent` are sums of others.
  Equations(std::mt19937& engine, std::size_t size, std::size_t slipping, std::size_t dependent) : n(size) {
    const auto number = [&] { return std::uniform_real_distribution(-1.0, 1.0)(engine); };
    const std::size_t ways = 2 * n;
    std::vector<double> rows(n * ways);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < 4; ++k) rows[i * ways + engine() % ways] += 3 * number();
    for (std::size_t i = 0; i < n; ++i) rows[i * ways + i] += 1;
    for (std::size_t d = 0; d < dependent; ++d)
      for (std::size_t w = 0; w < ways; ++w)
        rows[(d + 3) * ways + w] = rows[d * ways + w] - 2 * rows[(d + 1) * ways + w];
    std::vector<double> pushes = rows;
    for (std::size_t i = n - slipping; i < n; ++i)
      for (std::size_t w = 0; w < ways; ++w) pushes[i * ways + w] += 0.2 * number();
    matrix.resize(n * n);
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t w = 0; w < ways; ++w) matrix[j * n + i] += rows[i * ways + w] * pushes[j * ways + w];
  }
  [[nodiscard]] double residual(const std::vector<double>& x, const std::vector<double>& b) const {
    double greatest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      long double sum = -static_cast<long double>(b[i]);
      for (std::size_t j = 0; j < n; ++j) sum += static_cast<long double>(matrix[j * n + i]) * x[j];
      greatest = std::max(greatest, static_cast<double>(std::abs(sum)));
    }
    return greatest;
  }
};

TEST(ConstraintEquations, AreSolvedAsByAnOrthogonalDecomposition) {
  std::mt19937 engine(3);
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t n = 6 + engine() % 40, slipping = engine() % 4, dependent = trial % 4 == 0 ? engine() % 3 : 0;
    const Equations of(engine, n, slipping, dependent);
    std::vector<double> wanted(n), b(n);  // b has a solution
    for (double& part : wanted) part = std::uniform_real_distribution(-1.0, 1.0)(engine);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) b[i] += of.matrix[j * n + i] * wanted[j];
    ConstraintEquations<double> equations;
    MinimumNorm<double> orthogonal;
    equations.factor(n, of.matrix), orthogonal.factor(n, of.matrix);
    EXPECT_EQ(equations.rank(), orthogonal.rank()) << trial;
    EXPECT_EQ(equations.rank(), n - dependent) << trial;
    EXPECT_EQ(equations.determinant_sign(), orthogonal.determinant_sign()) << trial;
    EXPECT_EQ(equations.independent().size(), equations.rank()) << trial;
    std::vector<double> x = b, other = b;
    equations.solve(x), orthogonal.solve(other);
    EXPECT_LT(of.residual(x, b), 1e-11) << trial;
    double size = 0, apart = 0;
    for (std::size_t i = 0; i < n; ++i) size += x[i] * x[i], apart += (x[i] - other[i]) * (x[i] - other[i]);
    EXPECT_LT(std::sqrt(apart), 1e-8 * (1 + std::sqrt(size))) << trial;
  }
}

}  // namespace
}  // namespace continuo::constraint_equations_test
