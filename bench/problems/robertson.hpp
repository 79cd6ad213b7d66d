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
  static constexpr double third_above_0_01 = 0.26401907818763256315, first_below_0_0001 = 20795496.88302662326;

  static std::vector<Reference<State>> reference() {
    return {
        {0.4, in<Real>({0.985172113860989862_c, 0.0000338639537897490414_c, 0.0147940221852203885_c})},
        {4, in<Real>({0.905518678584253912_c, 0.0000224047568756020091_c, 0.0944589166588704861_c})},
        {40, in<Real>({0.715827068719405090_c, 0.00000918553476455776390_c, 0.284163745745830352_c})},
        {400, in<Real>({0.450518668471102424_c, 0.00000322290144167461131_c, 0.549478108627455901_c})},
        {4000, in<Real>({0.183202257776709311_c, 0.000000894237125277590926_c, 0.816796847986165411_c})},
        {40000, in<Real>({0.0389833770854828525_c, 0.000000162176831590968242_c, 0.961016460737685557_c})},
        {400000, in<Real>({0.00493827452097981556_c, 0.0000000198499408795437544_c, 0.995061705629079305_c})},
        {4000000, in<Real>({0.000516809601492438416_c, 0.00000000206829449122445355_c, 0.999483188330213070_c})},
        {40000000, in<Real>({0.0000520307184412054736_c, 0.000000000208133573189253272_c, 0.999947969073425221_c})},
        {400000000, in<Real>({0.00000520770210357317252_c, 0.0000000000208309155941536498_c, 0.999994792277065511_c})},
        {4000000000,
         in<Real>({0.000000520827661143593506_c, 0.00000000000208331171660457196_c, 0.999999479170255545_c})},
        {4e10, in<Real>({0.0000000520834517679923920_c, 0.000000000000208333817792548904_c, 0.999999947916339898_c})},
        {1e11, in<Real>({0.0000000208334014970129423_c, 0.0000000000000833336077033478340_c, 0.999999979166515169_c})}};
  }
};

}  // namespace continuo::bench
