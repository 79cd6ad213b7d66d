// Random expressions enclosed over random intervals: values and difference quotients lie within.
#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/program/step_enclosure.hpp>
#include <continuo/symbolic/tape/tape_enclosure.hpp>

namespace continuo::model::tape_enclosure_test {
namespace {

using Values = Enclosure<double>;
using Curve = EnclosureWithSlope<double>;

constexpr std::uint32_t states = 6, parameters = 3, variables = 1 + states + parameters;
constexpr TapeVariables layout = {.variables = variables, .steady_begin = 1 + states, .steady_end = variables};

std::vector<Table> tables() {
  return {Table({-1, 0, 0.5, 2}, {0.5, -1, 1, 0}, Table::Between::linear),
          Table({-0.5, 0.25, 1}, {1, -2, 0.5}, Table::Between::step)};
}

class RandomExpressions {
 public:
  explicit RandomExpressions(unsigned seed) : random_(seed) {
    for (std::uint32_t i = 0; i < variables; ++i) nodes.push_back(g.variable(i));
    for (const double c : {2.0, -1.0, 0.5, 3.0}) nodes.push_back(g.constant(c));
  }

  void grow() { nodes.push_back(make(random_() % 24)); }

  Graph g;
  std::vector<NodeId> nodes;

 private:
  NodeId any() { return nodes[random_() % nodes.size()]; }
  NodeId make(std::size_t kind) {
    constexpr Op bounded[] = {Op::sine,        Op::cosine,  Op::hyperbolic_tangent, Op::arc_tangent, Op::absolute,
                              Op::square_root, Op::tangent, Op::logarithm,          Op::arc_sine,    Op::sign,
                              Op::floor,       Op::negate,  Op::logical_not};
    constexpr Op of_two[] = {Op::minimum, Op::maximum, Op::hypotenuse, Op::arc_tangent2, Op::modulo, Op::power};
    switch (kind) {
      case 0:
      case 1:
      case 2:
      case 3:
        return g.apply(bounded[random_() % std::size(bounded)], any());
      case 4:
      case 5:
      case 6:
        return g.apply(of_two[random_() % std::size(of_two)], any(), any());
      case 7:
        return g.select(g.less(any(), any()), any(), any());
      case 8:
        return g.select(g.apply(Op::logical_or, g.less_equal(any(), any()), g.less(any(), any())), any(), any());
      case 9:
        return g.divide(any(), any());
      case 10:
        return g.interpolate(static_cast<std::uint32_t>(random_() % 2), any());
      case 11:
        return g.interpolate_slope(0, any());
      case 12:
        return g.apply(Op::exponential, g.negate(g.apply(Op::absolute, any())));
      default:
        return kind < 16 ? g.subtract(any(), any()) : kind < 19 ? g.add(any(), any()) : g.multiply(any(), any());
    }
  }

  std::mt19937 random_;
};

/// Linear motions of the variables, each with its own rate; the parameters are constant.
struct Motion {
  std::vector<double> from, rate;

  explicit Motion(unsigned seed) : from(variables), rate(variables) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-2, 2);
    for (std::uint32_t i = 0; i < variables; ++i) {
      from[i] = uniform(random);
      if (i <= states && random() % 4 != 0) rate[i] = uniform(random);
    }
  }
  double at(std::size_t i, double theta) const { return from[i] + theta * rate[i]; }
};

template <class Number>
std::vector<Number> evaluate(const Tape& tape, const std::vector<Number>& start) {
  std::vector<Number> registers(tape.register_count()), outputs(tape.output_count());
  std::ranges::copy(start, registers.begin());
  tape.prepare<Number>(registers);
  tape.evaluate<Number>(registers, outputs);
  return outputs;
}

std::vector<double> values_at(const Tape& tape, const Motion& motion, double theta) {
  std::vector<double> start;
  for (std::size_t i = 0; i < variables; ++i) start.push_back(motion.at(i, theta));
  return evaluate<double>(tape, start);
}

std::vector<double> widths_at(const Tape& tape, const Motion& motion, double theta) {
  std::vector<Values> start;
  for (std::size_t i = 0; i < variables; ++i)
    start.push_back(enclosing::widened_by(motion.at(i, theta), motion.at(i, theta)));
  std::vector<double> widths;
  for (const Values& value : evaluate(tape, start)) widths.push_back(value.hi - value.lo);
  return widths;
}

