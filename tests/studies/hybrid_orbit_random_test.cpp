// Multipliers and exponents of random piecewise linear maps and flows against closed forms: an orbit that is found is
// right, a failure states its reason.
#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "problems.hpp"
#include "random_flows.hpp"
#include <continuo/studies/hybrid_orbit.hpp>
#include <continuo/studies/lyapunov.hpp>
#include <continuo/studies/support/forcing_period.hpp>

namespace continuo::studies {
namespace {

/// Each expected value is among those found; nearly equal ones have only the accuracy of a double root.
void expect_same(std::vector<std::complex<double>> found, const std::vector<std::complex<double>>& expected,
                 double accuracy, const std::string& text) {
  ASSERT_EQ(found.size(), expected.size()) << text;
  for (const auto& value : expected) {
    const auto nearest =
        std::ranges::min_element(found, {}, [&](const auto& other) { return std::abs(other - value); });
    EXPECT_LE(std::abs(*nearest - value), accuracy * std::max(1.0, std::abs(value))) << text;
    found.erase(nearest);
  }
}

/// x -> A_j x + b_j with j by the sign of x_0 - level.
struct RandomMap {
  RealMatrix a[2];
  RealVector b[2];
  double level = 0;

  RandomMap(Eigen::Index n, std::mt19937_64& random) {
    std::uniform_real_distribution<double> entry(-0.9, 0.9), place(-1, 1);
    for (int side = 0; side < 2; ++side) {
      a[side].resize(n, n);
      b[side].resize(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        b[side][i] = place(random);
        for (Eigen::Index k = 0; k < n; ++k) a[side](i, k) = entry(random);
      }
    }
    level = 0.3 * place(random);
  }

