// continuo/numerics/lanes.hpp
// W numbers that go through the same arithmetic together, one per SIMD lane:
//
//   using std::sin;
//   Lanes<double, 4> x{1.0};                       // all lanes 1
//   x.set(2, 3.0);                                 // lane 2 becomes 3
//   auto y = 2 * sin(x) + 1;                       // all four at once
//   auto z = select(y > 2, Lanes<double, 4>(2), y);  // per lane: there is no `if` on lanes
//   double last = z[3];
//
// A function templated over its scalar runs W systems at once with it. Where the machine has registers of W numbers one
// is used, otherwise several smaller ones, otherwise (long double, odd W) plain numbers. Sums, products, quotients and
// square roots are rounded as for one number, so each lane gives the bits that one number would; the elementary
// functions are xsimd's, within a few units in the last place of those of <cmath>.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <type_traits>

#include <xsimd/xsimd.hpp>

#include <continuo/numerics/lane_mask.hpp>

namespace continuo {

/// W numbers of type Real; an operation applies to all of them.
template <std::floating_point Real, std::size_t W>
class Lanes {
 public:
  using Scalar = Real;
  using Mask = LaneMask<Real, W>;
  static constexpr std::size_t width = W;

  /// Zero in every lane.
  Lanes() : Lanes(Real(0)) {}
  /// The same number in every lane.
  Lanes(Real value) {
    for (Part& part : part_) part = Part(value);
  }
  /// One number for each lane.
  explicit Lanes(const std::array<Real, W>& values) : part_(std::bit_cast<Parts>(values)) {}

  /// The number of one lane, from 0 to W - 1.
  Real operator[](std::size_t lane) const { return values()[lane]; }
  /// Replaces the number of one lane.
  void set(std::size_t lane, Real value) {
    std::array<Real, W> all = values();
    all[lane] = value;
    part_ = std::bit_cast<Parts>(all);
  }
  /// The numbers of all lanes.
  [[nodiscard]] std::array<Real, W> values() const { return std::bit_cast<std::array<Real, W>>(part_); }

