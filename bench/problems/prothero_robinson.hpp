// bench/problems/prothero_robinson.hpp
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>

#include <bench/problems/problem.hpp>

#include <continuo/numerics/state.hpp>

namespace continuo::bench {

/// x' = lambda (x - phi(t)) + phi'(t) with phi(t) = sin(t + pi / 4): the solution is phi for every lambda, methods lose
/// order as lambda h grows. A. Prothero, A. Robinson, "On the stability and accuracy of one-step methods for solving
/// stiff systems of ordinary differential equations", Math. Comp. 28 (1974); E. Hairer, G. Wanner, "Solving Ordinary
/// Differential Equations II", IV.15. The derivative by t is not zero.
template <class Real = double>
struct ProtheroRobinson {
  static constexpr std::string_view name = "prothero_robinson", title = "Prothero-Robinson to t = 10";
  static constexpr std::size_t size = 1;
  static constexpr double duration = 10;
  using State = std::array<Real, size>;

  Real lambda = Real(-1000000);

  static State start() { return exact(Real(0)); }
  static State exact(const Real& t) {
    using std::sin;
    return {Real(sin(Real(t + quarter())))};
  }

  template <class X>
  void operator()(const auto& t, const X& x, X& dxdt) const {
    using std::cos, std::sin;
    const auto phase = t + quarter();
    dxdt[0] = lambda * (x[0] - sin(phase)) + cos(phase);
  }

  template <class X>
  void jacobian(const auto&, const X&, std::span<Scalar<X>> rows) const {
    rows[0] = Scalar<X>(lambda);
  }

  /// df/dt = -lambda phi' + phi''.
  template <class X>
  void time_derivative(const auto& t, const X&, X& dfdt) const {
    using std::cos, std::sin;
    const auto phase = t + quarter();
    dfdt[0] = Scalar<X>(-lambda * cos(phase) - sin(phase));
  }

 private:
  static constexpr Coefficient quarter_of_pi = 0.785398163397448309615660845819875721049292349843776_c;
  static Real quarter() { return in<Real>(quarter_of_pi); }
};

}  // namespace continuo::bench
