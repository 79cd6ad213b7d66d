// Second-order systems, by the documentation of continuo/system/second_order.hpp.
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/system/second_order.hpp>

namespace continuo::second_order_test {
namespace {

template <class System, class X>
X derivative(System system, const X& x) {
  X dxdt = x;
  evaluate(system, 0.5, x, dxdt);
  return dxdt;
}

const std::array<double, 4> x{1, 2, 3, 4};
const std::vector<double> y{1, 2, 3, 4};

TEST(SecondOrder, AReturnedAccelerationOfThePositions) {
  auto system = second_order([](double t, const auto& q) { return std::array{-q[0], t * q[1]}; });
  EXPECT_EQ(derivative(system, x), (std::array{3.0, 4.0, -1.0, 1.0}));
  EXPECT_EQ(derivative(system, y), (std::vector{3.0, 4.0, -1.0, 1.0}));
  EXPECT_TRUE(ignores_velocity(system, x));
  EXPECT_TRUE(ignores_velocity(system, y));
}

TEST(SecondOrder, AReturnedAccelerationOfPositionsAndVelocities) {
  auto system = second_order([](double, const auto& q, const auto& v) { return std::array{-q[0], v[0] * v[1]}; });
  EXPECT_EQ(derivative(system, x), (std::array{3.0, 4.0, -1.0, 12.0}));
  EXPECT_EQ(derivative(system, y), (std::vector{3.0, 4.0, -1.0, 12.0}));
  EXPECT_FALSE(ignores_velocity(system, x));
  EXPECT_FALSE(ignores_velocity(system, y));
}

TEST(SecondOrder, AnAccelerationMayBeWrittenInstead) {
  auto of_positions = second_order([](double, std::span<const double> q, std::span<double> a) {
    for (std::size_t i = 0; i < q.size(); ++i) a[i] = -q[i];
  });
  EXPECT_EQ(derivative(of_positions, y), (std::vector{3.0, 4.0, -1.0, -2.0}));
  EXPECT_TRUE(ignores_velocity(of_positions, y));
  auto of_both = second_order([](double, const auto& q, const auto& v, auto& a) {
    for (std::size_t i = 0; i < q.size(); ++i) a[i] = -q[i] * v[i];
  });
  EXPECT_EQ(derivative(of_both, x), (std::array{3.0, 4.0, -3.0, -8.0}));
  EXPECT_EQ(derivative(of_both, y), (std::vector{3.0, 4.0, -3.0, -8.0}));
  EXPECT_FALSE(ignores_velocity(of_both, x));
}

TEST(SecondOrder, ThePairsAreTheHalvesOfTheState) {
  auto system = second_order([](double, const auto& q) { return q; });
  static_assert(SecondOrder<decltype(system)>);
  ASSERT_EQ(system.pair_count(6), 3U);
  EXPECT_EQ(system.pair(1, 6).position, 1U);
  EXPECT_EQ(system.pair(1, 6).velocity, 4U);
}

TEST(SecondOrder, OneThatDoesNotSayDependsOnItsVelocities) {
  EXPECT_FALSE(ignores_velocity([](double, const std::array<double, 4>& state) { return state; }, x));
}

}  // namespace
}  // namespace continuo::second_order_test
