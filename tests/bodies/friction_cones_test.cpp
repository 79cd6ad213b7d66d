// Forces of contacts with friction in space that act together obey Coulomb's law, and are found wherever they must
// exist; forces that are not determined are moved to where they are within their cones.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_rigid/friction_cones.hpp>

namespace continuo::friction_cones_test {
namespace {

/// Contacts with random rows, of bodies that have so many ways to move: where these are few, forces are not determined.
ConeProblem<double> random_problem(std::mt19937& engine, std::size_t contacts, std::size_t ways) {
  const auto number = [&](double low, double high) { return std::uniform_real_distribution(low, high)(engine); };
  ConeProblem<double> problem;
  for (std::size_t k = 0; k < contacts; ++k) problem.contacts.push_back({.friction = number(0.1, 0.9), .slip = {}});
  const std::size_t all = 3 * contacts;
  std::vector<double> rows(all * ways), speeds(ways);
  for (double& part : rows) part = number(-1, 1);
  for (double& part : speeds) part = number(-1, 1);
  problem.matrix.resize(all * all), problem.rates.resize(all);
  for (std::size_t i = 0; i < all; ++i)
    for (std::size_t w = 0; w < ways; ++w) {
      problem.rates[i] += rows[i * ways + w] * speeds[w];
      for (std::size_t j = 0; j < all; ++j) problem.matrix[j * all + i] += rows[i * ways + w] * rows[j * ways + w];
    }
  return problem;
}
/// The rates with forces.
std::vector<double> rates_with(const ConeProblem<double>& problem, const std::vector<double>& forces) {
  std::vector<double> after = problem.rates;
  for (std::size_t j = 0; j < forces.size(); ++j)
    for (std::size_t i = 0; i < forces.size(); ++i) after[i] += problem.matrix[j * forces.size() + i] * forces[j];
  return after;
}
// With all contacts at rest there are always such impulses (D. E. Stewart, J. C. Trinkle, "An implicit time-stepping
// scheme for rigid body dynamics with inelastic collisions and Coulomb friction", 1996).
TEST(FrictionCones, ImpulsesObeyCoulombsLaw) {
  std::mt19937 engine(5);
  std::array<int, 3> met{};
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t contacts = 1 + engine() % 8, ways = contacts + 2;
    const ConeProblem<double> problem = random_problem(engine, contacts, ways);
    const auto found = FrictionCones<double>(problem).solve();
    ASSERT_TRUE(found) << trial;
    const std::vector<double> after = rates_with(problem, found->forces);
    double size = 1;
    for (const double force : found->forces) size = std::max(size, std::abs(force));
    const double small = 1e-8 * size;
    for (std::size_t k = 0; k < contacts; ++k) {
      const double normal = found->forces[3 * k], p = found->forces[3 * k + 1], q = found->forces[3 * k + 2];
      const double u = after[3 * k + 1], v = after[3 * k + 2], most = problem.contacts[k].friction * normal;
      EXPECT_GE(normal, -small) << trial;
      EXPECT_GE(after[3 * k], -small) << trial;
      EXPECT_NEAR(normal * after[3 * k], 0, small * size) << trial;
      EXPECT_LE(std::hypot(p, q), most + small) << trial;
      EXPECT_NEAR(p * u + q * v, -most * std::hypot(u, v), small * size) << trial;  // against the slip, with all of it
      ++met[static_cast<std::size_t>(found->modes[k])];
    }
  }
  for (const int often : met) EXPECT_GT(often, 50);
}
// A plate on three legs of friction 1/2, each of which bears 1. By the principle of virtual power a torque turns it if
// it does more than friction in a turn about some centre.
TEST(FrictionCones, ForcesThatAreNotDeterminedReachTheGreatestTorque) {
  const std::array<std::array<double, 2>, 3> legs{{{1, 0}, {-0.5, 0.8}, {-0.5, -0.8}}};
  const std::array friction{0.5, 0.5, 0.5};
  std::vector<double> matrix(81);
  const auto row = [&](std::size_t k, std::size_t i) {  // of the ways along x, y, z, and of the turns about them
    const double x = legs[k][0], y = legs[k][1];
    if (i == 0) return std::array<double, 6>{0, 0, 1, y, -x, 0};
    if (i == 1) return std::array<double, 6>{1, 0, 0, 0, 0, -y};
    return std::array<double, 6>{0, 1, 0, 0, 0, x};
  };
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < 9; ++j)
      for (std::size_t w = 0; w < 6; ++w) matrix[j * 9 + i] += row(i / 3, i % 3)[w] * row(j / 3, j % 3)[w];
  // The best forces under a torque: along the slips of a turn about some centre, here by trying many centres.
  const auto bears = [&](double torque) {
    double least = 1e9;
    for (int i = -200; i <= 200; ++i)
      for (int j = -200; j <= 200; ++j) {
        double power = 0;  // of friction where the plate turns about a centre with 1 rad/s
        for (const auto& leg : legs) power += 0.5 * std::hypot(leg[0] - 0.01 * i, leg[1] - 0.01 * j);
        least = std::min(least, power - torque);
      }
    return least;  // below 0 where the torque turns it
  };
  const double limit = bears(0);  // of the torque, by the principle of virtual power
  for (const double share : {0.9, 0.999, 1.001, 1.1}) {
    std::vector<double> forces(9);
    for (std::size_t k = 0; k < 3; ++k) forces[3 * k] = 1;
    forces[1] = 0, forces[2] = share * limit / 1.5;  // as a couple of the first leg and the two others
    forces[5] = forces[8] = -forces[2] / 2;
    const double room = ConeRoom<double>(matrix, friction).widen(forces);
    EXPECT_EQ(room > 0, share < 1) << share << ' ' << room;
    double torque = 0, sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
      torque += legs[k][0] * forces[3 * k + 2] - legs[k][1] * forces[3 * k + 1], sum += forces[3 * k + 1];
    EXPECT_NEAR(torque, share * limit, 1e-10);
    EXPECT_NEAR(sum, 0, 1e-10);
  }
}
// Where the rates along the normal and across it respond to each other's forces, friction and acceleration are against
// each other for few directions only.
TEST(FrictionCones, ASlipBeginsAgainstItsFriction) {
  std::mt19937 engine(7);
  int slips = 0;
  for (int trial = 0; trial < 200; ++trial) {
    ConeProblem<double> problem = random_problem(engine, 1, 3);
    problem.contacts[0].friction *= 0.3;
    const auto found = FrictionCones<double>(problem).solve();
    ASSERT_TRUE(found);
    if (found->modes[0] != ConeMode::slips) continue;
    ++slips;
    const auto& slip = found->slips[0];
    const auto after = rates_with(problem, found->forces);
    EXPECT_NEAR(slip[0] * after[2] - slip[1] * after[1], 0, 1e-12);
    EXPECT_GT(slip[0] * after[1] + slip[1] * after[2], 0);
    EXPECT_NEAR(std::atan2(slip[1], slip[0]), std::atan2(after[2], after[1]), 1e-10);
  }
  EXPECT_GT(slips, 20);
}

}  // namespace
}  // namespace continuo::friction_cones_test
