// Solutions of equations enclosed over an interval, against Newton's iteration in long double.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <tests/numerics/random_number.hpp>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/enclosure_with_slope.hpp>
#include <continuo/numerics/implicit_enclosure.hpp>

namespace continuo::implicit_enclosure_test {
namespace {

using Range = Enclosure<double>;
using Curve = EnclosureWithSlope<double>;

template <class Number>
Number number(double value) {
  return Number(value);
}

/// A u + c sin(u) of the next unknown = b theta + s, `c` = 0: linear.
struct Equations {
  std::size_t size;
  std::vector<double> matrix, curved, by_theta, constant;

  template <class Number>
  std::vector<Number> operator()(const Number& theta, std::span<const Number> u) const {
    using std::sin;
    std::vector<Number> f;
    for (std::size_t i = 0; i < size; ++i) {
      Number sum = number<Number>(-constant[i]) - number<Number>(by_theta[i]) * theta;
      for (std::size_t j = 0; j < size; ++j) sum = sum + number<Number>(matrix[i * size + j]) * u[j];
      f.push_back(sum + number<Number>(curved[i]) * sin(u[(i + 1) % size]));
    }
    return f;
  }
};

/// Diagonally dominant, so that the solution is unique for every theta.
Equations random_equations(std::mt19937& random, std::size_t size, bool is_linear) {
  Equations made{size, {}, {}, {}, {}};
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j)
      made.matrix.push_back(random_number<double>(random) + (i == j ? 1.5 * static_cast<double>(size + 1) : 0));
    made.curved.push_back(is_linear ? 0 : random_number<double>(random));
    made.by_theta.push_back(3 * random_number<double>(random));
    made.constant.push_back(2 * random_number<double>(random));
  }
  return made;
}

struct Solution {
  std::vector<long double> u, slope;
};

/// By Newton's iteration from `u` on; the slope solves J u' = -dF/dtheta.
Solution solved(const Equations& f, long double theta, std::vector<long double> u) {
  const std::size_t n = f.size;
  DenseLU<long double> lu(n);
  for (int iteration = 0; iteration < 60; ++iteration) {
    std::vector<long double> residual = f(theta, std::span<const long double>(u));
    for (std::size_t i = 0; i < n * n; ++i) lu.matrix()[i] = static_cast<long double>(f.matrix[i]);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t next = (i + 1) % n;
      lu.matrix()[i * n + next] += static_cast<long double>(f.curved[i]) * std::cos(u[next]);
    }
    EXPECT_TRUE(lu.factor());
    lu.solve(residual.data());
    for (std::size_t i = 0; i < n; ++i) u[i] -= residual[i];
  }
  std::vector<long double> slope(f.by_theta.begin(), f.by_theta.end());
  lu.solve(slope.data());
  return {std::move(u), std::move(slope)};
}

/// The enclosure over from..to, its guess off by `error`.
template <class F>
bool enclose(ImplicitEnclosure<double>& solution, const F& f, double from, double to, std::span<const double> at_middle,
             double error) {
  const std::size_t n = at_middle.size();
  const double middle = from + (to - from) / 2;
  std::vector<double> start;
  std::vector<Range> guess;
  for (const double u : at_middle) {
    start.push_back(u + error);
    guess.emplace_back(u + error - (to - from), u + error + (to - from));
  }
  return solution.over(
      guess, start, Range(from, to) - Range(middle),
      [&](std::span<const double> u, std::span<double> out) { std::ranges::copy(f(middle, u), out.begin()); },
      [&](std::span<const double> u, std::span<Range> out) {
        std::vector<Range> numbers;
        for (const double one : u) numbers.emplace_back(one);
        std::ranges::copy(f(Range(middle), std::span<const Range>(numbers)), out.begin());
      },
      [&](std::span<const Range> box, std::span<Range> by_u, std::span<Range> by_theta) {
        for (std::size_t j = 0; j <= n; ++j) {
          std::vector<Curve> u;
          for (std::size_t i = 0; i < n; ++i) u.emplace_back(box[i], i == j ? Range(1.0) : Range());
          const Curve theta({from, to}, j == n ? Range(1.0) : Range());
          const std::vector<Curve> out = f(theta, std::span<const Curve>(u));
          for (std::size_t i = 0; i < n; ++i) (j == n ? by_theta[i] : by_u[i * n + j]) = out[i].slope;
        }
      });
}

bool holds(const Range& range, long double value) {
  return static_cast<long double>(range.lo) <= value && value <= static_cast<long double>(range.hi);
}

TEST(ImplicitEnclosure, HoldsTheSolutionAndItsSlopeForRandomSystems) {
  std::mt19937 random(5);
  std::size_t proved = 0;
  constexpr int trials = 600;
  for (int trial = 0; trial < trials; ++trial) {
    const Equations f = random_equations(random, 1 + random() % 6, trial % 2 == 0);
    const double from = std::abs(random_number<double>(random));
    const double to = trial % 7 == 0 ? from : from + std::pow(10.0, -static_cast<double>(1 + random() % 14));
    const long double middle = static_cast<long double>(from) / 2 + static_cast<long double>(to) / 2;
    const Solution there = solved(f, middle, std::vector<long double>(f.size, 0));
    const std::vector<double> near(there.u.begin(), there.u.end());
    ImplicitEnclosure<double> solution(f.size);
    if (!enclose(solution, f, from, to, near, 1e-6)) continue;
    ++proved;
    const auto values = solution.values(), slopes = solution.slopes();
    for (int k = 0; k <= 8; ++k) {
      const long double theta = static_cast<long double>(from) + static_cast<long double>(to - from) * k / 8;
      const Solution exact = solved(f, theta, there.u);
      for (std::size_t i = 0; i < f.size; ++i) {
        ASSERT_TRUE(holds(values[i], exact.u[i])) << trial;
        if (from != to) {
          ASSERT_TRUE(holds(slopes[i], exact.slope[i])) << trial;
        }
      }
    }
  }
  EXPECT_EQ(proved, static_cast<std::size_t>(trials));  // the systems are far from singular, the parts a tenth at most
}

