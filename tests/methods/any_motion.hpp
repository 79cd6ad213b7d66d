// Motions of one position, q'' = a(t, q, v), of one type for all accelerations: each method is compiled once for a kind
// of number.
#pragma once
#include <array>
#include <cstddef>

#include <continuo/numerics/state.hpp>
#include <continuo/system/system.hpp>

namespace continuo::testing {

template <class Real>
struct AnyMotion {
  Real (*acceleration)(Real t, Real q, Real v);
  bool reads_velocity = true;

  using X = std::array<Real, 2>;
  void operator()(const Real& t, const X& x, X& dxdt) const { dxdt = {x[1], acceleration(t, x[0], x[1])}; }
  [[nodiscard]] std::size_t pair_count(std::size_t) const { return 1; }
  [[nodiscard]] PositionVelocity pair(std::size_t, std::size_t) const { return {0, 1}; }
  [[nodiscard]] bool ignores_velocity(const X&) const { return !reads_velocity; }
};

}  // namespace continuo::testing
