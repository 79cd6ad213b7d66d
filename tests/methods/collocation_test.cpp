// The coefficients of the collocation methods, derived at compile time, against the definition of such methods.
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <continuo/methods/collocation/collocation_table.hpp>

namespace continuo::collocation::collocation_test {
namespace {

using Quad = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;

// Coefficients carry 46 digits, and sums over seven stages with terms of some hundreds lose four of them.
constexpr double near_zero = 1e-40;

double size(const Coefficient& x) {
  return std::abs(x.as<double>());
}
Coefficient power(const Coefficient& x, std::size_t n) {
  Coefficient result = 1;
  for (std::size_t i = 0; i < n; ++i) result = result * x;
  return result;
}

// E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", IV.5: B(2s - 1), C(s), D(s - 1) make Radau IIA,
// B(2s), C(s), D(s) Gauss, and imply the order.
template <Nodes nodes, std::size_t s>
void expect_simplifying_assumptions() {
  const auto& node = c<nodes, s>;
  const auto a = find_a<nodes, s>();
  const auto b = find_b<nodes, s>();
  const std::size_t lost = nodes == Nodes::radau ? 1 : 0;
  for (std::size_t k = 1; k <= 2 * s - lost; ++k) {
    Coefficient sum = -(Coefficient(1) / k);
    for (std::size_t i = 0; i < s; ++i) sum += b[i] * power(node[i], k - 1);
    EXPECT_LT(size(sum), near_zero) << "B(" << k << "), s = " << s;
  }
  for (std::size_t k = 1; k <= s; ++k) {
    for (std::size_t i = 0; i < s; ++i) {
      Coefficient sum = -(power(node[i], k) / k);
      for (std::size_t j = 0; j < s; ++j) sum += a[i][j] * power(node[j], k - 1);
      EXPECT_LT(size(sum), near_zero) << "C(" << k << "), s = " << s;
    }
  }
  for (std::size_t k = 1; k <= s - lost; ++k) {
    for (std::size_t j = 0; j < s; ++j) {
      Coefficient sum = -(b[j] * (1 - power(node[j], k)) / k);
      for (std::size_t i = 0; i < s; ++i) sum += b[i] * power(node[i], k - 1) * a[i][j];
      EXPECT_LT(size(sum), near_zero) << "D(" << k << "), s = " << s;
    }
  }
}

TEST(Collocation, CoefficientsFulfilTheSimplifyingAssumptions) {
  expect_simplifying_assumptions<Nodes::radau, 3>();
  expect_simplifying_assumptions<Nodes::radau, 5>();
  expect_simplifying_assumptions<Nodes::radau, 7>();
  expect_simplifying_assumptions<Nodes::gauss, 2>();
}

// forward A^-1 back is block diagonal, forward back = 1: written as A back = back blocks^-1, without the inverse. The
// condition of the transformation is some hundreds.
template <Nodes nodes, std::size_t s>
void expect_transformation() {
  const auto numbers = make_table<Quad, nodes, s>();
  const auto a = find_a<nodes, s>();
  const double bound = 1e-30;
  std::array<std::array<Quad, s>, s> product{};
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t m = 0; m < s; ++m) {
      Quad identity = i == m ? -1 : 0;
      for (std::size_t j = 0; j < s; ++j) {
        identity += numbers.forward[i][j] * numbers.back[j][m];
        product[i][m] += a[i][j].template as<Quad>() * numbers.back[j][m];
      }
      EXPECT_LT(abs(identity), bound) << "s = " << s;
    }
  }
  // Columns of back: v, then 2 Re v, -2 Im v, with A (v_re + i v_im) (g + i d) = v_re + i v_im.
  for (std::size_t i = 0; i < s; ++i) {
    std::size_t m = 0;
    if (s % 2 == 1) {
      EXPECT_LT(abs(product[i][0] * numbers.eigenvalue[0] - numbers.back[i][0]), bound);
      m = 1;
    }
    for (; m < s; m += 2) {
      const Quad g = numbers.eigenvalue[m], d = numbers.eigenvalue[m + 1];
      EXPECT_LT(abs(product[i][m] * g + product[i][m + 1] * d - numbers.back[i][m]), bound);
      EXPECT_LT(abs(product[i][m + 1] * g - product[i][m] * d - numbers.back[i][m + 1]), bound);
    }
  }
}

TEST(Collocation, TransformationDiagonalizesTheInverseOfATo113Bits) {
  expect_transformation<Nodes::radau, 3>();
  expect_transformation<Nodes::radau, 5>();
  expect_transformation<Nodes::radau, 7>();
  expect_transformation<Nodes::gauss, 2>();
}

// The closed forms in Hairer & Wanner II, tables IV.5.6 and eq. IV.8.13: nodes, an entry of A, the real eigenvalue.
TEST(Collocation, RadauOfThreeStagesIsTheOneInTheBooks) {
  const Quad root6 = sqrt(Quad(6)), third = Quad(1) / 3, bound = 1e-32;
  const auto numbers = make_table<Quad, Nodes::radau, 3>();
  EXPECT_LT(abs(numbers.c[0] - (4 - root6) / 10), bound);
  EXPECT_LT(abs(numbers.c[1] - (4 + root6) / 10), bound);
  EXPECT_EQ(numbers.c[2], 1);
  const auto a = find_a<Nodes::radau, 3>();
  EXPECT_LT(abs(a[0][0].as<Quad>() - (88 - 7 * root6) / 360), bound);
  EXPECT_LT(abs(a[1][2].as<Quad>() - (-2 - 3 * root6) / 225), bound);
  EXPECT_LT(abs(1 / numbers.eigenvalue[0] - (6 + pow(Quad(81), third) - pow(Quad(9), third)) / 30), bound);
  // The weights of the estimate: -(13 + 7 sqrt 6)/3, (-13 + 7 sqrt 6)/3, -1/3, with the opposite sign a slope at 0.
  EXPECT_LT(abs(numbers.powers[0][0] - (13 + 7 * root6) / 3), 10 * bound);
  EXPECT_LT(abs(numbers.powers[0][1] - (13 - 7 * root6) / 3), 10 * bound);
  EXPECT_LT(abs(numbers.powers[0][2] - third), 10 * bound);
}

TEST(Collocation, GaussOfTwoStagesIsTheOneInTheBooks) {
  const auto numbers = make_table<Quad, Nodes::gauss, 2>();
  const Quad root3 = sqrt(Quad(3)), bound = 1e-32;
  EXPECT_LT(abs(numbers.c[0] - (3 - root3) / 6), bound);
  EXPECT_LT(abs(numbers.eigenvalue[0] - 3), bound);
  EXPECT_LT(abs(numbers.eigenvalue[1] - root3), bound);
  // x_new = x + b A^-1 Z.
  EXPECT_LT(abs(numbers.end[0] + root3), 10 * bound);
  EXPECT_LT(abs(numbers.end[1] - root3), 10 * bound);
}

}  // namespace
}  // namespace continuo::collocation::collocation_test