TEST(ImplicitEnclosure, IsAsTightAsRoundingAtAnInstantHoweverFarTheGuessIsOff) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 50; ++trial) {
    const Equations f = random_equations(random, 1 + random() % 4, false);
    const Solution there = solved(f, 0.5L, std::vector<long double>(f.size, 0));
    const std::vector<double> near(there.u.begin(), there.u.end());
    ImplicitEnclosure<double> solution(f.size);
    ASSERT_TRUE(enclose(solution, f, 0.5, 0.5, near, 1e-3));
    // Each equation has ten operations on numbers below ten, and their inverse has norm one at most.
    for (const Range& value : solution.values()) EXPECT_LT(value.hi - value.lo, 1e-13);
  }
}

// The excess over the range, which is the slope times the width, is of second order.
TEST(ImplicitEnclosure, TheExcessIsOfSecondOrder) {
  const Equations f{1, {2}, {1}, {1}, {1}};
  for (const double width : {1e-1, 1e-2, 1e-3}) {
    const Solution low = solved(f, 0.5L, {0}), high = solved(f, 0.5L + static_cast<long double>(width), low.u);
    const std::vector<double> near{static_cast<double>((low.u[0] + high.u[0]) / 2)};
    ImplicitEnclosure<double> solution(1);
    ASSERT_TRUE(enclose(solution, f, 0.5, 0.5 + width, near, 0));
    const Range value = solution.values()[0], slope = solution.slopes()[0];
    EXPECT_LT(value.hi - value.lo, static_cast<double>(high.u[0] - low.u[0]) + 2 * width * width);
    EXPECT_LT(slope.hi - slope.lo, 2 * width);
  }
}

// u^2 = 1 + theta.
const auto parabola = []<class Number>(const Number& theta, std::span<const Number> u) {
  return std::vector<Number>{u[0] * u[0] - Number(1.0) - theta};
};

TEST(ImplicitEnclosure, TheBranchIsThatOfTheGuess) {
  ImplicitEnclosure<double> solution(1);
  ASSERT_TRUE(enclose(solution, parabola, 0, 0.1, std::array{-1.02}, 0));
  EXPECT_TRUE(solution.values()[0].holds(-1.0) && solution.values()[0].holds(-std::sqrt(1.1)));
  EXPECT_LT(solution.values()[0].hi, 0);
  ASSERT_TRUE(enclose(solution, parabola, 0, 0.1, std::array{1.02}, 0));
  EXPECT_GT(solution.values()[0].lo, 0);
}

void expect_nothing(ImplicitEnclosure<double>& solution) {
  EXPECT_TRUE(solution.values()[0].is_entire());
  EXPECT_TRUE(solution.slopes()[0].is_entire());
}

TEST(ImplicitEnclosure, NothingIsSaidWhereTheMatrixIsSingular) {
  ImplicitEnclosure<double> solution(1);
  EXPECT_FALSE(enclose(solution, parabola, -1, -0.9, std::array{0.2}, 0));  // the branches meet at -1
  expect_nothing(solution);
  EXPECT_FALSE(enclose(solution, parabola, -1, -1, std::array{0.0}, 0));
  expect_nothing(solution);
  EXPECT_FALSE(enclose(solution, parabola, -1.3, -1.2, std::array{0.1}, 0));  // there is none
  expect_nothing(solution);
}

TEST(ImplicitEnclosure, NothingIsSaidWhereTheEquationsMayJump) {
  // u + floor(u)/2 = theta has no solution for theta in 1..1.5.
  const auto jumping = []<class Number>(const Number& theta, std::span<const Number> u) {
    using std::floor;
    return std::vector<Number>{u[0] + Number(0.5) * floor(u[0]) - theta};
  };
  ImplicitEnclosure<double> solution(1);
  EXPECT_FALSE(enclose(solution, jumping, 0.9, 1.1, std::array{0.95}, 0));
  expect_nothing(solution);
  EXPECT_TRUE(enclose(solution, jumping, 0.5, 0.6, std::array{0.55}, 0));
}

// u + abs(u)/2 = theta: slope 2/3 above zero, 2 below.
TEST(ImplicitEnclosure, AKinkIsNoJump) {
  const auto bent = []<class Number>(const Number& theta, std::span<const Number> u) {
    using std::abs;
    return std::vector<Number>{u[0] + Number(0.5) * abs(u[0]) - theta};
  };
  ImplicitEnclosure<double> solution(1);
  ASSERT_TRUE(enclose(solution, bent, -0.1, 0.1, std::array{0.0}, 0));
  const Range value = solution.values()[0], slope = solution.slopes()[0];
  EXPECT_TRUE(value.holds(-0.2) && value.holds(0.1 * 2 / 3));
  EXPECT_TRUE(slope.holds(2) && slope.holds(2.0 / 3));
}

}  // namespace
}  // namespace continuo::implicit_enclosure_test
