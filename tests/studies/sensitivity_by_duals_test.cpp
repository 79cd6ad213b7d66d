#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <continuo/studies/sensitivity_by_duals.hpp>

namespace continuo::studies::sensitivity_by_duals_test {
namespace {

TEST(SensitivityByDuals, OfDecayIsThatOfTheClosedForm) {  // x = q exp(-p t): dx/dp = -t x, dx/dq = x/q
  const auto decay = [](auto, const auto& x, const auto& p, auto& dxdt) { dxdt[0] = -p[0] * x[0]; };
  const auto run = sensitivities(decay, std::array{1.5}, std::array{0.5, 1.5}, {0, 2}, {.rtol = 1e-11, .atol = 1e-13},
                                 {{0.0}, {1.0}});
  const std::size_t last = run.rows() - 1;
  EXPECT_NEAR(run.x(last)[0], 1.5 * std::exp(-1), 1e-9);
  EXPECT_NEAR(run.by(last, 0)[0], -3 * std::exp(-1), 1e-9);
  EXPECT_NEAR(run.by(last, 1)[0], std::exp(-1), 1e-9);
}

// As tests/studies/sensitivity_test derives it: v_n = e^n sqrt(2 g h0), t_n = T (1 + 2 (e + ... + e^(n-1))).
TEST(SensitivityByDuals, OfABallAfterTenBouncesIsThatOfTheClosedForm) {
  const double g = 9.8, e = 0.9, h0 = 10, first = std::sqrt(2 * h0 / g), speed = std::sqrt(2 * g * h0), s = 0.3;
  double sum = 0.5, sum_by_e = 0;
  for (int j = 1; j < 10; ++j) sum += std::pow(e, j), sum_by_e += j * std::pow(e, j - 1);
  const double bounce = 2 * first * sum, v = std::pow(e, 10) * speed;
  const auto fall = [](auto, const auto& x, const auto& p, auto& dxdt) {
    dxdt[0] = x[1];
    dxdt[1] = -p[1];
  };
  const SensitiveGuard floor{"floor", [](auto, const auto& x, const auto&) { return x[0]; }, Direction::falls,
                             [](auto, const auto& before, const auto& p, auto& x) {
                               x[0] *= 0.0;
                               x[1] = -p[0] * before[1];
                             }};
  const auto run = sensitivities(fall, std::array{h0, 0.0}, std::array{e, g}, {0, bounce + s},
                                 {.rtol = 1e-12, .atol = 1e-14}, {}, floor);
  const std::size_t last = run.rows() - 1;
  ASSERT_EQ(run.solution.events.size(), 10u);
  const auto by = [&](double v_by, double bounce_by, double g_by) {
    return v_by * s - (v - g * s) * bounce_by - g_by * s * s / 2;
  };
  EXPECT_NEAR(run.by(last, 0)[0], by(10 * v / e, 2 * first * sum_by_e, 0), 1e-8);
  EXPECT_NEAR(run.by(last, 1)[0], by(v / (2 * g), -bounce / (2 * g), 1), 1e-8);
}

}  // namespace
}  // namespace continuo::studies::sensitivity_by_duals_test
