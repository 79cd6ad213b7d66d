// Balls inside curved and moving boundaries: falling through is the classic failure of simulators. Two hundred random
// boundaries, restitution from 0 to 1, ten seconds: no ball passes. Where impacts accumulate the run ends with that
// reason, or the ball rests.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tests/hybrid/random.hpp>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::hybrid {
namespace {

/// The ball is free where g(x, y, t) > 0. Gradient and rate of g are written out, and the velocity is reflected along
/// the gradient, relative to the boundary: v - (1 + e) (dg/dt) grad g/|grad g|^2.
struct Boundary {
  std::string name, g, gx, gy, gt;
  double (*value)(double x, double y, double t, const double* p);      // g
  double (*steepness)(double x, double y, double t, const double* p);  // |grad g|
  double p[4];
  bool moves;
};

/// How far beyond the boundary the ball is.
double depth(const Boundary& b, double x, double y, double t) {
  return -b.value(x, y, t, b.p) / b.steepness(x, y, t, b.p);
}

Boundary circle(Random& random) {
  const double r = random.decimal(0.8, 2), a = random.decimal(0.05, 0.3), w = random.decimal(0.5, 6);
  const bool moves = random.chance(0.5);
  const std::string x = moves ? fmt::format("(x - {}*sin({}*t))", a, w) : "x";
  return {"circle",
          fmt::format("{} - hypot({}, y)", r, x),
          fmt::format("-{}/hypot({}, y)", x, x),
          fmt::format("-y/hypot({}, y)", x),
          moves ? fmt::format("{}/hypot({}, y)*{}*cos({}*t)", x, x, a * w, w) : "0",
          [](double px, double py, double t, const double* p) {
            return p[0] - std::hypot(px - p[1] * std::sin(p[2] * t), py);
          },
          [](double, double, double, const double*) { return 1.0; },
          {r, moves ? a : 0, w, 0},
          moves};
}

Boundary parabola(Random& random) {
  const double c = random.decimal(0.3, 3), a = random.decimal(0.02, 0.2), w = random.decimal(0.5, 8);
  const bool moves = random.chance(0.5);
  return {"parabola",
          fmt::format("y - {}*x^2{}", c, moves ? fmt::format(" - {}*sin({}*t)", a, w) : ""),
          fmt::format("-{}*x", 2 * c),
          "1",
          moves ? fmt::format("-{}*cos({}*t)", a * w, w) : "0",
          [](double x, double y, double t, const double* p) { return y - p[0] * x * x - p[1] * std::sin(p[2] * t); },
          [](double x, double, double, const double* p) { return std::hypot(1, 2 * p[0] * x); },
          {c, moves ? a : 0, w, 0},
          moves};
}

/// Hills in a wide bowl, which bring the ball back.
Boundary hills(Random& random) {
  const double a = random.decimal(0.05, 0.4), k = random.decimal(1, 5), c = random.decimal(0.05, 0.3);
  return {"hills",
          fmt::format("y - {}*sin({}*x) - {}*x^2", a, k, c),
          fmt::format("-{}*cos({}*x) - {}*x", a * k, k, 2 * c),
          "1",
          "0",
          [](double x, double y, double, const double* p) { return y - p[0] * std::sin(p[1] * x) - p[2] * x * x; },
          [](double x, double, double, const double* p) {
            return std::hypot(1, p[0] * p[1] * std::cos(p[1] * x) + 2 * p[2] * x);
          },
          {a, k, c, 0},
          false};
}

Boundary table(Random& random) {
  const double a = random.decimal(0.02, 0.3), w = random.decimal(0.3, 20), b = random.decimal(0, 0.1);
  return {"table",
          fmt::format("y - {}*sin({}*t) - {}*cos({}*t)", a, w, b, 2.5 * w),
          "0",
          "1",
          fmt::format("-{}*cos({}*t) + {}*sin({}*t)", a * w, w, b * 2.5 * w, 2.5 * w),
          [](double, double y, double t, const double* p) {
            return y - p[0] * std::sin(p[2] * t) - p[1] * std::cos(2.5 * p[2] * t);
          },
          [](double, double, double, const double*) { return 1.0; },
          {a, b, w, 0},
          true};
}

Boundary boundary(Random& random) {
  switch (random.whole(0, 3)) {
    case 0:
      return circle(random);
    case 1:
      return parabola(random);
    case 2:
      return hills(random);
    default:
      return table(random);
  }
}

/// A quarter of the cases is elastic, and a quarter is without restitution.
double restitution(Random& random) {
  if (random.chance(0.25)) return 1;
  return random.chance(0.33) ? 0 : random.decimal(0.05, 0.98);
}

std::string model_text(const Boundary& b, double e, Random& random) {
  double x = 0, y = 0;
  do {
    x = random.decimal(-1, 1);
    y = random.decimal(-0.5, 1.5);
  } while (depth(b, x, y, 0) > -0.05);
  return fmt::format(
      "# {}\nlet g = {}, gx = {}, gy = {}\nlet along = (gx*x' + gy*y' + {})/(gx^2 + gy^2)\n"
      "x'' = 0; y'' = -9.81\nx(0) = {}; y(0) = {}; x'(0) = {}; y'(0) = {}\n"
      "when g falls through 0 {{ x' := x' - {}*along*gx; y' := y' - {}*along*gy }}\nrun 0..10 output 0.002\n",
      b.name, b.g, b.gx, b.gy, b.gt, x, y, random.decimal(-2, 2), random.decimal(-2, 2), 1 + e, 1 + e);
}

class Balls : public testing::TestWithParam<int> {};

TEST_P(Balls, StayInsideOfTheirBoundary) {
  Random random(static_cast<std::uint64_t>(GetParam()) * 7919 + 1);
  for (int i = 0; i < 20; ++i) {
    const Boundary b = boundary(random);
    const double e = restitution(random);
    const std::string text = model_text(b, e, random);
    const model::Loaded loaded = model::load(model::Source("ball.sim", text));
    ASSERT_TRUE(loaded) << loaded.text() << text;
    const model::Simulated simulated = simulate(*loaded.model, {.method = "dop853", .rtol = 1e-10, .atol = {1e-10}});
    ASSERT_TRUE(simulated.run) << text;
    const model::Run& run = *simulated.run;
    double deepest = -1, when = 0;
    for (std::size_t row = 0; row < run.motion.rows(); ++row) {
      const auto state = run.motion.state(row);  // x, x', y, y'
      const double t = run.motion.time(row), deep = depth(b, state[0], state[2], t);
      if (deep > deepest) {
        deepest = deep;
        when = t;
      }
    }
    EXPECT_LE(deepest, 1e-9) << "at t = " << when << "\n" << describe(run.outcome) << "\n" << text;
    EXPECT_FALSE(run.events.empty()) << text;
    if (run.outcome.ending == Ending::events_accumulate) {
      EXPECT_FALSE(run.outcome.event.empty()) << text;
      EXPECT_GE(run.outcome.limit_time, run.final_time() - 1e-9) << text;
      // Without loss at a fixed boundary, impacts cannot accumulate.
      EXPECT_TRUE(e < 1 || b.moves) << describe(run.outcome) << "\n" << text;
    } else {
      EXPECT_EQ(run.outcome.ending, Ending::reached_end) << describe(run.outcome) << "\n" << text;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Twenty, Balls, testing::Range(0, 10));

}  // namespace
}  // namespace continuo::hybrid
