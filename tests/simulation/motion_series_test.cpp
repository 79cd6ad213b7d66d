// Guards along the motion: against closed forms, and for random models against derivatives that the graph makes.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tests/language/check_helpers.hpp>

#include <continuo/simulation/program/motion_series.hpp>
#include <continuo/symbolic/graph/derivative.hpp>

namespace continuo::model::motion_series_test {
namespace {

/// The guards' motions at a state, in the model's start mode.
std::vector<GuardMotion> motions(const ModelProgram& program, double t, const std::vector<double>& x,
                                 double forward = 1) {
  MotionSeries series(program, start_values(program.model));
  std::vector<GuardMotion> found(program.model.events.size());
  series.guards(program.model.start_mode, t, x, forward, found);
  return found;
}
GuardMotion first_motion(const std::string& text, double t, const std::vector<double>& x, double forward = 1) {
  return motions(*compile(good(text)), t, x, forward).at(0);
}

void expect_near(const GuardMotion& found, const std::array<double, 4>& expected, double most_rounding = 1e-13) {
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LE(std::abs(found.c[k] - expected[k]), found.rounding[k] + 1e-15 * std::abs(expected[k])) << k;
    EXPECT_LE(found.rounding[k], most_rounding) << k;
  }
}

void expect_unknown_from(const GuardMotion& found, std::size_t first) {
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(std::isinf(found.rounding[k]), k >= first) << k;
}

constexpr const char* oscillator = R"(model Oscillator
param w = 3
x'' = -w^2*x
x(0) = 1; x'(0) = 0
when x falls through 0 { mark "zero" }
run 0..1
)";

// x = cos(w t), so c_k is its k-th derivative divided by k!.
TEST(MotionSeries, KnowsAnOscillator) {
  const double phase = 0.7, c = std::cos(phase), s = std::sin(phase);
  expect_near(first_motion(oscillator, 0.7 / 3, {c, -3 * s}), {c, -3 * s, -4.5 * c, 4.5 * s});
  expect_near(first_motion(oscillator, 0.7 / 3, {c, -3 * s}, -1), {c, 3 * s, -4.5 * c, -4.5 * s});
}

TEST(MotionSeries, FollowsAParameter) {
  const auto program = compile(good(oscillator));
  MotionSeries series(*program, start_values(program->model));
  std::vector<GuardMotion> found(1);
  series.guards(0, 0, std::vector{1.0, 0.0}, 1, found);
  EXPECT_EQ(found[0].c, (std::array<double, 4>{1, 0, -4.5, 0}));
  MotionSeries copy = series;
  series.set(program->model.layout.parameters, 2);
  series.guards(0, 0, std::vector{1.0, 0.0}, 1, found);
  EXPECT_EQ(found[0].c, (std::array<double, 4>{1, 0, -2, 0}));
  copy.guards(0, 0, std::vector{1.0, 0.0}, 1, found);
  EXPECT_EQ(found[0].c, (std::array<double, 4>{1, 0, -4.5, 0}));
}

TEST(MotionSeries, LeavesHeldStatesWhereTheyAre) {
  const auto program = compile(good(oscillator));
  MotionSeries series(*program, start_values(program->model));
  series.hold({0});
  std::vector<GuardMotion> found(1);
  series.guards(0, 0, std::vector{1.0, 2.0}, 1, found);
  EXPECT_EQ(found[0].c, (std::array<double, 4>{1, 0, 0, 0}));
  EXPECT_EQ(carried(found[0]), 0);
}