  std::string text() const {
    std::string all;
    const Eigen::Index n = b[0].size();
    for (Eigen::Index i = 0; i < n; ++i) all += fmt::format("x{0}' = 0\nx{0}(0) = 0.1\n", i);
    const auto branch = [&](int side) {
      std::string actions;
      for (Eigen::Index i = 0; i < n; ++i) {
        actions += fmt::format("x{} := {:.17g}", i, static_cast<double>(b[side][i]));
        for (Eigen::Index k = 0; k < n; ++k)
          actions += fmt::format(" + {:.17g}*x{}", static_cast<double>(a[side](i, k)), k);
        actions += "; ";
      }
      return actions;
    };
    return all + fmt::format("every 1 {{ if x0 > {:.17g} {{ {} }} else {{ {} }} }}\nrun 0..300\n", level, branch(1),
                             branch(0));
  }
};

struct Cycle {
  std::size_t length = 0;
  RealMatrix product;
};

/// The cycle that the map reaches after many iterations, if it repeats within `most` steps.
std::optional<Cycle> cycle_of(const RandomMap& map, std::size_t most) {
  const Eigen::Index n = map.b[0].size();
  RealVector x = RealVector::Constant(n, 0.1L);
  const auto step = [&](int side) { x = map.a[side] * x + map.b[side]; };
  for (int k = 0; k < 5000; ++k) {
    step(x[0] > map.level ? 1 : 0);
    if (!(x.norm() < 1e6L)) return std::nullopt;
  }
  const RealVector begin = x;
  Cycle cycle{0, RealMatrix::Identity(n, n)};
  while (cycle.length < most) {
    if (std::abs(x[0] - map.level) < 1e-5L) return std::nullopt;  // too close to the corner
    const int side = x[0] > map.level ? 1 : 0;
    cycle.product = map.a[side] * cycle.product;
    step(side);
    ++cycle.length;
    if ((x - begin).norm() < 1e-13L) return cycle;
  }
  return std::nullopt;
}

TEST(RandomPiecewiseLinearMaps, HaveTheMultipliersAndExponentsOfTheirCycles) {
  std::mt19937_64 random(20);
  int cycles = 0, found_cycles = 0;
  for (int member = 0; member < members(100); ++member) {
    const RandomMap map(1 + static_cast<Eigen::Index>(random() % 3), random);
    const std::string text = map.text();
    const auto program = program_of(text);
    const HybridOrbit found =
        find_hybrid_orbit(program, {}, {.settle = 300, .duration = 40, .forcing = forcing_of(*program).period});
    const std::optional<Cycle> expected = cycle_of(map, 16);
    if (!found.outcome) {
      EXPECT_NE(found.outcome.hint, "") << text;
      continue;
    }
    if (!expected || found.found_nearby) continue;
    ++cycles;
    EXPECT_EQ(found.turns, expected->length) << text;
    if (found.turns != expected->length) continue;
    ++found_cycles;
    const auto multipliers = sorted_eigenvalues(expected->product);
    expect_same(found.multipliers, multipliers, 1e-6, text);
    // The averages over 100 periods end within a cycle, so that the error is at most the contribution of one cycle.
    const LyapunovExponents exponents = lyapunov_exponents(program, {}, {.duration = 100, .settle = 100});
    ASSERT_EQ(exponents.exponents.size(), multipliers.size());
    std::vector<double> logarithms;
    for (const auto& value : multipliers)
      logarithms.push_back(std::log(std::abs(value)) / static_cast<double>(expected->length));
    std::ranges::sort(logarithms, std::ranges::greater());
    for (std::size_t i = 0; i < logarithms.size(); ++i) {
      if (logarithms[i] < -3) continue;  // below what neighbours can show
      EXPECT_NEAR(exponents.exponents[i], logarithms[i], 0.1) << text;
    }
  }
  EXPECT_GT(cycles, members(100) / 5);
  EXPECT_EQ(found_cycles, cycles);
}

TEST(RandomPiecewiseLinearFlows, HaveTheMultipliersOfTheirClosedForms) {
  std::mt19937_64 random(30);
  int cycles = 0, refused = 0;
  for (int member = 0; member < members(100); ++member) {
    const RandomFlow system(1 + static_cast<Eigen::Index>(random() % 3), member % 2 == 1, random);
    const std::string text = system.text();
    bool bounded = true;
    const std::optional<FlowCycle> expected = cycle_of(system, 8, bounded);
    if (!bounded) continue;
    const HybridOrbit found = find_hybrid_orbit(program_of(text), {}, {.settle = 25, .duration = 8});
    if (!found.outcome) {
      EXPECT_NE(found.outcome.hint, "") << text;
      if (expected) ++refused, ADD_FAILURE() << found.outcome.hint << "\n" << text;
      continue;
    }
    if (!expected || found.found_nearby) continue;
    ++cycles;
    EXPECT_NEAR(found.period, static_cast<double>(expected->period), 1e-8 * found.period) << text;
    expect_same(found.multipliers, sorted_eigenvalues(expected->product), 1e-6, text);
  }
  EXPECT_GT(cycles, members(100) / 5);
  EXPECT_EQ(refused, 0);
}

// Over whole periods each exponent is the logarithm of a multiplier's absolute value divided by the period, up to an
// error since the directions are not orthogonal. It is bounded by the condition number of the eigenvectors, for any
// number of periods.
TEST(RandomPiecewiseLinearFlows, HaveTheExponentsOfTheirClosedForms) {
  std::mt19937_64 random(31);
  int cycles = 0;
  for (int member = 0; member < members(40); ++member) {
    const RandomFlow system(1 + static_cast<Eigen::Index>(random() % 3), member % 2 == 1, random);
    bool bounded = true;
    const std::optional<FlowCycle> expected = cycle_of(system, 4, bounded);
    if (!bounded || !expected) continue;
    ++cycles;
    const std::string text = system.text();
    const auto period = static_cast<double>(expected->period);
    const double duration = period * std::ceil(8 / period);
    const LyapunovExponents found =
        lyapunov_exponents(program_of(text), {}, {.duration = duration, .settle = 15 * period});
    ASSERT_TRUE(found.outcome) << describe(found.outcome) << "\n" << text;
    std::vector<double> logarithms;
    for (const auto& value : sorted_eigenvalues(expected->product))
      logarithms.push_back(std::log(std::abs(value)) / period);
    std::ranges::sort(logarithms, std::ranges::greater());
    ASSERT_EQ(found.exponents.size(), logarithms.size()) << text;
    for (std::size_t i = 0; i < logarithms.size(); ++i) {
      if (logarithms[i] * period < -12) continue;  // below what neighbours can show
      EXPECT_NEAR(found.exponents[i], logarithms[i], (0.1 + crookedness(expected->product)) / duration)
          << i << " period " << period << " duration " << duration << "\n"
          << text;
    }
  }
  EXPECT_GT(cycles, members(40) / 5);
}

}  // namespace
}  // namespace continuo::studies
