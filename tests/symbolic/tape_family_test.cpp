// Families on the tape: the equations of a grid become loops over neighbouring registers and compute the same values.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tests/language/check_helpers.hpp>

#include <continuo/numerics/lanes.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/symbolic/tape/tape_copy.hpp>
#include <continuo/symbolic/tape/tape_run.hpp>

namespace continuo::model {
namespace {

/// Interleaved families: of `count` families member i of family f is variable 1 + i*count + f. The parameters follow.
struct Grid {
  std::uint32_t count, points, parameters = 2;

  std::uint32_t variable(std::uint32_t family, std::uint32_t i) const { return 1 + i * count + family; }
  std::uint32_t parameter(std::uint32_t k) const { return 1 + count * points + k; }
  std::uint32_t size() const { return 1 + count * points + parameters; }
  std::vector<std::uint32_t> families() const {
    std::vector<std::uint32_t> numbers(size());
    for (std::uint32_t i = 0; i < points; ++i)
      for (std::uint32_t f = 0; f < count; ++f) numbers[variable(f, i)] = f + 1;
    return numbers;
  }
  TapeVariables plain() const {
    return {.variables = size(), .steady_begin = 1 + count * points, .steady_end = size()};
  }
  TapeVariables with(std::span<const std::uint32_t> numbers) const {
    TapeVariables variables = plain();
    variables.families = numbers;
    return variables;
  }
};

template <class Real>
std::vector<Real> run(const Tape& tape, std::uint32_t variables) {
  std::vector<Real> registers(tape.register_count()), outputs(tape.output_count());
  for (std::uint32_t i = 0; i < variables; ++i) registers[i] = Real(0.3 + 0.7 * std::sin(3.0 * i));
  tape.prepare<Real>(registers);
  tape.evaluate<Real>(registers, outputs);
  tape.evaluate<Real>(registers, outputs);  // a second time: nothing it needs may have been overwritten
  return outputs;
}

/// u' = 1 + u^2*v - 4*u + k*d2u, v' = 3*u - u^2*v + k*d2v, the ends held at 1 and 3.
std::vector<NodeId> brusselator(Graph& g, const Grid& grid) {
  const std::uint32_t n = grid.points;
  const auto at = [&](std::uint32_t family, std::uint32_t i) {  // point i of 1..n
    return i < 1 || i > n ? g.constant(family == 0 ? 1 : 3) : g.variable(grid.variable(family, i - 1));
  };
  std::vector<NodeId> rates;
  for (std::uint32_t i = 1; i <= n; ++i) {
    for (const std::uint32_t family : {0u, 1u}) {
      const NodeId u = at(0, i), product = g.multiply(g.multiply(u, u), at(1, i));
      const NodeId reaction = family == 0 ? g.subtract(g.add(g.constant(1), product), g.multiply(g.constant(4), u))
                                          : g.subtract(g.multiply(g.constant(3), u), product);
      const NodeId bent =
          g.add(g.subtract(at(family, i - 1), g.multiply(g.constant(2), at(family, i))), at(family, i + 1));
      rates.push_back(g.add(reaction, g.multiply(g.variable(grid.parameter(0)), bent)));
    }
  }
  return rates;
}

TEST(TapeFamily, EndsOfALineLeaveItsInnerPointsSideBySide) {
  Graph g;
  const Grid grid{.count = 2, .points = 100};
  const auto rates = brusselator(g, grid);
  const auto numbers = grid.families();
  const Tape tape(g, rates, grid.with(numbers));
  EXPECT_EQ(tape.size().gathered, 0u);
  EXPECT_LE(tape.size().batches, 11u);  // seven operations in u', four in v'
  EXPECT_LE(tape.size().single, 22u);   // each of those at the two ends, at most
  EXPECT_GT(Tape(g, rates, grid.plain()).size().gathered, 0u);
}

TEST(TapeFamily, TheOrderOfTheLoopsChangesNoDigit) {
  Graph g;
  const Grid grid{.count = 2, .points = 150};
  const auto rates = brusselator(g, grid);
  const auto numbers = grid.families();
  const Tape families(g, rates, grid.with(numbers)), plain(g, rates, grid.plain());
  EXPECT_EQ(run<double>(families, grid.size()), run<double>(plain, grid.size()));
  EXPECT_EQ(run<float>(families, grid.size()), run<float>(plain, grid.size()));
  EXPECT_EQ(run<long double>(families, grid.size()), run<long double>(plain, grid.size()));
}

/// A few formulas over points of random families near i, repeated for all i; at the ends with other operands, or
/// absent.
struct RandomGrid {
  explicit RandomGrid(unsigned seed) : random(seed), grid{.count = 1 + below(3), .points = 10 + below(120)} {
    struct Term {
      std::uint32_t operation, family, shift, other, other_shift;
    };
    for (std::uint32_t formula = 0; formula < 3; ++formula) {
      std::vector<Term> terms;
      for (std::uint32_t k = 0; k < 4; ++k)
        terms.push_back({below(6), below(grid.count), below(3), below(grid.count), below(3)});
      for (std::uint32_t i = 0; i < grid.points; ++i) {
        NodeId sum = g.constant(below(40) == 0 ? 2 : 1);
        for (const Term& t : terms)
          sum = grown(sum, t.operation, at(t.family, i + t.shift), at(t.other, i + t.other_shift));
        if (below(50) != 0) outputs.push_back(sum);
      }
    }
    for (std::uint32_t k = 0; k < 5; ++k) outputs.push_back(outputs[below(static_cast<std::uint32_t>(outputs.size()))]);
    outputs.push_back(g.constant(7));
    if (below(2) == 0) std::ranges::shuffle(outputs, random);
  }

  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); }