// phi'' = -sin(phi), phi''' = -cos(phi) phi'. Upright and at rest it stays: all zeros are exact but for sin(pi).
TEST(MotionSeries, KnowsAPendulum) {
  constexpr const char* text = R"(model Pendulum
phi'' = -sin(phi)
phi(0) = 1; phi'(0) = 0
when phi falls through 0 { mark "down" }
run 0..1
)";
  expect_near(first_motion(text, 0, {1.2, 0.3}), {1.2, 0.3, -std::sin(1.2) / 2, -std::cos(1.2) * 0.3 / 6});
  EXPECT_EQ(carried(first_motion(text, 0, {1.2, 0})), -1);
  const GuardMotion hanging = first_motion(text, 0, {0, 0});
  EXPECT_EQ(hanging.rounding, (std::array<double, 4>{0, 0, 0, 0}));
  EXPECT_EQ(carried(hanging), 0);
}

// A ball in a bowl, g = y - x^2: g' = v - 2 x u, g'' = -10 - 2 u^2, g''' = 0.
TEST(MotionSeries, KnowsABallInABowl) {
  constexpr const char* text = R"(model Bowl
x'' = 0
y'' = -10
x(0) = 0; x'(0) = 1; y(0) = 1; y'(0) = 0
when y - x^2 falls through 0 { mark "touch" }
run 0..1
)";
  expect_near(first_motion(text, 0, {0.3, 0.7, 0.09, 0.5}), {0, 0.5 - 0.6 * 0.7, -5 - 0.49, 0});
  // On the surface and along it: the slope is rounding, the curvature decides.
  const GuardMotion along = first_motion(text, 0, {0.3, 0.7, 0.09, 0.42});
  EXPECT_LT(std::abs(along.c[1]), along.rounding[1]);
  EXPECT_EQ(carried(along), -1);
  EXPECT_EQ(carried(first_motion(text, 0, {0.3, 0.7, 0.09, 0.4200001})), 1);
  EXPECT_EQ(carried(first_motion(text, 0, {0.3, 0.7, 0.09, 0.42}, -1)), -1);  // at the top of its flight
  EXPECT_EQ(carried(first_motion(text, 0, {0.3, 0.7, 0.09, 0.4200001}, -1)), -1);
}

// A motion on a circle: g = x^2 + y^2 - 1 remains zero, so all its coefficients are rounding.
TEST(MotionSeries, CallsRoundingRounding) {
  constexpr const char* text = R"(model Circle
x' = -w*y
y' = w*x
param w = 1.7
x(0) = 1; y(0) = 0
when x^2 + y^2 falls through 1 { mark "inside" }
run 0..1
)";
  std::mt19937 engine(4);
  std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
  for (int trial = 0; trial < 1000; ++trial) {
    const double phi = angle(engine);
    const GuardMotion found = first_motion(text, 0, {std::cos(phi), std::sin(phi)});
    EXPECT_EQ(carried(found), 0);
    expect_near(found, {0, 0, 0, 0}, 1e-13);
  }
}

// z = x^2 + x by 0 = z - x^2 - x, or of the greater root of 0 = z^2 - 4*x: x = e^-t.
TEST(MotionSeries, SolvesForUnknowns) {
  constexpr const char* linear = R"(model Linear
x' = -x
unknown z = 1
0 = z - x^2 - x
x(0) = 1
when z falls through 1 { mark "low" }
run 0..1
)";
  const double x = 0.7, x2 = x * x;
  expect_near(first_motion(linear, 0, {x, x2 + x}), {x2 + x - 1, -2 * x2 - x, (4 * x2 + x) / 2, -(8 * x2 + x) / 6});
  constexpr const char* root = R"(model Root
x' = -x
unknown z = 2
0 = z^2 - 4*x
x(0) = 1
when z falls through 1 { mark "low" }
run 0..1
)";
  const double z = 2 * std::sqrt(x);  // 2 e^(-t/2)
  expect_near(first_motion(root, 0, {x, z}), {z - 1, -z / 2, z / 8, -z / 48});
  expect_near(first_motion(root, 0, {x, z}, -1), {z - 1, z / 2, z / 8, z / 48});
  // An unknown is only as accurate as its equation is satisfied.
  EXPECT_GT(first_motion(root, 0, {x, z + 1e-6}).rounding[0], 1e-6);
  // At z = 0 the equation does not determine the derivative of z.
  expect_unknown_from(first_motion(root, 0, {0, 0}), 1);
}

