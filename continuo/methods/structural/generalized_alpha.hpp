// continuo/methods/structural/generalized_alpha.hpp
#pragma once
#include <string_view>

#include <continuo/methods/structural/structural_dynamics.hpp>

namespace continuo {

/// The generalized-alpha method of J. Chung and G. M. Hulbert, J. Appl. Mech. 60 (1993) 371-375: order 2,
/// unconditionally stable for linear structures, and of all such methods the one that damps low frequencies least while
/// the highest are multiplied by Rho in a step. Rho = 1 damps nothing, Rho = 0 wipes them out at once. Fixed steps.
template <double Rho>
  requires(Rho >= 0 && Rho <= 1)
struct GeneralizedAlphaWith : StructuralDynamics<GeneralizedAlphaWith<Rho>> {
  static constexpr std::string_view name = "generalized_alpha";
  static constexpr int order = 2, error_order = 0;

  /// The parameters of the paper by the radius asked for: order 2, and the greatest damping of high frequencies.
  template <class Real>
  [[nodiscard]] static StructuralNumbers<Real> numbers() {
    const Real rho = Real(Rho);
    const Real alpha_m = (Real(2) * rho - Real(1)) / (rho + Real(1)), alpha_f = rho / (rho + Real(1));
    const Real beyond = Real(1) - alpha_m + alpha_f;
    return {alpha_m, alpha_f, beyond * beyond / Real(4), Real(0.5) - alpha_m + alpha_f};
  }
};

using GeneralizedAlpha = GeneralizedAlphaWith<0.8>;

}  // namespace continuo
