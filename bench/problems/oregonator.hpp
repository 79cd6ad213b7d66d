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
  static constexpr bool autonomous = true;
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

  /// From bench/reference/stiff.cpp; its two runs agree to 8e-22, relative to each component.
  static std::vector<Reference<State>> reference() {
    return {
        {30,
         in<Real>({1.000661467180496718245532572_c, 1512.778937348250419012314510_c, 10358.54312767227567005836492_c})},
        {60,
         in<Real>({1.000874625199625615582033338_c, 1144.336972384496211789045016_c, 83.72149966624624144376976644_c})},
        {90,
         in<Real>({1.001890368438750612385522955_c, 529.9926232295551225204457562_c, 1.662279579042419093745068811_c})},
        {120,
         in<Real>({1.004118022612645492370706394_c, 243.8326079910345591070563958_c, 1.008822224048646540111558752_c})},
        {150,
         in<Real>({1.008995416634061061778945331_c, 112.1664388662538378388208088_c, 1.007783229065319167287205618_c})},
        {180,
         in<Real>({1.019763472537298117249881844_c, 51.59761322947533692450149743_c, 1.016985778956374167220560862_c})},
        {210,
         in<Real>({1.043985088527474382981117370_c, 23.73442027531522829675801002_c, 1.037691843544521536030687518_c})},
        {240,
         in<Real>({1.100849071667922027659354857_c, 10.91533805469019497785331585_c, 1.085831969810860459122385448_c})},
        {270,
         in<Real>({1.249102130020571682619587212_c, 5.013945178605444627749129452_c, 1.208326626237875292722199363_c})},
        {300,
         in<Real>({1.779724751937019509402070780_c, 2.281852385542401830809942886_c, 1.613754023671725033496467280_c})},
        {330,
         in<Real>({1.000889326903503316674817954_c, 1125.438585746599655881572690_c, 16410.49483777162324606010637_c})},
        {360, in<Real>({1.000814870318522716281641752_c, 1228.178521549887983718017000_c,
                        132.0554942846508287742232719_c})}};
  }
};

}  // namespace continuo::bench