// Two coupled unknowns, and states that depend on them: y + z = x, y - z = sin(x), x' = y - 2 z.
TEST(MotionSeries, SolvesForUnknownsThatDriveTheStates) {
  constexpr const char* text = R"(model Coupled
x' = y - 2*z
unknown y = 1
unknown z = 1
0 = y + z - x
0 = y - z - sin(x)
x(0) = 1
when z rises through 2 { mark "high" }
when x falls through 0 { mark "low" }
run 0..1
)";
  // y = (x + sin x)/2, z = (x - sin x)/2, so x' = F(x) = -x/2 + 3/2 sin x, x'' = F' F, x''' = (F'' F + F'^2) F.
  const double x = 1.1, f = -x / 2 + 1.5 * std::sin(x), f1 = -0.5 + 1.5 * std::cos(x), f2 = -1.5 * std::sin(x);
  const double z1 = (1 - std::cos(x)) / 2, z2 = std::sin(x) / 2, z3 = std::cos(x) / 2;
  const double x1 = f, x2 = f1 * f, x3 = (f2 * f + f1 * f1) * f;
  const auto found = motions(*compile(good(text)), 0, {x, (x + std::sin(x)) / 2, (x - std::sin(x)) / 2});
  expect_near(found[1], {x, x1, x2 / 2, x3 / 6});
  expect_near(found[0], {(x - std::sin(x)) / 2 - 2, z1 * x1, (z2 * x1 * x1 + z1 * x2) / 2,
                         (z3 * x1 * x1 * x1 + 3 * z2 * x1 * x2 + z1 * x3) / 6});
}

// x' = u with u through (0, 0), (1, 2), (2, -4), then constant.
TEST(MotionSeries, TurnsWithATableAtItsCorner) {
  Model model = good(R"(model Driven
input u = 0
x' = u
x(0) = 0
when x rises through 1 { mark "there" }
run 0..3
)");
  model.inputs[0].points = Table({0, 1, 2}, {0, 2, -4}, Table::Between::linear);
  const auto program = compile(std::move(model));
  const auto at = [&](double t, double forward) { return motions(*program, t, {1}, forward)[0].c; };
  EXPECT_EQ(at(0.5, 1), (std::array<double, 4>{0, 1, 1, 0}));
  EXPECT_EQ(at(1, 1), (std::array<double, 4>{0, 2, -3, 0}));
  EXPECT_EQ(at(1, -1), (std::array<double, 4>{0, -2, 1, 0}));
  EXPECT_EQ(at(2, 1), (std::array<double, 4>{0, -4, 0, 0}));
  EXPECT_EQ(at(2, -1), (std::array<double, 4>{0, 4, -3, 0}));
  EXPECT_EQ(at(0, -1), (std::array<double, 4>{0, 0, 0, 0}));
  // Within the rounding of t at the corner the function may return either piece.
  const GuardMotion beside = motions(*program, std::nextafter(1.0, 0.0), {1})[0];
  EXPECT_EQ(carried(beside), 1);
  EXPECT_TRUE(std::isinf(beside.rounding[2]));
}

