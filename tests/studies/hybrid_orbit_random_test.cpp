// Multipliers and exponents of random piecewise linear maps and flows against closed forms: what is found is right,
// what is not found says why.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/studies/forcing_period.hpp>
#include <continuo/studies/hybrid_orbit.hpp>
#include <continuo/studies/lyapunov.hpp>

namespace continuo::studies {
namespace {

using Real = long double;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;  // without the heap
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1, 0, 4, 1>;

/// More of them than in the suite, for a longer look: CONTINUO_RANDOM_ORBITS=2000.
int members(int usual) {
  const char* asked = std::getenv("CONTINUO_RANDOM_ORBITS");
  return asked != nullptr ? std::max(usual, std::atoi(asked)) : usual;
}

std::vector<std::complex<double>> sorted_eigenvalues(const RealMatrix& m) {
  std::vector<std::complex<double>> values;
  const auto found = Eigen::EigenSolver<RealMatrix>(m, false).eigenvalues();
  for (Eigen::Index i = 0; i < found.size(); ++i)
    values.emplace_back(static_cast<double>(found[i].real()), static_cast<double>(found[i].imag()));
  return values;
}

/// Each of the expected ones is among the found ones; of nearly equal ones the digits are those of a double root.
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

/// Where the map comes to after a long way, if that repeats within `most` steps.
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
    if (std::abs(x[0] - map.level) < 1e-5L) return std::nullopt;  // as good as a corner
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
    // The averages over 100 periods end within a cycle, so that at most what one cycle does is left.
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

/// exp(h [[A, b], [0, 0]]) by its series, after halving: what x' = A x + b does in a time of h.
struct LinearFlow {
  RealMatrix a;
  RealVector b;

  RealVector rates(const RealVector& x) const { return a * x + b; }
  RealMatrix exponential(Real h) const {
    const Eigen::Index n = b.size();
    RealMatrix m = RealMatrix::Zero(n + 1, n + 1);
    m.topLeftCorner(n, n) = a * h;
    m.topRightCorner(n, 1) = b * h;
    int halvings = 0;
    while (m.norm() > 0.5L) m /= 2, ++halvings;
    RealMatrix sum = RealMatrix::Identity(n + 1, n + 1), term = sum;
    for (int k = 1; k < 30 && term.norm() > 1e-22L; ++k) {
      term = (term * m).eval() / static_cast<Real>(k);
      sum += term;
    }
    for (int k = 0; k < halvings; ++k) sum = (sum * sum).eval();
    return sum;
  }
};

/// Two modes; at c x = level, risen through in the first and fallen through in the second, the other one's turn comes,
/// after x := R x + r.
struct RandomFlow {
  LinearFlow flow[2];
  RealVector c;
  double level[2] = {0, 0};
  RealMatrix jump[2];
  RealVector shift[2];

  RandomFlow(Eigen::Index n, bool jumps, std::mt19937_64& random) {
    std::uniform_real_distribution<double> entry(-1, 1);
    c = RealVector::Zero(n);
    c[0] = 1;
    for (Eigen::Index i = 1; i < n; ++i) c[i] = 0.5 * entry(random);
    level[0] = 0.3 + 0.2 * entry(random);
    level[1] = -0.3 + 0.2 * entry(random);
    for (int mode = 0; mode < 2; ++mode) {
      flow[mode].a.resize(n, n);
      flow[mode].b.resize(n);
      jump[mode] = RealMatrix::Identity(n, n);
      shift[mode] = RealVector::Zero(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        flow[mode].b[i] = (mode == 0 ? 1 : -1) * (i == 0 ? 1.5 : 0.5) + 0.5 * entry(random);
        for (Eigen::Index k = 0; k < n; ++k) flow[mode].a(i, k) = 1.5 * entry(random) - (i == k ? 1.0 : 0.0);
        if (!jumps) continue;
        shift[mode][i] = 0.1 * entry(random);
        for (Eigen::Index k = 0; k < n; ++k) jump[mode](i, k) += 0.3 * entry(random);
      }
    }
  }

