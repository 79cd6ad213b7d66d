// The driver on systems with closed forms: tolerances met, orders kept, output at the requested times.
#include <cmath>

#include <gtest/gtest.h>

#include <continuo/methods/all.hpp>
#include <continuo/solve/solve.hpp>
#include <continuo/solve/with_method.hpp>

namespace continuo::driver_test {
namespace {

using X = std::array<double, 2>;

// x'' = -x from (1, 0): x = cos t. One type for all tests keeps the templates few.
struct Oscillator {
  static constexpr bool autonomous = true;
  void operator()(double, const X& x, X& dxdt) const { dxdt = {x[1], -x[0]}; }
};

double error_at_ten(const Solution<X>& solution) {
  return std::hypot(solution.final_state()[0] - std::cos(10), solution.final_state()[1] + std::sin(10));
}

// One unit of local error per unit step: the global error of this neutral system is the sum of some hundred of them.
TEST(Driver, ToleranceIsMetWithinAFactorOfAHundredAndTighterIsBetter) {
  double last = 1;
  for (const double rtol : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    const auto solution = solve(Oscillator{}, X{1, 0}, {0, 10}, Dop853{}, {.rtol = rtol, .atol = rtol});
    EXPECT_LT(error_at_ten(solution), 100 * rtol) << rtol;
    EXPECT_LT(error_at_ten(solution), last) << rtol;
    last = error_at_ten(solution);
  }
}

TEST(Driver, EveryControllerMeetsTheToleranceAndRejectsLittle) {
  for (const Controller& controller : {I, PI, PID}) {
    const auto solution =
        solve(Oscillator{}, X{1, 0}, {0, 10}, Dop853{}, {.rtol = 1e-8, .atol = 1e-8, .controller = controller});
    EXPECT_LT(error_at_ten(solution), 1e-6);
    EXPECT_LT(solution.statistics.rejected, solution.statistics.steps / 4 + 2);
  }
}

TEST(Driver, FixedStepsLieOnTheGridAndEndOnTheEnd) {
  const auto solution = solve(Oscillator{}, X{1, 0}, {0, 10}, Rk4{}, {.step = 0.1});
  ASSERT_EQ(solution.t.size(), 101U);
  for (std::size_t i = 0; i + 1 < solution.t.size(); ++i) EXPECT_EQ(solution.t[i], static_cast<double>(i) * 0.1);
  EXPECT_EQ(solution.t.back(), 10);
  const auto half = solve(Oscillator{}, X{1, 0}, {0, 10}, Rk4{}, {.step = 0.05});
  EXPECT_NEAR(std::log2(error_at_ten(solution) / error_at_ten(half)), 4, 0.15);
}

TEST(Driver, AFixedStepThatDoesNotFitEndsWithAShorterOne) {
  const auto solution = solve(Oscillator{}, X{1, 0}, {0, 1}, Rk4{}, {.step = 0.3});
  EXPECT_EQ(solution.statistics.steps, 4U);
  EXPECT_EQ(solution.t.back(), 1);
}

TEST(Driver, DenseOutputFollowsTheSolutionEverywhere) {
  const auto solution =
      solve(Oscillator{}, X{1, 0}, {0, 10}, Dop853{}, {.rtol = 1e-10, .atol = 1e-10, .save = Save<X>::dense()});
  for (double t = 0; t <= 10; t += 0.037) EXPECT_NEAR(solution(t)[0], std::cos(t), 1e-8) << t;
  EXPECT_EQ(solution(0)[0], 1);
}

TEST(Driver, OutputTimesAreHitWithoutShorteningAStep) {
  const auto free = solve(Oscillator{}, X{1, 0}, {0, 10}, Dop853{}, {.save = Save<X>::only_end()});
  const auto grid = solve(Oscillator{}, X{1, 0}, {0, 10}, Dop853{}, {.save = Save<X>::every(0.01)});
  EXPECT_EQ(free.statistics.steps, grid.statistics.steps);
  EXPECT_EQ(free.final_state(), grid.final_state());
  ASSERT_EQ(grid.t.size(), 1001U);
  EXPECT_EQ(grid.t[700], 7.0);
  const auto times = solve(Oscillator{}, X{1, 0}, {0, 10}, Dop853{}, {.save = Save<X>::at({1, 2.5, 10})});
  EXPECT_EQ(times.t, (std::vector<double>{1, 2.5, 10}));
  EXPECT_EQ(free.t, (std::vector<double>{10}));
}

TEST(Driver, ACallbackSeesWhatWouldBeSaved) {
  std::vector<double> seen;
  Save<X> save = Save<X>::every(2.5);
  save.callback = [&seen](double t, const X&) { seen.push_back(t); };
  const auto solution = solve(Oscillator{}, X{1, 0}, {0, 10}, Dop853{}, {.save = save});
  EXPECT_EQ(seen, (std::vector<double>{0, 2.5, 5, 7.5, 10}));
  EXPECT_TRUE(solution.t.empty());
}

// OrdinaryDiffEq.jl#1972: a copy taken during a run continues to the same bits.
TEST(Driver, ACopyOfAnIntegratorIsACheckpoint) {
  Integrator integrator(Oscillator{}, X{1, 0}, {0, 10}, Dop853{}, {.rtol = 1e-9});
  for (int i = 0; i < 5; ++i) integrator.advance();
  Integrator copy = integrator;
  while (integrator.advance()) {
  }
  while (copy.advance()) {
  }
  EXPECT_EQ(integrator.x(), copy.x());
  EXPECT_EQ(integrator.statistics().evaluations, copy.statistics().evaluations);
}

TEST(Driver, AHandOnTheStateBeginsAfresh) {
  Integrator integrator(Oscillator{}, X{1, 0}, {0, 10}, Dop853{}, {.rtol = 1e-10, .atol = 1e-10});
  while (integrator.t() < 5 && integrator.advance()) {
  }
  const double t = integrator.t();
  integrator.set_state({2, 0});
  while (integrator.advance()) {
  }
  EXPECT_NEAR(integrator.x()[0], 2 * std::cos(10 - t), 1e-7);
  integrator.extend_to(12);
  while (integrator.advance()) {
  }
  EXPECT_NEAR(integrator.x()[0], 2 * std::cos(12 - t), 1e-7);
}

// x' = -k x with k = 1 until t = 1 and k = 3 from there: x(2) = e^-1 e^-3.
TEST(Driver, ContinuesWithAChangedSystem) {
  struct Decay {
    double k = 1;
    std::array<double, 1> operator()(double, const std::array<double, 1>& x) const { return {-k * x[0]}; }
  };
  Integrator integrator(Decay{}, std::array{1.0}, {0, 1}, Dop853{}, {.rtol = 1e-12, .atol = 1e-14});
  while (integrator.advance()) continue;
  integrator.change_system([](Decay& decay) { decay.k = 3; });
  integrator.extend_to(2);
  while (integrator.advance()) continue;
  EXPECT_EQ(integrator.t(), 2);
  EXPECT_EQ(integrator.system().k, 3);
  EXPECT_NEAR(integrator.x()[0], std::exp(-4.0), 1e-12);
}

TEST(Driver, ToleranceMayStandForEachComponent) {
  const auto loose = solve(Oscillator{}, X{1, 0}, {0, 10}, Dop853{}, {.rtol = 1e-4, .atol = 1e-4});
  const auto tight =
      solve(Oscillator{}, X{1, 0}, {0, 10}, Dop853{}, {.rtol_each = {1e-10, 1e-10}, .atol_each = {1e-10, 1e-10}});
  EXPECT_LT(error_at_ten(tight), 1e-8);
  EXPECT_GT(tight.statistics.steps, loose.statistics.steps);
}

TEST(Driver, RunTimeSizesAndOtherScalarsGiveTheSameMotion) {
  const auto general = [](auto, const auto& x, auto& dxdt) {
    dxdt[0] = x[1];
    dxdt[1] = -x[0];
  };
  const auto fixed = solve(Oscillator{}, X{1, 0}, {0, 10}, Tsitouras5{}, {.rtol = 1e-8, .atol = 1e-8});
  const auto sized = solve(general, std::vector<double>{1, 0}, {0, 10}, Tsitouras5{}, {.rtol = 1e-8, .atol = 1e-8});
  EXPECT_NEAR(sized.final_state()[0], fixed.final_state()[0], 1e-13);
  const auto wide =
      solve(general, std::array<long double, 2>{1, 0}, {0, 10}, Verner9{}, {.rtol = 1e-16L, .atol = 1e-16L});
  EXPECT_NEAR(static_cast<double>(wide.final_state()[0] - std::cos(10.0L)), 0, 1e-15);
  const auto narrow = solve(general, std::array<float, 2>{1, 0}, {0, 10}, Tsitouras5{}, {.rtol = 1e-5F, .atol = 1e-5F});
  EXPECT_NEAR(narrow.final_state()[0], std::cos(10.0F), 1e-3);
}

TEST(Driver, MethodsAreFoundByName) {
  EXPECT_EQ(method_catalogue().size(), std::tuple_size_v<AllMethods>);
  int order = 0;
  EXPECT_TRUE(with_method("dop853", [&](auto method) { order = decltype(method)::order; }));
  EXPECT_EQ(order, 8);
  EXPECT_TRUE(with_method("euler", [&](auto method) { order = decltype(method)::order; }));
  EXPECT_EQ(order, 1);
  EXPECT_FALSE(with_method("rk5", [](auto) {}));
}

}  // namespace
}  // namespace continuo::driver_test
