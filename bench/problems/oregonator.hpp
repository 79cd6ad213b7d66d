// bench/problems/oregonator.hpp
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <bench/problems/problem.hpp>

#include <continuo/numerics/state.hpp>

namespace continuo::bench {

/// The Belousov-Zhabotinskii reaction in three equations, with jumps over five powers of ten: R. J. Field, R. M. Noyes,
/// "Oscillations in chemical systems IV", J. Chem. Phys. 60 (1974); E. Hairer, G. Wanner, "Solving Ordinary
/// Differential Equations II", IV.10.
template <class Real = double>
struct Oregonator {
  static constexpr std::string_view name = "oregonator", title = "Oregonator to t = 360";
  static constexpr std::size_t size = 3;
  static constexpr double duration = 360;
  using State = std::array<Real, size>;

  Real s = in<Real>(77.27_c), w = in<Real>(0.161_c), q = in<Real>(0.000008375_c), inverse_s = in<Real>(100_c / 7727_c);

  static State start() { return {Real(1), Real(2), Real(3)}; }

  template <class X>
  void operator()(const auto&, const X& x, X& dxdt) const {
    dxdt[0] = s * (x[1] + x[0] * (Real(1) - q * x[0] - x[1]));
    dxdt[1] = (x[2] - (Real(1) + x[0]) * x[1]) * inverse_s;
    dxdt[2] = w * (x[0] - x[2]);
  }

  template <class X>
  void jacobian(const auto&, const X& x, std::span<Scalar<X>> rows) const {
    write<Scalar<X>>(rows, {s * (Real(1) - Real(2) * q * x[0] - x[1]), s * (Real(1) - x[0]), Scalar<X>(0),  //
                            -x[1] * inverse_s, -(Real(1) + x[0]) * inverse_s, Scalar<X>(inverse_s),         //
                            Scalar<X>(w), Scalar<X>(0), Scalar<X>(-w)});
  }

  static std::vector<Reference<State>> reference() {
    return {{30, in<Real>({1.0006614671804967_c, 1512.7789373482504_c, 10358.543127672276_c})},
            {60, in<Real>({1.0008746251996256_c, 1144.3369723844962_c, 83.721499666246242_c})},
            {90, in<Real>({1.0018903684387506_c, 529.99262322955512_c, 1.6622795790424191_c})},
            {120, in<Real>({1.0041180226126455_c, 243.83260799103456_c, 1.0088222240486465_c})},
            {150, in<Real>({1.0089954166340611_c, 112.16643886625384_c, 1.0077832290653192_c})},
            {180, in<Real>({1.0197634725372981_c, 51.597613229475337_c, 1.0169857789563742_c})},
            {210, in<Real>({1.0439850885274744_c, 23.734420275315228_c, 1.0376918435445215_c})},
            {240, in<Real>({1.1008490716679220_c, 10.915338054690195_c, 1.0858319698108605_c})},
            {270, in<Real>({1.2491021300205717_c, 5.0139451786054446_c, 1.2083266262378753_c})},
            {300, in<Real>({1.7797247519370195_c, 2.2818523855424018_c, 1.6137540236717250_c})},
            {330, in<Real>({1.0008893269035033_c, 1125.4385857465997_c, 16410.494837771623_c})},
            {360, in<Real>({1.0008148703185227_c, 1228.1785215498880_c, 132.05549428465083_c})}};
  }
};

}  // namespace continuo::bench
