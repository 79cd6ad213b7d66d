// bench/problems/robertson.hpp
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <bench/problems/problem.hpp>

#include <continuo/numerics/state.hpp>

namespace continuo::bench {

/// Three reactions whose rates lie nine powers of ten apart, followed over thirteen decades of time: H. H. Robertson,
/// "The solution of a set of reaction rate equations" (1966); E. Hairer, G. Wanner, "Solving Ordinary Differential
/// Equations II", IV.1. The amounts add up to 1 at all times; the second one never exceeds 4e-5.
template <class Real = double>
struct Robertson {
  static constexpr std::string_view name = "robertson", title = "Robertson to t = 1e11";
  static constexpr std::size_t size = 3;
  static constexpr double duration = 1e11;
  static constexpr bool autonomous = true;
  using State = std::array<Real, size>;

  Real slow = in<Real>(0.04_c), fast = Real(3e7), back = Real(1e4);

  static State start() { return {Real(1), Real(0), Real(0)}; }

  template <class X>
  void operator()(const auto&, const X& x, X& dxdt) const {
    const Scalar<X> first = slow * x[0] - back * x[1] * x[2], second = fast * x[1] * x[1];
    dxdt[0] = -first;
    dxdt[1] = first - second;
    dxdt[2] = second;
  }

  template <class X>
  void jacobian(const auto&, const X& x, std::span<Scalar<X>> rows) const {
    const Scalar<X> a(slow), b = back * x[2], c = back * x[1], d = Real(2) * fast * x[1], zero(0);
    write<Scalar<X>>(rows, {-a, b, c,       //
                            a, -b - d, -c,  //
                            zero, d, zero});
  }

  /// When x[2] rises through 0.01 and when x[0] falls through 1e-4: the two events of the example cvRoberts_dns of
  /// SUNDIALS.
  static constexpr double third_above_0_01 = 0.26401907818763256315, first_below_0_0001 = 20795496.883026623256;

  /// From bench/reference/stiff.cpp; its two runs agree to 4e-30, relative to each component.
  static std::vector<Reference<State>> reference() {
    return {{0.4, in<Real>({0.9851721138609898616512851322_c, 0.00003386395378974904123177665201_c,
                            0.01479402218522038930748309120_c})},
            {4, in<Real>({0.9055186785842539118756964229_c, 0.00002240475687560200911007898153_c,
                          0.09445891665887048611519349814_c})},
            {40, in<Real>({0.7158270687194050904744737512_c, 0.000009185534764557763903899212578_c,
                           0.2841637457458303517616223496_c})},
            {400, in<Real>({0.4505186684711024244776426865_c, 0.000003222901441674611303301423559_c,
                            0.5494781086274559009110540120_c})},
            {4000, in<Real>({0.1832022577767093113036895148_c, 0.0000008942371252775909259934054013_c,
                             0.8167968479861654111053844918_c})},
            {40000, in<Real>({0.03898337708548285247997107551_c, 0.0000001621768315909682423887353622_c,
                              0.9610164607376855565517865358_c})},
            {400000, in<Real>({0.004938274520979815560239722266_c, 0.00000001984994087954375437013891753_c,
                               0.9950617056290793048960059076_c})},
            {4000000, in<Real>({0.0005168096014924384155164017706_c, 0.000000002068294491224453554313499196_c,
                                0.9994831883302130703600300439_c})},
            {40000000, in<Real>({0.00005203071844120547360895932410_c, 0.0000000002081335731892532715965909057_c,
                                 0.9999479690734252213371377691_c})},
            {400000000, in<Real>({0.000005207702103573172517975183492_c, 0.00000000002083091559415364983058460866_c,
                                  0.9999947922770655112333283750_c})},
            {4000000000, in<Real>({0.0000005208276611435935056893512091_c, 0.000000000002083311716604571959142164791_c,
                                   0.9999994791702555446898897387_c})},
            {4e10, in<Real>({0.00000005208345176799239198771381235_c, 0.0000000000002083338177925489034960963090_c,
                             0.9999999479163398981898154634_c})},
            {1e11, in<Real>({0.00000002083340149701294230572549280_c, 0.00000000000008333360770334783400647660286_c,
                             0.9999999791665151693793543464_c})}};
  }
};

}  // namespace continuo::bench
