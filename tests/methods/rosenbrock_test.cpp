// The Rosenbrock methods: their coefficients meet the order conditions, their measured order is the stated one, on
// stiff problems too, and they solve systems with algebraic equations.
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <bench/problems/robertson.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "implicit_problems.hpp"
#include "rooted_trees.hpp"
#include "solved_by_name.hpp"
#include <continuo/methods/rosenbrock/rodas4.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/methods/rosenbrock/rosenbrock23.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::rosenbrock_test {
namespace {

using Real =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float_50::backend_type, boost::multiprecision::et_off>;
using Row = std::vector<Real>;
using Matrix = std::vector<Row>;

/// alpha_ij, beta_ij = alpha_ij + gamma_ij and the weights b, embedded of the k_i, from the coefficients of the u_i:
/// gamma = (1 / gamma - c)^-1, alpha = a gamma, b = m gamma (E. Hairer, G. Wanner II, IV.7, before eq. 7.25).
struct Classical {
  Matrix alpha, beta;
  Row b, embedded;
};

template <class M>
Classical classical() {
  constexpr auto& tableau = M::tableau;
  constexpr std::size_t s = tableau.stages;
  const Real g = tableau.gamma.template as<Real>();
  Matrix gamma(s, Row(s, Real(0)));
  for (std::size_t j = 0; j < s; ++j) {  // (1 / g) gamma_ij = delta_ij + sum_k<i c_ik gamma_kj
    for (std::size_t i = j; i < s; ++i) {
      Real sum(i == j ? 1 : 0);
      for (std::size_t k = j; k < i; ++k) sum += tableau.c[i][k].template as<Real>() * gamma[k][j];
      gamma[i][j] = g * sum;
    }
  }
  Classical result{Matrix(s, Row(s, Real(0))), gamma, Row(s, Real(0)), Row(s, Real(0))};
  for (std::size_t j = 0; j < s; ++j) {
    for (std::size_t k = 0; k < s; ++k) {
      const Real m = tableau.m[k].template as<Real>();
      result.b[j] += m * gamma[k][j];
      result.embedded[j] += (m - tableau.error[k].template as<Real>()) * gamma[k][j];
      for (std::size_t i = 0; i < s; ++i) result.alpha[i][j] += tableau.a[i][k].template as<Real>() * gamma[k][j];
    }
  }
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < s; ++j) result.beta[i][j] += result.alpha[i][j];
  }
  return result;
}

/// phi_i(tree) of a Rosenbrock method: through alpha where a node has several branches, through beta where it has one
/// (ibid., theorem 7.4).
Matrix rosenbrock_weights(const std::vector<testing::RootedTree>& forest, const Classical& method) {
  const std::size_t s = method.b.size();
  Matrix weights;
  for (const testing::RootedTree& tree : forest) {
    const Matrix& through = tree.branches.size() == 1 ? method.beta : method.alpha;
    Row phi(s, Real(1));
    for (const std::size_t branch : tree.branches) {
      for (std::size_t i = 0; i < s; ++i) {
        Real sum(0);
        for (std::size_t j = 0; j < s; ++j) sum += through[i][j] * weights[branch][j];
        phi[i] *= sum;
      }
    }
    weights.push_back(phi);
  }
  return weights;
}

Real violation(const std::vector<testing::RootedTree>& forest, const Matrix& phi, const Row& b, int nodes) {
  Real worst(0);
  for (std::size_t n = 0; n < forest.size(); ++n) {
    if (forest[n].nodes != nodes) continue;
    Real sum = -1 / Real(forest[n].density);
    for (std::size_t i = 0; i < b.size(); ++i) sum += b[i] * phi[n][i];
    worst = std::max(worst, Real(abs(sum)));
  }
  return worst;
}

template <class M>
class Rosenbrock : public ::testing::Test {
 protected:
  /// Rodas4 and Rodas5P are printed to 16 digits; sums of terms up to 1e2 lose two of them, products along a tree
  /// three.
  static Real bound() { return Real(M::order == 2 ? "1e-44" : "1e-12"); }
};
struct NameOfMethod {
  template <class M>
  static std::string GetName(int) {
    return std::string(M::name);
  }
};
using Methods = ::testing::Types<Rosenbrock23, Rodas4, Rodas5P>;
TYPED_TEST_SUITE(Rosenbrock, Methods, NameOfMethod);

TYPED_TEST(Rosenbrock, MeetsTheConditionsOfItsOrderAndNoMore) {
  const auto forest = testing::rooted_trees(TypeParam::order + 1);
  const Classical method = classical<TypeParam>();
  const Matrix phi = rosenbrock_weights(forest, method);
  for (int nodes = 1; nodes <= TypeParam::order; ++nodes)
    EXPECT_LT(violation(forest, phi, method.b, nodes), this->bound()) << nodes;
  EXPECT_GT(violation(forest, phi, method.b, TypeParam::order + 1), Real("1e-6"));
}

