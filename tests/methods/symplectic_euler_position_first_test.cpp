// Symplectic Euler with the position first is the loop of a lecture's slide: to the same bits, for any acceleration.
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/methods/symplectic/semi_implicit_euler.hpp>
#include <continuo/methods/symplectic/symplectic_euler_position_first.hpp>
#include <continuo/methods/symplectic/velocity_verlet.hpp>
#include <continuo/solve/solve.hpp>
#include <continuo/system/second_order.hpp>

namespace continuo::symplectic_euler_position_first_test {
namespace {

using X = std::vector<double>;  // positions, then velocities

/// Masses with springs that stiffen, between each and the next, with a damper for each; all numbers random.
struct Chain {
  std::vector<double> stiffness, cubic, damping;

  void operator()(double, std::span<const double> q, std::span<const double> v, std::span<double> a) const {
    for (std::size_t i = 0; i < q.size(); ++i) {
      const double stretch = q[i] - (i > 0 ? q[i - 1] : 0.0);
      a[i] = -stiffness[i] * stretch - cubic[i] * stretch * stretch * stretch - damping[i] * v[i];
    }
  }
};

struct Problem {
  Chain chain;
  X start;
  double h;
};
Problem random_problem(unsigned seed, bool damped) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  const std::size_t masses = 1 + seed % 4;
  Problem problem{{}, X(2 * masses), std::ldexp(1.0, -4 - static_cast<int>(seed % 4))};  // h n is exact
  for (std::size_t i = 0; i < masses; ++i) {
    problem.chain.stiffness.push_back(1 + number(random));
    problem.chain.cubic.push_back(1 + number(random));
    problem.chain.damping.push_back(damped ? 1 + number(random) : 0.0);
  }
  for (double& x : problem.start) x = number(random);
  return problem;
}

/// The loop of the slide: for each mass x += v*dt, and then v += a*dt with the new x.
X slide(const Problem& problem, int steps) {
  X state = problem.start;
  const std::size_t masses = state.size() / 2;
  const std::span<double> x(state.data(), masses), v(state.data() + masses, masses);
  std::vector<double> a(masses);
  for (int n = 0; n < steps; ++n) {
    for (std::size_t i = 0; i < masses; ++i) x[i] += v[i] * problem.h;
    problem.chain(0, x, v, a);
    for (std::size_t i = 0; i < masses; ++i) v[i] += a[i] * problem.h;
  }
  return state;
}

template <class Method>
X run(const Problem& problem, int steps) {
  const auto solution = solve(second_order(problem.chain), problem.start, {0.0, problem.h * steps}, Method{},
                              {.step = problem.h, .save = Save<X>::only_end()});
  EXPECT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_EQ(solution.statistics.steps, static_cast<std::size_t>(steps));
  return solution.final_state();
}

#ifdef __FMA__  // where the compiler may join a product and a sum, the bits of two pieces of code can differ
constexpr bool same_bits = false;
#else
constexpr bool same_bits = true;
#endif

void expect_same(const X& ours, const X& expected) {
  ASSERT_EQ(ours.size(), expected.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    EXPECT_NEAR(ours[i], expected[i], same_bits ? 0 : 1e-9) << i;
  }
}

TEST(SymplecticEulerPositionFirst, IsTheLoopOfTheSlideToTheSameBits) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    const Problem problem = random_problem(seed, seed % 2 == 1);
    expect_same(run<SymplecticEulerPositionFirst>(problem, 500), slide(problem, 500));
  }
}

TEST(SymplecticEulerPositionFirst, AConstantForceGivesTheNumbersOfTheLecture) {
  // m = F = 1, h = 1: x = 0, 1, 3 and v = 1, 2, 3.
  const auto force = second_order([](double, const auto&) { return std::array{1.0}; });
  const auto solution = solve(force, std::array{0.0, 0.0}, {0.0, 3.0}, SymplecticEulerPositionFirst{}, {.step = 1.0});
  EXPECT_EQ(solution.x, (std::vector<std::array<double, 2>>{{0, 0}, {0, 1}, {1, 2}, {3, 3}}));
}

// Both orders move x and v in turn. Started after one more move of x, the velocity first gives the velocities of the
// position first, and its positions a step later.
TEST(SymplecticEulerPositionFirst, BothOrdersAreOneSequenceOfMoves) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    const Problem first = random_problem(seed, false);
    Problem later = first;
    const std::size_t masses = first.start.size() / 2;
    for (std::size_t i = 0; i < masses; ++i) later.start[i] += first.h * first.start[masses + i];
    const X ours = run<SymplecticEulerPositionFirst>(first, 100), next = run<SymplecticEulerPositionFirst>(first, 101);
    X expected = ours;
    for (std::size_t i = 0; i < masses; ++i) expected[i] = next[i];
    expect_same(run<SemiImplicitEuler>(later, 100), expected);
  }
}

// Half a step with the velocity first and half a step with the position first: v by h/2, x by h, v by h/2.
TEST(SymplecticEulerPositionFirst, AfterTheOtherOrderIsVelocityVerlet) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const Problem problem = random_problem(seed, false);
    Problem half{problem.chain, problem.start, problem.h / 2};
    for (int n = 0; n < 50; ++n) {
      half.start = run<SemiImplicitEuler>(half, 1);
      half.start = run<SymplecticEulerPositionFirst>(half, 1);
    }
    const auto acceleration = [&](double t, std::span<const double> q, std::span<double> a) {
      problem.chain(t, q, q, a);  // the dampers are 0
    };
    const auto verlet = solve(second_order(acceleration), problem.start, {0.0, 50 * problem.h}, VelocityVerlet{},
                              {.step = problem.h, .save = Save<X>::only_end()});
    for (std::size_t i = 0; i < half.start.size(); ++i) EXPECT_NEAR(half.start[i], verlet.final_state()[i], 1e-12);
  }
}

TEST(SymplecticEulerPositionFirst, TheEnergyOfAnOscillatorSwingsWithinOrderH) {
  // It conserves q^2 + v^2 + h q v, where the velocity first conserves q^2 + v^2 - h q v.
  const double h = 0.125;
  const auto oscillator = second_order([](double, const auto& q) { return std::array{-q[0]}; });
  const auto solution =
      solve(oscillator, std::array{1.0, 0.0}, {0.0, 1250.0}, SymplecticEulerPositionFirst{}, {.step = h});
  ASSERT_EQ(solution.x.size(), 10001U);
  for (const auto& [q, v] : solution.x) ASSERT_NEAR(q * q + v * v + h * q * v, 1, 1e-12);
}

TEST(SymplecticEulerPositionFirst, EvaluatesOnceAStepWhereVelocitiesDoNotCount) {
  const Problem problem = random_problem(2, false);
  const auto acceleration = [&](double t, std::span<const double> q, std::span<double> a) {
    problem.chain(t, q, q, a);  // the dampers are 0
  };
  const auto solution = solve(second_order(acceleration), problem.start, {0.0, 100 * problem.h},
                              SymplecticEulerPositionFirst{}, {.step = problem.h});
  EXPECT_EQ(solution.statistics.evaluations, 101U);
}

}  // namespace
}  // namespace continuo::symplectic_euler_position_first_test
