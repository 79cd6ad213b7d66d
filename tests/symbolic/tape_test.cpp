// The tape computes the values of its expressions, with all optimizations.
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/numerics/lanes.hpp>
#include <continuo/symbolic/tape/tape_run.hpp>

namespace continuo::model {
namespace {

constexpr std::uint32_t states = 12, parameters = 4, variables = 1 + states + parameters;
constexpr TapeVariables layout = {.variables = variables, .steady_begin = 1 + states, .steady_end = variables};

template <class Real>
std::vector<Real> run(const Tape& tape, const std::vector<double>& values) {
  std::vector<Real> registers(tape.register_count()), outputs(tape.output_count());
  for (std::size_t i = 0; i < values.size(); ++i) registers[i] = static_cast<Real>(values[i]);
  tape.prepare<Real>(registers);
  tape.evaluate<Real>(registers, outputs);
  tape.evaluate<Real>(registers, outputs);  // a second time: nothing it needs may have been overwritten
  return outputs;
}

/// Random expressions of sums, products and functions, with values of order one.
class RandomExpressions {
 public:
  explicit RandomExpressions(unsigned seed) : random_(seed) {
    for (std::uint32_t i = 0; i < variables; ++i) nodes.push_back(g.variable(i));
    for (double c : {2.0, -1.0, 0.5, 3.0}) nodes.push_back(g.constant(c));
  }

  NodeId any() { return nodes[random_() % nodes.size()]; }

  void grow() {
    NodeId made;
    switch (random_() % 12) {
      case 0:
        made = g.apply(Op::sine, any());
        break;
      case 1:
        made = g.apply(Op::hyperbolic_tangent, any());
        break;
      case 2:
        made = g.negate(any());
        break;
      case 3:
        made = g.select(g.less(any(), any()), any(), any());
        break;
      case 4:
        made = g.divide(any(), g.add(g.constant(1.5), g.apply(Op::absolute, any())));
        break;
      case 5:
        made = g.apply(Op::maximum, any(), any());
        break;
      case 6:
      case 7:
        made = g.subtract(any(), any());
        break;
      case 8:
        made = g.add(any(), any());
        break;
      default:
        made = g.multiply(g.apply(Op::arc_tangent, any()), any());
    }
    nodes.push_back(made);
  }

  Graph g;
  std::vector<NodeId> nodes;

 private:
  std::mt19937 random_;
};

TEST(Tape, AgreesWithTheExpressionsOnRandomOnes) {
  std::vector<double> values;
  for (std::uint32_t i = 0; i < variables; ++i) values.push_back(0.3 + 0.7 * std::sin(3.0 * i));
  for (unsigned seed = 0; seed < 200; ++seed) {
    RandomExpressions e(seed);
    for (int i = 0; i < 60; ++i) e.grow();
    const std::vector<NodeId> outputs(e.nodes.end() - 10, e.nodes.end());
    const Tape tape(e.g, outputs, layout);
    const auto computed = run<double>(tape, values);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      const double expected = evaluate(e.g, outputs[i], values);
      // Steady factors are gathered: sixty operations, each good to half a unit in the last place.
      EXPECT_NEAR(computed[i], expected, 1e-11 * (1 + std::abs(expected))) << "seed " << seed << " output " << i;
    }
  }
}

// One operation each, in the order of the text: every digit is that of the expression.
TEST(Tape, SumsAndProductsOfThreeAreOneOperation) {
  Graph g;
  const NodeId a = g.variable(1), b = g.variable(2), c = g.variable(3), d = g.variable(4);
  const NodeId outputs[] = {
      g.multiply(g.multiply(a, b), c),
      g.multiply(d, g.multiply(b, c)),
      g.subtract(g.add(a, b), g.multiply(c, d)),
      g.add(g.subtract(a, g.multiply(b, c)), d),
      g.add(d, g.subtract(b, g.multiply(a, c))),
      g.negate(g.multiply(g.multiply(a, c), d)),
      g.negate(g.subtract(g.multiply(a, d), g.add(b, c))),
      g.negate(g.add(g.subtract(c, g.multiply(a, b)), d)),
  };
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const NodeId output : outputs) {
    const Tape tape(g, std::span(&output, 1), layout);
    EXPECT_LE(tape.size().single, g[output].op == Op::negate ? 2u : 1u);
    for (int repeat = 0; repeat < 100; ++repeat) {
      std::vector<double> values(variables);
      for (double& value : values) value = uniform(random);
      EXPECT_EQ(run<double>(tape, values).front(), evaluate(g, output, values));
    }
  }
}

TEST(Tape, WhatHangsOnParametersAloneIsPrepared) {
  Graph g;
  const NodeId x = g.variable(1), k = g.variable(1 + states), m = g.variable(2 + states);
  const NodeId acceleration = g.multiply(g.divide(g.negate(k), m), x);  // -k/m*x
  const Tape tape(g, std::vector{acceleration}, layout);
  EXPECT_EQ(tape.size().single, 1u);
  EXPECT_GE(tape.size().prepared, 1u);
  const NodeId spelled_otherwise = g.divide(g.negate(g.multiply(k, x)), m);  // -k*x/m
  EXPECT_EQ(Tape(g, std::vector{spelled_otherwise}, layout).size().single, 1u);
}

