// Balls on a line that all meet in one point. Each pair of neighbours has its own event, and one instant needs several
// rounds of them. Balls of equal mass exchange their velocities, so afterwards these are sorted, in whatever order the
// pairs collide; for other masses momentum and energy are kept, and no ball passes through another.
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/methods/explicit_rk/dormand_prince5.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::simultaneous_collisions_test {
namespace {

using X = std::vector<double>;  // positions, then velocities

struct Line {
  std::vector<double> masses, velocities;  // of the balls from left to right, before they meet at t = 1
  std::vector<std::size_t> order;          // in which the pairs are declared
  double place;                            // where they meet

  [[nodiscard]] std::size_t size() const { return masses.size(); }
  [[nodiscard]] X start() const {
    X x(2 * size());
    for (std::size_t i = 0; i < size(); ++i) x[i] = place - velocities[i], x[size() + i] = velocities[i];
    return x;
  }
};

/// Velocities that decrease from left to right, in steps of at least 0.05.
Line random_line(std::mt19937& random, std::size_t size, bool has_equal_masses) {
  std::uniform_real_distribution<double> part(0.05, 1), mass(0.1, 10);
  Line line;
  double velocity = 2;
  for (std::size_t i = 0; i < size; ++i) {
    line.masses.push_back(has_equal_masses ? 1 : mass(random));
    line.velocities.push_back(velocity -= part(random));
  }
  line.order.resize(size - 1);
  std::iota(line.order.begin(), line.order.end(), std::size_t{0});
  std::ranges::shuffle(line.order, random);
  line.place = random() % 2 == 0 ? 0 : part(random);
  return line;
}

Event<X> collision(const Line& line, std::size_t i) {
  const std::size_t n = line.size();
  const double a = line.masses[i], b = line.masses[i + 1];
  return falls<X>(
      "pair " + std::to_string(i), [i](double, const X& x) { return x[i + 1] - x[i]; },
      [n, i, a, b](auto& now) {
        const double v = now.before[n + i], w = now.before[n + i + 1], centre = (a * v + b * w) / (a + b);
        now.x[n + i] = 2 * centre - v;
        now.x[n + i + 1] = 2 * centre - w;
      });
}

Solution<X> motion(const Line& line) {
  const auto fly = [n = line.size()](double, const X& x, X& dxdt) {
    for (std::size_t i = 0; i < n; ++i) dxdt[i] = x[n + i], dxdt[n + i] = 0;
  };
  Options<X> options{.rtol = 1e-10, .atol = 1e-12};
  for (const std::size_t i : line.order) options.events.push_back(collision(line, i));
  return solve(fly, line.start(), {0, 2}, DormandPrince5{}, options);
}

TEST(SimultaneousCollisions, OfEqualBallsSortTheirVelocities) {
  std::mt19937 random(1);
  for (int k = 0; k < 300; ++k) {
    const Line line = random_line(random, 3 + static_cast<std::size_t>(k % 4), true);
    const auto solution = motion(line);
    ASSERT_TRUE(solution.outcome) << k << ": " << describe(solution.outcome);
    std::vector<double> sorted(line.velocities);
    std::ranges::sort(sorted);
    for (std::size_t i = 0; i < line.size(); ++i)
      EXPECT_NEAR(solution.final_state()[line.size() + i], sorted[i], 1e-12) << k << ", ball " << i;
  }
}

TEST(SimultaneousCollisions, KeepMomentumAndEnergyAndTheOrderOfTheBalls) {
  std::mt19937 random(2);
  for (int k = 0; k < 300; ++k) {
    const Line line = random_line(random, 3 + static_cast<std::size_t>(k % 4), false);
    const std::size_t n = line.size();
    const auto solution = motion(line);
    ASSERT_TRUE(solution.outcome) << k << ": " << describe(solution.outcome);
    const X& x = solution.final_state();
    double momentum = 0, energy = 0, size = 0;
    for (std::size_t i = 0; i < n; ++i) {
      momentum += line.masses[i] * (x[n + i] - line.velocities[i]);
      energy += line.masses[i] * (x[n + i] * x[n + i] - line.velocities[i] * line.velocities[i]);
      size += line.masses[i] * line.velocities[i] * line.velocities[i];
    }
    EXPECT_NEAR(momentum, 0, 1e-12 * (1 + size)) << k;
    EXPECT_NEAR(energy, 0, 1e-12 * (1 + size)) << k;
    for (std::size_t i = 0; i + 1 < n; ++i) EXPECT_LT(x[i], x[i + 1]) << k << ", ball " << i;
  }
}

}  // namespace
}  // namespace continuo::simultaneous_collisions_test