TEST(MotionSeries, LeavesAKinkOnTheSideThatComes) {
  const auto guard = [](const char* expression) {
    return fmt::format(
        "model Kink\nx' = v\nv' = 0\nx(0) = 1; v(0) = 1\nwhen {} rises through 0 {{ mark \"a\" }}\nrun 0..1\n",
        expression);
  };
  EXPECT_EQ(first_motion(guard("abs(x)"), 0, {0, 2}).c[1], 2);
  EXPECT_EQ(first_motion(guard("abs(x)"), 0, {0, -2}).c[1], 2);
  EXPECT_EQ(first_motion(guard("abs(x)"), 0, {0, -2}, -1).c[1], 2);
  EXPECT_EQ(first_motion(guard("x*abs(x)"), 0, {0, -2}).c[2], -4);
  EXPECT_EQ(first_motion(guard("max(x, 3*x) - min(x, 3*x)"), 0, {0, -2}).c[1], 4);
  EXPECT_EQ(first_motion(guard("mod(x, 1) - 0.5"), 0, {3, -2}).c[0], 0.5);  // 2.999...
  EXPECT_EQ(first_motion(guard("mod(x, 1) - 0.5"), 0, {3, 2}).c[0], -0.5);
  EXPECT_EQ(first_motion(guard("(if x > 1 then 5*x else x) - 1"), 0, {1, 1}).c[1], 5);
  EXPECT_EQ(first_motion(guard("(if x > 1 then 5*x else x) - 1"), 0, {1, -1}).c[1], -1);
  // Within the rounding of x at the kink the direction is undecided.
  EXPECT_EQ(carried(first_motion(guard("abs(x - 1)"), 0, {std::nextafter(1.0, 2.0), 1})), 0);
  // But where the function rises on both sides of the kink, it rises.
  EXPECT_EQ(carried(first_motion(guard("max(x - 1, 3*(x - 1))"), 0, {std::nextafter(1.0, 2.0), 1})), 1);
  // The slope of -sqrt(x) at 0 is infinite.
  EXPECT_EQ(carried(first_motion(guard("-sqrt(x)"), 0, {0, 1})), -1);
}

// The branch of the equations, too, is the one that the motion enters, even if only a later coefficient shows it.
TEST(MotionSeries, EntersTheBranchOfTheEquations) {
  constexpr const char* text = R"(model Relay
x'' = -sign(x)
x(0) = 1; x'(0) = 0
when x falls through 0 { mark "zero" }
run 0..1
)";
  EXPECT_EQ(first_motion(text, 0, {0, 1}).c, (std::array<double, 4>{0, 1, -0.5, 0}));
  EXPECT_EQ(first_motion(text, 0, {0, -1}).c, (std::array<double, 4>{0, -1, 0.5, 0}));
  EXPECT_EQ(first_motion(text, 0, {0, 1}, -1).c, (std::array<double, 4>{0, -1, 0.5, 0}));
}

// Both sides lead back to the surface: no motion leaves it, and no coefficient is invented.
TEST(MotionSeries, DoesNotInventAMotionWhereBothSidesLeadBack) {
  constexpr const char* text = R"(model Stuck
v' = 0.5 - sign(v)
v(0) = 1
when v falls through 0 { mark "stuck" }
run 0..1
)";
  const GuardMotion found = first_motion(text, 0, {0});
  expect_unknown_from(found, 1);
  EXPECT_EQ(carried(found), 0);
}

