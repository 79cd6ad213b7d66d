// Equations with a corner or a jump just where a root, a power or a logarithm ends: a tank that runs empty,
// h' = -k*sqrt(max(h, 0)). Beyond the corner the branch of this side has no value. Random members against their closed
// forms.
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::model {
namespace {

const std::vector<std::string> methods_with_switches{"",    "dop853", "tsitouras5", "adams",    "rodas5p",
                                                     "bdf", "radau",  "trbdf2",     "kvaerno5", "dormand_prince5"};

/// The state at the end of the run.
std::vector<double> state_at_end(const std::string& text, const std::string& method) {
  const Loaded loaded = load(Source("border.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  if (!loaded) return {0, 0};
  Experiment experiment;
  if (!method.empty()) experiment.method = method;
  experiment.rtol = 1e-7;
  experiment.atol = {1e-9};
  const Simulated simulated = simulate(*loaded.model, experiment);
  EXPECT_TRUE(simulated.run && succeeded(simulated.run->outcome.ending))
      << text << method << ": " << render(simulated.diagnostics, loaded.source)
      << (simulated.run ? describe(simulated.run->outcome) : "");
  if (!simulated.run) return {0, 0};
  const auto x = simulated.run->final_state();
  return {x.begin(), x.end()};
}

double end_of(const std::string& text, const std::string& method) {
  return state_at_end(text, method)[0];
}

class BorderOfDomain : public testing::Test {
 protected:
  double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }

 private:
  std::mt19937 random_{2026};
};

// sqrt(h) = sqrt(h0) - k t/2 until the tank is empty.
TEST_F(BorderOfDomain, ATankRunsEmpty) {
  for (const std::string& method : methods_with_switches) {
    const double k = between(0.3, 2), h0 = between(0.2, 3), empty = 2 * std::sqrt(h0) / k;
    for (const double t : {0.7 * empty, 1.5 * empty, 20 * empty}) {
      const double root = std::max(0.0, std::sqrt(h0) - k * t / 2);
      EXPECT_NEAR(end_of(fmt::format("h' = -{}*sqrt(max(h, 0))\nh(0) = {}\nrun 0..{}\n", k, h0, t), method),
                  root * root, 1e-5)
          << method << " k = " << k << " h0 = " << h0 << " t = " << t;
    }
  }
}

// The integral of |t - c|^p.
TEST_F(BorderOfDomain, PowersOfAMagnitude) {
  for (const std::string& method : methods_with_switches) {
    const double c = between(0.2, 1.8), p = between(0.3, 3.5);
    const double exact = (std::pow(c, p + 1) + std::pow(2 - c, p + 1)) / (p + 1);
    EXPECT_NEAR(end_of(fmt::format("x' = abs(t - {})^{}\nx(0) = 0\nrun 0..2\n", c, p), method), exact, 1e-5)
        << method << " c = " << c << " p = " << p;
  }
}

// A function of time that ends at c, and another one behind it.
TEST_F(BorderOfDomain, AnotherFunctionBehindTheBorder) {
  for (const std::string& method : methods_with_switches) {
    const double c = between(0.2, 1.8), d = between(0.1, 3);
    const double left = 2.0 / 3 * std::pow(c, 1.5), right = d * (2 - c);
    EXPECT_NEAR(end_of(fmt::format("x' = if t < {} then sqrt({} - t) else {}\nx(0) = 0\nrun 0..2\n", c, c, d), method),
                left + right, 1e-5)
        << method << " c = " << c;
    const double arc = c * (std::acos(-1.0) / 2 - 1) + (2 - c) * std::acos(-1.0) / 2;
    EXPECT_NEAR(end_of(fmt::format("x' = asin(min(t/{}, 1))\nx(0) = 0\nrun 0..2\n", c), method), arc, 1e-5)
        << method << " c = " << c;
  }
}

// Two tanks: what leaves the first fills the second, and nothing is lost.
TEST_F(BorderOfDomain, TwoTanksKeepTheirWater) {
  for (const std::string& method : methods_with_switches) {
    const double k = between(0.5, 2), h0 = between(0.2, 2);
    const auto text =
        fmt::format("a' = -{0}*sqrt(max(a, 0))\nb' = {0}*sqrt(max(a, 0))\na(0) = {1}\nb(0) = 0\nrun 0..30\n", k, h0);
    const std::vector<double> water = state_at_end(text, method);
    EXPECT_NEAR(water[0], 0, 1e-6) << method;
    EXPECT_NEAR(water[0] + water[1], h0, 1e-6) << method;
  }
}

}  // namespace
}  // namespace continuo::model
