// The order of the dense output of methods for x'' = a(t, x), measured once for all of them.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <continuo/methods/method.hpp>
#include <continuo/system/second_order.hpp>

namespace continuo {

/// One step from an exact state of x'' = -x, in 34 digits: the greatest error between the ends, which is that of the
/// velocity, falls with h^(p+1) from h to h / 2.
template <class M>
void expect_dense_order_on_oscillator(double h) {
  using Number = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                               boost::multiprecision::et_off>;
  using X = std::array<Number, 2>;
  const auto error = [](const Number& step) {
    auto spring =
        second_order([](const Number&, const std::array<Number, 1>& q) { return std::array<Number, 1>{-q[0]}; });
    const Number t = 0.3;
    const X x{cos(t), -sin(t)};
    X x_new = x, between = x;
    auto work = M::workspace(x);
    M::step(spring, t, x, step, true, work, x_new);
    Interpolant<X, M::dense_degree> interpolant(x);
    M::interpolate(spring, t, x, step, x_new, work, interpolant);
    Number worst = 0;
    for (Number theta = 0.0625; theta <= 1; theta += 0.0625) {
      interpolant(theta, between);
      worst = std::max(
          {worst, Number(abs(between[0] - cos(t + theta * step))), Number(abs(between[1] + sin(t + theta * step)))});
    }
    return worst;
  };
  const double order = std::log2(static_cast<double>(Number(error(Number(h)) / error(Number(h / 2)))));
  EXPECT_NEAR(order, M::dense_order + 1, 0.3);
}

}  // namespace continuo
