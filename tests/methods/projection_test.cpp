// Every method with a projection: Kepler's ellipse onto its energy and its angular momentum. Orders and tolerances are
// kept, and the errors are no greater than without. The reference is the closed form: after a period the start.
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/solve/catalogue.hpp>
#include <continuo/studies/support/named_solve.hpp>

namespace continuo::projection_test {
namespace {

using V = std::vector<double>;
constexpr double eccentricity = 0.5;

V start() {
  return {1 - eccentricity, 0, 0, std::sqrt((1 + eccentricity) / (1 - eccentricity))};
}
double energy(const V& x) {
  return 0.5 * (x[2] * x[2] + x[3] * x[3]) - 1 / std::hypot(x[0], x[1]);
}
double momentum(const V& x) {
  return x[0] * x[3] - x[1] * x[2];
}
double beside_invariants(const V& x) {
  return std::abs(energy(x) - energy(start())) + std::abs(momentum(x) - momentum(start()));
}

// Newton's iteration along the two gradients: the nearest state on both, to the second order.
bool onto_invariants(double, V& x) {
  for (int iteration = 0; iteration < 20; ++iteration) {
    const double a = energy(x) - energy(start()), b = momentum(x) - momentum(start());
    if (std::abs(a) + std::abs(b) < 1e-15) return true;
    const double r = std::hypot(x[0], x[1]), pull = 1 / (r * r * r);
    const std::array<double, 4> of_a{pull * x[0], pull * x[1], x[2], x[3]}, of_b{x[3], -x[2], -x[1], x[0]};
    double aa = 0, ab = 0, bb = 0;
    for (std::size_t i = 0; i < 4; ++i) aa += of_a[i] * of_a[i], ab += of_a[i] * of_b[i], bb += of_b[i] * of_b[i];
    const double determinant = aa * bb - ab * ab, along_a = (bb * a - ab * b) / determinant,
                 along_b = (aa * b - ab * a) / determinant;
    for (std::size_t i = 0; i < 4; ++i) x[i] -= along_a * of_a[i] + along_b * of_b[i];
  }
  return beside_invariants(x) < 1e-13;
}

Solution<V> turn(const MethodInfo& method, double step, bool projected) {
  static const auto kepler = studies::named_motion<double>(4, [](double, std::span<const double> x, auto dxdt) {
    const double r = std::hypot(x[0], x[1]), pull = 1 / (r * r * r);
    dxdt[0] = x[2];
    dxdt[1] = x[3];
    dxdt[2] = -pull * x[0];
    dxdt[3] = -pull * x[1];
  });
  const double period = 2 * std::acos(-1.0);
  Options<V> options{.rtol = 1e-4, .atol = 1e-4, .step = step, .save = Save<V>::every(period / 100)};
  if (projected) options.projection = onto_invariants;
  return studies::named_solve<double>(method.name, kepler, start(), {0, period}, options);
}
double error_of(const Solution<V>& solution) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += std::pow(solution.final_state()[i] - start()[i], 2);
  return std::sqrt(sum);
}

TEST(Projection, EveryMethodKeepsItsOrderOrItsTolerance) {
  for (const MethodInfo& method : method_catalogue()) {
    if (method.needs_series) continue;  // see taylor_series_test.cpp
    SCOPED_TRACE(method.name);
    const double step = method.error_order > 0 ? 0 : 2 * std::acos(-1.0) / 400;
    const auto plain = turn(method, step, false), projected = turn(method, step, true);
    ASSERT_TRUE(projected.outcome) << describe(projected.outcome);
    for (const V& x : projected.x) EXPECT_LT(beside_invariants(x), 1e-13);
    EXPECT_LT(error_of(projected), 1.6 * error_of(plain) + 1e-14);
    // One evaluation more at each step, of the methods that would have kept f at its end: of some the second.
    EXPECT_LT(projected.statistics.evaluations, 2 * plain.statistics.evaluations);
    const double half = step > 0 ? error_of(turn(method, step / 2, true)) : 0;
    if (half <= 1e-13) continue;
    EXPECT_GT(std::log2(error_of(projected) / half), method.order_of_fixed_steps - 0.2);
  }
}

}  // namespace
}  // namespace continuo::projection_test
