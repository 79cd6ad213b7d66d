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
  static constexpr bool autonomous = true;
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

  /// For mu = 1000, from bench/reference/stiff.cpp; its two runs agree to 2e-22, relative to each component.
  static std::vector<Reference<State>> reference() {
    return {{1000, in<Real>({-1.863646254808133889544119363_c, 0.0007535430865435433600996399081_c})},
            {2000, in<Real>({1.706167732170465008478187592_c, -0.0008928097010248165477786030646_c})},
            {3000, in<Real>({-1.510606936744111490217688813_c, 0.001178380000730911023889222849_c})},
            {11000, in<Real>({-1.590150544829126768390642983_c, 0.001040279389212387030673939478_c})}};
  }
};

/// The same with time in units of the drift, x'' = stiffness ((1 - x^2) x' - x) where stiffness is mu^2: E. Hairer, G.
/// Wanner, "Solving Ordinary Differential Equations II", IV.10. It starts beside the slow curve.
template <class Real = double>
struct VanDerPolScaled {
  static constexpr std::string_view name = "van_der_pol_scaled", title = "van der Pol, 1 / epsilon = 1e6, to t = 11";
  static constexpr std::size_t size = 2;
  static constexpr double duration = 11;
  static constexpr bool autonomous = true;
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

  /// For stiffness = 1e6, from bench/reference/stiff.cpp; its two runs agree to 2e-22, relative to each component.
  static std::vector<Reference<State>> reference() {
    return {{1, in<Real>({-1.863646006138871647154173283_c, 0.7535432683993615368026174512_c})},
            {2, in<Real>({1.706167437543195403956123115_c, -0.8928100165510993266953866791_c})},
            {3, in<Real>({-1.510606547878561722993634480_c, 1.178380777327612387711800318_c})},
            {4, in<Real>({1.194413753830497278166519738_c, -2.799598312252838982332427568_c})},
            {5, in<Real>({1.890428354027810238685860773_c, -0.7345120353796181631603733088_c})},
            {6, in<Real>({-1.737716022873564841347401464_c, 0.8604011451024106963867757733_c})},
            {7, in<Real>({1.551614281761787302661483372_c, -1.102383518252466072229824784_c})},
            {8, in<Real>({-1.278631319745746942797856729_c, 2.013895226964351415743162158_c})},
            {9, in<Real>({-1.916552712893919906849974760_c, 0.7169574550725873679158753318_c})},
            {10, in<Real>({1.768163517987805584159480438_c, -0.8315278912106106197643030312_c})},
            {11, in<Real>({-1.590150201536823907010561808_c, 1.040279907638033547673775807_c})}};
  }
};

}  // namespace continuo::bench
