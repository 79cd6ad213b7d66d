// The coefficients of the normal forms of degenerate folds. Internal to bifurcation_curve. Yu. A. Kuznetsov,
// "Numerical normalization techniques for all codim 2 bifurcations of equilibria in ODE's", SIAM J. Numer. Anal. 36
// (1999) 1104-1124.
#pragma once
#include <span>
#include <vector>

#include <continuo/studies/bifurcation_curve.hpp>

namespace continuo::studies::detail {

/// c of y' = b1 + b2 y + c y^3: c = p . (C(q, q, q) + 3 B(q, h)) / 6 with A q = 0, |q| = 1, p A = 0, p . q = 1, A h =
/// -B(q, q). Empty where algebraic equations are part of the system, or it is not determined.
[[nodiscard]] std::vector<NormalFormNumber> cusp_numbers(const ParametricSystem& system, const std::vector<double>& x,
                                                         std::span<const double> p, double t);

/// a and b of y0' = y1, y1' = b1 + b2 y0 + a y0^2 + b y0 y1: a = p1 . B(q0, q0) / 2, b = p0 . B(q0, q0) + p1 . B(q0,
/// q1) with A q0 = 0, A q1 = q0, p1 A = 0, p0 A = p1, |q0| = 1, q0 . q1 = 0, p0 . q0 = p1 . q1 = 1, p0 . q1 = 0. Where
/// a b < 0 the orbit that is born at the Hopf points attracts. Empty as above.
[[nodiscard]] std::vector<NormalFormNumber> double_zero_numbers(const ParametricSystem& system,
                                                                const std::vector<double>& x, std::span<const double> p,
                                                                double t);

}  // namespace continuo::studies::detail
