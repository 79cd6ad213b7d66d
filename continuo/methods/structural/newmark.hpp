// continuo/methods/structural/newmark.hpp
#pragma once
#include <cstddef>
#include <string_view>

#include <continuo/methods/structural/structural_dynamics.hpp>

namespace continuo {

/// Newmark's method with parameters of one's own: unconditionally stable for linear structures where
/// 2 Beta >= Gamma >= 1/2, of order 2 for Gamma = 1/2, with dissipation beyond.
template <double Beta, double Gamma>
struct NewmarkWith : StructuralDynamics<NewmarkWith<Beta, Gamma>> {
  static constexpr std::string_view name = "newmark";
  static constexpr int order = Gamma == 0.5 ? 2 : 1;
  static constexpr int error_order = Gamma == 0.5 && Beta > 1.0 / 6 ? 2 : 0;

  template <class Real>
  [[nodiscard]] static StructuralNumbers<Real> numbers() {
    return {Real(0), Real(0), Real(Beta), Real(Gamma)};
  }

  /// With a' = (a_1 - a) / h and a'' the change of a' since the step before, what the series of q and v have besides
  /// the method: (Beta - 1/6) h^3 a' for positions (O. C. Zienkiewicz, Y. M. Xie, "A simple error estimator and
  /// adaptive time stepping procedure for dynamic analysis", Earthquake Eng. Struct. Dyn. 20 (1991) 871-887), h^3 a'' /
  /// 12 for velocities, from the second step on.
  template <class System, class Work>
  static void estimate(const System& system, Work& work) {
    using Real = typename Work::Real;
    const Real h = work.h, last = work.h_last;
    for_each_pair(system, work.a, [&](std::size_t q, std::size_t v) {
      const Real change = work.a_new.data()[v] - work.a.data()[v];
      work.error.data()[q] = (Real(Beta) - Real(1) / Real(6)) * h * h * change;
      work.error.data()[v] = Real(0);
      if (last == Real(0)) return;
      const Real bend = (change / h - (work.a.data()[v] - work.a_last.data()[v]) / last) * Real(2) / (h + last);
      work.error.data()[v] = h * h * h * bend / Real(12);
    });
  }
};

/// Average acceleration: beta = 1/4, gamma = 1/2. Order 2, no damping at any frequency, and with an error estimate.
using Newmark = NewmarkWith<0.25, 0.5>;

}  // namespace continuo
