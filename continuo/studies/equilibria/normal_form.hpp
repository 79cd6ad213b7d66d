// Stability and direction of bifurcations from the terms of higher order, where the linear part does not determine
// them: the coefficients of the normal forms of folds and Hopf points. Yu. A. Kuznetsov, "Elements of Applied
// Bifurcation Theory", 2nd edition, 5.4.
#pragma once
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include <continuo/system/parametric_system.hpp>

namespace continuo::studies {

/// Derivatives of f along directions at one place, by differences of df/dx.
class DirectionalDerivatives {
 public:
  DirectionalDerivatives(const ParametricSystem& system, std::vector<double> x, std::vector<double> p, double t);

  /// B(u, v) = d/ds d/dr f(x + s u + r v).
  [[nodiscard]] std::vector<double> second(const std::vector<double>& u, const std::vector<double>& v) const;
  /// C(u, v, v).
  [[nodiscard]] std::vector<double> third(const std::vector<double>& u, const std::vector<double>& v) const;

 private:
  /// df/dx u at x + s v.
  [[nodiscard]] std::vector<double> along(const std::vector<double>& u, const std::vector<double>& v, double s) const;

  const ParametricSystem& system_;
  std::vector<double> x_, p_;
  double t_;
};

/// The first Lyapunov coefficient where df/dx has the eigenvalues +- i omega: l = Re(p . C(q, q, q*) - 2 p . B(q,
/// A^-1 B(q, q*)) + p . B(q*, (2 i omega - A)^-1 B(q, q))) / (2 omega), with A q = i omega q, |q| = 1, p . q = 1. Below
/// 0 the orbit that is born attracts (supercritical), above 0 it repels (subcritical); its sign alone does not depend
/// on the units. Nothing where algebraic equations are part of the system, or A is singular.
struct LyapunovCoefficient {
  double value = 0;
  double rounding = 0;  // what rounding and differences may leave of a zero, as where something is conserved
};
[[nodiscard]] std::optional<LyapunovCoefficient> first_lyapunov_coefficient(const ParametricSystem& system,
                                                                            const std::vector<double>& x,
                                                                            std::span<const double> p,
                                                                            double angular_frequency, double t = 0);

/// a = p . B(q, q) / 2 with A q = 0, |q| = 1, p . q = 1, p A = 0: on the line of q the motion is y' = b (constant) +
/// a y^2, up to the sign of y. Where it is 0 two folds meet, a cusp. Nothing as above.
[[nodiscard]] std::optional<double> fold_coefficient(const ParametricSystem& system, const std::vector<double>& x,
                                                     std::span<const double> p, double t = 0);

}  // namespace continuo::studies