TEST(Tape, SmoothCostsNothing) {
  Graph g;
  const NodeId x = g.variable(1), y = g.variable(2), k = g.variable(1 + states);
  const NodeId bare = g.multiply(k, g.apply(Op::absolute, x)), smooth = g.apply(Op::smooth, bare);
  ASSERT_NE(bare, smooth);
  const auto outputs = [&](NodeId e) { return std::vector{g.add(y, e), g.multiply(e, y), e}; };
  const Tape with(g, outputs(smooth), layout), without(g, outputs(bare), layout);
  EXPECT_EQ(with.size().single, without.size().single);
  EXPECT_EQ(with.size().prepared, without.size().prepared);
  EXPECT_EQ(with.register_count(), without.register_count());
  const std::vector<double> values(variables, -3);
  EXPECT_EQ(run<double>(with, values), run<double>(without, values));
}

TEST(Tape, ChangedParametersNeedNoNewTape) {
  Graph g;
  const Tape tape(g, std::vector{g.multiply(g.apply(Op::square_root, g.variable(1 + states)), g.variable(1))}, layout);
  std::vector<double> values(variables, 3);
  values[1 + states] = 4;
  EXPECT_EQ(run<double>(tape, values)[0], 6);
  values[1 + states] = 16;
  EXPECT_EQ(run<double>(tape, values)[0], 12);
}

/// u[i]' = D*(u[i-1] - 2*u[i] + u[i+1])/dx^2 on a line held at 0.
std::vector<NodeId> heat(Graph& g, std::uint32_t n) {
  const auto u = [&](std::uint32_t i) { return i < 1 || i > n ? g.constant(0) : g.variable(i); };
  const NodeId d = g.variable(n + 1), dx = g.variable(n + 2);
  std::vector<NodeId> rates;
  for (std::uint32_t i = 1; i <= n; ++i) {
    const NodeId bent = g.add(g.subtract(u(i - 1), g.multiply(g.constant(2), u(i))), u(i + 1));
    rates.push_back(g.divide(g.multiply(d, bent), g.multiply(dx, dx)));
  }
  return rates;
}

TEST(Tape, FamiliesBecomeLoops) {
  Graph g;
  constexpr std::uint32_t n = 100;
  const auto rates = heat(g, n);
  const Tape tape(g, rates, {.variables = n + 3, .steady_begin = n + 1, .steady_end = n + 3});
  EXPECT_LE(tape.size().single + tape.size().batches, 20u);
  EXPECT_GE(tape.size().batched, n - 2);
  std::vector<double> values(n + 3);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::cos(0.1 * static_cast<double>(i * i));
  const auto computed = run<double>(tape, values);
  for (std::size_t i = 0; i < n; ++i) {
    const double expected = evaluate(g, rates[i], values);
    EXPECT_NEAR(computed[i], expected, 1e-14 * (1 + std::abs(expected)));
  }
}

/// x[i]'' = sum over j != i of m[j]*(x[j] - x[i])/r^3 in the plane, written as a model writes it.
std::vector<NodeId> galaxy(Graph& g, std::uint32_t n) {
  const auto x = [&](std::uint32_t i) { return g.variable(1 + i); };
  const auto y = [&](std::uint32_t i) { return g.variable(1 + n + i); };
  const auto mass = [&](std::uint32_t i) { return g.variable(1 + 2 * n + i); };
  std::vector<NodeId> accelerations;
  for (const bool vertical : {false, true}) {
    const auto along = [&](std::uint32_t i) { return vertical ? y(i) : x(i); };
    for (std::uint32_t i = 0; i < n; ++i) {
      NodeId sum = g.constant(0);
      for (std::uint32_t j = 0; j < n; ++j) {
        if (j == i) continue;
        const NodeId dx = g.subtract(x(j), x(i)), dy = g.subtract(y(j), y(i));
        const NodeId r = g.apply(Op::square_root, g.add(g.multiply(dx, dx), g.multiply(dy, dy)));
        const NodeId pull = g.divide(g.multiply(mass(j), g.subtract(along(j), along(i))), g.power(r, g.constant(3)));
        sum = g.add(sum, pull);
      }
      accelerations.push_back(sum);
    }
  }
  return accelerations;
}

TEST(Tape, EachPairOfBodiesComputesItsDistanceOnce) {
  Graph g;
  constexpr std::uint32_t n = 20, pairs = n * (n - 1) / 2;
  const auto accelerations = galaxy(g, n);
  std::size_t roots = 0;
  for (std::uint32_t i = 0; i < g.size(); ++i) roots += g[NodeId{i}].op == Op::square_root;
  EXPECT_EQ(roots, pairs);
  const Tape tape(g, accelerations, {.variables = 1 + 3 * n, .steady_begin = 1 + 2 * n, .steady_end = 1 + 3 * n});
  std::vector<double> values(1 + 3 * n);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 1 + std::sin(7.0 * static_cast<double>(i * i));
  const auto computed = run<double>(tape, values);
  for (std::size_t i = 0; i < accelerations.size(); ++i) {
    const double expected = evaluate(g, accelerations[i], values);
    EXPECT_NEAR(computed[i], expected, 1e-12 * (1 + std::abs(expected)));
  }
}

