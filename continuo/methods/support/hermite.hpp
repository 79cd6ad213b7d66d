// continuo/methods/support/hermite.hpp
#pragma once
#include <array>
#include <cstddef>

#include <continuo/methods/method.hpp>
#include <continuo/system/system.hpp>

namespace continuo::detail {

/// The cubic in theta that has values x, x_new and slopes (times h) first, last at theta = 0, 1: with d = x_new - x its
/// powers are x, first, 3 d - 2 first - last, first + last - 2 d. U is a component or a register of them.
template <class Real, class U, class Powers>
inline void set_cubic_hermite(const U& x, const U& x_new, const U& first, const U& last, Powers& c) {
  const U difference = x_new - x;
  c[0] = x;
  c[1] = first;
  c[2] = Real(3) * difference - Real(2) * first - last;
  c[3] = first + last - Real(2) * difference;
}

/// q(theta) = q0 + h v0 theta + h^2 a0 theta^2 / 2 + A theta^3 + B theta^4 + C theta^5, where A, B, C are what the
/// other end asks for: with Q, V, W the position, h times the velocity and h^2 times the acceleration still missing
/// there, A = 10 Q - 4 V + W/2, B = -15 Q + 7 V - W, C = 6 Q - 3 V + W/2.
template <State X, int Degree>
  requires(Degree >= 5)
void set_quintic_hermite(const X& x, const Scalar<X>& h, const X& x_new, const Scalar<X>& a0, const Scalar<X>& a1,
                         PositionVelocity pair, Interpolant<X, Degree>& interpolant) {
  using Real = Scalar<X>;
  const auto [q, v] = pair;
  const Real v0 = x.data()[v], half = Real(0.5);
  const Real w0 = h * h * a0;
  const Real position = (x_new.data()[q] - x.data()[q]) - h * (v0 + half * h * a0);
  const Real velocity = h * ((x_new.data()[v] - v0) - h * a0);
  const Real curvature = h * h * a1 - w0;
  const std::array<Real, 6> c{x.data()[q],
                              h * v0,
                              half * w0,
                              Real(10) * position - Real(4) * velocity + half * curvature,
                              Real(-15) * position + Real(7) * velocity - curvature,
                              Real(6) * position - Real(3) * velocity + half * curvature};
  for (std::size_t j = 0; j < 6; ++j) interpolant.c[j].data()[q] = c[j];
  for (std::size_t j = 0; j < 5; ++j)
    interpolant.c[j].data()[v] = j == 0 ? v0 : Real(static_cast<double>(j + 1)) * c[j + 1] / h;
  for (std::size_t j = 5; j <= Degree; ++j) interpolant.c[j].data()[v] = Real(0);
  for (std::size_t j = 6; j <= Degree; ++j) interpolant.c[j].data()[q] = Real(0);
}

}  // namespace continuo::detail
