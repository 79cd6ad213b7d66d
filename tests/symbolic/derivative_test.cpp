// Derivatives are exact: compared with the limit that defines them.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/symbolic/graph/derivative.hpp>

namespace continuo::model {
namespace {

class Derivative : public testing::Test {
 protected:
  Graph g;
  NodeId x = g.variable(1), y = g.variable(2), k = g.variable(3);
  std::vector<double> at = {0, 0.7, 0.4, 1.3};

  /// (f(x+h) - f(x-h))/(2h) with h = eps^(1/3) is exact to about h^2 = 4e-11 of f's scale.
  double by_difference(NodeId e, std::uint32_t variable) {
    const double h = 6e-6;
    std::vector<double> above = at, below = at;
    above[variable] += h;
    below[variable] -= h;
    return (evaluate(g, e, above) - evaluate(g, e, below)) / (2 * h);
  }
};

TEST_F(Derivative, EveryOperationAgreesWithItsDifferenceQuotient) {
  for (int i = static_cast<int>(Op::add); i <= static_cast<int>(Op::select); ++i) {
    const Op op = static_cast<Op>(i);
    const NodeId inside = g.multiply(g.apply(Op::sine, x), g.add(y, g.constant(0.5)));
    const NodeId e = arity(op) == 1   ? g.apply(op, inside)
                     : arity(op) == 2 ? g.apply(op, inside, g.add(x, y))
                                      : g.select(g.less(x, y), g.multiply(x, y), g.divide(x, y));
    for (const std::uint32_t variable : {1u, 2u, 3u}) {
      const double exact = evaluate(g, differentiate(g, e, variable), at);
      EXPECT_NEAR(exact, by_difference(e, variable), 1e-8) << name(op) << " by " << variable;
    }
  }
}

TEST_F(Derivative, PowersSimplifyToTheTextbookForm) {
  const auto text = [&](NodeId id) { return to_text(g, id, [](auto i) { return std::string(1, "txyk"[i]); }); };
  EXPECT_EQ(text(differentiate(g, g.power(x, g.constant(2)), 1)), "2*x");
  EXPECT_EQ(text(differentiate(g, g.negate(g.multiply(k, x)), 1)), "-k");
  EXPECT_EQ(text(differentiate(g, g.power(x, y), 1)), "y*x^(y - 1)");
  EXPECT_EQ(text(differentiate(g, g.apply(Op::exponential, g.multiply(k, x)), 1)), "k*exp(x*k)");
}

TEST_F(Derivative, JacobianHoldsTheSparsityOfAChain) {
  // u[i]' = u[i-1] - 2*u[i] + u[i+1]: three entries a row, two at the ends.
  constexpr std::uint32_t n = 100;
  std::vector<NodeId> outputs;
  std::vector<std::uint32_t> variables;
  for (std::uint32_t i = 1; i <= n; ++i) {
    variables.push_back(i);
    NodeId rate = g.multiply(g.constant(-2), g.variable(i));
    if (i > 1) rate = g.add(rate, g.variable(i - 1));
    if (i < n) rate = g.add(rate, g.variable(i + 1));
    outputs.push_back(g.multiply(g.variable(n + 1), rate));
  }
  const auto entries = jacobian(g, outputs, variables);
  EXPECT_EQ(entries.size(), 3 * n - 2);
  for (const auto& entry : entries)
    EXPECT_LE(std::abs(static_cast<int>(entry.row) - static_cast<int>(entry.column)), 1);
}

TEST_F(Derivative, StepsHaveNoSlope) {
  EXPECT_TRUE(g.is(differentiate(g, g.apply(Op::floor, g.divide(k, x)), 1), 0));
  EXPECT_TRUE(g.is(differentiate(g, g.less(x, y), 1), 0));
}

}  // namespace
}  // namespace continuo::model