  NodeId at(std::uint32_t family, std::uint32_t shifted) {
    const bool outside = shifted < 1 || shifted > grid.points;
    return outside ? g.constant(0.5) : g.variable(grid.variable(family, shifted - 1));
  }

  NodeId grown(NodeId sum, std::uint32_t operation, NodeId a, NodeId b) {
    switch (operation) {
      case 0:
        return g.add(sum, g.multiply(a, b));
      case 1:
        return g.subtract(g.multiply(g.variable(grid.parameter(0)), g.subtract(a, b)), sum);
      case 2:
        return g.select(g.less(a, b), sum, a);
      case 3:
        return g.divide(sum, g.add(g.constant(2), g.multiply(b, b)));
      case 4:
        return g.apply(Op::sine, g.add(sum, a));
      default:
        return g.multiply(g.add(a, g.variable(grid.parameter(1))), sum);
    }
  }

  std::mt19937 random;
  Grid grid;
  Graph g;
  std::vector<NodeId> outputs;
};

TEST(TapeFamily, RandomGridsComputeWhatTheirExpressionsSay) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomGrid random(seed);
    const Grid& grid = random.grid;
    const auto numbers = grid.families();
    const Tape tape(random.g, random.outputs, grid.with(numbers)), plain(random.g, random.outputs, grid.plain());
    const auto computed = run<double>(tape, grid.size());
    EXPECT_EQ(computed, run<double>(plain, grid.size())) << "seed " << seed;
    EXPECT_EQ(run<float>(tape, grid.size()), run<float>(plain, grid.size())) << "seed " << seed;
    EXPECT_EQ(run<long double>(tape, grid.size()), run<long double>(plain, grid.size())) << "seed " << seed;
    std::vector<double> values(grid.size());
    for (std::uint32_t i = 0; i < values.size(); ++i) values[i] = 0.3 + 0.7 * std::sin(3.0 * i);
    for (std::size_t k = 0; k < computed.size(); ++k) {
      const double expected = evaluate(random.g, random.outputs[k], values);
      // Steady factors are gathered: some twenty operations on numbers below ten, each good to half a unit.
      EXPECT_NEAR(computed[k], expected, 1e-13 * (10 + std::abs(expected))) << "seed " << seed << " output " << k;
    }
  }
}

