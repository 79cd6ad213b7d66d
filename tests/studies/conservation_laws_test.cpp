// Conservation laws found in random networks, and their use where they hold, against closed forms.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/studies/conservation_laws.hpp>
#include <continuo/studies/continuation.hpp>
#include <continuo/studies/equilibrium.hpp>
#include <continuo/studies/orbit_continuation.hpp>
#include <continuo/studies/periodic_orbit.hpp>

namespace continuo::studies::conservation_laws_test {
namespace {

using Vector = std::vector<double>;

/// x' = S v(x), v_j = k_j prod x_i^order_ij: random reactions of up to two molecules on either side.
struct Network {
  Eigen::MatrixXi change;  // S
  Eigen::MatrixXi order;
  Vector rates;

  Network(std::mt19937& random, int species, int reactions)
      : change(Eigen::MatrixXi::Zero(species, reactions)), order(Eigen::MatrixXi::Zero(species, reactions)) {
    std::uniform_int_distribution<int> any(0, species - 1), molecules(1, 2);
    std::uniform_real_distribution<double> rate(0.2, 5);
    for (int j = 0; j < reactions; ++j) {
      for (int k = molecules(random); k > 0; --k) ++order(any(random), j);
      change.col(j) -= order.col(j);
      for (int k = molecules(random); k > 0; --k) ++change(any(random), j);
      rates.push_back(rate(random));
    }
  }
  /// Reactions that consume the same molecules are one term of f: only their total change is visible.
  Eigen::MatrixXd seen() const {
    Eigen::MatrixXd columns(change.rows(), change.cols());
    int count = 0;
    for (int j = 0; j < change.cols(); ++j) {
      int first = 0;
      while (order.col(first) != order.col(j)) ++first;
      if (first < j) continue;
      columns.col(count).setZero();
      for (int k = j; k < change.cols(); ++k)
        if (order.col(k) == order.col(j))
          columns.col(count) += rates[static_cast<std::size_t>(k)] * change.col(k).cast<double>();
      ++count;
    }
    return columns.leftCols(count);
  }
  ParametricSystem system() const {
    return parametric_system(static_cast<std::size_t>(change.rows()),
                             [network = *this](double, Values x, Values, std::span<double> out) {
                               std::ranges::fill(out, 0.0);
                               for (int j = 0; j < network.change.cols(); ++j) {
                                 double speed = network.rates[static_cast<std::size_t>(j)];
                                 for (int i = 0; i < network.change.rows(); ++i)
                                   for (int k = 0; k < network.order(i, j); ++k)
                                     speed *= x[static_cast<std::size_t>(i)];
                                 for (int i = 0; i < network.change.rows(); ++i)
                                   out[static_cast<std::size_t>(i)] += network.change(i, j) * speed;
                               }
                             });
  }
};

TEST(ConservationLaws, AreThoseOfRandomNetworks) {
  std::mt19937 random(7);
  int with_laws = 0;
  for (int k = 0; k < 200; ++k) {
    const int species = 2 + k % 9, reactions = 1 + static_cast<int>(random() % static_cast<unsigned>(species + 3));
    const Network network(random, species, reactions);
    std::uniform_real_distribution<double> amount(0.1, 4);
    Vector start(static_cast<std::size_t>(species));
    for (double& x : start) x = amount(random);
    const Eigen::MatrixXd columns = network.seen();
    const auto laws = conservation_laws_of(network.system(), start);
    ASSERT_EQ(static_cast<Eigen::Index>(laws.size()), species - Eigen::FullPivLU<Eigen::MatrixXd>(columns).rank()) << k;
    with_laws += !laws.empty();
    Eigen::MatrixXd rows(laws.size(), species);
    for (std::size_t i = 0; i < laws.size(); ++i) {
      rows.row(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::RowVectorXd>(laws[i].weights.data(), species);
      double value = 0;
      for (std::size_t j = 0; j < start.size(); ++j) value += laws[i].weights[j] * start[j];
      EXPECT_NEAR(laws[i].value, value, 1e-12 * (1 + std::abs(value)));
    }
    if (laws.empty()) continue;
    EXPECT_LE((rows * columns).cwiseAbs().maxCoeff(),
              1e-8 * rows.cwiseAbs().maxCoeff() * columns.cwiseAbs().maxCoeff());
    EXPECT_EQ(Eigen::FullPivLU<Eigen::MatrixXd>(rows).rank(), rows.rows());
  }
  EXPECT_GE(with_laws, 50);
}

// Reversible reactions of first order, on graphs of several parts: in each part the total is conserved, and the
// equilibrium is the unique solution of K x = 0 with that total. It is stable and the only one.
TEST(ConservationLaws, HeldGiveTheRestThatTheMotionComesTo) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> rate(0.2, 5);
  for (int k = 0; k < 60; ++k) {
    const int n = 3 + k % 8, parts = 1 + k % 3;
    Eigen::MatrixXd flow = Eigen::MatrixXd::Zero(n, n);
    const auto react = [&](int a, int b) {
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
        const double speed = rate(random);
        flow(to, from) += speed;
        flow(from, from) -= speed;
      }
    };
    for (int i = parts; i < n; ++i) react(i - parts, i);  // i belongs to the part i mod parts
    Vector start(static_cast<std::size_t>(n));
    for (double& x : start) x = rate(random);
    const auto free = parametric_system(start.size(), [flow](double, Values x, Values, std::span<double> out) {
      Eigen::Map<Eigen::VectorXd>(out.data(), flow.rows()) =
          flow * Eigen::Map<const Eigen::VectorXd>(x.data(), flow.rows());
    });
    const auto laws = conservation_laws_of(free, start);
    ASSERT_EQ(laws.size(), static_cast<std::size_t>(parts));
    const auto held = holding(free, laws, [start](Values) { return start; });
    const auto found =
        find_equilibria(held, {.low = Vector(start.size(), 0), .high = Vector(start.size(), 60), .starts = 20});
    ASSERT_EQ(found.equilibria.size(), 1u);
    EXPECT_TRUE(found.equilibria[0].isolated);
    EXPECT_EQ(found.equilibria[0].stability, Stability::asymptotically_stable);
    EXPECT_EQ(found.equilibria[0].eigenvalues.size(), static_cast<std::size_t>(n - parts));
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n + parts, n);
    Eigen::VectorXd wanted = Eigen::VectorXd::Zero(n + parts);
    rows.topRows(n) = flow;
    for (int i = 0; i < n; ++i) rows(n + i % parts, i) = 1, wanted(n + i % parts) += start[static_cast<std::size_t>(i)];
    const Eigen::VectorXd x = rows.colPivHouseholderQr().solve(wanted);
    for (int i = 0; i < n; ++i) EXPECT_NEAR(found.equilibria[0].x[static_cast<std::size_t>(i)], x(i), 1e-9);
    // No eigenvalue of the motion is lost or made up: those of K but the zeros.
    Eigen::VectorXd own = flow.eigenvalues().real();
    std::ranges::sort(own);
    for (int i = 0; i < n - parts; ++i) {
      const auto& all = found.equilibria[0].eigenvalues;
      EXPECT_TRUE(std::ranges::any_of(all, [&](const auto& value) { return std::abs(value - own(i)) < 1e-8; }))
          << own(i);
    }
  }
}

