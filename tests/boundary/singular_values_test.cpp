// The pseudo-inverse of singular matrices against the four equations that define it.
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/boundary/singular_values.hpp>

namespace continuo::boundary::singular_values_test {
namespace {

using Complex = ComplexNumber<double>;
using Matrix = std::vector<Complex>;

Matrix product(const Matrix& a, const Matrix& b, std::size_t n) {
  Matrix c(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t j = 0; j < n; ++j) c[i * n + j] += a[i * n + k] * b[k * n + j];
  return c;
}

Matrix adjoint(const Matrix& a, std::size_t n) {
  Matrix c(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) c[j * n + i] = conjugate(a[i * n + j]);
  return c;
}

double size(const Matrix& a) {
  double greatest = 0;
  for (const Complex& entry : a) greatest = std::max(greatest, size_of(entry));
  return greatest;
}

void expect_equal(const Matrix& a, const Matrix& b, double tolerance) {
  for (std::size_t e = 0; e < a.size(); ++e) EXPECT_LE(size_of(a[e] - b[e]), tolerance);
}

/// A random matrix of this rank: the sum of so many products of a column and a row.
Matrix of_rank(std::size_t rank, std::size_t n, double scale, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Matrix a(n * n);
  for (std::size_t r = 0; r < rank; ++r) {
    Matrix column(n), row(n);
    for (std::size_t i = 0; i < n; ++i)
      column[i] = {normal(random) * scale, normal(random) * scale}, row[i] = {normal(random), normal(random)};
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) a[i * n + j] += column[i] * row[j];
  }
  return a;
}

TEST(SingularValues, MeetTheEquationsOfPenrose) {
  std::mt19937 random(1);
  for (const double scale : {1.0, 1e-200, 1e200})
    for (std::size_t n = 1; n <= 5; ++n)
      for (std::size_t rank = 0; rank <= n; ++rank) {
        const Matrix a = of_rank(rank, n, scale, random);
        const SingularValues<Complex> of(a, n);
        const Matrix inverse = of.pseudo_inverse();
        const Matrix left = product(inverse, a, n), right = product(a, inverse, n);
        // Rounding in products of n terms, which the condition number enlarges.
        const double condition = size(a) * size(inverse) + 1;
        const double rounding = 100 * std::numeric_limits<double>::epsilon() * condition * condition;
        expect_equal(left, adjoint(left, n), rounding);
        expect_equal(right, adjoint(right, n), rounding);
        expect_equal(product(right, a, n), a, rounding * size(a));
        expect_equal(product(left, inverse, n), inverse, rounding * size(inverse));
        const Matrix projector = of.null_projector();
        expect_equal(product(projector, projector, n), projector, rounding);
        expect_equal(product(a, projector, n), Matrix(n * n), rounding * size(a));
        Complex trace{};
        for (std::size_t i = 0; i < n; ++i) trace += projector[i * n + i];
        EXPECT_NEAR(trace.re, static_cast<double>(n - rank), 1e-9);
      }
}

TEST(SingularValues, AreExactWhereThereIsNothingToRotate) {
  const std::vector<double> a{0, 0, 0, -2};
  const SingularValues<double> of(a, 2);
  EXPECT_EQ(of.pseudo_inverse(), (std::vector<double>{0, 0, 0, -0.5}));
  EXPECT_EQ(of.null_projector(), (std::vector<double>{1, 0, 0, 0}));
}

}  // namespace
}  // namespace continuo::boundary::singular_values_test