TEST(TapeFamily, LanesGoTheSameWay) {
  using Four = Lanes<double, 4>;
  Graph g;
  const Grid grid{.count = 2, .points = 75};
  const auto rates = brusselator(g, grid);
  const auto numbers = grid.families();
  const Tape tape(g, rates, grid.with(numbers));
  const auto alone = run<double>(tape, grid.size());
  const auto together = run<Four>(tape, grid.size());
  for (std::size_t k = 0; k < alone.size(); ++k)
    for (std::size_t lane = 0; lane < 4; ++lane) EXPECT_EQ(together[k][lane], alone[k]);
}

TEST(TapeFamily, SteadyVariablesAreReadWhereTheyAre) {
  // The families contain parameters: expressions that depend only on them are computed in advance, before anything
  // could be copied.
  Graph g;
  constexpr std::uint32_t n = 40;
  std::vector<std::uint32_t> numbers(2 + 2 * n);
  std::vector<NodeId> outputs;
  for (std::uint32_t i = 0; i < n; ++i) {
    const NodeId a = g.variable(2 + 2 * i), b = g.variable(3 + 2 * i);
    numbers[2 + 2 * i] = 1, numbers[3 + 2 * i] = 2;
    outputs.push_back(g.multiply(g.apply(Op::square_root, g.add(g.multiply(a, a), g.multiply(b, b))), g.variable(1)));
  }
  const Tape tape(g, outputs,
                  {.variables = 2 + 2 * n, .steady_begin = 2, .steady_end = 2 + 2 * n, .families = numbers});
  std::vector<double> registers(tape.register_count()), computed(n);
  for (const double scale : {1.0, 2.0}) {
    registers[1] = 10;
    for (std::uint32_t i = 0; i < n; ++i) registers[2 + 2 * i] = 3 * scale, registers[3 + 2 * i] = 4 * scale;
    tape.prepare<double>(registers);
    tape.evaluate<double>(registers, computed);
    EXPECT_EQ(computed, std::vector<double>(n, 50 * scale));
  }
}

// States and outputs at other places: the same values, and nothing else is written.
TEST(TapeFamily, StatesAndOutputsMayLieElsewhere) {
  constexpr std::uint32_t n = 40;
  for (const bool reads_t : {false, true}) {
    for (const bool reads_all_by_copies : {true, false}) {
      Graph g;
      std::vector<std::uint32_t> numbers(1 + 2 * n, 0), places;
      std::vector<NodeId> outputs;
      for (std::uint32_t i = 0; i < n; ++i) {
        const NodeId u = g.variable(1 + 2 * i), v = g.variable(2 + 2 * i), meet = g.multiply(g.multiply(u, u), v);
        outputs.push_back(g.subtract(meet, u));
        outputs.push_back(reads_t ? g.add(g.subtract(v, meet), g.variable(0)) : g.subtract(v, meet));
        numbers[1 + 2 * i] = 1;
        if (reads_all_by_copies) numbers[2 + 2 * i] = 2;
        places.insert(places.end(), {300 + 5 * i, 600 - 3 * i});
      }
      const Tape tape(g, outputs,
                      {.variables = 1 + 2 * n, .states_begin = 1, .states_end = 1 + 2 * n, .families = numbers});
      std::vector<double> whole(tape.register_count()), apart(tape.register_count(), -7), states(2 * n);
      for (std::uint32_t i = 0; i < 2 * n; ++i) whole[1 + i] = states[i] = std::sin(1 + i);
      whole[0] = apart[0] = 0.25;
      std::vector<double> expected(2 * n), computed(2 * n), placed(700, 5), expected_placed = placed;
      tape.prepare<double>(whole);
      tape.prepare<double>(apart);
      tape.evaluate<double>(whole, expected);
      tape.evaluate<double>(apart, states, computed);
      EXPECT_EQ(computed, expected);
      for (std::uint32_t k = 0; k < 2 * n; ++k) {
        EXPECT_EQ(expected[k], evaluate(g, outputs[k], whole));
        expected_placed[places[k]] = expected[k];
      }
      tape.evaluate<double>(apart, states, placed, tape.outputs_at(places));
      EXPECT_EQ(placed, expected_placed);
    }
  }
}

