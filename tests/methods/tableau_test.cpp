// Every tableau satisfies all conditions of the order that its method states, in 50-digit arithmetic, to 1e-24. The
// bound follows from DOP853, which is printed to 30 digits and whose conditions of order 8 multiply those errors by up
// to 1e5.
#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "rooted_trees.hpp"
#include <continuo/methods/all.hpp>

namespace continuo::tableau_test {
namespace {

using boost::multiprecision::cpp_bin_float_50;
using Real = boost::multiprecision::number<cpp_bin_float_50::backend_type, boost::multiprecision::et_off>;
using Row = std::vector<Real>;

const Real bound("1e-24");

template <std::size_t N>
Row row(const Coefficient (&from)[N], std::size_t size) {
  Row result(size, Real(0));
  for (std::size_t j = 0; j < N; ++j) result[j] = from[j].template as<Real>();
  return result;
}

/// The matrix of all slopes that the interpolant uses: the stages, f at the end (whose argument is x_new), the extra
/// stages.
template <class M>
std::vector<Row> matrix() {
  constexpr auto& tableau = M::tableau;
  std::vector<Row> a;
  for (std::size_t i = 0; i < tableau.stages; ++i) a.push_back(row(tableau.a[i], tableau.known));
  a.push_back(row(tableau.b, tableau.known));
  for (std::size_t i = 0; i < tableau.extra; ++i) a.push_back(row(tableau.extra_a[i], tableau.known));
  return a;
}

/// The largest violation of the conditions for trees of exactly `nodes` nodes at theta.
Real violation(const std::vector<testing::RootedTree>& forest, const std::vector<Row>& phi, const Row& weights,
               int nodes, const Real& theta = Real(1)) {
  Real worst(0);
  for (std::size_t n = 0; n < forest.size(); ++n) {
    if (forest[n].nodes != nodes) continue;
    Real sum = -pow(theta, nodes) / Real(forest[n].density);
    for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * phi[n][i];
    worst = std::max(worst, Real(abs(sum)));
  }
  return worst;
}

/// Meets every condition up to `order`, and not all of the next.
void expect_order(const std::vector<testing::RootedTree>& forest, const std::vector<Row>& phi, const Row& weights,
                  int order) {
  for (int nodes = 1; nodes <= order; ++nodes) EXPECT_LT(violation(forest, phi, weights, nodes), bound) << nodes;
  EXPECT_GT(violation(forest, phi, weights, order + 1), Real("1e-9")) << "the order is higher than stated";
}

template <class M>
class TableauOf : public ::testing::Test {
 protected:
  const std::vector<testing::RootedTree> forest = testing::rooted_trees(M::order + 1);
  const std::vector<Row> a = matrix<M>();
  const std::vector<Row> phi = testing::elementary_weights(forest, a);
};

struct NameOfMethod {
  template <class M>
  static std::string GetName(int) {
    return std::string(M::name);
  }
};
using Methods = ::testing::Types<ExplicitEuler, Midpoint, Heun, Rk4, Rk38, BogackiShampine3, DormandPrince5, Tsitouras5,
                                 Dop853, Verner7, Verner9>;
TYPED_TEST_SUITE(TableauOf, Methods, NameOfMethod);

TEST(RootedTrees, AreAsManyAsCayleyCounted) {
  const auto forest = testing::rooted_trees(10);
  const std::vector<int> expected{1, 1, 2, 4, 9, 20, 48, 115, 286, 719};
  for (int nodes = 1; nodes <= 10; ++nodes) {
    EXPECT_EQ(std::count_if(forest.begin(), forest.end(), [&](const auto& tree) { return tree.nodes == nodes; }),
              expected[static_cast<std::size_t>(nodes - 1)]);
  }
}

TYPED_TEST(TableauOf, RowsSumToTheirNodes) {
  constexpr auto& tableau = TypeParam::tableau;
  const auto expect_sum = [](const Row& weights, const Coefficient& c) {
    Real sum = -c.as<Real>();
    for (const Real& entry : weights) sum += entry;
    EXPECT_LT(abs(sum), bound);
  };
  for (std::size_t i = 0; i < tableau.stages; ++i) expect_sum(this->a[i], tableau.c[i]);
  for (std::size_t i = 0; i < tableau.extra; ++i) expect_sum(this->a[tableau.stages + 1 + i], tableau.extra_c[i]);
}

TYPED_TEST(TableauOf, IsExplicit) {
  for (std::size_t i = 0; i < this->a.size(); ++i) {
    for (std::size_t j = i; j < this->a.size(); ++j) EXPECT_EQ(this->a[i][j], 0) << i << " " << j;
  }
}

TYPED_TEST(TableauOf, MeetsTheConditionsOfItsOrderAndNoMore) {
  expect_order(this->forest, this->phi, row(TypeParam::tableau.b, TypeParam::tableau.known), TypeParam::order);
}

TYPED_TEST(TableauOf, TheEmbeddedSolutionHasItsOrderAndNoMore) {
  constexpr auto& tableau = TypeParam::tableau;
  if constexpr (std::is_same_v<TypeParam, Dop853>) {
    Row fifth = row(tableau.b, tableau.known);
    for (std::size_t j = 0; j < 12; ++j) fifth[j] -= dop853::error5[j].template as<Real>();
    expect_order(this->forest, this->phi, fifth, 5);
    expect_order(this->forest, this->phi, row(dop853::third_order, tableau.known), 3);
  } else if constexpr (TypeParam::error_order > 0) {
    expect_order(this->forest, this->phi, row(tableau.embedded, tableau.known), TypeParam::error_order);
  } else {
    for (const Coefficient& weight : tableau.embedded) EXPECT_TRUE(weight.is_zero());
  }
}

/// The weights at theta: cubic Hermite and theta^2 (1 - theta)^2 times the polynomial of the tableau.
template <class M>
Row weights_at(const Real& theta) {
  constexpr auto& tableau = M::tableau;
  constexpr std::size_t end = tableau.first_same_as_last() ? tableau.stages - 1 : tableau.end;
  Row weights = row(tableau.b, tableau.known);
  for (Real& weight : weights) weight *= theta * theta * (3 - 2 * theta);
  weights[0] += theta * (1 - theta) * (1 - theta);
  weights[end] -= theta * theta * (1 - theta);
  for (std::size_t i = 0; i < tableau.known; ++i) {
    Real sum(0);
    for (std::size_t j = tableau.dense_terms; j-- > 0;) sum = sum * theta + tableau.dense[i][j].template as<Real>();
    weights[i] += theta * theta * (1 - theta) * (1 - theta) * sum;
  }
  return weights;
}

TYPED_TEST(TableauOf, TheInterpolantMeetsTheConditionsOfItsOrderBetweenTheSteps) {
  for (const Real& theta : {Real("0.125"), Real("0.3"), Real("0.5"), Real("0.77"), Real("0.96875")}) {
    const Row weights = weights_at<TypeParam>(theta);
    for (int nodes = 1; nodes <= TypeParam::dense_order; ++nodes) {
      EXPECT_LT(violation(this->forest, this->phi, weights, nodes, theta), bound) << theta << " " << nodes;
    }
  }
}

TYPED_TEST(TableauOf, TheInterpolantHasNoHigherOrderThanStated) {
  Real worst(0);
  for (const Real& theta : {Real("0.3"), Real("0.5"), Real("0.77")}) {
    worst = std::max(
        worst, violation(this->forest, this->phi, weights_at<TypeParam>(theta), TypeParam::dense_order + 1, theta));
  }
  EXPECT_GT(worst, Real("1e-9"));
}

/// The published interpolant of Verner's pairs is x + h sum_ij weights[i][j] theta^(j+1) k_i; its division by theta^2
/// (1 - theta)^2 must have no remainder, or the interpolant would not match values and slopes at the ends.
template <class M, std::size_t Known, std::size_t Degree>
void expect_no_rest(const Coefficient (&published)[Known][Degree]) {
  for (const Real& theta : {Real("0.3"), Real("0.9")}) {
    const Row weights = weights_at<M>(theta);
    for (std::size_t i = 0; i < Known; ++i) {
      Real sum(0);
      for (std::size_t j = Degree; j-- > 0;) sum = (sum + published[i][j].template as<Real>()) * theta;
      // Printed to 40 digits, the largest of them some 1e4.
      EXPECT_LT(abs(sum - weights[i]), Real("1e-33")) << i;
    }
  }
}
TEST(Verner7, TheInterpolantIsThePublishedOne) {
  expect_no_rest<Verner7>(verner7::interpolation);
}
TEST(Verner9, TheInterpolantLeavesNoRest) {
  expect_no_rest<Verner9>(verner9::interpolation);
}

}  // namespace
}  // namespace continuo::tableau_test