  /// Arithmetic, lane by lane, rounded as for single numbers.
  /// @{
  friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return map([](const Part& x, const Part& y) { return Part(x + y); }, a, b);
  }
  friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return map([](const Part& x, const Part& y) { return Part(x - y); }, a, b);
  }
  friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return map([](const Part& x, const Part& y) { return Part(x * y); }, a, b);
  }
  friend Lanes operator/(const Lanes& a, const Lanes& b) {
    return map([](const Part& x, const Part& y) { return Part(x / y); }, a, b);
  }
  friend Lanes operator-(const Lanes& a) {
    return map([](const Part& x) { return Part(-x); }, a);
  }
  friend Lanes operator+(const Lanes& a) { return a; }
  Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
  Lanes& operator-=(const Lanes& b) { return *this = *this - b; }
  Lanes& operator*=(const Lanes& b) { return *this = *this * b; }
  Lanes& operator/=(const Lanes& b) { return *this = *this / b; }
  /// @}

  /// Comparisons, lane by lane.
  /// @{
  friend Mask operator<(const Lanes& a, const Lanes& b) {
    return test([](const Part& x, const Part& y) { return x < y; }, a, b);
  }
  friend Mask operator<=(const Lanes& a, const Lanes& b) {
    return test([](const Part& x, const Part& y) { return x <= y; }, a, b);
  }
  friend Mask operator>(const Lanes& a, const Lanes& b) { return b < a; }
  friend Mask operator>=(const Lanes& a, const Lanes& b) { return b <= a; }
  friend Mask operator==(const Lanes& a, const Lanes& b) {
    return test([](const Part& x, const Part& y) { return x == y; }, a, b);
  }
  friend Mask operator!=(const Lanes& a, const Lanes& b) { return !(a == b); }
  /// @}

  /// Lane by lane: yes where the mask is set, otherwise no.
  friend Lanes select(const Mask& mask, const Lanes& yes, const Lanes& no) {
    Lanes result;
    for (std::size_t i = 0; i < parts; ++i) result.part_[i] = Choice::select(mask.part(i), yes.part_[i], no.part_[i]);
    return result;
  }

  // max and min choose as std::max and std::min do: the first one where neither is greater, or one is not a number.
  /// The greater, or the lesser, lane by lane.
  /// @{
  friend Lanes max(const Lanes& a, const Lanes& b) { return select(a < b, b, a); }
  friend Lanes min(const Lanes& a, const Lanes& b) { return select(b < a, b, a); }
  /// @}
  /// The lanes that are not a number.
  friend Mask isnan(const Lanes& a) { return a != a; }
  /// The lanes that are neither infinite nor not a number.
  friend Mask isfinite(const Lanes& a) { return a - a == Lanes(); }

  // clang-format off
  /// Elementary functions, lane by lane, within a few units in the last place of those of <cmath>.
  /// @{
  friend Lanes abs(const Lanes& a) { return map([](const Part& x) { using std::abs; return Part(abs(x)); }, a); }
  friend Lanes sqrt(const Lanes& a) { return map([](const Part& x) { using std::sqrt; return Part(sqrt(x)); }, a); }
  friend Lanes floor(const Lanes& a) { return map([](const Part& x) { using std::floor; return Part(floor(x)); }, a); }
  friend Lanes ceil(const Lanes& a) { return map([](const Part& x) { using std::ceil; return Part(ceil(x)); }, a); }
  friend Lanes sin(const Lanes& a) { return map([](const Part& x) { using std::sin; return Part(sin(x)); }, a); }
  friend Lanes cos(const Lanes& a) { return map([](const Part& x) { using std::cos; return Part(cos(x)); }, a); }
  friend Lanes tan(const Lanes& a) { return map([](const Part& x) { using std::tan; return Part(tan(x)); }, a); }
  friend Lanes asin(const Lanes& a) { return map([](const Part& x) { using std::asin; return Part(asin(x)); }, a); }
  friend Lanes acos(const Lanes& a) { return map([](const Part& x) { using std::acos; return Part(acos(x)); }, a); }
  friend Lanes atan(const Lanes& a) { return map([](const Part& x) { using std::atan; return Part(atan(x)); }, a); }
  friend Lanes tanh(const Lanes& a) { return map([](const Part& x) { using std::tanh; return Part(tanh(x)); }, a); }
  friend Lanes log(const Lanes& a) { return map([](const Part& x) { using std::log; return Part(log(x)); }, a); }
  friend Lanes log10(const Lanes& a) { return map([](const Part& x) { using std::log10; return Part(log10(x)); }, a); }
  friend Lanes cbrt(const Lanes& a) { return map([](const Part& x) { using std::cbrt; return Part(cbrt(x)); }, a); }
  friend Lanes fabs(const Lanes& a) { return abs(a); }
  // xsimd's overflow and underflow a little early: numbers near the ends of the range go one by one.
  friend Lanes exp(const Lanes& a) { return near(a, exponent_limit) ? map([](const Part& x) { using std::exp; return Part(exp(x)); }, a) : each([](Real x) { return std::exp(x); }, a); }
  friend Lanes sinh(const Lanes& a) { return near(a, exponent_limit) ? map([](const Part& x) { using std::sinh; return Part(sinh(x)); }, a) : each([](Real x) { return std::sinh(x); }, a); }
  friend Lanes cosh(const Lanes& a) { return near(a, exponent_limit) ? map([](const Part& x) { using std::cosh; return Part(cosh(x)); }, a) : each([](Real x) { return std::cosh(x); }, a); }
  // xsimd's lose digits (pow: hundreds of units) or special cases (0^0, atan2(0, 0), large hypot): one by one.
  friend Lanes pow(const Lanes& a, const Lanes& b) { return each([](Real x, Real y) { return std::pow(x, y); }, a, b); }
  friend Lanes atan2(const Lanes& a, const Lanes& b) { return each([](Real x, Real y) { return std::atan2(x, y); }, a, b); }
  friend Lanes hypot(const Lanes& a, const Lanes& b) { return each([](Real x, Real y) { return std::hypot(x, y); }, a, b); }
  /// @}
  // clang-format on

 private:
  using Choice = detail::LaneParts<Real, W>;
  using Part = typename Choice::Part;
  static constexpr std::size_t parts = Choice::count;
  using Parts = std::array<Part, parts>;
  Parts part_;

  /// exp is comfortably finite and normal up to here.
  static constexpr Real exponent_limit = Real(0.95) * std::numeric_limits<Real>::max_exponent * Real(0.693);
  [[nodiscard]] static bool near(const Lanes& a, Real limit) { return all(abs(a) < Lanes(limit)); }

  template <class F, class... A>
  [[nodiscard]] static Lanes each(F f, const A&... a) {
    std::array<Real, W> result;
    for (std::size_t i = 0; i < W; ++i) result[i] = f(a[i]...);
    return Lanes(result);
  }
  template <class F, class... A>
  [[nodiscard]] static Lanes map(F f, const A&... a) {
    Lanes result;
    for (std::size_t i = 0; i < parts; ++i) result.part_[i] = f(a.part_[i]...);
    return result;
  }
  template <class F, class... A>
  [[nodiscard]] static Mask test(F f, const A&... a) {
    Mask result;
    for (std::size_t i = 0; i < parts; ++i) result.part(i) = f(a.part_[i]...);
    return result;
  }
};

}  // namespace continuo

/// The limits of a lane.
template <class Real, std::size_t W>
struct std::numeric_limits<continuo::Lanes<Real, W>> : std::numeric_limits<Real> {};