  static std::string linear(const RealMatrix& m, const RealVector& v, Eigen::Index i) {
    std::string text = fmt::format("{:.17g}", static_cast<double>(v[i]));
    for (Eigen::Index k = 0; k < v.size(); ++k) text += fmt::format(" + {:.17g}*x{}", static_cast<double>(m(i, k)), k);
    return text;
  }
  std::string text() const {
    std::string all;
    const Eigen::Index n = c.size();
    for (int mode = 0; mode < 2; ++mode) {
      all += mode == 0 ? "mode up {" : "mode down {";
      for (Eigen::Index i = 0; i < n; ++i)
        all += fmt::format("{}x{}' = {}", i == 0 ? " " : "; ", i, linear(flow[mode].a, flow[mode].b, i));
      all += " }\n";
    }
    all += "start in up\n";
    for (Eigen::Index i = 0; i < n; ++i) all += fmt::format("x{}(0) = 0\n", i);
    std::string guard;
    for (Eigen::Index i = 0; i < n; ++i)
      guard += fmt::format("{}{:.17g}*x{}", i == 0 ? "" : " + ", static_cast<double>(c[i]), i);
    for (int mode = 0; mode < 2; ++mode) {
      all += fmt::format("when {} {} through {:.17g} in {} {{ go {}", guard, mode == 0 ? "rises" : "falls", level[mode],
                         mode == 0 ? "up" : "down", mode == 0 ? "down" : "up");
      for (Eigen::Index i = 0; i < n; ++i) all += fmt::format("; x{} := {}", i, linear(jump[mode], shift[mode], i));
      all += " }\n";
    }
    return all + "run 0..200\n";
  }
};

struct Turn {
  Real time = 0;
  RealVector x;
  RealMatrix product;
};

constexpr Real short_time = 0.01L;

/// From just behind the jump into `mode` to just behind the next; nothing where there is none within a time of 50.
/// `step` is the exponential of a short time. The product is asked for only where the turn is to be differentiated.
std::optional<Turn> half_turn(const RandomFlow& system, int mode, const RealMatrix& step, const RealVector& begin,
                              bool differentiated) {
  const LinearFlow& flow = system.flow[mode];
  const Eigen::Index n = begin.size();
  const Real h = short_time;
  const auto state = [&](const RealVector& x, Real time) {
    const RealMatrix e = flow.exponential(time);
    return RealVector(e.topLeftCorner(n, n) * x + e.topRightCorner(n, 1));
  };
  const Real sign = mode == 0 ? 1 : -1;
  const auto height = [&](const RealVector& x) { return sign * (system.c.dot(x) - system.level[mode]); };
  RealVector x = begin;
  for (int k = 0; k < 5000; ++k) {
    const RealVector next = step.topLeftCorner(n, n) * x + step.topRightCorner(n, 1);
    if (height(x) < 0 && height(next) >= 0) {
      // Newton's method from where the chord crosses: h is short, so that a few steps are exact.
      Real at = h * height(x) / (height(x) - height(next));
      Real move = h;
      for (int newton = 0; newton < 6 && std::abs(move) > 1e-18L; ++newton) {
        const RealVector there = state(x, at);
        move = height(there) / (sign * system.c.dot(flow.rates(there)));
        at -= move;
      }
      const RealVector hit = state(x, at);
      const RealVector before = flow.rates(hit);
      Turn turn{k * h + at, system.jump[mode] * hit + system.shift[mode], {}};
      const RealVector after = system.flow[1 - mode].rates(turn.x);
      const Real speed = system.c.dot(before);
      if (std::abs(speed) < 1e-4L) return std::nullopt;  // as good as touched only
      if (!differentiated) return turn;
      const RealMatrix saltation =
          system.jump[mode] + (after - system.jump[mode] * before) * system.c.transpose() / speed;
      turn.product = saltation * flow.exponential(turn.time).topLeftCorner(n, n);
      return turn;
    }
    x = next;
  }
  return std::nullopt;
}

struct FlowCycle {
  Real period = 0;
  RealMatrix product;
};

/// After many turns, if these repeat within `most`. `bounded`: whether it stays where it began, near the levels; far
/// from them it switches ever faster.
std::optional<FlowCycle> cycle_of(const RandomFlow& system, std::size_t most, bool& bounded) {
  const Eigen::Index n = system.c.size();
  RealVector x = RealVector::Zero(n);
  const RealMatrix step[2] = {system.flow[0].exponential(short_time), system.flow[1].exponential(short_time)};
  const auto whole_turn = [&](bool differentiated) -> std::optional<Turn> {
    const auto first = half_turn(system, 0, step[0], x, differentiated);
    if (!first) return std::nullopt;
    const auto second = half_turn(system, 1, step[1], first->x, differentiated);
    bounded = bounded && first->x.norm() < 30 && (!second || second->x.norm() < 30);
    if (!second || !bounded) return std::nullopt;
    Turn turn{first->time + second->time, second->x, {}};
    if (differentiated) turn.product = second->product * first->product;
    return turn;
  };
  for (int k = 0; k < 100; ++k) {
    const auto turn = whole_turn(false);
    if (!turn) return std::nullopt;
    x = turn->x;
  }
  const RealVector begin = x;
  FlowCycle cycle{0, RealMatrix::Identity(n, n)};
  for (std::size_t k = 0; k < most; ++k) {
    const auto turn = whole_turn(true);
    if (!turn) return std::nullopt;
    cycle.period += turn->time;
    cycle.product = turn->product * cycle.product;
    x = turn->x;
    if ((x - begin).norm() < 1e-11L) return cycle;
  }
  return std::nullopt;
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

}  // namespace
}  // namespace continuo::studies
