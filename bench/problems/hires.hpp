// bench/problems/hires.hpp
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <bench/problems/problem.hpp>

#include <continuo/numerics/state.hpp>

namespace continuo::bench {

/// How a plant responds to red light, eight reactions: E. Schaefer, "A new approach to explain the high irradiance
/// responses of photomorphogenesis on the basis of phytochrome", J. Math. Biology 2 (1975); E. Hairer, G. Wanner,
/// "Solving Ordinary Differential Equations II", IV.10. x[6] + x[7] stays 0.0057.
template <class Real = double>
struct Hires {
  static constexpr std::string_view name = "hires", title = "HIRES to t = 321.8122";
  static constexpr std::size_t size = 8;
  static constexpr double duration = 321.8122;
  static constexpr bool autonomous = true;
  using State = std::array<Real, size>;

  // Rates of the reactions, and of all that leave one substance.
  Real k1 = in<Real>(1.71_c), k2 = in<Real>(0.43_c), k3 = in<Real>(8.32_c), k4 = in<Real>(0.69_c),
       k5 = in<Real>(0.035_c), bind = Real(280), source = in<Real>(0.0007_c);
  Real from1 = in<Real>(8.75_c), from2 = in<Real>(10.03_c), from3 = in<Real>(1.12_c), from4 = in<Real>(1.745_c),
       from6 = in<Real>(1.81_c);

  static State start() {
    State x{};
    x[0] = Real(1);
    x[7] = in<Real>(0.0057_c);
    return x;
  }

  template <class X>
  void operator()(const auto&, const X& x, X& dxdt) const {
    const Scalar<X> bound = bind * x[5] * x[7];
    dxdt[0] = -k1 * x[0] + k2 * x[1] + k3 * x[2] + source;
    dxdt[1] = k1 * x[0] - from1 * x[1];
    dxdt[2] = -from2 * x[2] + k2 * x[3] + k5 * x[4];
    dxdt[3] = k3 * x[1] + k1 * x[2] - from3 * x[3];
    dxdt[4] = -from4 * x[4] + k2 * (x[5] + x[6]);
    dxdt[5] = -bound + k4 * x[3] + k1 * x[4] - k2 * x[5] + k4 * x[6];
    dxdt[6] = bound - from6 * x[6];
    dxdt[7] = -dxdt[6];
  }

  template <class X>
  void jacobian(const auto&, const X& x, std::span<Scalar<X>> rows) const {
    for (Scalar<X>& entry : rows) entry = Scalar<X>(0);
    const auto at = [&](std::size_t row, std::size_t column) -> Scalar<X>& { return rows[row * size + column]; };
    const Scalar<X> by5 = bind * x[7], by7 = bind * x[5];
    at(0, 0) = Scalar<X>(-k1), at(0, 1) = Scalar<X>(k2), at(0, 2) = Scalar<X>(k3);
    at(1, 0) = Scalar<X>(k1), at(1, 1) = Scalar<X>(-from1);
    at(2, 2) = Scalar<X>(-from2), at(2, 3) = Scalar<X>(k2), at(2, 4) = Scalar<X>(k5);
    at(3, 1) = Scalar<X>(k3), at(3, 2) = Scalar<X>(k1), at(3, 3) = Scalar<X>(-from3);
    at(4, 4) = Scalar<X>(-from4), at(4, 5) = Scalar<X>(k2), at(4, 6) = Scalar<X>(k2);
    at(5, 3) = Scalar<X>(k4), at(5, 4) = Scalar<X>(k1), at(5, 5) = -by5 - k2, at(5, 6) = Scalar<X>(k4), at(5, 7) = -by7;
    at(6, 5) = by5, at(6, 6) = Scalar<X>(-from6), at(6, 7) = by7;
    at(7, 5) = -by5, at(7, 6) = Scalar<X>(from6), at(7, 7) = -by7;
  }

  /// From bench/reference/stiff.cpp; its two runs agree to 2e-25, relative to each component.
  static std::vector<Reference<State>> reference() {
    return {{321.8122, in<Real>({0.0007371312573325666233282459898_c, 0.0001442485726316184347910486307_c,
                                 0.00005888729740967572077358109580_c, 0.001175651343283148852241967388_c,
                                 0.002386356198831325743542230250_c, 0.006238968252742780959432673648_c,
                                 0.002849998395185765338373852265_c, 0.002850001604814234661626147735_c})},
            {421.8122, in<Real>({0.0006703055035818635050571096045_c, 0.0001309968469863468929754933584_c,
                                 0.00004686223159773258144451986552_c, 0.001044668020551704803640358894_c,
                                 0.0005948838309514850515812041477_c, 0.001399628833942774029258911596_c,
                                 0.001014492757718479680590882532_c, 0.004685507242281520319409117468_c})}};
  }
};

}  // namespace continuo::bench
