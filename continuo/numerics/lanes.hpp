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
// functions of doubles are those of libmvec (registers/vector_functions.hpp) and our own (registers/vector_power.hpp),
// within a few units in the last place of those of <cmath>, or where there is none those of <cmath>. No lane depends on
// its neighbours, nor on W.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <limits>
#include <type_traits>

#include <xsimd/xsimd.hpp>

#include <continuo/numerics/lane_mask.hpp>
#include <continuo/numerics/registers/vector_power.hpp>

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
  Real operator[](std::size_t lane) const {
    Real value;
    std::memcpy(&value, reinterpret_cast<const char*>(&part_) + lane * sizeof(Real), sizeof(Real));
    return value;
  }
  /// Replaces the number of one lane.
  void set(std::size_t lane, Real value) {
    std::memcpy(reinterpret_cast<char*>(&part_) + lane * sizeof(Real), &value, sizeof(Real));
  }
  /// The first `To::width` lanes in another precision; zeros where there are not so many.
  template <class To>
  [[nodiscard]] To to() const {
    if constexpr (W == To::width && std::has_single_bit(W) && W > 1) {
      using Number [[gnu::vector_size(W * sizeof(Real))]] = Real;
      using Other [[gnu::vector_size(W * sizeof(typename To::Scalar))]] = typename To::Scalar;
      // Copied, not passed: where the vector is wider than the registers, how a function takes it is not settled.
      Number numbers;
      std::memcpy(&numbers, &part_, sizeof numbers);
      const Other others = __builtin_convertvector(numbers, Other);
      To result;
      std::memcpy(&result.part_, &others, sizeof others);
      return result;
    } else {
      std::array<typename To::Scalar, To::width> result{};
      for (std::size_t i = 0; i < std::min(W, To::width); ++i) result[i] = static_cast<typename To::Scalar>((*this)[i]);
      return To(result);
    }
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
  friend Lanes sin(const Lanes& a) { return function<detail::registers::sine_of_register>([](const auto& x) { using std::sin; return sin(x); }, a); }
  friend Lanes cos(const Lanes& a) { return function<detail::registers::cosine_of_register>([](const auto& x) { using std::cos; return cos(x); }, a); }
  friend Lanes tan(const Lanes& a) { return function<detail::vector_tan>([](const auto& x) { using std::tan; return tan(x); }, a); }
  friend Lanes asin(const Lanes& a) { return function<detail::vector_asin>([](const auto& x) { using std::asin; return asin(x); }, a); }
  friend Lanes acos(const Lanes& a) { return function<detail::vector_acos>([](const auto& x) { using std::acos; return acos(x); }, a); }
  friend Lanes atan(const Lanes& a) { return function<detail::vector_atan>([](const auto& x) { using std::atan; return atan(x); }, a); }
  friend Lanes tanh(const Lanes& a) { return function<detail::vector_tanh>([](const auto& x) { using std::tanh; return tanh(x); }, a); }
  friend Lanes log(const Lanes& a) { return function<detail::vector_log>([](const auto& x) { using std::log; return log(x); }, a); }
  friend Lanes log10(const Lanes& a) { return function<detail::vector_log10>([](const auto& x) { using std::log10; return log10(x); }, a); }
  friend Lanes cbrt(const Lanes& a) { return function<detail::vector_cbrt>([](const auto& x) { using std::cbrt; return cbrt(x); }, a); }
  friend Lanes fabs(const Lanes& a) { return abs(a); }
  friend Lanes exp(const Lanes& a) { return function<detail::vector_exp>([](const auto& x) { using std::exp; return exp(x); }, a); }
  friend Lanes sinh(const Lanes& a) { return function<detail::vector_sinh>([](const auto& x) { using std::sinh; return sinh(x); }, a); }
  friend Lanes cosh(const Lanes& a) { return function<detail::vector_cosh>([](const auto& x) { using std::cosh; return cosh(x); }, a); }
  friend Lanes pow(const Lanes& a, const Lanes& b) { return function<detail::registers::power_of_register>([](Real x, Real y) { return std::pow(x, y); }, a, b); }
  friend Lanes atan2(const Lanes& a, const Lanes& b) { return function<detail::vector_atan2>([](Real x, Real y) { return std::atan2(x, y); }, a, b); }
  friend Lanes hypot(const Lanes& a, const Lanes& b) { return function<detail::vector_hypot>([](Real x, Real y) { return std::hypot(x, y); }, a, b); }
  /// @}
  // clang-format on

  // For step controllers, of positive finite floats: see controller.hpp, whose functions of these names do the same.
  friend Lanes significand(const Lanes& a)
    requires std::same_as<Real, float>
  {
    return map([](const Part& x) { return from_bits<Part>((bits(x) & Bits(0x007fffffU)) | Bits(0x3f800000U)); }, a);
  }
  friend Lanes exponent(const Lanes& a)
    requires std::same_as<Real, float>
  {
    // The exponent in the last bits of a number at 2^23, whose distance from 2^23 it is.
    return map([](const Part& x) { return from_bits<Part>((bits(x) >> 23) | Bits(0x4b000000U)); }, a) -
           Lanes(0x1p23F + 127.0F);
  }
  friend Lanes power_of_two(const Lanes& sum)
    requires std::same_as<Real, float>
  {
    return map([](const Part& x) { return from_bits<Part>((bits(x) + Bits(127U)) << 23); }, sum);
  }

 private:
  template <std::floating_point, std::size_t>
  friend class Lanes;
  using Choice = detail::LaneParts<Real, W>;
  using Part = typename Choice::Part;
  static constexpr std::size_t parts = Choice::count;
  using Parts = std::array<Part, parts>;
  using Bits = typename Choice::Bits;
  Parts part_;

  // Functions of doubles go through one kind of register, whatever W is, so that a number has the same function in
  // every lane of every width. xsimd's would choose their way by all the numbers of a register.
  template <auto OfRegister, class F, class... A>
  [[nodiscard, gnu::always_inline]] static Lanes function(F one, const A&... a) {
    if constexpr (std::same_as<Real, double> && detail::has_vector_functions &&
                  sizeof(Part) == sizeof(detail::NumbersOfRegister)) {
      using Register = detail::NumbersOfRegister;
      Lanes result;
      for (std::size_t i = 0; i < parts; ++i)
        result.part_[i] = std::bit_cast<Part>(OfRegister(std::bit_cast<Register>(a.part_[i])...));
      return result;
    } else if constexpr (std::same_as<Real, double> && detail::has_vector_functions) {
      constexpr std::size_t at_once = detail::vector_width;
      std::array<Real, W> result;
      for (std::size_t first = 0; first < W; first += at_once) {
        const std::size_t count = std::min(at_once, W - first);
        const auto part = OfRegister(numbers(a.values(), first, count)...);
        std::memcpy(result.data() + first, &part, count * sizeof(Real));
      }
      return Lanes(result);
    } else {
      return each(one, a...);
    }
  }
  // The numbers from `first` on in a register, the last one again where there are too few.
  [[nodiscard]] static detail::NumbersOfRegister numbers(const std::array<Real, W>& all, std::size_t first,
                                                         std::size_t count) {
    detail::NumbersOfRegister result;
    std::array<Real, detail::vector_width> padded;
    for (std::size_t i = 0; i < padded.size(); ++i) padded[i] = all[first + std::min(i, count - 1)];
    std::memcpy(&result, &padded, sizeof result);
    return result;
  }

  [[nodiscard]] static Bits bits(const Part& x)
    requires std::same_as<Real, float>
  {
    return std::bit_cast<Bits>(x);
  }
  template <class To>
  [[nodiscard]] static To from_bits(const Bits& x) {
    return std::bit_cast<To>(x);
  }
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
