// A wrong derivative is found and named; a right one passes, however badly its system is scaled.
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <bench/problems/hires.hpp>
#include <bench/problems/oregonator.hpp>
#include <bench/problems/pollution.hpp>
#include <bench/problems/robertson.hpp>
#include <bench/problems/van_der_pol.hpp>
#include <gtest/gtest.h>

#include <continuo/system/check_jacobian.hpp>
#include <continuo/system/differentiable.hpp>

namespace continuo::check_jacobian_test {
namespace {

using Pair = std::array<double, 2>;

/// Predator and prey with seasonal growth; each test supplies its own derivative.
struct Prey {
  double slope_of_prey = 1, slope_of_time = 1;
  std::string_view component_name(std::size_t i) const { return i == 0 ? "hare" : "lynx"; }
  void operator()(double t, const Pair& x, Pair& dxdt) const {
    dxdt = {x[0] * (std::sin(t) - x[1]), x[1] * (x[0] - 0.5)};
  }
  void jacobian(double t, const Pair& x, std::span<double> rows) const {
    rows[0] = std::sin(t) - x[1], rows[1] = -x[0];
    rows[2] = slope_of_prey * x[1], rows[3] = x[0] - 0.5;
  }
  void time_derivative(double t, const Pair& x, Pair& dfdt) const { dfdt = {slope_of_time * x[0] * std::cos(t), 0}; }
};

TEST(CheckJacobian, ARightOnePasses) {
  Prey prey;
  const auto check = check_jacobian(prey, 0.7, Pair{2, 3});
  EXPECT_TRUE(check.agrees());
  EXPECT_EQ(check.compared, 6U);
  EXPECT_TRUE(check.undecided.empty() && check.kinks.empty());
  ASSERT_EQ(check.right.size(), 1U);
  EXPECT_LT(check.right.front().apart, 1e-10);
}

TEST(CheckJacobian, AWrongEntryIsNamedWithWhatItIsAndShouldBe) {
  Prey prey{.slope_of_prey = -1};
  const auto check = check_jacobian(prey, 0.7, Pair{2, 3});
  ASSERT_EQ(check.wrong.size(), 1U);
  const auto& entry = check.wrong.front();
  EXPECT_EQ(entry_name(prey, entry, 2), "d(lynx')/d(hare)");
  EXPECT_EQ(entry.given, -3);
  EXPECT_NEAR(entry.measured, 3, entry.doubt);
  EXPECT_LT(entry.doubt, 1e-8);
}

TEST(CheckJacobian, ASlipOfOnePartInAMillionIsSeen) {
  Prey prey{.slope_of_prey = 1 + 1e-6};
  EXPECT_FALSE(check_jacobian(prey, 0.7, Pair{2, 3}).agrees());
}

TEST(CheckJacobian, AWrongTimeDerivativeIsFound) {
  Prey prey{.slope_of_time = 2};
  const auto check = check_jacobian(prey, 0.7, Pair{2, 3});
  ASSERT_EQ(check.wrong.size(), 1U);
  EXPECT_EQ(entry_name(prey, check.wrong.front(), 2), "d(hare')/d(t)");
  EXPECT_TRUE(check_jacobian(prey, 0.7, Pair{2, 3}, {.by_time = false}).agrees());
}

TEST(CheckJacobian, TheWorstOfSeveralComesFirst) {
  Prey prey{.slope_of_prey = 1.001, .slope_of_time = 50};
  const auto check = check_jacobian(prey, 0.7, Pair{2, 3});
  ASSERT_EQ(check.wrong.size(), 2U);
  EXPECT_EQ(check.wrong.front().column, 2U);
}

/// Heat in a rod with a pattern that may lack places, and values in its order.
struct Rod {
  using X = std::vector<double>;
  SparsePattern pattern;
  double scale = 1;
  void operator()(double, const X& x, X& dxdt) const {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double left = i == 0 ? 0 : x[i - 1], right = i + 1 == x.size() ? 0 : x[i + 1];
      dxdt[i] = left - 2 * x[i] + right;
    }
  }
  const SparsePattern& jacobian_pattern() const { return pattern; }
};
struct RodWithValues : Rod {
  void jacobian_values(double, const X&, std::span<double> values) const {
    for (std::size_t j = 0; j < pattern.size(); ++j)
      for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p)
        values[p] = scale * (pattern.row(p) == j ? -2.0 : 1.0);
  }
};

SparsePattern neighbours(std::uint32_t n, bool all) {
  std::vector<MatrixPlace> places;
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    places.push_back({i, i + 1});
    if (all || i != 3) places.push_back({i + 1, i});
  }
  return SparsePattern(n, places);
}

TEST(CheckJacobian, AnEntryOutsideThePatternIsFoundWithAndWithoutValues) {
  const Rod::X x{1, 2, 4, 3, 5, 1, 0, 2};
  Rod complete{neighbours(8, true)}, lacking{neighbours(8, false)};
  EXPECT_TRUE(check_jacobian(complete, 0.0, x).agrees());
  RodWithValues with_values{lacking};
  const auto expect_the_place = [](const auto& check) {
    ASSERT_EQ(check.wrong.size(), 1U);
    EXPECT_EQ(check.wrong.front().row, 4U);
    EXPECT_EQ(check.wrong.front().column, 3U);
    EXPECT_FALSE(check.wrong.front().in_pattern);
  };
  expect_the_place(check_jacobian(lacking, 0.0, x));
  expect_the_place(check_jacobian(with_values, 0.0, x));
  RodWithValues doubled{{neighbours(8, true), 2}};
  EXPECT_EQ(check_jacobian(doubled, 0.0, x).wrong.size(), 8U + 7U + 7U);
}

