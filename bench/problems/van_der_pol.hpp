// bench/problems/van_der_pol.hpp
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <bench/problems/problem.hpp>

#include <continuo/numerics/state.hpp>

namespace continuo::bench {

/// B. van der Pol's oscillator x'' = mu (1 - x^2) x' - x in the form of the test set of F. Mazzia and others: slow
/// drifts of length mu, jumps of length 1 / mu.
template <class Real = double>
struct VanDerPol {
  static constexpr std::string_view name = "van_der_pol", title = "van der Pol, mu = 1000, to t = 2000";
  static constexpr std::size_t size = 2;
  static constexpr double duration = 2000;
  using State = std::array<Real, size>;

  Real mu = Real(1000);

  static State start() { return {Real(2), Real(0)}; }

  template <class X>
  void operator()(const auto&, const X& x, X& dxdt) const {
    dxdt[0] = x[1];
    dxdt[1] = mu * (Real(1) - x[0] * x[0]) * x[1] - x[0];
  }

  template <class X>
  void jacobian(const auto&, const X& x, std::span<Scalar<X>> rows) const {
    write<Scalar<X>>(rows,
                     {Scalar<X>(0), Scalar<X>(1), Real(-2) * mu * x[0] * x[1] - Real(1), mu * (Real(1) - x[0] * x[0])});
  }

  /// For mu = 1000.
  static std::vector<Reference<State>> reference() {
    return {{1000, in<Real>({-1.8636462548081339_c, 0.00075354308654354336_c})},
            {2000, in<Real>({1.7061677321704650_c, -0.00089280970102481655_c})},
            {3000, in<Real>({-1.5106069367441115_c, 0.0011783800007309110_c})},
            {11000, in<Real>({-1.5901505448291268_c, 0.0010402793892123870_c})}};
  }
};

/// The same with time in units of the drift, x'' = stiffness ((1 - x^2) x' - x) where stiffness is mu^2: E. Hairer, G.
/// Wanner, "Solving Ordinary Differential Equations II", IV.10. It starts beside the slow curve.
template <class Real = double>
struct VanDerPolScaled {
  static constexpr std::string_view name = "van_der_pol_scaled", title = "van der Pol, 1 / epsilon = 1e6, to t = 11";
  static constexpr std::size_t size = 2;
  static constexpr double duration = 11;
  using State = std::array<Real, size>;

  Real stiffness = Real(1000000);

  static State start() { return {Real(2), in<Real>(-0.66_c)}; }

  template <class X>
  void operator()(const auto&, const X& x, X& dxdt) const {
    dxdt[0] = x[1];
    dxdt[1] = stiffness * ((Real(1) - x[0] * x[0]) * x[1] - x[0]);
  }

  template <class X>
  void jacobian(const auto&, const X& x, std::span<Scalar<X>> rows) const {
    write<Scalar<X>>(rows, {Scalar<X>(0), Scalar<X>(1), stiffness * (Real(-2) * x[0] * x[1] - Real(1)),
                            stiffness * (Real(1) - x[0] * x[0])});
  }

  /// For stiffness = 1e6.
  static std::vector<Reference<State>> reference() {
    return {{1, in<Real>({-1.8636460061388716_c, 0.75354326839936154_c})},
            {2, in<Real>({1.7061674375431954_c, -0.89281001655109933_c})},
            {3, in<Real>({-1.5106065478785617_c, 1.1783807773276124_c})},
            {4, in<Real>({1.1944137538304973_c, -2.7995983122528389_c})},
            {5, in<Real>({1.8904283540278102_c, -0.73451203537961816_c})},
            {6, in<Real>({-1.7377160228735648_c, 0.86040114510241070_c})},
            {7, in<Real>({1.5516142817617873_c, -1.1023835182524661_c})},
            {8, in<Real>({-1.2786313197457469_c, 2.0138952269643514_c})},
            {9, in<Real>({-1.9165527128939199_c, 0.71695745507258737_c})},
            {10, in<Real>({1.7681635179878056_c, -0.83152789121061062_c})},
            {11, in<Real>({-1.5901502015368239_c, 1.0402799076380335_c})}};
  }
};

}  // namespace continuo::bench