// Rosenbrock23 keeps the solution of order 2 and compares it with one of order 3: its estimate is the error itself.
TYPED_TEST(Rosenbrock, TheEmbeddedSolutionHasItsOrder) {
  const auto forest = testing::rooted_trees(TypeParam::order + 1);
  const Classical method = classical<TypeParam>();
  const Matrix phi = rosenbrock_weights(forest, method);
  const int order = TypeParam::order == 2 ? 3 : TypeParam::error_order;
  for (int nodes = 1; nodes <= order; ++nodes)
    EXPECT_LT(violation(forest, phi, method.embedded, nodes), this->bound()) << nodes;
  if (order < TypeParam::order) {
    EXPECT_GT(violation(forest, phi, method.embedded, order + 1), Real("1e-6"));
  }
}

TYPED_TEST(Rosenbrock, NodesAreTheSumsOfTheirRows) {
  constexpr auto& tableau = TypeParam::tableau;
  const Classical method = classical<TypeParam>();
  for (std::size_t i = 0; i < tableau.stages; ++i) {
    Real alpha(0), beta(0);
    for (std::size_t j = 0; j < tableau.stages; ++j) alpha += method.alpha[i][j], beta += method.beta[i][j];
    EXPECT_LT(abs(alpha - tableau.alpha[i].template as<Real>()), this->bound()) << i;
    EXPECT_LT(abs(beta - alpha - tableau.gamma_sum[i].template as<Real>()), this->bound()) << i;
  }
}

// R(infinity) = 1 - b^T beta^-1 1, where beta is the matrix of stages (IV.7, eq. 7.16); the matrix is lower triangular.
TYPED_TEST(Rosenbrock, IsZeroAtInfinity) {
  const Classical method = classical<TypeParam>();
  Row y(method.b.size());
  Real at_infinity(1);
  for (std::size_t i = 0; i < y.size(); ++i) {
    Real sum(1);
    for (std::size_t j = 0; j < i; ++j) sum -= method.beta[i][j] * y[j];
    y[i] = sum / method.beta[i][i];
    at_infinity -= method.b[i] * y[i];
  }
  EXPECT_LT(abs(at_infinity), this->bound());
}

TYPED_TEST(Rosenbrock, HasItsOrderWhereFDependsOnTime) {
  const auto error = [](int n) { return testing::error_of_steps<TypeParam, testing::Forced>(n); };
  // From 64 steps on: the leading error of Rodas5P is small, the next one (h^6) is not.
  EXPECT_NEAR(testing::measured_order(error, 64), TypeParam::order, 0.25);
}

TYPED_TEST(Rosenbrock, HasItsOrderInTheUnknownOfAnAlgebraicEquation) {
  const auto error = [](int n) { return testing::error_of_steps<TypeParam, testing::Circle>(n); };
  EXPECT_GT(testing::measured_order(error, 16), TypeParam::order - 0.2);
}

TYPED_TEST(Rosenbrock, TheInterpolantHasTheStatedOrder) {
  const auto forced = [](int n) { return testing::dense_error<TypeParam, testing::Forced>(n); };
  EXPECT_NEAR(testing::measured_order(forced, 8), TypeParam::dense_order + 1, 0.3);
  // Algebraic variables are not integrated: one power of h less inside a step, the same order over a run.
  const auto algebraic = [](int n) { return testing::dense_error<TypeParam, testing::Circle>(n); };
  EXPECT_GT(testing::measured_order(algebraic, 8), TypeParam::dense_order - 0.3);
}

// lambda = -1e6. The error is h^q / lambda or h^q; measured are q = 2, 1 and 3 (E. Hairer, G. Wanner II, IV.15 and
// G. Steinebach 2023: Rodas5P was made for this), and errors far below those of h^order alone.
TYPED_TEST(Rosenbrock, LosesThatMuchOrderOnProtheroRobinson) {
  const auto error = [](int n) { return testing::error_of_steps<TypeParam, testing::ProtheroRobinson>(n); };
  const double order = TypeParam::order == 2 ? 2 : TypeParam::order == 4 ? 1 : 3;
  const double bound = TypeParam::order == 2 ? 8e-5 : TypeParam::order == 4 ? 7e-10 : 3e-13;  // as measured
  EXPECT_NEAR(testing::measured_order(error, 32), order, 0.2);
  EXPECT_LT(static_cast<double>(error(64)), bound);
}