/// A system whose Jacobian action is right and whose matrix is wrong.
struct TwoWays {
  void operator()(double, const Pair& x, Pair& dxdt) const { dxdt = {x[1], -x[0]}; }
  void jacobian(double, const Pair&, std::span<double> rows) const {
    rows[0] = 0, rows[1] = 1, rows[2] = 1, rows[3] = 0;
  }
  void jacobian_action(double, const Pair&, const Pair& v, Pair& product) const { product = {v[1], -v[0]}; }
};

TEST(CheckJacobian, EveryWayOfSayingItIsChecked) {
  TwoWays system;
  const auto check = check_jacobian(system, 0.0, Pair{1, 2});
  ASSERT_EQ(check.wrong.size(), 1U);
  EXPECT_EQ(entry_name(system, check.wrong.front(), 2), "d(x[1]')/d(x[0])");
}

TEST(CheckJacobian, ASystemThatSaysWronglyThatItIsAutonomousIsFound) {
  struct Driven {
    bool autonomous = true;
    void operator()(double t, const Pair& x, Pair& dxdt) const { dxdt = {x[1], -x[0] + std::cos(t)}; }
  } driven;
  EXPECT_EQ(check_jacobian(driven, 0.5, Pair{1, 2}).wrong.size(), 1U);
  driven.autonomous = false;
  EXPECT_TRUE(check_jacobian(driven, 0.5, Pair{1, 2}).agrees());
}

TEST(CheckJacobian, WhereThereIsNoDerivativeAValueBetweenTheSlopesPassesAndIsSaid) {
  struct Friction {
    double slope = 0;
    void operator()(double, const Pair& x, Pair& dxdt) const { dxdt = {x[1], -std::abs(x[1])}; }
    void jacobian(double, const Pair&, std::span<double> rows) const {
      rows[0] = 0, rows[1] = 1, rows[2] = 0, rows[3] = slope;
    }
  } friction;
  for (const double slope : {-1.0, 0.0, 1.0}) {
    friction.slope = slope;
    const auto check = check_jacobian(friction, 0.0, Pair{1, 0});
    EXPECT_TRUE(check.agrees()) << slope;
    ASSERT_EQ(check.kinks.size(), 1U) << slope;
    EXPECT_NEAR(check.kinks.front().below, 1, 1e-9);
    EXPECT_NEAR(check.kinks.front().above, -1, 1e-9);
  }
  friction.slope = 1.5;
  EXPECT_FALSE(check_jacobian(friction, 0.0, Pair{1, 0}).agrees());
  // Next to the kink the derivative is unique, and only that is accepted.
  friction.slope = -1;
  EXPECT_TRUE(check_jacobian(friction, 0.0, Pair{1, 1e-3}).agrees());
  friction.slope = 1;
  EXPECT_FALSE(check_jacobian(friction, 0.0, Pair{1, 1e-3}).agrees());
}

TEST(CheckJacobian, WhereFIsNotFiniteNothingIsDecidedAndNoNumberPassesForANumber) {
  struct Root {
    double slope;
    void operator()(double, const Pair& x, Pair& dxdt) const { dxdt = {std::sqrt(x[0]), -x[1]}; }
    void jacobian(double, const Pair&, std::span<double> rows) const {
      rows[0] = slope, rows[1] = 0, rows[2] = 0, rows[3] = -1;
    }
  } root{0.5};
  const auto check = check_jacobian(root, 0.0, Pair{0, 1});
  EXPECT_TRUE(check.agrees());
  EXPECT_EQ(check.undecided.size(), 1U);
  EXPECT_TRUE(check_jacobian(root, 0.0, Pair{1, 1}).agrees());
  root.slope = std::nan("");
  EXPECT_FALSE(check_jacobian(root, 0.0, Pair{1, 1}).agrees());
}

/// The Jacobians written by hand and those by dual numbers, at the start and at states whose components differ by ten
/// orders of magnitude.
template <class Problem>
void expect_right(const Problem& problem) {
  for (const double size : {1.0, 1e-5}) {
    auto x = problem.start();
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = x[i] * 1.25 + size * static_cast<double>(i + 1) / 100;
    auto by_hand = problem;
    auto by_duals = differentiable(problem);
    for (const auto& check : {check_jacobian(by_hand, 0.5, x), check_jacobian(by_duals, 0.5, x)}) {
      EXPECT_TRUE(check.agrees()) << Problem::name;
      EXPECT_TRUE(check.undecided.empty() && check.kinks.empty()) << Problem::name;
    }
  }
}

TEST(CheckJacobian, StiffProblemsPass) {
  expect_right(bench::Robertson{});
  expect_right(bench::Hires{});
  expect_right(bench::Oregonator{});
  expect_right(bench::Pollution{});
  expect_right(bench::VanDerPol{});
}

TEST(CheckJacobian, LongDoubleSeesSmallerSlips) {
  struct Square {
    long double slope;
    using X = std::array<long double, 1>;
    void operator()(long double, const X& x, X& dxdt) const { dxdt = {x[0] * x[0]}; }
    void jacobian(long double, const X& x, std::span<long double> rows) const { rows[0] = slope * x[0]; }
  } square{2};
  EXPECT_TRUE(check_jacobian(square, 0.0L, Square::X{3}).agrees());
  square.slope = 2 + 1e-15L;
  EXPECT_FALSE(check_jacobian(square, 0.0L, Square::X{3}).agrees());
}

}  // namespace
}  // namespace continuo::check_jacobian_test
