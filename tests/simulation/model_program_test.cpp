// The properties of a compiled model.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <tests/language/check_helpers.hpp>

#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/program/model_system.hpp>

namespace continuo::model {
namespace {

TEST(ModelProgram, KnowsWhetherADerivativeReadsTheTime) {
  const auto is_autonomous = [](const char* text) { return compile(good(text))->autonomous; };
  EXPECT_TRUE(is_autonomous("model M\nx' = -x\nx(0) = 1\nrun 0..1\n"));
  EXPECT_TRUE(is_autonomous("model M\nx' = -x\nx(0) = 1\noutput late = x*t\nrun 0..1\n"));
  EXPECT_FALSE(is_autonomous("model M\nparam w = 2\nx' = -x + sin(w*t)\nx(0) = 1\nrun 0..1\n"));
  EXPECT_FALSE(is_autonomous(R"(model M
mode still { x' = -x }
mode driven { x' = t - x }
x(0) = 1
when x falls through 0.5 { go driven }
run 0..1
)"));
}

/// The expressions of a copy may change: what was made of those of the other program would be wrong.
TEST(ModelProgram, MakesATapeOnceForAllRunsAndNoneForACopy) {
  const auto program = compile(good("model M\nx' = -x\nx(0) = 1\nrun 0..1\n"));
  const std::span<const NodeId> nodes = program->model.modes.front().derivatives;
  const auto tape = program->shared_tape_of(nodes);
  EXPECT_EQ(program->shared_tape_of(nodes), tape);
  ModelProgram copy = *program;
  EXPECT_NE(copy.shared_tape_of(nodes), tape);
  EXPECT_EQ(program->shared_tape_of({}), program->shared_tape_of({}));
  EXPECT_NE(program->shared_tape_of({}), tape);
}

TEST(ModelProgram, HasABlockForTheLimitOfEachEvent) {
  const auto program = compile(good(R"(model Ball
mode flight { h'' = -10 }
mode rest { h'' = 0 }
h(0) = 1; h'(0) = -3
when h rises through 5 { stop }
when h falls through 0 in flight { h' := -h'/2 } then { h := h'/4; if h > 0 { go rest } else { stop } }
run 0..1
)"));
  ASSERT_EQ(program->limit_blocks.size(), 2U);
  EXPECT_TRUE(program->limit_blocks[0].actions.empty());
  EXPECT_EQ(program->limit_blocks[0].tape->output_count(), 0U);
  const ProgramBlock& block = program->limit_blocks[1];
  ASSERT_EQ(block.actions.size(), 2U);
  EXPECT_EQ(block.actions[1].otherwise.at(0).target, 1U);  // the second `stop` of the model
  EXPECT_EQ(program->stops, 2U);
  std::vector<double> registers(block.tape->register_count()), values(block.tape->output_count());
  const std::vector<double> start = start_values(program->model);
  std::copy(start.begin(), start.end(), registers.begin());
  block.tape->prepare<double>(registers);
  block.tape->evaluate<double>(registers, values);
  EXPECT_EQ(values.at(block.actions[0].expression), -0.75);
}

// The row of a held state is zero, in the order of the pattern and in the band.
TEST(ModelSystem, AHeldStateHasNoDerivativesInABandEither) {
  const auto program = compile(good(R"(model Line
param N = 30
for i in 1..N { u[i](0) = i/N }
u[1]' = u[2] - 2*u[1]
for i in 2..N-1 { u[i]' = u[i-1] - 2*u[i] + u[i+1]^2 }
u[N]' = u[N-1] - 2*u[N]
run 0..1
)"));
  ModelSystem system(program, start_values(program->model));
  const SparsePattern& pattern = system.jacobian_pattern();
  ASSERT_TRUE(pattern.is_banded());
  const std::vector<std::uint32_t> places = pattern.places_in_band();
  const std::vector<double> x(30, 0.75);
  std::vector<double> values(pattern.entries()), band(pattern.band().numbers());
  for (const bool held : {false, true}) {
    if (held) system.hold({7});
    system.jacobian_values(0, x, values);
    system.jacobian_band(0, x, band);
    EXPECT_EQ(values[pattern.find(7, 7)], held ? 0 : -2);
    EXPECT_EQ(values[pattern.find(7, 8)], held ? 0 : 1.5);
    for (std::size_t p = 0; p < places.size(); ++p) EXPECT_EQ(band[places[p]], values[p]);
  }
}

}  // namespace
}  // namespace continuo::model
