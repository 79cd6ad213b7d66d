// The concept `Method`, and what becomes of a method that has all members of which one is wrong. The sentences by which
// the compiler refuses a method are tested in tests/refusals_of_methods.
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "own_method.hpp"
#include <continuo/methods/all.hpp>
#include <continuo/methods/measured_orders.hpp>
#include <continuo/methods/multistep/bdf_krylov.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::check_method_test {
namespace {

using testing::Fault;
using testing::OwnHeun;
using X = std::array<double, 2>;

template <class State, class List>
constexpr bool all_are_methods = false;
template <class State, class... M>
constexpr bool all_are_methods<State, std::tuple<M...>> = (check_method<M, State>() && ...);
static_assert(all_are_methods<X, AllMethods> && all_are_methods<std::vector<double>, AllMethods>);
static_assert(all_are_methods<std::array<long double, 2>, AllMethods> &&
              check_method<BdfKrylov, std::vector<double>>());

template <Fault... faults>
constexpr bool none_is_a_method = (!Method<OwnHeun<faults>, X> && ...);
static_assert(check_method<OwnHeun<>, X>() && check_method<OwnHeun<>, std::vector<float>>());
static_assert(none_is_a_method<Fault::name, Fault::order, Fault::error_order, Fault::dense_order, Fault::dense_degree,
                               Fault::second_order, Fault::workspace, Fault::step, Fault::interpolate, Fault::accept,
                               Fault::error_norm, Fault::error_of, Fault::derivative>);

/// Without an estimate, nothing that measures errors is needed.
struct Plain : OwnHeun<> {
  static constexpr int error_order = 0;
  static void error_norm() = delete;
  static void error_of() = delete;
  static void derivative() = delete;
};
static_assert(check_method<Plain, X>());

struct Oscillator {
  void operator()(double, const X& x, X& dxdt) const { dxdt = {x[1], -x[0]}; }
};

TEST(OwnMethod, RunsWithEventsAndDenseOutput) {
  Options<X> options{.rtol = 1e-8, .atol = 1e-8, .save = Save<X>::dense()};
  options.events.push_back(falls<X>("zero", [](double, const X& x) { return x[0]; }));
  const auto solution = solve(Oscillator{}, X{1, 0}, {0, 3}, OwnHeun<>{}, options);
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  ASSERT_EQ(solution.events.size(), 1U);
  // Heun's method adds up to some units of local error per step, of which there are thousands.
  EXPECT_NEAR(solution.events[0].t, std::acos(0.0), 1e-4);
  EXPECT_NEAR(solution(2)[0], std::cos(2), 1e-4);
}

// ---- what a wrong member does

template <Fault fault>
std::string refusal() {
  return check_orders<OwnHeun<fault>>().message;
}
TEST(CheckOrders, AcceptsARightMethodAndNamesTheClaimThatIsWrong) {
  EXPECT_EQ(refusal<Fault::none>(), "");
  EXPECT_EQ(refusal<Fault::weight>(), "own_heun claims order 2, but its error decreases with order 1.0");
  EXPECT_EQ(refusal<Fault::order_claimed>(), "own_heun claims order 3, but its error decreases with order 2.0");
  EXPECT_EQ(refusal<Fault::interpolant>(),
            "own_heun claims dense_order 2, but the error of its interpolant decreases with order 1.0");
  EXPECT_EQ(refusal<Fault::interpolant_end>(), "the interpolant of own_heun does not join x and x_new");
  EXPECT_EQ(refusal<Fault::zero_estimate>(),
            "own_heun claims error_order 1, but its error estimate is 0 or not a number");
  EXPECT_EQ(refusal<Fault::large_estimate_order>(),
            "own_heun claims error_order 2, but its error estimate decreases with order 1.0");
}

TEST(CheckOrders, AcceptsEveryMethodOfTheLibraryWhoseOrderDoesNotVary) {
  int methods = 0;
  for_each_method([&]<class M>() {
    using State = std::array<long double, 2>;
    if constexpr (!detail::HasErrorOrderOf<M, typename M::template Workspace<State>>) {
      ++methods;
      EXPECT_EQ(check_orders<M>().message, "");
    }
  });
  EXPECT_GT(methods, 30);
}

TEST(OwnMethod, AStepThatIsNotFiniteIsNoSuccessThoughTheErrorNormIgnoresIt) {
  const auto solution = solve(Oscillator{}, X{1, 0}, {0, 2}, OwnHeun<Fault::nan_step>{});
  EXPECT_EQ(solution.outcome.ending, Ending::not_finite) << describe(solution.outcome);
  EXPECT_LE(solution.t.back(), 1);
  for (const X& x : solution.x) EXPECT_TRUE(std::isfinite(x[0]));
}

template <class M>
class FactorOf : public ::testing::Test {};
using WrongFactors =
    ::testing::Types<OwnHeun<Fault::zero_factor>, OwnHeun<Fault::negative_factor>, OwnHeun<Fault::nan_factor>>;
TYPED_TEST_SUITE(FactorOf, WrongFactors);
TYPED_TEST(FactorOf, TheNextStepThatIsNotPositiveIsReplacedByThatOfTheController) {
  const auto right = solve(Oscillator{}, X{1, 0}, {0, 1}, OwnHeun<>{});
  const auto solution = solve(Oscillator{}, X{1, 0}, {0, 1}, TypeParam{});
  EXPECT_TRUE(solution.outcome) << describe(solution.outcome);
  EXPECT_EQ(solution.t, right.t);
  EXPECT_EQ(solution.x, right.x);
}

}  // namespace
}  // namespace continuo::check_method_test
