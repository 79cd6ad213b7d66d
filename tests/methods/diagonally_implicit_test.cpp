// The diagonally implicit methods: their coefficients meet the order conditions, their measured order is the stated
// one, also on stiff problems, for algebraic equations and for systems in two parts.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <bench/problems/robertson.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "implicit_problems.hpp"
#include "rooted_trees.hpp"
#include "solved_by_name.hpp"
#include <continuo/methods/dirk/implicit_euler.hpp>
#include <continuo/methods/dirk/implicit_midpoint.hpp>
#include <continuo/methods/dirk/kencarp4.hpp>
#include <continuo/methods/dirk/kvaerno5.hpp>
#include <continuo/methods/dirk/tr_bdf2.hpp>
#include <continuo/methods/dirk/trapezoidal.hpp>
#include <continuo/methods/multistep/bdf2.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::diagonally_implicit_test {
namespace {

using Real =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float_50::backend_type, boost::multiprecision::et_off>;
using Row = std::vector<Real>;
using Matrix = std::vector<Row>;

template <std::size_t N>
Row row(const Coefficient (&from)[N]) {
  Row result;
  for (const Coefficient& value : from) result.push_back(value.as<Real>());
  return result;
}
template <std::size_t N>
Matrix matrix(const Coefficient (&from)[N][N]) {
  Matrix result;
  for (const auto& line : from) result.push_back(row(line));
  return result;
}

/// phi_i of every tree of the forest, for every way to take each branch through one of the matrices: with one, the
/// conditions of theorem 2.13; with two, those of additive methods (C. A. Kennedy, M. H. Carpenter 2003, section 2).
std::vector<Matrix> coloured_weights(const std::vector<testing::RootedTree>& forest,
                                     const std::vector<Matrix>& matrices) {
  const std::size_t stages = matrices.front().size();
  std::vector<Matrix> weights, through;  // by tree: the phi, and the phi multiplied by each of the matrices
  for (const testing::RootedTree& tree : forest) {
    Matrix phis{Row(stages, Real(1))};
    for (const std::size_t branch : tree.branches) {
      Matrix longer;
      for (const Row& phi : phis) {
        for (const Row& factor : through[branch]) {
          Row product(stages);
          for (std::size_t i = 0; i < stages; ++i) product[i] = phi[i] * factor[i];
          longer.push_back(product);
        }
      }
      phis = longer;
    }
    Matrix next;
    for (const Row& phi : phis) {
      for (const Matrix& a : matrices) {
        Row product(stages, Real(0));
        for (std::size_t i = 0; i < stages; ++i)
          for (std::size_t j = 0; j < stages; ++j) product[i] += a[i][j] * phi[j];
        next.push_back(product);
      }
    }
    weights.push_back(phis);
    through.push_back(next);
  }
  return weights;
}

/// The greatest violation of the conditions for trees of `nodes` nodes.
Real violation(const std::vector<Matrix>& matrices, const Row& b, int nodes, const Real& theta = Real(1)) {
  const auto forest = testing::rooted_trees(nodes);
  const auto weights = coloured_weights(forest, matrices);
  Real worst(0);
  for (std::size_t n = 0; n < forest.size(); ++n) {
    if (forest[n].nodes != nodes) continue;
    for (const Row& phi : weights[n]) {
      Real sum = -pow(theta, nodes) / Real(forest[n].density);
      for (std::size_t i = 0; i < b.size(); ++i) sum += b[i] * phi[i];
      worst = std::max(worst, Real(abs(sum)));
    }
  }
  return worst;
}

struct NameOfMethod {
  template <class M>
  static std::string GetName(int) {
    return std::string(M::name);
  }
};
template <class M>
class Diagonal : public ::testing::Test {
 protected:
  /// Kvaerno5 is printed to 16 digits; the fractions of KenCarp4 with 13 digits in their denominators to 26.
  static Real bound() { return Real(M::order == 5 ? "1e-15" : M::order == 4 ? "1e-24" : "1e-44"); }
};
using Tableaus = ::testing::Types<ImplicitEuler, ImplicitMidpoint, Trapezoidal, TrBdf2, KenCarp4, Kvaerno5>;
TYPED_TEST_SUITE(Diagonal, Tableaus, NameOfMethod);

TYPED_TEST(Diagonal, MeetsTheConditionsOfItsOrderAndNoMore) {
  const auto a = matrix(TypeParam::tableau.a);
  const Row b = row(TypeParam::tableau.b);
  for (int nodes = 1; nodes <= TypeParam::order; ++nodes) EXPECT_LT(violation({a}, b, nodes), this->bound()) << nodes;
  EXPECT_GT(violation({a}, b, TypeParam::order + 1), Real("1e-6"));
}

// TR-BDF2 keeps the solution of order 2 and compares it with one of order 3, implicit Euler with one of order 2.
TYPED_TEST(Diagonal, TheEmbeddedSolutionHasItsOrder) {
  if (TypeParam::error_order == 0) return;
  const auto a = matrix(TypeParam::tableau.a);
  const Row embedded = row(TypeParam::tableau.embedded);
  const int order = TypeParam::order <= 2 ? TypeParam::order + 1 : TypeParam::error_order;
  for (int nodes = 1; nodes <= order; ++nodes) EXPECT_LT(violation({a}, embedded, nodes), this->bound()) << nodes;
  EXPECT_GT(violation({a}, embedded, order + 1), Real("1e-6"));
}

TYPED_TEST(Diagonal, RowsSumToTheirNodesAndTheDiagonalIsConstant) {
  constexpr auto& tableau = TypeParam::tableau;
  for (std::size_t i = 0; i < tableau.stages; ++i) {
    Real sum = -tableau.c[i].template as<Real>();
    for (std::size_t j = 0; j <= i; ++j) sum += tableau.a[i][j].template as<Real>();
    EXPECT_LT(abs(sum), this->bound()) << i;
    for (std::size_t j = i + 1; j < tableau.stages; ++j) EXPECT_TRUE(tableau.a[i][j].is_zero());
    if (i > 0 || !tableau.starts_explicit()) {
      EXPECT_EQ(tableau.a[i][i], tableau.gamma) << i;
    }
  }
}

TYPED_TEST(Diagonal, TheInterpolantMeetsTheConditionsOfItsOrder) {
  constexpr auto& tableau = TypeParam::tableau;
  const auto a = matrix(tableau.a);
  for (const Real& theta : {Real("0.3"), Real("0.8"), Real(1)}) {
    Row b(tableau.stages, Real(0));
    for (std::size_t n = 0; n < tableau.degree; ++n)
      for (std::size_t i = 0; i < tableau.stages; ++i)
        b[i] += pow(theta, static_cast<int>(n) + 1) * tableau.dense[n][i].template as<Real>();
    for (int nodes = 1; nodes <= TypeParam::dense_order; ++nodes)
      EXPECT_LT(violation({a}, b, nodes, theta), this->bound()) << nodes;
  }
}

TEST(KenCarp4Tableau, MeetsTheConditionsOfBothPartsAndBetweenThem) {
  const std::vector<Matrix> both{matrix(KenCarp4::tableau.a), matrix(KenCarp4::tableau.explicit_a)};
  for (int nodes = 1; nodes <= 4; ++nodes)
    EXPECT_LT(violation(both, row(KenCarp4::tableau.b), nodes), Real("1e-24")) << nodes;
  for (int nodes = 1; nodes <= 3; ++nodes)
    EXPECT_LT(violation(both, row(KenCarp4::tableau.embedded), nodes), Real("1e-24")) << nodes;
}

template <class M>
class DiagonalMethod : public ::testing::Test {};
using Methods = ::testing::Types<ImplicitEuler, ImplicitMidpoint, Trapezoidal, Bdf2, TrBdf2, KenCarp4, Kvaerno5>;
TYPED_TEST_SUITE(DiagonalMethod, Methods, NameOfMethod);

TYPED_TEST(DiagonalMethod, HasItsOrder) {
  const auto error = [](int n) { return testing::error_of_steps<TypeParam, testing::Forced>(n); };
  EXPECT_NEAR(testing::measured_order(error, 64), TypeParam::order, 0.15);
}

TYPED_TEST(DiagonalMethod, HasItsOrderInTheUnknownOfAnAlgebraicEquation) {
  const auto error = [](int n) { return testing::error_of_steps<TypeParam, testing::Circle>(n); };
  EXPECT_NEAR(testing::measured_order(error, 64), TypeParam::order, 0.15);
}

TYPED_TEST(DiagonalMethod, TheInterpolantHasTheStatedOrder) {
  const auto forced = [](int n) { return testing::dense_error<TypeParam, testing::Forced>(n); };
  EXPECT_NEAR(testing::measured_order(forced, 64), TypeParam::dense_order + 1, 0.2);
  const auto algebraic = [](int n) { return testing::dense_error<TypeParam, testing::Circle>(n); };
  EXPECT_GT(testing::measured_order(algebraic, 32), TypeParam::dense_order + 0.7);
}

// lambda = -1e6: the observed order is that of the stages, 2 (1 for implicit Euler), and the error is divided by lambda
// where the last stage is the end of the step (E. Hairer, G. Wanner II, IV.15). The implicit midpoint rule has no such
// stage.
TYPED_TEST(DiagonalMethod, LosesThatMuchOrderOnProtheroRobinson) {
  const auto error = [](int n) { return testing::error_of_steps<TypeParam, testing::ProtheroRobinson>(n); };
  EXPECT_NEAR(testing::measured_order(error, 32), TypeParam::order == 1 ? 1 : 2, 0.25);
  const double bound = std::is_same_v<TypeParam, ImplicitMidpoint> ? 1e-3 : 2e-8;  // as measured: 3e-4, 1.6e-8 and less
  EXPECT_LT(static_cast<double>(error(64)), bound);
}

TYPED_TEST(DiagonalMethod, AFixedStepThatCannotBeSolvedEndsByName) {
  const std::array<double, 2> x0{1, 0};
  const auto lost = solve(testing::any_function<testing::LostUnknown>(), x0, {0.0, 1.0}, TypeParam{}, {.step = 0.1});
  EXPECT_EQ(lost.outcome.ending, Ending::nonlinear_solve_failed);
  EXPECT_NE(lost.outcome.hint.find("singular"), std::string::npos) << lost.outcome.hint;
  const auto wall =
      solve(testing::any_function<testing::NotANumberBeyond>(), x0, {0.0, 1.0}, TypeParam{}, {.step = 0.01});
  EXPECT_EQ(wall.outcome.ending, Ending::not_finite);
  EXPECT_NEAR(wall.outcome.t, 0.5, 0.02);
}

TYPED_TEST(DiagonalMethod, ARunGoesOnFromACopyBitByBit) {
  const Options<std::array<double, 2>> options{
      .rtol = 1e-5, .atol = 1e-12, .step = TypeParam::error_order > 0 ? 0 : 0.01};
  Integrator run(testing::any_problem<double, testing::Forced>(), std::array<double, 2>{0, 1}, {0.0, 1.0}, TypeParam{},
                 options);
  for (int i = 0; i < 7; ++i) ASSERT_TRUE(run.advance());
  auto copy = run;
  while (run.advance()) continue;
  while (copy.advance()) continue;
  ASSERT_EQ(run.outcome().ending, Ending::reached_end);
  EXPECT_EQ(run.x(), copy.x());
}

template <class M>
class AdaptiveDiagonal : public ::testing::Test {};
using Adaptive = ::testing::Types<ImplicitEuler, TrBdf2, KenCarp4, Kvaerno5>;
TYPED_TEST_SUITE(AdaptiveDiagonal, Adaptive, NameOfMethod);

// Error per step is controlled: over a run of order p it grows like the tolerance to the power p / (p + 1).
TYPED_TEST(AdaptiveDiagonal, MeetsTheToleranceOnRobertson) {
  using Problem = bench::Robertson<double>;
  const auto reference = bench::end_of<Problem>();
  for (const double rtol : {1e-3, 1e-5, 1e-7}) {
    if (rtol < 1e-3 && TypeParam::order == 1) continue;
    if (rtol < 1e-5 && TypeParam::order == 2) continue;
    const auto solution = promises::solved_by_name<TypeParam, Problem>(rtol, rtol * 1e-8);
    ASSERT_EQ(solution.outcome.ending, Ending::reached_end);
    const auto& x = solution.final_state();
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(x[i], reference[i], 30 * rtol * reference[i]) << rtol << " " << i;
    EXPECT_LT(solution.statistics.jacobians, solution.statistics.steps);
    EXPECT_LT(solution.statistics.factorizations, solution.statistics.steps + 20);
  }
}

TYPED_TEST(AdaptiveDiagonal, DifferencesServeWhereNoDerivativesAreGiven) {
  const auto solution =
      solve(testing::ForcedAlone{}, std::vector<double>{0, 1}, {0.0, 1.0}, TypeParam{}, {.rtol = 1e-5, .atol = 1e-5});
  ASSERT_EQ(solution.outcome.ending, Ending::reached_end);
  EXPECT_NEAR(solution.final_state()[0], std::sin(1.0), TypeParam::order == 1 ? 3e-3 : 3e-4);
}

TYPED_TEST(AdaptiveDiagonal, FailuresHaveTheirOutcome) {
  const std::array<double, 2> x0{1, 0};
  EXPECT_EQ(solve(testing::any_function<testing::LostUnknown>(), x0, {0.0, 1.0}, TypeParam{}).outcome.ending,
            Ending::nonlinear_solve_failed);
  EXPECT_EQ(
      solve(testing::any_problem<double, testing::NotANumberInJacobian>(), x0, {0.0, 1.0}, TypeParam{}).outcome.ending,
      Ending::not_finite);
  const auto wall = solve(testing::any_function<testing::NotANumberBeyond>(), x0, {0.0, 1.0}, TypeParam{});
  EXPECT_EQ(wall.outcome.ending, Ending::not_finite);
  EXPECT_NEAR(wall.outcome.t, 0.5, 1e-8);
}

/// Forced in two parts: the spring is stiff, the force is not.
struct Split : testing::ForcedAlone {
  template <class X>
  void stiff(const Scalar<X>&, const X& x, X& dxdt) const {
    dxdt[0] = x[1];
    dxdt[1] = -x[0] * x[0] * x[0];
  }
  template <class X>
  void nonstiff(const Scalar<X>& t, const X&, X& dxdt) const {
    using std::sin;
    const Scalar<X> s = sin(t);
    dxdt[0] = 0;
    dxdt[1] = s * s * s - s;
  }
};

TEST(KenCarp4Split, HasItsOrderInBothParts) {
  const auto error = [](int n) { return testing::error_of_steps<KenCarp4>(Split{}, n); };
  EXPECT_NEAR(testing::measured_order(error, 64), 4, 0.15);
  const auto dense = [](int n) { return testing::dense_error<KenCarp4>(Split{}, n); };
  EXPECT_NEAR(testing::measured_order(dense, 64), 4, 0.2);
}

TEST(KenCarp4Split, IteratesOnTheStiffPartAlone) {
  struct Counting {
    int* stiff_calls;
    void operator()(double, const std::array<double, 1>&, std::array<double, 1>&) const { FAIL() << "never whole"; }
    void stiff(double, const std::array<double, 1>& x, std::array<double, 1>& f) const {
      ++*stiff_calls, f[0] = -1e4 * x[0];
    }
    void nonstiff(double t, const std::array<double, 1>&, std::array<double, 1>& f) const { f[0] = std::cos(t); }
  };
  int calls = 0;
  const auto exact = [](double t) { return (1e4 * std::cos(t) + std::sin(t)) / (1e8 + 1); };  // of x' = cos t - 1e4 x
  Integrator run(Counting{&calls}, std::array<double, 1>{exact(0)}, {0.0, 1.0}, KenCarp4{}, {.step = 0.05});
  while (run.advance()) continue;
  ASSERT_EQ(run.outcome().ending, Ending::reached_end);
  EXPECT_NEAR(run.x()[0], exact(1), 1e-2 * exact(1));
  EXPECT_GT(calls, 100);  // five stages of twenty steps at least
}

TEST(Bdf2, AStepOfAnotherSizeKeepsTheOrder) {
  // 0.05 does not divide 1.01: the last step is a fifth of the others.
  const auto f = [](double, const std::array<double, 1>& x) { return std::array{-x[0]}; };
  const auto error = [&](double h) {
    const auto solution = solve(f, std::array{1.0}, {0.0, 1.01}, Bdf2{}, {.rtol = 1e-12, .atol = 1e-12, .step = h});
    return std::abs(solution.final_state()[0] - std::exp(-1.01));
  };
  EXPECT_NEAR(std::log2(error(0.05) / error(0.025)), 2, 0.2);
}

}  // namespace
}  // namespace continuo::diagonally_implicit_test
