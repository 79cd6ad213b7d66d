// Tapes for several runs at once against the tape for each run alone, bit by bit: random expressions of every
// operation, families in loops, tables, values that are no numbers.
#include <algorithm>
#include <cstddef>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "native_referee.hpp"
#include "random_expressions.hpp"
#include <continuo/symbolic/native/native_compiler.hpp>
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

/// The same by machine code, which reads the states from an array of their own.
void expect_machine_code(Graph& g, const std::vector<NodeId>& expressions, std::mt19937& random,
                         NativeCompiler& native) {
  const auto tape = std::make_shared<const Tape>(g, expressions, layout, tables());
  const std::shared_ptr<NativeFunction> code = native.lane_code(tape);
  ASSERT_NE(code->code(), nullptr) << native.report().trouble;
  for (int i = 0; i < 10; ++i) {
    std::vector<TapeLanes> registers(tape->register_count()), states_of(states), outputs(tape->output_count());
    std::vector<std::vector<double>> values;
    for (std::size_t lane = 0; lane < TapeLanes::width; ++lane) {
      values.push_back(random_values(random));
      for (std::size_t k = 0; k < variables; ++k)
        (k >= 1 && k <= states ? states_of[k - 1] : registers[k]).set(lane, values.back()[k]);
    }
    tape->prepare<TapeLanes>(registers);
    reinterpret_cast<NativeLaneEvaluation>(code->code())(registers.front().numbers.data(),
                                                         states_of.front().numbers.data(),
                                                         outputs.front().numbers.data(), nullptr, nullptr);
    for (std::size_t lane = 0; lane < TapeLanes::width; ++lane) {
      const std::vector<double> alone = evaluated(*tape, values[lane]);
      for (std::size_t k = 0; k < alone.size(); ++k)
        ASSERT_EQ(bits(outputs[k][lane]), bits(alone[k])) << "lane " << lane << ", output " << k;
    }
  }
}

TEST(TapeLanes, MachineCodeHasTheBitsOfEachRunAlone) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  for (unsigned seed = 0; seed < 2; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Graph g;
    expect_machine_code(g, random_expressions(g, random, 60 + seed * 60), random, *native);
    expect_machine_code(g, random_family(g, random), random, *native);
  }
  EXPECT_EQ(native->report().trouble, "");
}

}  // namespace
}  // namespace continuo::model
