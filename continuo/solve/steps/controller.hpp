// continuo/solve/steps/controller.hpp
// The next step size from the errors so far: h_new = h * safety * err_n^-b1 * err_(n-1)^-b2 * err_(n-2)^-b3, each
// exponent divided by the order of the error estimate plus one. G. Soderlind, "Digital filters in adaptive
// time-stepping", ACM TOMS 29 (2003).
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>

namespace continuo {

/// A step controller is three exponents and the bounds of one change.
struct Controller {
  double beta1;  // the exponent of the last error
  double beta2;  // of the one before
  double beta3;  // and of that before it
  /// The ratio of the next step to the greatest one that would be accepted. A rejected step of a method with many
  /// stages is expensive, and bench/ found 0.7 to 0.8 the cheapest at equal true error for every pair of orders 5 to 9.
  double safety = 0.75;
  double least_factor = 0.2;    // no step is shorter than this times the one before
  double greatest_factor = 10;  // nor longer than this
};

/// The elementary controller: each error alone.
inline constexpr Controller I{1, 0, 0};
/// The proportional-integral controller of Hairer's DOPRI5 (beta = 0.04): follows a solution that changes its pace as
/// fast as the elementary one, with fewer rejections, and keeps step sizes calm where stability bounds them.
/// E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", IV.2, eq. 2.43. Against PI.3.4 of K. Gustafsson
/// (0.7, -0.4; safety 0.9) it saves 6 to 10 % of the evaluations at equal true error.
inline constexpr Controller PI{0.85, -0.2, 0};
/// The PID controller of C. Kennedy, M. Carpenter, Appl. Numer. Math. 44 (2003), for noisy right-hand sides.
inline constexpr Controller PID{0.58, -0.21, 0.1};

namespace detail {

/// The parts of a positive finite number, significand(x) * 2^exponent(x), from its bits. Lanes have the same functions.
[[nodiscard]] inline float significand(float x) {
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(x) & 0x007fffffU) | 0x3f800000U);
}
[[nodiscard]] inline float exponent(float x) {
  return static_cast<float>(static_cast<std::int32_t>(std::bit_cast<std::uint32_t>(x) >> 23) - 127);
}
/// 2^n, where n is in the last bits of a sum of n and 1.5 * 2^23.
[[nodiscard]] inline float power_of_two(float sum) {
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(sum) + 127U) << 23);
}

/// log2 of a positive finite number and 2^x, to 0.001: a step size needs no more, and the functions of the library
/// would take the longest time between one small step and the next. The cubics have the smallest maximum error among
/// those without a jump from one power of two to the next, and are summed in pairs of terms, which shortens the chain
/// of operations. Real is float, or lanes of it.
template <class Real>
[[nodiscard]] inline Real quick_log2(const Real& x) {
  const Real m = significand(x);
  const Real below = exponent(x) - Real(2.16416994F);
  return (below + Real(3.06469457F) * m) + m * m * (Real(0.159219831F) * m - Real(1.05974446F));
}
template <class Real>
[[nodiscard]] inline Real quick_exp2(const Real& x) {  // for x in -126..127, bounded where it is not
  using std::max, std::min;
  const Real bounded = min(max(x, Real(-126.0F)), Real(127.0F));
  const Real shift(0x1.8p23F);
  const Real shifted = bounded + shift;
  const Real f = bounded - (shifted - shift);
  return power_of_two(shifted) *
         ((Real(0.999928014F) + Real(0.693261013F) * f) + f * f * (Real(0.242612141F) + Real(0.0551720782F) * f));
}

}  // namespace detail

/// The memory of a controller: the logarithms of the last two squared errors. A jump of the state clears it. Errors are
/// given as squares, which the mean of squares provides: the next step would have to wait for the root. Real is float,
/// or lanes of it.
template <class Real>
struct ErrorHistoryOf {
  Real last = Real(0), before_last = Real(0);

  /// For checkpoints.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(last, before_last);
  }

  /// The factor for the next step after an accepted one; the error is kept for the steps after.
  [[nodiscard]] Real accept(const Controller& controller, int error_order, const Real& error_square) {
    using std::max, std::min;
    const float order = exponent_of(error_order);
    const Real here = detail::quick_log2(max(error_square, Real(1e-20F)));
    const Real older =
        Real(static_cast<float>(controller.beta2)) * last + Real(static_cast<float>(controller.beta3)) * before_last;
    before_last = last;
    last = here;
    // All other terms are known before `here`, for which the next step waits.
    const Real factor =
        Real(static_cast<float>(controller.safety)) *
        detail::quick_exp2(Real(-order) * older - Real(order * static_cast<float>(controller.beta1)) * here);
    return min(max(factor, Real(static_cast<float>(controller.least_factor))),
               Real(static_cast<float>(controller.greatest_factor)));
  }

  /// The factor for another try of a rejected step.
  [[nodiscard]] static float reject(const Controller& controller, int error_order, float error_square) {
    const float wanted = detail::quick_exp2(-exponent_of(error_order) * detail::quick_log2(error_square));
    return std::clamp(static_cast<float>(controller.safety) * wanted, static_cast<float>(controller.least_factor) / 2,
                      0.9F);
  }

  /// Of the squares of errors.
  [[nodiscard]] static float exponent_of(int error_order) { return 0.5F / static_cast<float>(error_order + 1); }
};
using ErrorHistory = ErrorHistoryOf<float>;

}  // namespace continuo