/// x + z = u is conserved; x, y tend to the circle of radius r, r^2 = p, with the period 2 pi / (1 + u).
struct Circles {
  ParametricSystem held;
  PeriodicOrbit orbit;

  Circles() {
    const auto free = parametric_system(3,
                                        [](double, Values x, Values p, std::span<double> out) {
                                          const double shrink = p[0] - x[0] * x[0] - x[1] * x[1];
                                          const double turn = 1 + x[0] + x[2];
                                          out[0] = shrink * x[0] - turn * x[1];
                                          out[1] = shrink * x[1] + turn * x[0];
                                          out[2] = -out[0];
                                        },
                                        {1.0});
    const Vector start{0.5, 0.2, 1.3};
    held = holding(free, conservation_laws_of(free, start), [start](Values) { return start; });
    orbit = find_periodic_orbit(held, start, {.settle = 20, .duration = 20});
  }
  static constexpr double period = 2 * std::numbers::pi / 2.8;
};

TEST(ConservationLaws, HeldLeaveOneOrbitOfMany) {  // with one multiplier beside its own
  const Circles circles;
  const PeriodicOrbit& orbit = circles.orbit;
  ASSERT_EQ(circles.held.conserved, 1u);
  ASSERT_TRUE(orbit.outcome) << describe(orbit.outcome);
  EXPECT_NEAR(orbit.period, Circles::period, 1e-8);
  ASSERT_EQ(orbit.multipliers.size(), 2u);
  EXPECT_NEAR(std::abs(orbit.multipliers[1] - std::exp(-2 * orbit.period)), 0, 1e-7);
  EXPECT_TRUE(orbit.stable);
}

TEST(ConservationLaws, HeldLeaveOneBranchOfOrbits) {  // on each the multiplier is exp(-2 p T)
  const Circles circles;
  ASSERT_TRUE(circles.orbit.outcome) << describe(circles.orbit.outcome);
  const auto branch = continue_orbit(circles.held, circles.orbit, {.low = 0.5, .high = 2});
  ASSERT_GE(branch.points.size(), 5u);
  for (const OrbitPoint& point : branch.points) {
    EXPECT_NEAR(point.period, Circles::period, 1e-7);
    ASSERT_EQ(point.multipliers.size(), 1u);
    EXPECT_NEAR(point.multipliers[0].real(), std::exp(-2 * point.constant * point.period), 1e-6);
  }
}

// The continuation parameter is the total: a + b = p, a' = b - 2 a, at equilibrium a = p / 3.
TEST(ConservationLaws, MoveWithTheStart) {
  const auto free = parametric_system(2,
                                      [](double, Values x, Values, std::span<double> out) {
                                        out[0] = x[1] - 2 * x[0];
                                        out[1] = -out[0];
                                      },
                                      {3.0});
  const auto laws = conservation_laws_of(free, Vector{3, 0});
  ASSERT_EQ(laws.size(), 1u);
  const auto held = holding(free, laws, [](Values p) { return Vector{p[0], 0}; });
  const auto branch = continue_equilibrium(held, {1, 2}, {.low = 1, .high = 9});
  EXPECT_TRUE(branch.status) << branch.status.message;
  EXPECT_TRUE(branch.bifurcations.empty());
  for (const BranchPoint& point : branch.points) {
    EXPECT_NEAR(point.x[0], point.constant / 3, 1e-9);
    EXPECT_EQ(point.stability, Stability::asymptotically_stable);
  }
}

TEST(ConservationLaws, WhatHoldsNearbyAloneIsNone) {  // beyond 10^3 x goes on, and for p != 1 the sum does
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    out[0] = x[0] > 1e3 ? 1 : 0;
    out[1] = x[0] - x[1];
    out[2] = p[0] * (x[1] - x[0]);
  };
  EXPECT_TRUE(conservation_laws_of(parametric_system(3, f, {1.0}), Vector{1, 2, 3}).empty());
}

}  // namespace
}  // namespace continuo::studies::conservation_laws_test