TEST(Tape, ComputesInOtherPrecisions) {
  Graph g;
  const Tape tape(g, std::vector{g.apply(Op::square_root, g.variable(1))}, layout);
  const std::vector<double> values(variables, 2);
  EXPECT_EQ(run<float>(tape, values)[0], std::sqrt(2.0f));
  EXPECT_EQ(run<long double>(tape, values)[0], std::sqrt(2.0L));
}

TEST(Tape, ReadsTables) {
  Graph g;
  const std::vector<Table> tables = {Table({0, 1, 3}, {0, 2, 2}, Table::Between::linear)};
  const std::vector<NodeId> outputs = {g.interpolate(0, g.variable(0)), g.interpolate_slope(0, g.variable(0))};
  const Tape tape(g, outputs, layout, tables);
  std::vector<double> values(variables, 0.25);
  EXPECT_EQ(run<double>(tape, values), (std::vector<double>{0.5, 2}));
  values[0] = 5;
  EXPECT_EQ(run<double>(tape, values), (std::vector<double>{2, 0}));
}

TEST(Tape, LanesGiveWhatSingleNumbersGive) {
  using Four = Lanes<double, 4>;
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomExpressions e(seed);
    for (int i = 0; i < 60; ++i) e.grow();
    const std::vector<NodeId> outputs(e.nodes.end() - 10, e.nodes.end());
    const Tape tape(e.g, outputs, layout);
    std::vector<Four> registers(tape.register_count()), together(outputs.size());
    std::vector<std::vector<double>> alone;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      std::vector<double> values;
      for (std::uint32_t i = 0; i < variables; ++i) values.push_back(std::sin(3.0 * i + static_cast<double>(lane)));
      for (std::uint32_t i = 0; i < variables; ++i) registers[i].set(lane, values[i]);
      alone.push_back(run<double>(tape, values));
    }
    tape.prepare<Four>(registers);
    tape.evaluate<Four>(registers, together);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      for (std::size_t lane = 0; lane < 4; ++lane) {
        // The elementary functions of lanes differ from those of <cmath> by a few units in the last place.
        EXPECT_NEAR(together[i][lane], alone[lane][i], 1e-12 * (1 + std::abs(alone[lane][i])));
      }
    }
  }
}

TEST(Tape, LanesReadTablesOneByOne) {
  Graph g;
  const std::vector<Table> tables = {Table({0, 1}, {0, 2}, Table::Between::linear)};
  const Tape tape(g, std::vector{g.interpolate(0, g.variable(0))}, {.variables = 1}, tables);
  std::vector<Lanes<double, 4>> registers(tape.register_count()), out(1);
  for (std::size_t lane = 0; lane < 4; ++lane) registers[0].set(lane, 0.25 * static_cast<double>(lane));
  tape.prepare<Lanes<double, 4>>(registers);
  tape.evaluate<Lanes<double, 4>>(registers, out);
  for (std::size_t lane = 0; lane < 4; ++lane) EXPECT_EQ(out[0][lane], 0.5 * static_cast<double>(lane));
}

/// A dual number: the least that a type for automatic differentiation must provide.
struct Dual {
  double value = 0, slope = 0;
  Dual() = default;
  explicit Dual(double v, double s = 0) : value(v), slope(s) {}
  friend Dual operator+(Dual a, Dual b) { return Dual(a.value + b.value, a.slope + b.slope); }
  [[maybe_unused]] friend Dual operator-(Dual a, Dual b) { return Dual(a.value - b.value, a.slope - b.slope); }
  [[maybe_unused]] friend Dual operator-(Dual a) { return Dual(-a.value, -a.slope); }
  friend Dual operator*(Dual a, Dual b) { return Dual(a.value * b.value, a.value * b.slope + a.slope * b.value); }
};

TEST(Tape, OperationsAreGenericOverTypesThatCarryDerivatives) {
  using tape::Code;
  // d(x*y + z)/dx = y
  const Dual d = tape::operate<Code::multiply_add>(Dual(2, 1), Dual(5), Dual(1), Dual());
  EXPECT_EQ(d.value, 11);
  EXPECT_EQ(d.slope, 5);
}

TEST(Tape, OutputsMayBeVariablesAndConstants) {
  Graph g;
  const Tape tape(g, std::vector{g.variable(2), g.constant(7), g.variable(2)}, layout);
  std::vector<double> values(variables, 5);
  EXPECT_EQ(run<double>(tape, values), (std::vector<double>{5, 7, 5}));
}

TEST(Tape, NothingIsATapeToo) {
  Graph g;
  EXPECT_TRUE(run<double>(Tape(g, {}, layout), std::vector<double>(variables)).empty());
}

}  // namespace
}  // namespace continuo::model
