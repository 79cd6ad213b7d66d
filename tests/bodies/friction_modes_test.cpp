// Forces of many contacts with friction that act together obey Coulomb's law, and are found wherever they must exist.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_rigid/friction_modes.hpp>

namespace continuo::friction_modes_test {
namespace {

/// Impulses of pairs of two points each, between bodies with fewer ways to move than there are rows. With all pairs
/// free to stick there are always such impulses (D. E. Stewart, J. C. Trinkle, "An implicit time-stepping scheme for
/// rigid body dynamics with inelastic collisions and Coulomb friction", 1996).
TEST(FrictionModes, ImpulsesOfManyContactsObeyCoulombsLaw) {
  std::mt19937 engine(5);
  const auto number = [&](double low, double high) { return std::uniform_real_distribution(low, high)(engine); };
  for (int trial = 0; trial < 100; ++trial) {
    const std::size_t pairs = 6 + engine() % 6, points = 2 * pairs, all = points + pairs, ways = 2 * pairs;
    FrictionProblem<double> problem;
    for (std::size_t k = 0; k < points; ++k) problem.pair_of_point.push_back(static_cast<std::uint32_t>(k / 2));
    for (std::size_t p = 0; p < pairs; ++p) problem.pairs.push_back({.friction = number(0.1, 0.8)});
    std::vector<double> rows(all * ways), speeds(ways);
    for (double& part : rows) part = number(-1, 1);
    for (double& part : speeds) part = number(-1, 1);
    problem.matrix.resize(all * all), problem.rates.resize(all);
    for (std::size_t i = 0; i < all; ++i) {
      for (std::size_t w = 0; w < ways; ++w) {
        problem.rates[i] += rows[i * ways + w] * speeds[w];
        for (std::size_t j = 0; j < all; ++j) problem.matrix[j * all + i] += rows[i * ways + w] * rows[j * ways + w];
      }
    }
    const auto found = FrictionModes<double>(problem).solve();
    ASSERT_TRUE(found) << trial;
    std::vector<double> after = problem.rates;
    for (std::size_t j = 0; j < all; ++j)
      for (std::size_t i = 0; i < all; ++i) after[i] += problem.matrix[j * all + i] * found->forces[j];
    constexpr double small = 1e-7;
    for (std::size_t k = 0; k < points; ++k) {
      EXPECT_GE(found->forces[k], -small) << trial;
      EXPECT_GE(after[k], -small) << trial;
      EXPECT_NEAR(found->forces[k] * after[k], 0, small) << trial;
    }
    for (std::size_t p = 0; p < pairs; ++p) {
      const double across = found->forces[points + p], slip = after[points + p];
      const double most = problem.pairs[p].friction * (found->forces[2 * p] + found->forces[2 * p + 1]);
      EXPECT_LE(std::abs(across), most + small) << trial;
      EXPECT_NEAR(across * slip, -most * std::abs(slip), small) << trial;  // against the slip, with all its force
    }
  }
}

/// Blocks on a floor, between which machines drive them apart with given accelerations: block p has u[p] + x, with the
/// same x for all. Their friction is against that, or what holds the one that stays. So x is the zero of a function
/// that grows, found by bisection; and never do two blocks stick that are driven apart.
TEST(FrictionModes, BlocksThatAreDrivenApartDoNotAllStick) {
  std::mt19937 engine(7);
  const auto number = [&](double low, double high) { return std::uniform_real_distribution(low, high)(engine); };
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t n = 2 + engine() % 8, all = 2 * n;
    const double g = 9.81, driven = std::pow(10, number(-3, 1));
    std::vector<double> mass(n), u(n);
    double total = 0;
    FrictionProblem<double> problem;
    for (std::size_t p = 0; p < n; ++p) {
      mass[p] = number(0.5, 10), u[p] = driven * number(-1, 1), total += mass[p];
      problem.pair_of_point.push_back(static_cast<std::uint32_t>(p));
      problem.pairs.push_back({.friction = number(0.1, 1)});
    }
    problem.matrix.resize(all * all);
    problem.rates.assign(n, -g);
    problem.rates.insert(problem.rates.end(), u.begin(), u.end());
    for (std::size_t p = 0; p < n; ++p) {
      problem.matrix[p * all + p] = 1 / mass[p];
      for (std::size_t q = 0; q < n; ++q) problem.matrix[(n + p) * all + n + q] = 1 / total;
    }
    const auto excess = [&](double x) {  // of the inertia over friction
      double sum = total * x;
      for (std::size_t p = 0; p < n; ++p) sum += std::copysign(problem.pairs[p].friction * mass[p] * g, u[p] + x);
      return sum;
    };
    double low = -100, high = 100;
    for (int round = 0; round < 200; ++round) (excess((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
    const auto found = FrictionModes<double>(problem).solve();
    ASSERT_TRUE(found) << trial;
    double x = 0;
    for (std::size_t p = 0; p < n; ++p) x += found->forces[n + p] / total;
    EXPECT_NEAR(x, low, 1e-7 * g) << trial;
    for (std::size_t p = 0; p < n; ++p) {
      if (found->rubbing[p] == Rubbing::sticks) {
        EXPECT_NEAR(u[p] + low, 0, 1e-7 * g) << trial;
      }
    }
  }
}

}  // namespace
}  // namespace continuo::friction_modes_test