TEST(TapeEnclosure, HoldsValuesAndQuotientsOfDifferencesOfRandomExpressions) {
  const auto both = tables();
  std::size_t bounded = 0, checked = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    RandomExpressions e(seed);
    for (int i = 0; i < 30; ++i) e.grow();
    const std::vector<NodeId> outputs(e.nodes.end() - 10, e.nodes.end());
    const Tape tape(e.g, outputs, layout, both);
    const Motion motion(seed);
    const double width = std::pow(10.0, -static_cast<double>(seed % 7));
    std::vector<Values> values;
    std::vector<Curve> curves;
    for (std::size_t i = 0; i < variables; ++i) {
      const Curve moving = Curve(motion.from[i]) + Curve({0, width}, Values(1)) * Curve(motion.rate[i]);
      curves.push_back(moving);
      values.push_back(moving.value);
    }
    const auto ranges = evaluate(tape, values);
    const auto with_slopes = evaluate(tape, curves);
    for (int k = 0; k < 8; ++k) {
      const double a = width * k / 8, b = width * (k + 0.5) / 8;
      const auto at_a = values_at(tape, motion, a), at_b = values_at(tape, motion, b);
      for (std::size_t i = 0; i < outputs.size(); ++i) {
        const std::string what = "seed " + std::to_string(seed) + " output " + std::to_string(i);
        ++checked;
        bounded += with_slopes[i].slope.is_bounded();
        if (!std::isfinite(at_a[i]) || !std::isfinite(at_b[i])) continue;
        EXPECT_TRUE(ranges[i].holds(at_a[i])) << what;
        EXPECT_TRUE(with_slopes[i].value.holds(at_a[i])) << what;
        if (!with_slopes[i].slope.is_bounded()) continue;
        // The rounding of the values is at most the width of an enclosure at a point.
        const double rounding = 2 * (widths_at(tape, motion, a)[i] + widths_at(tape, motion, b)[i]) + 1e-300;
        const double change = at_b[i] - at_a[i];
        EXPECT_GE(change, with_slopes[i].slope.lo * (b - a) - rounding) << what;
        EXPECT_LE(change, with_slopes[i].slope.hi * (b - a) + rounding) << what;
      }
    }
  }
  EXPECT_GT(bounded, checked / 2);  // an unbounded enclosure would contain everything
}

TEST(TapeEnclosure, TablesHaveTheRangeOfAllTheirPieces) {
  const Table line({0, 1, 3}, {0, 2, 1}, Table::Between::linear), steps({0, 1, 3}, {5, 2, 1}, Table::Between::step);
  const auto over = [](const Table& table, double from, double to) {
    return enclose(table, Curve({from, to}, Values(1)), false);
  };
  EXPECT_NEAR(over(line, 0.5, 2).value.lo, 1, 1e-14);
  EXPECT_NEAR(over(line, 0.5, 2).value.hi, 2, 1e-14);
  EXPECT_NEAR(over(line, 0.5, 2).slope.lo, -0.5, 1e-14);
  EXPECT_NEAR(over(line, 0.5, 2).slope.hi, 2, 1e-14);
  EXPECT_NEAR(over(line, 1.5, 1.75).slope.hi, -0.5, 1e-14);
  EXPECT_TRUE(over(line, -5, -1).is_steady());
  EXPECT_TRUE(over(line, -5, -1).value.is_point());
  EXPECT_EQ(over(steps, 0.5, 2).value.lo, 2);
  EXPECT_EQ(over(steps, 0.5, 2).value.hi, 5);
  EXPECT_FALSE(over(steps, 0.5, 2).slope.is_bounded());
  EXPECT_TRUE(over(steps, 1, 2).is_steady());
  EXPECT_FALSE(over(steps, 0.5, 1).is_steady());  // from its x on a point is the new value
}

TEST(TapeEnclosure, ASquareIsNotNegativeAndAProductMayBe) {
  Graph g;
  const NodeId x = g.variable(1), y = g.variable(2);
  const Tape tape(g, std::vector{g.multiply(x, x), g.multiply(x, y), g.apply(Op::hypotenuse, x, y)}, layout);
  std::vector<Values> start(variables, Values(-1, 1));
  const auto outputs = evaluate(tape, start);
  EXPECT_EQ(outputs[0].lo, 0);
  EXPECT_LE(outputs[1].lo, -1);
  EXPECT_EQ(outputs[2].lo, 0);
}

}  // namespace
}  // namespace continuo::model::tape_enclosure_test
