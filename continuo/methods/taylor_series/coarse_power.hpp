// Logarithms and powers to three digits, for step sizes, which need no more: in a third of the time of the library's,
// for which the next step would wait.
//
//   coarse_exp2(coarse_log2(x) / -20)   // x^(-1/20), to a ten-thousandth
#pragma once
#include <bit>
#include <cstdint>

namespace continuo::detail {

/// log2 of a positive finite number, to 1.2e-4; at most -1022 of those below the normal ones, 0 among them. The quartic
/// is that through the Chebyshev nodes of 1..2.
[[nodiscard]] inline double coarse_log2(double x) {
  constexpr std::uint64_t fraction = 0x000fffffffffffff, one = 0x3ff0000000000000;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const double m = std::bit_cast<double>((bits & fraction) | one);
  const auto exponent = static_cast<double>(static_cast<int>(bits >> 52) - 1023);
  const double square = m * m;
  return (exponent - 2.498353148814169 + 4.029211391071479 * m) +
         square * ((0.6260321821639283 * m - 2.0783351682517117) - 0.0784406762091458 * square);
}

/// 2^x for x in -1021..1022, to a ten-thousandth of it: the cubic through the Chebyshev nodes of -0.5..0.5.
[[nodiscard]] inline double coarse_exp2(double x) {
  constexpr double shift = 0x1.8p52;  // the sum has the nearest whole number in its last bits
  const double shifted = x + shift, f = x - (shifted - shift);
  const auto power = std::bit_cast<double>((std::bit_cast<std::uint64_t>(shifted) + 1023U) << 52);
  return power *
         ((0.9999245569508709 + 0.6931367338836214 * f) + f * f * (0.24263947854625845 + 0.055838282946220126 * f));
}

}  // namespace continuo::detail
