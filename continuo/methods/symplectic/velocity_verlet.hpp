// continuo/methods/symplectic/velocity_verlet.hpp
#pragma once
#include <string_view>

#include <continuo/methods/support/second_order_method.hpp>

namespace continuo {

/// Velocity Verlet, order 2, symplectic and time-reversible where a = a(q):
///
///   q_new = q + h v + h^2/2 a,   v_new = v + h/2 (a + a_new).
///
/// Where a depends on v, a_new is taken at the predicted v + h a, which keeps order 2. Components in no pair take a
/// step of the trapezoidal rule (Heun) with the same two evaluations. W. C. Swope, H. C. Andersen, P. H. Berens, K. R.
/// Wilson, J. Chem. Phys. 76 (1982) 637-649.
struct VelocityVerlet : SecondOrderMethod {
  static constexpr std::string_view name = "velocity_verlet";
  static constexpr int order = 2, dense_order = 2;

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    const int evaluations = work.evaluate_start(system, t, x, discontinuity);
    const Scalar<X> half = h * Scalar<X>(0.5);
    euler(x, h, work.start, x_new);
    for_each_pair(system, x, [&](std::size_t position, std::size_t velocity) {
      const Scalar<X> middle = x.data()[velocity] + half * work.start.data()[velocity];
      x_new.data()[position] = x.data()[position] + h * middle;
    });
    evaluate(system, t + h, x_new, work.end);
    correct(system, x, half, work, x_new);
    return evaluations + 1;
  }
};

}  // namespace continuo
