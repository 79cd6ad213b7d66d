// Runs of plain right-hand sides that are in the library: the same bits as those that are compiled with the program.
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/methods/automatic.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/dormand_prince5.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/explicit_rk/verner9.hpp>
#include <continuo/solve/automatic.hpp>
#include <continuo/solve/erased_system.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo {
namespace {

template <class X>
X sized(std::size_t size) {
  if constexpr (FixedSize<X>) {
    return {};
  } else {
    return X(size);
  }
}

/// Cubic equations with random coefficients, nonlinear and damped.
template <class X>
struct RandomMotion {
  X start;
  std::vector<double> matrix;

  RandomMotion(std::size_t size, std::mt19937& random) : start(sized<X>(size)), matrix(size * size) {
    std::normal_distribution<double> normal;
    for (double& entry : start) entry = normal(random);
    for (double& entry : matrix) entry = normal(random);
  }
  auto f() const {
    return [a = matrix](double t, const X& x, X& dxdt) {
      for (std::size_t i = 0; i < x.size(); ++i) {
        dxdt[i] = 0.1 * t - x[i] * x[i] * x[i];
        for (std::size_t j = 0; j < x.size(); ++j) dxdt[i] += a[i * x.size() + j] * x[j];
      }
    };
  }
};

template <class X>
void expect_same(const Solution<X>& by_library, const Solution<X>& compiled) {
  ASSERT_TRUE(compiled.outcome) << describe(compiled.outcome);
  EXPECT_EQ(by_library.t, compiled.t);
  EXPECT_EQ(by_library.x, compiled.x);
  EXPECT_EQ(by_library.statistics.steps, compiled.statistics.steps);
  EXPECT_EQ(by_library.statistics.evaluations, compiled.statistics.evaluations);
  EXPECT_EQ(by_library.event_names, compiled.event_names);
  ASSERT_EQ(by_library.events.size(), compiled.events.size());
  for (std::size_t i = 0; i < compiled.events.size(); ++i) EXPECT_EQ(by_library.events[i].t, compiled.events[i].t);
}

template <class X, class M>
void compare(std::size_t size, M method, std::mt19937& random) {
  const RandomMotion<X> motion(size, random);
  Options<X> options{.rtol = 1e-7, .atol = 1e-9};
  if (std::is_same_v<M, Rk4>) options.step = 0.01;
  options.events = {falls<X>("zero", [](double, const X& x) { return x[0]; }),
                    crosses<X>(
                        "turn", [](double t, const X& x) { return x.back() - 0.3 * t; },
                        [](EventAction<X>& now) { now.x[0] += 0.25; })};
  const auto f = motion.f();
  Integrator<std::decay_t<decltype(f)>, X, M> compiled(f, motion.start, {0, 5}, method, options);
  const Solution<X> expected = run(compiled);
  expect_same(solve(ErasedSystem<X>(f), motion.start, {0, 5}, method, options), expected);
  expect_same(solve(f, motion.start, {0, 5}, method, options), expected);
}

TEST(ErasedSystem, GivesTheBitsOfTheSystem) {
  std::mt19937 random(22);
  std::apply([&](auto... method) { (compare<std::array<double, 2>>(2, method, random), ...); },
             detail::MethodsInLibrary{});
  compare<std::array<double, 1>>(1, Dop853{}, random);
  compare<std::array<double, 3>>(3, Tsitouras5{}, random);
  compare<std::array<double, 4>>(4, DormandPrince5{}, random);
  compare<std::vector<double>>(5, Tsitouras5Rodas5P{}, random);
}

TEST(ErasedSystem, IsWhatIsChosenForRunsByItself) {
  const auto oscillator = [](double, const std::array<double, 2>& x) { return std::array{x[1], -x[0]}; };
  const auto erased = solve(ErasedSystem<std::array<double, 2>>(oscillator), std::array{1.0, 0.0}, {0, 10});
  const auto plain = solve(oscillator, std::array{1.0, 0.0}, {0, 10});
  EXPECT_EQ(erased.x, plain.x);
  EXPECT_NEAR(plain.final_state()[0], std::cos(10), 1e-4);
}

using X2 = std::array<double, 2>;
template <class F, class M = Dop853, class X = X2>
constexpr bool without_optimization = detail::runs_in_library<F, X, M, false>;

// Whoever says more than a right-hand side is compiled with all that is said.
TEST(ErasedSystem, ReplacesNoSystemThatSaysMore) {
  const auto plain = [](double, const X2& x) { return x; };
  using Plain = std::decay_t<decltype(plain)>;
  static_assert(without_optimization<Plain>);
  static_assert(without_optimization<X2 (*)(double, const X2&)>);
  static_assert(!without_optimization<Plain, Verner9>);
  static_assert(!without_optimization<Plain, Dop853, std::array<double, 5>>);
  static_assert(!without_optimization<Plain, Dop853, std::array<float, 2>>);
  static_assert(!detail::runs_in_library<Plain, X2, Dop853, true>);
  static_assert(detail::runs_in_library<ErasedSystem<X2>, X2, Dop853, true>);

  struct WithJacobian {
    X2 operator()(double, const X2& x) const { return x; }
    void jacobian(double, const X2&, std::span<double>) const {}
  };
  struct WithMass {
    X2 operator()(double, const X2& x) const { return x; }
    double mass(std::size_t) const { return 2; }
  };
  struct Autonomous {
    bool autonomous = true;
    X2 operator()(double, const X2& x) const { return x; }
  };
  struct Final final {  // what else it has cannot be seen
    X2 operator()(double, const X2& x) const { return x; }
  };
  static_assert(!without_optimization<WithJacobian>);
  static_assert(!without_optimization<WithMass>);
  static_assert(!without_optimization<Autonomous>);
  static_assert(!without_optimization<Final>);
  static_assert(!without_optimization<SystemReference<WithJacobian>>);
}

TEST(ErasedSystem, SaysThatADerivativeHasAnotherSize) {
  using X = std::vector<double>;
  const auto f = [](double, const X&) { return X{1, 2, 3}; };
  const auto solution = solve(ErasedSystem<X>(f), X{1, 2}, {0, 1}, Dop853{});
  EXPECT_EQ(solution.outcome.ending, Ending::invalid_input);
  EXPECT_NE(describe(solution.outcome).find("3 derivatives of 2"), std::string::npos) << describe(solution.outcome);
}

}  // namespace
}  // namespace continuo
