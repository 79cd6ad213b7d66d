// Expressions: equal ones are one node, simplification preserves values, printed text parses to the same expression.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/symbolic/graph/expression.hpp>

namespace continuo::model {
namespace {

class Expression : public testing::Test {
 protected:
  Graph g;
  NodeId t = g.variable(0), x = g.variable(1), y = g.variable(2), k = g.variable(3);

  NodeId number(double value) { return g.constant(value); }
  std::string text(NodeId id) {
    return to_text(g, id, [](std::uint32_t i) { return std::string(1, "txyk"[i]); });
  }
};

TEST_F(Expression, EqualExpressionsAreOneNode) {
  EXPECT_EQ(g.add(x, y), g.add(y, x));
  EXPECT_EQ(g.multiply(k, g.add(x, y)), g.multiply(g.add(y, x), k));
  EXPECT_NE(g.subtract(x, y), g.subtract(y, x));
  EXPECT_EQ(g.subtract(x, y), g.negate(g.subtract(y, x)));
  EXPECT_EQ(text(g.subtract(x, y)) + text(g.subtract(y, x)), "x - yy - x");
}

// Whatever is made in whatever order: no two nodes are the same operation on the same arguments.
TEST_F(Expression, NoExpressionIsThereTwice) {
  std::mt19937 random(5);
  std::vector<NodeId> nodes{t, x, y, k};
  for (int i = 0; i < 20'000; ++i) {
    // A quarter of the arguments are those of hundreds of other operations.
    const auto any = [&] {
      if (random() % 4 == 0) return nodes[random() % 4];
      return nodes[nodes.size() - 1 - random() % std::min<std::size_t>(nodes.size(), 60)];
    };
    NodeId made;
    switch (random() % 10) {
      case 0:
        made = g.constant(static_cast<double>(random() % 50));
        break;
      case 1:
        made = g.variable(static_cast<std::uint32_t>(random() % 90));
        break;
      case 2:
        made = g.select(g.less(any(), any()), any(), any());
        break;
      case 3:
        made = g.apply(random() % 2 == 0 ? Op::sine : Op::negate, any());
        break;
      default:
        constexpr Op all[] = {Op::add, Op::subtract, Op::multiply, Op::divide, Op::minimum, Op::arc_tangent2};
        made = g.apply(all[random() % std::size(all)], any(), any());
    }
    nodes.push_back(made);
  }
  std::set<std::tuple<Op, std::uint32_t, NodeId, NodeId, NodeId, std::uint64_t>> seen;
  for (std::uint32_t i = 0; i < g.size(); ++i) {
    const Node& node = g[NodeId{i}];
    const auto value = std::bit_cast<std::uint64_t>(g.value(NodeId{i}).value_or(0));
    EXPECT_TRUE(seen.emplace(node.op, node.number, node.a, node.b, node.c, value).second)
        << i << " is there already: " << name(node.op);
  }
  EXPECT_GT(g.size(), 5000u);
}

// Numbers that follow each other, and numbers far from all others, first seen while the graph is small or large.
TEST_F(Expression, AVariableIsOneNodeWhateverItsNumber) {
  std::mt19937 random(7);
  std::map<std::uint32_t, NodeId> made{{0, t}, {1, x}, {2, y}, {3, k}};
  for (int i = 0; i < 20'000; ++i) {
    const std::uint32_t beyond[] = {0, 900, 8'000, 1u << 30, 0xffffff00};
    const std::uint32_t number = beyond[random() % std::size(beyond)] + static_cast<std::uint32_t>(random() % 256);
    if (random() % 2 == 0) static_cast<void>(g.constant(i));
    const NodeId variable = g.variable(number);
    EXPECT_EQ(g[variable].op, Op::variable);
    EXPECT_EQ(g[variable].number, number);
    EXPECT_EQ(made.emplace(number, variable).first->second, variable) << number;
  }
  const std::size_t size = g.size();
  for (const auto& [number, variable] : made) EXPECT_EQ(g.variable(number), variable) << number;
  EXPECT_EQ(g.size(), size);
}

TEST_F(Expression, NeutralElementsVanish) {
  EXPECT_EQ(g.add(x, number(0)), x);
  EXPECT_EQ(g.multiply(number(1), x), x);
  EXPECT_EQ(g.divide(x, number(1)), x);
  EXPECT_EQ(g.negate(g.negate(x)), x);
  EXPECT_EQ(g.subtract(x, g.negate(y)), g.add(x, y));
  EXPECT_EQ(g.add(x, g.negate(y)), g.subtract(x, y));
  EXPECT_EQ(g.power(x, number(2)), g.multiply(x, x));
  EXPECT_EQ(g.power(x, number(0.5)), g.apply(Op::square_root, x));
}

TEST_F(Expression, ZeroTimesAnExpressionIsZeroOnlyWhereItCannotBeInfinite) {
  EXPECT_TRUE(g.is(g.multiply(number(0), g.add(x, y)), 0));
  EXPECT_FALSE(g.is(g.multiply(number(0), g.divide(x, y)), 0));
  EXPECT_FALSE(g.is(g.multiply(number(0), g.apply(Op::logarithm, x)), 0));
}

TEST_F(Expression, ConstantsAreFolded) {
  EXPECT_TRUE(g.is(g.multiply(number(6), number(7)), 42));
  EXPECT_TRUE(g.is(g.apply(Op::square_root, number(2)), std::sqrt(2.0)));
  EXPECT_TRUE(g.is(g.less(number(1), number(2)), 1));
  EXPECT_EQ(g.select(g.less(number(1), number(2)), x, y), x);
}

TEST_F(Expression, SmoothStandsRoundWhatHasCornersAndNowhereElse) {
  const NodeId jump = g.apply(Op::sign, x), kept = g.apply(Op::smooth, g.multiply(y, jump));
  EXPECT_EQ(text(kept), "smooth(y*sign(x))");
  EXPECT_EQ(g.apply(Op::smooth, kept), kept);
  EXPECT_EQ(g.apply(Op::smooth, g.multiply(k, kept)), g.multiply(k, kept));
  EXPECT_EQ(g.apply(Op::smooth, g.apply(Op::sine, g.divide(x, y))), g.apply(Op::sine, g.divide(x, y)));
  EXPECT_TRUE(g.is(g.apply(Op::smooth, number(3)), 3));
  EXPECT_TRUE(g[g.multiply(k, jump)].corners);
  EXPECT_FALSE(g[kept].corners);
  for (const NodeId corner : {g.apply(Op::minimum, x, y), g.apply(Op::absolute, x), g.apply(Op::modulo, t, k),
                              g.select(g.less(x, y), x, y), g.interpolate(0, x), g.less_equal(x, y)}) {
    EXPECT_NE(g.apply(Op::smooth, corner), corner);
  }
  const std::vector<double> at{0, -2, 3, 1};
  EXPECT_EQ(evaluate(g, kept, at), -3);
}

TEST_F(Expression, SmoothIsSeenThroughWhereItsArgumentIsLinear) {
  const NodeId jump = g.apply(Op::sign, x);
  const auto linear = linear_in(g, g.apply(Op::smooth, g.add(g.multiply(jump, y), g.apply(Op::absolute, x))), 2);
  ASSERT_TRUE(linear);
  EXPECT_EQ(text(linear->coefficient), "smooth(sign(x))");
  EXPECT_EQ(text(linear->remainder), "smooth(abs(x))");
  const NodeId equation = g.subtract(g.apply(Op::smooth, g.multiply(g.add(jump, number(3)), y)), k);
  const auto solved = solve_linear(g, std::vector{equation}, std::vector{2U});
  ASSERT_TRUE(solved);
  EXPECT_EQ(evaluate(g, solved->front(), std::vector<double>{0, 5, 0, 8}), 2);
}

TEST_F(Expression, PrintsAsAModelWouldWriteIt) {
  EXPECT_EQ(text(g.divide(g.negate(g.multiply(k, x)), y)), "-x*k/y");
  EXPECT_EQ(text(g.subtract(x, g.subtract(y, k))), "x - (y - k)");
  EXPECT_EQ(text(g.divide(x, g.multiply(y, y))), "x/y^2");
  EXPECT_EQ(text(g.multiply(g.add(x, y), k)), "k*(x + y)");
  EXPECT_EQ(text(g.power(g.negate(x), y)), "(-x)^y");
  EXPECT_EQ(text(g.subtract(x, number(3))), "x - 3");
  EXPECT_EQ(text(g.select(g.less(x, number(0)), y, g.apply(Op::sine, k))), "if x < 0 then y else sin(k)");
}

TEST_F(Expression, LongOnesAreCutOffNotExpanded) {
  NodeId doubled = x;  // 2^60 operations when written out
  for (int i = 0; i < 60; ++i) doubled = g.add(g.apply(Op::sine, doubled), g.apply(Op::cosine, doubled));
  EXPECT_LT(text(doubled).size(), 20000u);
}

TEST_F(Expression, DeepChainsDoNotExhaustTheStack) {
  NodeId sum = x;
  for (int i = 0; i < 200000; ++i) sum = g.apply(Op::sine, g.add(sum, y));
  EXPECT_TRUE(depends_on(g, sum, 2));
  EXPECT_FALSE(depends_on(g, sum, 3));
  EXPECT_FALSE(text(sum).empty());
  EXPECT_TRUE(std::isfinite(evaluate(g, sum, std::vector<double>{0, 1, 2, 3})));
}

TEST_F(Expression, LinearInGivesCoefficientAndRemainder) {
  // m*a + c*v - F = 0 solved for a, as for a highest derivative.
  const NodeId equation = g.subtract(g.add(g.multiply(k, x), g.multiply(g.apply(Op::sine, y), t)), number(3));
  const auto linear = linear_in(g, equation, 1);
  ASSERT_TRUE(linear);
  EXPECT_EQ(linear->coefficient, k);
  EXPECT_EQ(text(linear->remainder), "t*sin(y) - 3");
  EXPECT_FALSE(linear_in(g, equation, 2));
  EXPECT_FALSE(linear_in(g, g.multiply(x, g.add(x, y)), 1));
  EXPECT_FALSE(linear_in(g, g.apply(Op::floor, x), 1));
  const auto quotient = linear_in(g, g.divide(x, y), 1);
  ASSERT_TRUE(quotient);
  EXPECT_TRUE(g.is(quotient->remainder, 0));
}

TEST_F(Expression, CoupledLinearEquationsAreSolvedTogether) {
  // 2x + k*y = 5, k*x - 3y = 1 at k = 4: determinant -22, x = -19/-22, y = -18/-22 (Cramer).
  const std::vector<NodeId> residuals = {g.subtract(g.add(g.multiply(number(2), x), g.multiply(k, y)), number(5)),
                                         g.subtract(g.subtract(g.multiply(k, x), g.multiply(number(3), y)), number(1))};
  const std::vector<std::uint32_t> unknowns = {1, 2};
  const auto solution = solve_linear(g, residuals, unknowns);
  ASSERT_TRUE(solution);
  const std::vector<double> values = {0, 0, 0, 4};
  EXPECT_NEAR(evaluate(g, (*solution)[0], values), 19.0 / 22, 4e-16);
  EXPECT_NEAR(evaluate(g, (*solution)[1], values), 18.0 / 22, 4e-16);
  EXPECT_FALSE(solve_linear(g, std::vector{g.multiply(x, y), x}, unknowns));
}

TEST_F(Expression, SubstitutionSimplifies) {
  const NodeId e = g.add(g.multiply(k, x), g.multiply(y, t));
  EXPECT_EQ(substitute(g, e, 3, number(0)), g.multiply(y, t));
  EXPECT_EQ(substitute(g, e, 1, y), g.add(g.multiply(k, y), g.multiply(y, t)));
  EXPECT_THAT(variables_of(g, e), testing::ElementsAre(0, 1, 2, 3));
}

TEST_F(Expression, ModuloHasTheSignOfTheDivisor) {
  EXPECT_TRUE(g.is(g.apply(Op::modulo, number(-1), number(3)), 2));
  EXPECT_TRUE(g.is(g.apply(Op::modulo, number(7), number(3)), 1));
}

TEST_F(Expression, ManyAreEvaluatedTogetherAsEachAlone) {
  const NodeId shared = g.apply(Op::sine, g.multiply(x, y));
  const std::vector<NodeId> all{g.add(shared, k), shared, number(3), g.divide(t, g.add(shared, number(2))), t};
  const std::vector<double> values{0.5, 1.25, -2, 7};
  const std::vector<double> together = evaluate(g, all, values);
  ASSERT_EQ(together.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(together[i], evaluate(g, all[i], values)) << i;
  EXPECT_EQ(together[0], std::sin(1.25 * -2) + 7);
  EXPECT_THAT(evaluate(g, std::vector<NodeId>{}, values), testing::IsEmpty());
}

}  // namespace
}  // namespace continuo::model