TEST(MotionSeries, WatchesTheGuardsOfItsMode) {
  const auto program = compile(good(R"(model Modes
mode up { x' = 1 }
mode down { x' = -2 }
x(0) = 0
when x rises through 1 in up { go down }
when x falls through 0 in down { go up }
run 0..1
)"));
  MotionSeries series(*program, start_values(program->model));
  std::vector<GuardMotion> found(2);
  series.guards(1, 0, std::vector{0.5}, 1, found);
  EXPECT_EQ(found[0].c, (std::array<double, 4>{}));
  EXPECT_EQ(found[1].c, (std::array<double, 4>{0.5, -2, 0, 0}));
}

// ---- random models ----------------------------------------------------------------------------------------------

/// Formulas of x, y, z and t that are smooth and have values of moderate size.
class RandomFormula {
 public:
  explicit RandomFormula(std::mt19937& engine) : engine_(engine) {}

  std::string operator()(int depth) {
    const auto deeper = [&] { return (*this)(depth - 1); };
    switch (depth == 0 ? pick(5) : 5 + pick(13)) {
      case 0:
        return "x";
      case 1:
        return "y";
      case 2:
        return "z";
      case 3:
        return "t";
      case 4:
        return fmt::format("{}", 0.25 * (1 + pick(8)));
      case 5:
        return fmt::format("({} + {})", deeper(), deeper());
      case 6:
        return fmt::format("({} - {})", deeper(), deeper());
      case 7:
      case 8:
        return fmt::format("{}*{}", deeper(), deeper());
      case 9:
        return fmt::format("{}/(2 + sin({}))", deeper(), deeper());
      case 10:
        return fmt::format("sin({})", deeper());
      case 11:
        return fmt::format("cos({})", deeper());
      case 12:
        return fmt::format("atan({})", deeper());
      case 13:
        return fmt::format("sqrt(1 + ({})^2)", deeper());
      case 14:
        return fmt::format("exp(tanh({}))", deeper());
      case 15:
        return fmt::format("log(2 + cos({}))", deeper());
      case 16:
        return fmt::format("abs({})", deeper());
      default:
        return fmt::format("max({}, {})", deeper(), deeper());
    }
  }

 private:
  int pick(int n) { return std::uniform_int_distribution(0, n - 1)(engine_); }
  std::mt19937& engine_;
};

/// g, Lg, L^2 g/2 and L^3 g/6 with Lg = dg/dt + sum of dg/dx_i f_i.
std::vector<NodeId> along_motion(Graph& graph, const Model& model, NodeId g) {
  std::vector<NodeId> derivatives{g};
  for (int k = 1; k <= 3; ++k) {
    NodeId sum = differentiate(graph, derivatives.back(), Layout::time);
    for (std::size_t i = 0; i < model.states.size(); ++i) {
      const NodeId slope = differentiate(graph, derivatives.back(), model.states[i].variable);
      sum = graph.add(sum, graph.multiply(slope, model.modes[0].derivatives[i]));
    }
    derivatives.push_back(graph.divide(sum, graph.constant(k)));
  }
  return derivatives;
}

// At random states no kink is near. The graph's numbers have a rounding of their own: of the same size.
TEST(MotionSeries, AgreesWithTheDerivativesOfRandomModels) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> number(-1.5, 1.5);
  RandomFormula formula(engine);
  for (int trial = 0; trial < 150; ++trial) {
    const std::string text = fmt::format(
        "model Random\nx' = {}\ny' = {}\nz' = {}\nx(0) = 0; y(0) = 0; z(0) = 0\nwhen {} rises through {} {{ mark \"a\" "
        "}}\n"
        "run 0..1\n",
        formula(2), formula(2), formula(2), formula(3), formula(1));
    const auto program = compile(good(text));
    Graph graph = program->model.graph;
    const std::vector<NodeId> nodes = along_motion(graph, program->model, program->model.events[0].guard);
    for (int state = 0; state < 3; ++state) {
      const double t = number(engine);
      const std::vector<double> x{number(engine), number(engine), number(engine)};
      std::vector<double> variables = start_values(program->model);
      variables[Layout::time] = t;
      std::ranges::copy(x, variables.begin() + program->model.layout.states);
      const std::vector<double> expected = evaluate(graph, nodes, variables);
      const GuardMotion found = motions(*program, t, x)[0], past = motions(*program, t, x, -1)[0];
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_LE(std::abs(found.c[k] - expected[k]), 2 * found.rounding[k] + 1e-14 * std::abs(expected[k]))
            << k << " of " << text;
        EXPECT_LE(std::abs(past.c[k] - (k % 2 == 0 ? 1 : -1) * found.c[k]), past.rounding[k] + found.rounding[k])
            << k << " of " << text;
        EXPECT_LT(found.rounding[k], 1e-11 * (1 + std::abs(found.c[k]) + std::abs(found.c[1]))) << k << " of " << text;
      }
    }
  }
}

}  // namespace
}  // namespace continuo::model::motion_series_test
