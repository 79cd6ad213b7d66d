// The entries of a pattern are used wherever a system gives them, whatever its size and the scalar of its state, and
// beside a mass matrix: no Jacobian is taken by differences then.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/methods/implicit/linearization.hpp>
#include <continuo/solve/steps/consistent.hpp>

namespace continuo::jacobian_values_test {
namespace {

/// x_i' = -(i + 1) x_i^2 + x_(i+1), and x_0 in the last row where `cyclic`; a pattern that is full if asked for.
template <class X>
struct Chain {
  using Real = Scalar<X>;
  std::size_t size;
  SparsePattern pattern;
  int calls = 0, evaluations = 0;

  Chain(std::size_t n, bool full) : size(n) {
    std::vector<MatrixPlace> places;
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = 0; j < n; ++j)
        if (full || j == i + 1 || (i + 1 == n && j == 0)) places.push_back({i, j});
    pattern = SparsePattern(n, places);
  }
  void operator()(Real, const X& x, X& dxdt) {
    ++evaluations;
    for (std::size_t i = 0; i < size; ++i)
      dxdt[i] = -Real(static_cast<double>(i + 1)) * x[i] * x[i] + x[(i + 1) % size];
  }
  const SparsePattern& jacobian_pattern() const { return pattern; }
  void jacobian_values(Real, const X& x, std::span<Real> values) {
    ++calls;
    for (std::size_t j = 0; j < size; ++j) {
      for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p) {
        if (pattern.row(p) == j) values[p] += -2 * Real(static_cast<double>(j + 1)) * x[j];
        if ((pattern.row(p) + 1) % size == j) values[p] += Real(1);
      }
    }
  }
};

/// The same with a mass matrix, beside which no sparse solver is used.
template <class X>
struct HeavyChain : Chain<X> {
  using Chain<X>::Chain;
  void mass_matrix(std::span<Scalar<X>> rows) const {
    for (std::size_t i = 0; i < this->size; ++i) rows[i * this->size + i] = Scalar<X>(2);
  }
};

template <class System, class X>
void expect_exact_rows(System system, const X& x) {
  using Real = Scalar<X>;
  Linearization<X> linear(x);
  linear.prepare(system, x);
  ASSERT_FALSE(linear.sparse());
  X fx = x;
  const int evaluations = linear.evaluate(system, Real(0), x, fx, [](std::size_t) { return Real(1); });
  EXPECT_EQ(evaluations, 0);
  EXPECT_EQ(system.evaluations, 0);
  EXPECT_EQ(system.calls, 1);
  for (std::size_t i = 0; i < system.size; ++i) {
    for (std::size_t j = 0; j < system.size; ++j) {
      Real expected = i == j ? Real(-2 * Real(static_cast<double>(j + 1)) * x[j]) : Real(0);
      if ((i + 1) % system.size == j) expected += Real(1);
      EXPECT_EQ(linear.entries()[i * system.size + j], expected) << i << ", " << j;
    }
  }
}

TEST(JacobianValues, FillTheRowsOfStatesThatAreNotSolvedSparse) {
  expect_exact_rows(Chain<std::array<double, 3>>(3, false), std::array{1.0, 2.0, 3.0});
  expect_exact_rows(Chain<std::array<double, 3>>(3, true), std::array{1.0, 2.0, 3.0});
  expect_exact_rows(Chain<std::array<float, 3>>(3, false), std::array{1.0F, 2.0F, 3.0F});
  expect_exact_rows(Chain<std::array<double, 1>>(1, false), std::array{0.5});
  std::vector<double> few(5, 0.7), many(24, -0.3);
  few[2] = 4;
  expect_exact_rows(Chain<std::vector<double>>(5, false), few);
  expect_exact_rows(Chain<std::vector<double>>(24, true), many);
  expect_exact_rows(HeavyChain<std::vector<double>>(24, false), many);
  expect_exact_rows(Chain<std::vector<long double>>(24, false), std::vector<long double>(24, 0.3L));
}

/// x' = z, 0 = x - z^3.
struct Root {
  using X = std::array<double, 2>;
  SparsePattern pattern{2, std::vector<MatrixPlace>{{0, 1}, {1, 0}, {1, 1}}};
  int calls = 0;

  void operator()(double, const X& x, X& dxdt) const { dxdt = {x[1], x[0] - x[1] * x[1] * x[1]}; }
  double mass(std::size_t i) const { return i == 0 ? 1 : 0; }
  const SparsePattern& jacobian_pattern() const { return pattern; }
  void jacobian_values(double, const X& x, std::span<double> values) {
    ++calls;
    values[pattern.find(0, 1)] = 1;
    values[pattern.find(1, 0)] = 1;
    values[pattern.find(1, 1)] = -3 * x[1] * x[1];
  }
};

TEST(JacobianValues, LeadToTheUnknownsOfAlgebraicEquations) {
  Root system;
  Root::X x{8, 1.5};
  const Consistency found = make_consistent(system, 0.0, x, Tolerance<double>{1e-10, 1e-10});
  ASSERT_TRUE(found);
  EXPECT_NEAR(x[1], 2, 4e-10);
  EXPECT_GT(system.calls, 1);
}

}  // namespace
}  // namespace continuo::jacobian_values_test
