// Fused operations in the machine code of a tape, each against std::fma.
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "native_referee.hpp"
#include "random_expressions.hpp"
#include <continuo/symbolic/native/native_compiler.hpp>

namespace continuo::model::fused_test {
namespace {

using namespace random_expressions_test;

std::vector<double> fused_values(const Graph& g, const std::vector<NodeId>& outputs, const std::vector<double>& values,
                                 NativeCompiler& native) {
  const auto tape = std::make_shared<const Tape>(g, outputs, layout, tables());
  native.watch(tape, Fusing::equations);
  EXPECT_TRUE(tape->is_native()) << native.report().trouble;
  return evaluated(*tape, values);
}

std::vector<double> normal_values(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values(variables);
  for (double& value : values) value = normal(random);
  return values;
}

/// Each has four variables of its own, so that its products are read once.
TEST(Fused, EveryProductThatOneSumReadsIsRoundedWithIt) {
  if (!has_fused_operations()) GTEST_SKIP() << why_not(NativeUse::fused);
  const TestFolder folder;
  NativeCompiler native({NativeUse::fused, folder.path / "cache"});
  const std::vector<double> values = normal_values(1);
  Graph g;
  std::vector<NodeId> outputs;
  std::vector<double> expected;
  std::uint32_t next = 1;
  const auto add = [&](const auto& form, const auto& value) {
    const NodeId a = g.variable(next), b = g.variable(next + 1), c = g.variable(next + 2), d = g.variable(next + 3);
    outputs.push_back(form(a, b, c, d));
    expected.push_back(value(values[next], values[next + 1], values[next + 2], values[next + 3]));
    next += 4;
  };
  using Node = NodeId;
  add([&](Node a, Node b, Node c, Node) { return g.add(g.multiply(a, b), c); },
      [](double a, double b, double c, double) { return std::fma(a, b, c); });
  add([&](Node a, Node b, Node c, Node) { return g.subtract(g.multiply(a, b), c); },
      [](double a, double b, double c, double) { return std::fma(a, b, -c); });
  add([&](Node a, Node b, Node c, Node) { return g.subtract(c, g.multiply(a, b)); },
      [](double a, double b, double c, double) { return std::fma(-a, b, c); });
  add([&](Node a, Node b, Node c, Node) { return g.negate(g.add(g.multiply(a, b), c)); },
      [](double a, double b, double c, double) { return -std::fma(a, b, c); });
  add([&](Node a, Node b, Node c, Node d) { return g.add(g.multiply(a, b), g.multiply(c, d)); },
      [](double a, double b, double c, double d) { return std::fma(a, b, c * d); });
  add([&](Node a, Node b, Node c, Node d) { return g.subtract(g.multiply(a, b), g.multiply(c, d)); },
      [](double a, double b, double c, double d) { return std::fma(a, b, -(c * d)); });
  add([&](Node a, Node b, Node c, Node d) { return g.negate(g.add(g.multiply(a, b), g.multiply(c, d))); },
      [](double a, double b, double c, double d) { return -std::fma(a, b, c * d); });
  add([&](Node a, Node b, Node c, Node d) { return g.subtract(g.add(c, d), g.multiply(a, b)); },
      [](double a, double b, double c, double d) { return std::fma(-a, b, c + d); });
  add([&](Node a, Node b, Node c, Node d) { return g.add(g.subtract(c, g.multiply(a, b)), d); },
      [](double a, double b, double c, double d) { return std::fma(-a, b, c) + d; });
  add([&](Node a, Node b, Node c, Node d) { return g.add(g.multiply(g.multiply(a, b), c), d); },
      [](double a, double b, double c, double d) { return std::fma(a * b, c, d); });
  const std::vector<double> actual = fused_values(g, outputs, values, native);
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_EQ(bits(actual[k]), bits(expected[k])) << "output " << k;
}

TEST(Fused, AProductThatTwoReadIsRoundedItself) {
  if (!has_fused_operations()) GTEST_SKIP() << why_not(NativeUse::fused);
  const TestFolder folder;
  NativeCompiler native({NativeUse::fused, folder.path / "cache"});
  const std::vector<double> values = normal_values(2);
  Graph g;
  const NodeId product = g.multiply(g.variable(1), g.variable(2));
  const std::vector<NodeId> outputs{g.add(product, g.variable(3)), g.subtract(product, g.variable(4))};
  const std::vector<double> actual = fused_values(g, outputs, values, native);
  EXPECT_EQ(bits(actual[0]), bits(evaluated(Tape(g, outputs, layout, tables()), values)[0]));
  EXPECT_EQ(bits(actual[1]), bits(evaluated(Tape(g, outputs, layout, tables()), values)[1]));
}

/// What nobody has allowed to be fused, and what is a loop, keeps the bits of the tape.
TEST(Fused, OnlyWhereItIsAllowed) {
  if (!has_fused_operations()) GTEST_SKIP() << why_not(NativeUse::fused);
  const TestFolder folder;
  NativeCompiler native({NativeUse::fused, folder.path / "cache"});
  const std::vector<double> values = normal_values(3);
  Graph g;
  std::vector<NodeId> outputs;
  for (std::uint32_t i = 1; i <= 20; ++i)
    outputs.push_back(g.add(g.multiply(g.variable(i), g.variable(i + 1)), g.variable(i + 20)));
  const Tape plain(g, outputs, layout, tables());
  const std::vector<double> expected = evaluated(plain, values);
  const std::vector<double> in_a_loop = fused_values(g, outputs, values, native);
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_EQ(bits(in_a_loop[k]), bits(expected[k]));
  outputs.resize(5);
  const auto guards = std::make_shared<const Tape>(g, outputs, layout, tables());
  native.watch(guards);
  const std::vector<double> of_guards = evaluated(*guards, values);
  for (std::size_t k = 0; k < outputs.size(); ++k) EXPECT_EQ(bits(of_guards[k]), bits(expected[k]));
  const std::vector<double> fused = fused_values(g, outputs, values, native);
  std::size_t others = 0;
  for (std::size_t k = 0; k < outputs.size(); ++k) others += bits(fused[k]) != bits(expected[k]) ? 1 : 0;
  EXPECT_GT(others, 0u);
}

TEST(Fused, AFailureOfTheCompilerIsCounted) {
  const TestFolder folder;
  setenv("CC", "false", 1);
  NativeCompiler native({NativeUse::fused, folder.path / "cache"});
  Graph g;
  const std::vector<NodeId> outputs{g.add(g.variable(1), g.variable(2))};
  native.watch(std::make_shared<const Tape>(g, outputs, layout, tables()), Fusing::equations);
  unsetenv("CC");
  EXPECT_EQ(native.report().failed, 1u);
  EXPECT_NE(native.report().trouble, "");
}

}  // namespace
}  // namespace continuo::model::fused_test
