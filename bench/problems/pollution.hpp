// bench/problems/pollution.hpp
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <bench/problems/problem.hpp>

#include <continuo/numerics/state.hpp>

namespace continuo::bench {

/// Twenty substances in the air, 25 reactions: J. G. Verwer, "Gauss-Seidel iteration for stiff ODEs from chemical
/// kinetics", SIAM J. Sci. Comput. 15 (1994); the test set of F. Mazzia and others. Three sums stay what they are, see
/// `invariants`.
template <class Real = double>
struct Pollution {
  static constexpr std::string_view name = "pollution", title = "Pollution to t = 60";
  static constexpr std::size_t size = 20;
  static constexpr double duration = 60;
  static constexpr bool autonomous = true;
  using State = std::array<Real, size>;

  /// Rates, in the order of the paper.
  std::array<Real, 25> k =
      in<Real>({0.35_c,       26.6_c,  12300, 0.00086_c, 0.00082_c, 15000,   0.00013_c, 24000,    16500,
                9000,         0.022_c, 12000, 1.88_c,    16300,     4800000, 0.00035_c, 0.0175_c, 100000000,
                444000000000, 1240,    2.1_c, 5.78_c,    0.0474_c,  1780,    3.12_c});

  static State start() {
    State x{};
    x[1] = in<Real>(0.2_c), x[3] = in<Real>(0.04_c), x[6] = in<Real>(0.1_c), x[7] = in<Real>(0.3_c);
    x[8] = in<Real>(0.01_c), x[16] = in<Real>(0.007_c);
    return x;
  }

  template <class X>
  void operator()(const auto&, const X& x, X& dxdt) const {
    using S = Scalar<X>;
    const S r1 = k[0] * x[0], r2 = k[1] * x[1] * x[3], r3 = k[2] * x[4] * x[1], r4 = k[3] * x[6], r5 = k[4] * x[6];
    const S r6 = k[5] * x[6] * x[5], r7 = k[6] * x[8], r8 = k[7] * x[8] * x[5], r9 = k[8] * x[10] * x[1];
    const S r10 = k[9] * x[10] * x[0], r11 = k[10] * x[12], r12 = k[11] * x[9] * x[1], r13 = k[12] * x[13];
    const S r14 = k[13] * x[0] * x[5], r15 = k[14] * x[2], r16 = k[15] * x[3], r17 = k[16] * x[3], r18 = k[17] * x[15];
    const S r19 = k[18] * x[15], r20 = k[19] * x[16] * x[5], r21 = k[20] * x[18], r22 = k[21] * x[18];
    const S r23 = k[22] * x[0] * x[3], r24 = k[23] * x[18] * x[0], r25 = k[24] * x[19];
    dxdt[0] = -r1 - r10 - r14 - r23 - r24 + r2 + r3 + r9 + r11 + r12 + r22 + r25;
    dxdt[1] = -r2 - r3 - r9 - r12 + r1 + r21;
    dxdt[2] = -r15 + r1 + r17 + r19 + r22;
    dxdt[3] = -r2 - r16 - r17 - r23 + r15;
    dxdt[4] = -r3 + r4 + r4 + r6 + r7 + r13 + r20;
    dxdt[5] = -r6 - r8 - r14 - r20 + r3 + r18 + r18;
    dxdt[6] = -r4 - r5 - r6 + r13;
    dxdt[7] = r4 + r5 + r6 + r7;
    dxdt[8] = -r7 - r8;
    dxdt[9] = -r12 + r7 + r9;
    dxdt[10] = -r9 - r10 + r8 + r11;
    dxdt[11] = r9;
    dxdt[12] = -r11 + r10;
    dxdt[13] = -r13 + r12;
    dxdt[14] = r14;
    dxdt[15] = -r18 - r19 + r16;
    dxdt[16] = -r20;
    dxdt[17] = r20;
    dxdt[18] = -r21 - r22 - r24 + r23 + r25;
    dxdt[19] = -r25 + r24;
  }