TEST(TapeFamily, RegularCopiesBringEachNumberToItsPlace) {
  std::mt19937 random(1);
  std::size_t joined = 0, parted = 0;
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  for (int repeat = 0; repeat < 300; ++repeat) {
    std::vector<tape::Place> places;
    std::uint32_t to = 0;
    for (std::uint32_t part = 0; part < 4; ++part) {
      const std::uint32_t mixed = 1 + below(20), count = below(60), from = below(100), step = below(4);
      if (part == 2) {  // two that take turns where they come from
        for (std::uint32_t k = 0; k < 2 * count; ++k)
          places.push_back({.from = 900 + from + k, .to = to + k / 2 + k % 2 * count});
        to += 2 * count;
        continue;
      }
      if (part % 2 == 1) {  // two that take turns where they go, not all along
        const std::uint32_t late = below(4), early = below(4);
        for (std::uint32_t k = 0; k + early < count; ++k) places.push_back({.from = from + k, .to = to + 2 * k});
        for (std::uint32_t k = late; k < count; ++k) places.push_back({.from = from + 300 + k, .to = to + 2 * k + 1});
        to += 2 * count;
        continue;
      }
      for (std::uint32_t k = 0; k < count; ++k)
        for (std::uint32_t m = 0; m < mixed; ++m) places.push_back({.from = from + 7 * m + step * k, .to = to++});
      for (std::uint32_t k = below(5); k > 0; --k) places.push_back({.from = below(500), .to = to++});
    }
    std::ranges::shuffle(places, random);
    if (repeat % 3 != 0) std::ranges::sort(places);
    const tape::Copies copies = tape::regular_copies(places);
    std::vector<int> from(2000), copied(to, -1);
    for (std::size_t i = 0; i < from.size(); ++i) from[i] = static_cast<int>(i);
    tape::run(copies, from.data(), copied.data());
    std::size_t written = copies.alone.size();
    for (const tape::Copy& copy : copies.regular) written += copy.count;
    for (const tape::Turns& turns : copies.joined) written += 2 * turns.count;
    for (const tape::Turns& turns : copies.parted) written += 2 * turns.count;
    joined += copies.joined.size(), parted += copies.parted.size();
    EXPECT_EQ(written, places.size());
    for (const tape::Place& place : places) EXPECT_EQ(copied[place.to], static_cast<int>(place.from));
  }
  EXPECT_GT(joined, 20u);
  EXPECT_GT(parted, 20u);
}

TEST(TapeFamily, MembersOfAModelsStatesAreFamilies) {
  const Model model = good(R"(model Line
param N = 50, k = 2
for i in 1..N { u[i](0) = i/N; v[i](0) = 1 - i/N }
u[1]' = u[1]^2*v[1] + k*(u[2] - u[1])
v[1]' = -u[1]^2*v[1] - k*v[1]
for i in 2..N {
  u[i]' = u[i]^2*v[i] + k*(u[i-1] - u[i])
  v[i]' = -u[i]^2*v[i] - k*v[i]
}
run 0..1
)");
  const auto program = compile(model);
  const Tape::Size size = program->derivatives[0]->size();
  EXPECT_GE(size.batched, 3 * 49u);
  EXPECT_EQ(size.gathered, 0u);
}

}  // namespace
}  // namespace continuo::model
