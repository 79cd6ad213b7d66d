// Right-hand sides of double of one type for all of them, for tests that take the steps themselves: each method is
// compiled once for a kind of state.
#pragma once
#include <cstddef>
#include <functional>
#include <span>

#include <continuo/numerics/state.hpp>
#include <continuo/system/system.hpp>

namespace continuo::testing {

/// The first half of the state are positions, the second their velocities, for methods that ask.
struct Equations {
  std::function<void(double, std::span<const double>, std::span<double>)> f;
  int calls = 0;

  template <State X>
  void operator()(double t, const X& x, X& dxdt) {
    ++calls;
    f(t, x, dxdt);
  }
  [[nodiscard]] std::size_t pair_count(std::size_t size) const { return size / 2; }
  [[nodiscard]] PositionVelocity pair(std::size_t i, std::size_t size) const { return {i, i + size / 2}; }
};

}  // namespace continuo::testing
