// The methods for q'' = a(t, q, v), by their documentation; their orders are measured in order_test.cpp.
#include <array>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include <continuo/methods/structural/central_difference.hpp>
#include <continuo/methods/symplectic/semi_implicit_euler.hpp>
#include <continuo/methods/symplectic/symplectic_euler_position_first.hpp>
#include <continuo/methods/symplectic/velocity_verlet.hpp>

namespace continuo::second_order_method_test {
namespace {

using X = std::array<double, 2>;

/// The state after n steps of size h, and the evaluations they took.
template <class M, class System>
X after(System system, X x, double h, int n, int* evaluations = nullptr) {
  X x_new{};
  auto work = M::workspace(x);
  for (int i = 0; i < n; ++i) {
    const int count = M::step(system, h * i, x, h, i == 0, work, x_new);
    if (evaluations) *evaluations += count;
    M::accept(work);
    x = x_new;
  }
  return x;
}

const auto oscillator = second_order([](double, const auto& q) { return std::array{-q[0]}; });

TEST(SemiImplicitEuler, AConstantForceGivesTheNumbersOfTheLecture) {
  // m = F = 1, h = 1: v = 1, 2, 3 and x = 1, 3, 6 (explicit Euler gives 3, the exact value is 4.5).
  const auto force = second_order([](double, const auto&) { return std::array{1.0}; });
  EXPECT_EQ((after<SemiImplicitEuler>(force, X{0, 0}, 1, 3)), (X{6, 3}));
}

TEST(SemiImplicitEuler, TheEnergyOfAnOscillatorSwingsWithinOrderH) {
  // It conserves (q^2 + v^2 - h q v) / 2 exactly, so the energy stays within h/2 of its relative value.
  const double h = 0.1;
  X x{1, 0}, x_new{};
  auto system = oscillator;
  auto work = SemiImplicitEuler::workspace(x);
  for (int i = 0; i < 10000; ++i) {
    SemiImplicitEuler::step(system, h * i, x, h, i == 0, work, x_new);
    SemiImplicitEuler::accept(work);
    x = x_new;
    ASSERT_NEAR(x[0] * x[0] + x[1] * x[1] - h * x[0] * x[1], 1, 1e-12);
  }
}

TEST(VelocityVerlet, IsTheTextbookFormula) {
  const double h = 0.3;
  const X x{1, 0.5};
  const double q = x[0] + h * x[1] - h * h / 2 * x[0];
  const double v = x[1] - h / 2 * (x[0] + q);
  const X x_new = after<VelocityVerlet>(oscillator, x, h, 1);
  EXPECT_NEAR(x_new[0], q, 1e-15);  // the same sums in another order
  EXPECT_NEAR(x_new[1], v, 1e-15);
}

TEST(VelocityVerlet, RunsBackTheWayItCame) {
  const auto pendulum = second_order([](double, const auto& q) { return std::array{-std::sin(q[0])}; });
  const X x{2, 0.5};
  const X there = after<VelocityVerlet>(pendulum, x, 0.1, 1000);
  const X back = after<VelocityVerlet>(pendulum, there, -0.1, 1000);
  // Each of two thousand steps rounds at the size of the state, and these errors grow linearly along the orbit.
  EXPECT_NEAR(back[0], x[0], 1e-10);
  EXPECT_NEAR(back[1], x[1], 1e-10);
}

template <class M>
void expect_one_evaluation_a_step() {
  int evaluations = 0;
  after<M>(oscillator, X{1, 0}, 0.1, 100, &evaluations);
  EXPECT_EQ(evaluations, 101);
}
TEST(VelocityVerlet, EvaluatesOnceAStepWhereVelocitiesDoNotCount) {
  expect_one_evaluation_a_step<VelocityVerlet>();
}
TEST(CentralDifference, EvaluatesOnceAStepWhereVelocitiesDoNotCount) {
  expect_one_evaluation_a_step<CentralDifference>();
}

TEST(CentralDifference, PositionsFollowTheThreeTermRecursion) {
  // q_next = 2 q - q_last + h^2 a(q), from q_1 = q_0 + h v_0 + h^2/2 a(q_0).
  const double h = 0.2;
  double last = 1, q = last + h * 0.5 - h * h / 2 * last;
  for (int n = 2; n <= 50; ++n) {
    const double next = 2 * q - last - h * h * q;
    last = q;
    q = next;
    EXPECT_NEAR(after<CentralDifference>(oscillator, X{1, 0.5}, h, n)[0], q, 1e-12);  // round-off grows like n^2 here
  }
}

TEST(CentralDifference, AJumpDropsItsHistory) {
  auto system = oscillator;
  const X x{1, 0}, elsewhere{-3, 7};
  X x_new{};
  auto work = CentralDifference::workspace(x);
  CentralDifference::step(system, 0.0, x, 0.1, true, work, x_new);
  CentralDifference::accept(work);
  CentralDifference::step(system, 0.1, elsewhere, 0.1, true, work, x_new);
  EXPECT_EQ(x_new, (after<CentralDifference>(oscillator, elsewhere, 0.1, 1)));
}

TEST(CentralDifference, AStepThatDoesNotStandLeavesNoTrace) {
  auto system = oscillator;
  const X x{1, 0};
  X once{}, x_new{}, expected{};
  auto work = CentralDifference::workspace(x), straight = CentralDifference::workspace(x);
  for (auto* each : {&work, &straight}) {
    CentralDifference::step(system, 0.0, x, 0.1, true, *each, once);
    CentralDifference::accept(*each);
  }
  CentralDifference::step(system, 0.1, once, 0.7, false, work, x_new);  // not accepted
  CentralDifference::step(system, 0.1, once, 0.1, false, work, x_new);
  CentralDifference::step(system, 0.1, once, 0.1, false, straight, expected);
  EXPECT_EQ(x_new, expected);
}

/// q'' = -q beside a first-order z' = -z + q: z is in no pair.
struct Mixed {
  void operator()(double, const std::array<double, 3>& x, std::array<double, 3>& dxdt) const {
    dxdt = {x[1], -x[0], x[0] - x[2]};
  }
  std::size_t pair_count(std::size_t) const { return 1; }
  PositionVelocity pair(std::size_t, std::size_t) const { return {0, 1}; }
};

template <class M>
double first_order_error(int n) {
  // q = cos t, z = (cos t + sin t - e^-t) / 2 from (1, 0, 0).
  Mixed system;
  std::array<double, 3> x{1, 0, 0}, x_new{};
  auto work = M::workspace(x);
  for (int i = 0; i < n; ++i) {
    M::step(system, 1.0 / n * i, x, 1.0 / n, i == 0, work, x_new);
    M::accept(work);
    x = x_new;
  }
  return std::abs(x[2] - (std::cos(1.0) + std::sin(1.0) - std::exp(-1.0)) / 2);
}
template <class M>
void expect_order_beside_pairs() {
  EXPECT_NEAR(std::log2(first_order_error<M>(100) / first_order_error<M>(200)), M::order, 0.15);
}
TEST(SemiImplicitEuler, AComponentInNoPairHasItsOrder) {
  expect_order_beside_pairs<SemiImplicitEuler>();
}
TEST(SymplecticEulerPositionFirst, AComponentInNoPairHasItsOrder) {
  expect_order_beside_pairs<SymplecticEulerPositionFirst>();
}
TEST(VelocityVerlet, AComponentInNoPairHasItsOrder) {
  expect_order_beside_pairs<VelocityVerlet>();
}
TEST(CentralDifference, AComponentInNoPairHasItsOrder) {
  expect_order_beside_pairs<CentralDifference>();
}

}  // namespace
}  // namespace continuo::second_order_method_test
