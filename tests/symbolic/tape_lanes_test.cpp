// Tapes for several runs at once against the tape for each run alone, bit by bit: random expressions of every
// operation, families in loops, tables, values that are no numbers.
#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "native_referee.hpp"
#include "random_expressions.hpp"
#include <continuo/symbolic/tape/tape_lanes.hpp>
#include <continuo/symbolic/tape/wide_vectors.hpp>

namespace continuo::model {
namespace {

using namespace random_expressions_test;

template <class Register>
void expect_each_lane_alone(const Tape& tape, std::mt19937& random) {
  std::vector<Register> registers(tape.register_count()), outputs(tape.output_count());
  std::vector<std::vector<double>> values;
  for (std::size_t lane = 0; lane < Register::width; ++lane) {
    values.push_back(random_values(random));
    for (std::size_t i = 0; i < variables; ++i) registers[i].set(lane, values.back()[i]);
  }
  tape.prepare<Register>(registers);
  tape.evaluate<Register>(registers, outputs);
  for (std::size_t lane = 0; lane < Register::width; ++lane) {
    const std::vector<double> alone = evaluated(tape, values[lane]);
    for (std::size_t k = 0; k < alone.size(); ++k)
      ASSERT_EQ(bits(outputs[k][lane]), bits(alone[k])) << "lane " << lane << ", output " << k;
  }
}

void expect_each_lane_alone(Graph& g, const std::vector<NodeId>& expressions, std::mt19937& random) {
  const Tape tape(g, expressions, layout, tables());
  for (int i = 0; i < 10; ++i) {
    expect_each_lane_alone<TapeLanes>(tape, random);
    if (has_wide_vectors()) expect_each_lane_alone<WideTapeLanes>(tape, random);
  }
}

TEST(TapeLanes, HaveTheBitsOfEachRunAlone) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Graph g;
    expect_each_lane_alone(g, random_expressions(g, random, 10 + seed * 10), random);
  }
}

TEST(TapeLanes, OfFamiliesHaveTheBitsOfEachRunAlone) {
  std::size_t loops = 0;
  for (unsigned seed = 100; seed < 120; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Graph g;
    const std::vector<NodeId> expressions = random_family(g, random);
    loops += Tape(g, expressions, layout, tables()).size().batches;
    expect_each_lane_alone(g, expressions, random);
  }
  EXPECT_GT(loops, 20u);
}

}  // namespace
}  // namespace continuo::model