TYPED_TEST(Rosenbrock, MeetsTheToleranceOnRobertson) {
  using Problem = bench::Robertson<double>;
  const auto reference = bench::end_of<Problem>();
  for (const double rtol : {1e-3, 1e-5, 1e-7}) {
    if (rtol == 1e-7 && TypeParam::order == 2) continue;  // 1e5 steps: the method is not meant for this
    const auto solution = promises::solved_by_name<TypeParam, Problem>(rtol, rtol * 1e-8);
    ASSERT_EQ(solution.outcome.ending, Ending::reached_end);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(solution.final_state()[i], reference[i], 30 * rtol * reference[i]) << rtol << " " << i;
    const auto& x = solution.final_state();
    EXPECT_NEAR(x[0] + x[1] + x[2], 1, 1e-11);                            // round-off: 1e4 steps of some units of 1e-16
    EXPECT_EQ(solution.statistics.jacobians, solution.statistics.steps);  // one for each start, rejected or not
    EXPECT_EQ(solution.statistics.factorizations, solution.statistics.steps + solution.statistics.rejected);
  }
}

TYPED_TEST(Rosenbrock, AVectorGivesTheSameAsAnArray) {
  const auto by_array =
      solve(testing::any_problem<double, testing::Circle>(), std::array<double, 2>{0, 1}, {0.0, 1.0}, TypeParam{});
  const auto by_vector = solve(testing::Circle{}, std::vector<double>{0, 1}, {0.0, 1.0}, TypeParam{});
  ASSERT_EQ(by_vector.outcome.ending, Ending::reached_end);
  EXPECT_EQ(by_array.statistics.steps, by_vector.statistics.steps);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(by_array.final_state()[i], by_vector.final_state()[i], 1e-12);
}

TYPED_TEST(Rosenbrock, DifferencesServeWhereNoDerivativesAreGiven) {
  const auto given =
      solve(testing::any_problem<double, testing::Forced>(), std::array<double, 2>{0, 1}, {0.0, 1.0}, TypeParam{});
  const auto taken =
      solve(testing::any_function<testing::ForcedAlone>(), std::array<double, 2>{0, 1}, {0.0, 1.0}, TypeParam{});
  EXPECT_EQ(given.statistics.steps, taken.statistics.steps);
  EXPECT_GT(taken.statistics.evaluations, given.statistics.evaluations);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(given.final_state()[i], taken.final_state()[i], 1e-8);
}

TYPED_TEST(Rosenbrock, ARunGoesOnFromACopyBitByBit) {
  Integrator run(testing::any_problem<double, testing::Forced>(), std::array<double, 2>{0, 1}, {0.0, 40.0}, TypeParam{},
                 {.rtol = 1e-5, .atol = 1e-12});
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(run.advance());
  auto copy = run;
  while (run.advance()) continue;
  while (copy.advance()) continue;
  EXPECT_EQ(run.t(), copy.t());
  EXPECT_EQ(run.x(), copy.x());
}

TYPED_TEST(Rosenbrock, FailuresHaveTheirOutcome) {
  const std::array<double, 2> x0{1, 0};
  const auto lost = solve(testing::any_function<testing::LostUnknown>(), x0, {0.0, 1.0}, TypeParam{});
  EXPECT_EQ(lost.outcome.ending, Ending::nonlinear_solve_failed);
  EXPECT_NE(lost.outcome.hint.find("singular"), std::string::npos) << lost.outcome.hint;
  const auto wall = solve(testing::any_function<testing::NotANumberBeyond>(), x0, {0.0, 1.0}, TypeParam{});
  EXPECT_EQ(wall.outcome.ending, Ending::not_finite);
  EXPECT_NEAR(wall.outcome.t, 0.5, 1e-8);  // df/dt by a difference evaluates f sqrt(epsilon) t ahead
  const auto bad = solve(testing::any_problem<double, testing::NotANumberInJacobian>(), x0, {0.0, 1.0}, TypeParam{});
  EXPECT_EQ(bad.outcome.ending, Ending::not_finite);
}

struct Robertson : bench::Robertson<double> {
  bool autonomous = true;
};
TEST(RosenbrockMethod, ASystemThatSaysSoIsSpentNoEvaluationForTime) {
  const Options<std::array<double, 3>> options{.step = 1e-3};
  Robertson silent;
  silent.autonomous = false;
  const auto known = solve(Robertson{}, Robertson::start(), {0.0, 0.01}, Rodas4{}, options);
  const auto unknown = solve(silent, Robertson::start(), {0.0, 0.01}, Rodas4{}, options);
  EXPECT_EQ(known.statistics.evaluations, 60U);
  EXPECT_EQ(unknown.statistics.evaluations, 70U);
  EXPECT_EQ(known.final_state(), unknown.final_state());
}

// 700,000 steps, in which the third amount slowly approaches 1: without compensated sums the rounding of the steps adds
// up to 2e-13. With them the amounts add up to 1 within the rounding of the three.
TEST(Rosenbrock23, RoundingIsNotAddedUp) {
  const auto solution = promises::solved_by_name<Rosenbrock23, bench::Robertson<>>(1e-8, 1e-18);
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_GT(solution.statistics.steps, 500'000U);
  const auto& x = solution.final_state();
  EXPECT_NEAR(x[0] + x[1] + x[2], 1, 3e-16);
}

}  // namespace
}  // namespace continuo::rosenbrock_test
