// continuo/methods/symplectic/semi_implicit_euler.hpp
#pragma once
#include <string_view>

#include <continuo/methods/support/second_order_method.hpp>

namespace continuo {

/// Semi-implicit (symplectic) Euler, order 1: v_new = v + h a(t, q, v), q_new = q + h v_new. The energy of an
/// oscillator swings about its value instead of growing. Components in no pair take an explicit Euler step.
/// E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2nd ed. (2006), I.1.2, eq. 1.9.
struct SemiImplicitEuler : SecondOrderMethod {
  static constexpr std::string_view name = "semi_implicit_euler";
  static constexpr int order = 1, dense_order = 1;

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    const int evaluations = work.evaluate_start(system, t, x, discontinuity);
    euler(x, h, work.start, x_new);
    for_each_pair(system, x, [&](std::size_t position, std::size_t velocity) {
      x_new.data()[position] = x.data()[position] + h * x_new.data()[velocity];
    });
    return evaluations;
  }
};

}  // namespace continuo