  template <class X>
  void jacobian(const auto&, const X& x, std::span<Scalar<X>> rows) const {
    using S = Scalar<X>;
    for (S& entry : rows) entry = S(0);
    const auto at = [&](std::size_t row, std::size_t column) -> S& { return rows[row * size + column]; };
    // ri_j: the derivative of rate i by x[j].
    const S r1_0(k[0]), r4_6(k[3]), r5_6(k[4]), r7_8(k[6]), r11_12(k[10]), r13_13(k[12]), r15_2(k[14]), r16_3(k[15]);
    const S r17_3(k[16]), r18_15(k[17]), r19_15(k[18]), r21_18(k[20]), r22_18(k[21]), r25_19(k[24]);
    const S r2_1 = k[1] * x[3], r2_3 = k[1] * x[1], r3_1 = k[2] * x[4], r3_4 = k[2] * x[1];
    const S r6_5 = k[5] * x[6], r6_6 = k[5] * x[5], r8_5 = k[7] * x[8], r8_8 = k[7] * x[5];
    const S r9_1 = k[8] * x[10], r9_10 = k[8] * x[1], r10_0 = k[9] * x[10], r10_10 = k[9] * x[0];
    const S r12_1 = k[11] * x[9], r12_9 = k[11] * x[1], r14_0 = k[13] * x[5], r14_5 = k[13] * x[0];
    const S r20_5 = k[19] * x[16], r20_16 = k[19] * x[5], r23_0 = k[22] * x[3], r23_3 = k[22] * x[0];
    const S r24_0 = k[23] * x[18], r24_18 = k[23] * x[0];
    at(0, 0) = -r1_0 - r10_0 - r14_0 - r23_0 - r24_0, at(0, 1) = r2_1 + r3_1 + r9_1 + r12_1, at(0, 3) = r2_3 - r23_3;
    at(0, 4) = r3_4, at(0, 5) = -r14_5, at(0, 9) = r12_9, at(0, 10) = r9_10 - r10_10, at(0, 12) = r11_12;
    at(0, 18) = r22_18 - r24_18, at(0, 19) = r25_19;
    at(1, 0) = r1_0, at(1, 1) = -r2_1 - r3_1 - r9_1 - r12_1, at(1, 3) = -r2_3, at(1, 4) = -r3_4, at(1, 9) = -r12_9;
    at(1, 10) = -r9_10, at(1, 18) = r21_18;
    at(2, 0) = r1_0, at(2, 2) = -r15_2, at(2, 3) = r17_3, at(2, 15) = r19_15, at(2, 18) = r22_18;
    at(3, 0) = -r23_0, at(3, 1) = -r2_1, at(3, 2) = r15_2, at(3, 3) = -r2_3 - r16_3 - r17_3 - r23_3;
    at(4, 1) = -r3_1, at(4, 4) = -r3_4, at(4, 5) = r6_5 + r20_5, at(4, 6) = r4_6 + r4_6 + r6_6, at(4, 8) = r7_8;
    at(4, 13) = r13_13, at(4, 16) = r20_16;
    at(5, 0) = -r14_0, at(5, 1) = r3_1, at(5, 4) = r3_4, at(5, 5) = -r6_5 - r8_5 - r14_5 - r20_5, at(5, 6) = -r6_6;
    at(5, 8) = -r8_8, at(5, 15) = r18_15 + r18_15, at(5, 16) = -r20_16;
    at(6, 5) = -r6_5, at(6, 6) = -r4_6 - r5_6 - r6_6, at(6, 13) = r13_13;
    at(7, 5) = r6_5, at(7, 6) = r4_6 + r5_6 + r6_6, at(7, 8) = r7_8;
    at(8, 5) = -r8_5, at(8, 8) = -r7_8 - r8_8;
    at(9, 1) = r9_1 - r12_1, at(9, 8) = r7_8, at(9, 9) = -r12_9, at(9, 10) = r9_10;
    at(10, 0) = -r10_0, at(10, 1) = -r9_1, at(10, 5) = r8_5, at(10, 8) = r8_8, at(10, 10) = -r9_10 - r10_10;
    at(10, 12) = r11_12;
    at(11, 1) = r9_1, at(11, 10) = r9_10;
    at(12, 0) = r10_0, at(12, 10) = r10_10, at(12, 12) = -r11_12;
    at(13, 1) = r12_1, at(13, 9) = r12_9, at(13, 13) = -r13_13;
    at(14, 0) = r14_0, at(14, 5) = r14_5;
    at(15, 3) = r16_3, at(15, 15) = -r18_15 - r19_15;
    at(16, 5) = -r20_5, at(16, 16) = -r20_16;
    at(17, 5) = r20_5, at(17, 16) = r20_16;
    at(18, 0) = r23_0 - r24_0, at(18, 3) = r23_3, at(18, 18) = -r21_18 - r22_18 - r24_18, at(18, 19) = r25_19;
    at(19, 0) = r24_0, at(19, 18) = r24_18, at(19, 19) = -r25_19;
  }

  /// Each row, times the state, is constant: the left null space of the 20 by 25 matrix of what the reactions turn into
  /// what.
  static constexpr std::array<std::array<int, size>, 3> invariants{
      {{0, 0, 0, 0, 0, 0, 1, 1, 2, 1, 2, 1, 2, 1, 0, 0, 0, 0, 0, 0},
       {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0},
       {1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 2}}};

  /// From bench/reference/stiff.cpp; its two runs agree to 3e-31, relative to each component.
  static std::vector<Reference<State>> reference() {
    return {{60, in<Real>({0.05646255480022769277981672966_c,        0.1342484130422338521851184887_c,
                           0.000000004139734331099426970094594162_c, 0.005523140207484359937251944944_c,
                           0.0000002018977262302196040124326587_c,   0.0000001464541863493965792558679678_c,
                           0.07784249118997964146099156011_c,        0.3245075353396018218304241251_c,
                           0.007494013383880405552572576710_c,       0.00000001622293157301560349363931390_c,
                           0.00000001135863833257074821718227580_c,  0.002230505975721359860990973746_c,
                           0.0002087162882798630040961110790_c,      0.00001396921016840157715603746938_c,
                           0.008964884856898294177578245191_c,       0.000000000000000004352846369330103674237222581_c,
                           0.006899219696263405404685500430_c,       0.0001007803037365945953144995696_c,
                           0.000001772146513969984537138419644_c,    0.00005682943292316393442664347687_c})}};
  }
};

}  // namespace continuo::bench
