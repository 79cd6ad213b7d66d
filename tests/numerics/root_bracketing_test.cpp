// Changes of sign that are enclosed: of random functions, in both directions, the two ends are neighbours in the number
// format and have the two signs; and no function needs more evaluations than three times the bits of the format.
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include <continuo/numerics/root_bracketing.hpp>

namespace continuo::root_bracketing_test {
namespace {

using Function = std::function<double(double)>;

// A bisection at least halves the enclosure after three other places; it goes on below the spacing of numbers at one,
// down to that at the root, which is at most 1074 + 53 halvings further.
constexpr int most_evaluations = 3 * (1074 + 53);

struct Enclosed {
  Bracket<double> bracket;
  int evaluations = 0;
};

Enclosed enclosed(const Function& f, double near, double far) {
  Enclosed result;
  const auto counted = [&](double t) {
    ++result.evaluations;
    return f(t);
  };
  result.bracket = enclose_root(counted, near, far, f(near), f(far));
  return result;
}

void expect_enclosed(const Function& f, double near, double far) {
  const auto [bracket, evaluations] = enclosed(f, near, far);
  EXPECT_EQ(std::nextafter(bracket.near, bracket.far), bracket.far);
  EXPECT_LE(f(bracket.near), 0);
  EXPECT_GT(f(bracket.far), 0);
  EXPECT_LE(evaluations, most_evaluations);
}

// A polynomial with one root in 0..1 or more, of any size, steep or flat there.
Function random_function(std::mt19937& engine) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double root = (1 + uniform(engine)) / 2, size = std::ldexp(1.0, static_cast<int>(engine() % 600) - 300);
  const double a = uniform(engine), b = uniform(engine), power = std::ldexp(1.0, static_cast<int>(engine() % 4));
  switch (engine() % 4) {
    case 0:
      return [=](double t) { return size * (t - root) * (1 + a * t + b * t * t); };
    case 1:
      return [=](double t) { return size * std::copysign(std::pow(std::abs(t - root), power), t - root); };
    case 2:
      return [=](double t) { return size * std::expm1(20 * a * (t - root)) * (a > 0 ? 1 : -1); };
    default:
      return [=](double t) { return t > root ? size : -size; };
  }
}

TEST(RootBracketing, EnclosesTheChangesOfSignOfRandomFunctions) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  int enclosed_ones = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    const Function f = random_function(engine);
    const double a = uniform(engine), b = uniform(engine);
    if (!(f(a) < 0) || !(f(b) > 0)) continue;
    ++enclosed_ones;
    SCOPED_TRACE(trial);
    expect_enclosed(f, a, b);
    expect_enclosed([&](double t) { return f(-t); }, -a, -b);
    if (HasFailure()) return;
  }
  EXPECT_GT(enclosed_ones, 3000);
}

// A root at zero, where numbers become denser and denser, and values that are zero over a stretch of numbers.
TEST(RootBracketing, EndsAtZeroAndAtStretchesOfZeros) {
  expect_enclosed([](double t) { return t; }, -1, 2);
  expect_enclosed([](double t) { return t * t * t; }, -1, 0.7);
  expect_enclosed([](double t) { return std::abs(t - 0.3) < 1e-9 ? 0.0 : t - 0.3; }, 0, 1);
}

}  // namespace
}  // namespace continuo::root_bracketing_test
