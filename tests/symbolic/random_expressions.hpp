// Random expressions of every operation, and families of them, with values to evaluate them at.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include <continuo/symbolic/graph/expression.hpp>
#include <continuo/symbolic/graph/table.hpp>
#include <continuo/symbolic/tape/tape.hpp>

namespace continuo::model::random_expressions_test {

inline constexpr std::uint32_t states = 40, parameters = 5, variables = 1 + states + parameters;
inline constexpr TapeVariables layout = {.variables = variables,
                                         .steady_begin = 1 + states,
                                         .steady_end = variables,
                                         .states_begin = 1,
                                         .states_end = 1 + states};

inline std::vector<Table> tables() {
  return {Table({-1, 0, 0.5, 2}, {0.5, -1, 1, 0}, Table::Between::linear),
          Table({-0.5, 0.25, 1}, {1, -2, 0.5}, Table::Between::step)};
}

inline constexpr Op of_one[] = {Op::negate,
                                Op::sine,
                                Op::cosine,
                                Op::tangent,
                                Op::arc_sine,
                                Op::arc_cosine,
                                Op::arc_tangent,
                                Op::hyperbolic_sine,
                                Op::exponential,
                                Op::logarithm,
                                Op::hyperbolic_cosine,
                                Op::hyperbolic_tangent,
                                Op::logarithm10,
                                Op::square_root,
                                Op::absolute,
                                Op::sign,
                                Op::floor,
                                Op::ceiling,
                                Op::logical_not};
inline constexpr Op of_two[] = {Op::add,     Op::subtract,   Op::multiply,     Op::divide,    Op::power, Op::minimum,
                                Op::maximum, Op::hypotenuse, Op::arc_tangent2, Op::modulo,    Op::less,  Op::less_equal,
                                Op::equal,   Op::not_equal,  Op::logical_and,  Op::logical_or};

inline NodeId random_node(Graph& g, std::vector<NodeId>& nodes, std::mt19937& random) {
  const auto any = [&] { return nodes[random() % nodes.size()]; };
  switch (random() % 8) {
    case 0:
      return g.apply(of_one[random() % std::size(of_one)], any());
    case 1:
      return g.apply(of_two[random() % std::size(of_two)], any(), any());
    case 2:
      return g.select(g.less(any(), any()), any(), any());
    case 3:
      return random() % 2 ? g.interpolate(static_cast<std::uint32_t>(random() % 2), any())
                          : g.interpolate_slope(0, any());
    case 4:
      return g.subtract(any(), g.multiply(any(), any()));
    case 5:
      return g.add(g.multiply(any(), any()), g.multiply(any(), any()));
    case 6:
      return g.multiply(g.subtract(any(), any()), any());
    default:
      return g.add(any(), any());
  }
}

/// Expressions of everything, and of families with neighbours, mirrored and alone.
inline std::vector<NodeId> random_expressions(Graph& g, std::mt19937& random, std::size_t count) {
  std::vector<NodeId> nodes;
  for (std::uint32_t i = 0; i < variables; ++i) nodes.push_back(g.variable(i));
  for (const double c : {2.0, -1.0, 0.5, 1e-300, -0.0}) nodes.push_back(g.constant(c));
  for (std::size_t i = 0; i < count; ++i) nodes.push_back(random_node(g, nodes, random));
  return {nodes.end() - static_cast<std::ptrdiff_t>(count), nodes.end()};
}

inline std::vector<NodeId> random_family(Graph& g, std::mt19937& random) {
  const auto shift = static_cast<std::uint32_t>(1 + random() % 3);
  const Op outer = of_one[random() % std::size(of_one)], inner = of_two[random() % std::size(of_two)];
  const bool mirrored = random() % 2 == 0;
  std::vector<NodeId> rates;
  for (std::uint32_t i = 0; i < states; ++i) {
    const NodeId here = g.variable(1 + i);
    const NodeId there = g.variable(1 + (mirrored ? states - 1 - i : (i + shift) % states));
    const NodeId parameter = g.variable(1 + states + (random() % 50 == 0 ? 1 : 0));
    rates.push_back(g.add(g.apply(outer, g.apply(inner, there, here)), g.multiply(parameter, g.subtract(there, here))));
  }
  return rates;
}

inline std::vector<double> random_values(std::mt19937& random) {
  constexpr double special[] = {
      0,     -0.0,    1,  -1, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN(),
      1e300, -1e-300, 0.5};
  std::normal_distribution<double> normal;
  std::vector<double> values(variables);
  for (double& value : values) value = random() % 10 == 0 ? special[random() % std::size(special)] : normal(random);
  return values;
}

inline std::vector<double> evaluated(const Tape& tape, const std::vector<double>& values) {
  std::vector<double> registers(tape.register_count()), outputs(tape.output_count());
  std::ranges::copy(values, registers.begin());
  tape.prepare<double>(registers);
  tape.evaluate<double>(registers, std::span(values).subspan(1, states), outputs);
  return outputs;
}

}  // namespace continuo::model::random_expressions_test
