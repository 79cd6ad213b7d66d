// Powers, sines and cosines of the doubles of a register, written out where they are used: a call of the C library's
// sends every other register through memory, and computes again what a sine and a cosine of one number share. Each is
// within two units in the last place. Uncommon numbers go to the C library's functions: powers of what is not positive
// and normal, or that leave the range of normal numbers, and sines beyond a million.
//
// Every product that is added to something is a fused operation in the text, and none is left to the compiler: the bits
// of a lane are the same wherever this is compiled into.
#pragma once
#include <continuo/numerics/registers/vector_functions.hpp>

#if defined(CONTINUO_VECTOR_FUNCTIONS) && defined(__FMA__) && \
    (defined(__AVX512F__) ? defined(__AVX512DQ__) : defined(__AVX2__))
#include <bit>
#include <cstdint>

#include <immintrin.h>

namespace continuo::detail::registers {

using Numbers = NumbersOfRegister;
using Bits [[gnu::vector_size(sizeof(Numbers))]] = std::uint64_t;
using Test [[gnu::vector_size(sizeof(Numbers))]] = std::int64_t;  // all bits of a lane, or none

[[gnu::always_inline]] inline Numbers all_numbers(double value) {
  return Numbers{} + value;
}

/// a*b + c, rounded once.
[[gnu::always_inline]] inline Numbers fused(Numbers a, Numbers b, Numbers c) {
#if defined(__AVX512F__)
  return _mm512_fmadd_pd(a, b, c);
#else
  return _mm256_fmadd_pd(a, b, c);
#endif
}
[[gnu::always_inline]] inline Numbers fused(Numbers a, Numbers b, double c) {
  return fused(a, b, all_numbers(c));
}
[[gnu::always_inline]] inline Numbers fused(Numbers a, double b, Numbers c) {
  return fused(a, all_numbers(b), c);
}
[[gnu::always_inline]] inline Numbers fused(Numbers a, double b, double c) {
  return fused(a, all_numbers(b), all_numbers(c));
}

[[gnu::always_inline]] inline bool any_lane(Test test) {
#if defined(__AVX512F__)
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(test)) != 0;
#else
  return _mm256_movemask_pd(reinterpret_cast<__m256d>(test)) != 0;
#endif
}

/// Adding it to a number below 2^51 rounds that to a whole one, which then stands in the last bits of the sum.
inline constexpr double to_whole = 0x1.8p52;

/// A logarithm as a number and what is left of it.
struct LogarithmOfRegister {
  Numbers high, low;
};

/// Of positive normal numbers, within some 2^-64 of its size: x = 2^k z with z about 1, and with s = (z - 1)/(z + 1)
/// log z = 2 artanh s = 2 (s + s^3/3 + s^5/5 + ...).
[[gnu::always_inline]] inline LogarithmOfRegister logarithm_of_register(Bits x) {
  constexpr std::uint64_t root_of_half = 0x3fe6a09e00000000, exponent_of_1024 = std::uint64_t{1024} << 52u;
  const Bits shifted = x - root_of_half + exponent_of_1024;
  const Bits k_above_1024 = (shifted >> 52u) | std::bit_cast<std::uint64_t>(0x1p52);
  const Numbers k = reinterpret_cast<Numbers>(k_above_1024) - (0x1p52 + 1024);
  const Numbers z = reinterpret_cast<Numbers>(x - (shifted & (std::uint64_t{0xfff} << 52u)) + exponent_of_1024);
  // s = q + q_rest, where q_rest = rest/(z + 1) and 1/(z + 1) = (1 - s)/2.
  const Numbers f = z - 1.0, below = z + 1.0, below_rest = f - (below - 2.0), q = f / below;
  const Numbers rest = fused(-q, below_rest, fused(-q, below, f));
  const Numbers q_rest = rest * fused(q, -0.5, 0.5);
  const Numbers q2 = q * q;
  const Numbers q2_rest = fused(q + q, q_rest, fused(q, q, -q2));
  const Numbers q4 = q2 * q2, q8 = q4 * q4;
  // 1/5 + 1/7 q^2 + ... + 1/23 q^18, in pairs that do not wait for each other.
  const Numbers p0 = fused(q2, 1.0 / 7, 1.0 / 5), p1 = fused(q2, 1.0 / 11, 1.0 / 9), p2 = fused(q2, 1.0 / 15, 1.0 / 13);
  const Numbers p3 = fused(q2, 1.0 / 19, 1.0 / 17), p4 = fused(q2, 1.0 / 23, 1.0 / 21);
  const Numbers p = fused(q8, fused(q8, p4, fused(q4, p3, p2)), fused(q4, p1, p0));
  // artanh s / s - 1 = q^2 (1/3 + q^2 p) as a number and a rest.
  constexpr double third = 1.0 / 3, third_rest = 1.0L / 3 - third;
  const Numbers factor = fused(q2, p, third), factor_rest = fused(q2, p, third - factor) + third_rest;
  const Numbers more = q2 * factor;
  const Numbers more_rest = fused(q2, factor_rest, fused(q2_rest, factor, fused(q2, factor, -more)));
  const Numbers half = fused(q, more, q);
  const Numbers half_rest = fused(q, more_rest, fused(q_rest, more, fused(q, more, q - half) + q_rest));
  const Numbers log_z = half + half;
  // ln 2 in two parts, the first with so few bits that its product with k is exact.
  constexpr double ln2 = 0x1.62e42fefa38p-1, ln2_rest = 0x1.ef35793c7673p-45;
  const Numbers high = fused(k, ln2, log_z);
  const Numbers low = fused(k, ln2_rest, (fused(k, ln2, -high) + log_z) + (half_rest + half_rest));
  return {high, low};
}

/// exp of numbers between -700 and 700, and of what is left of them.
[[gnu::always_inline]] inline Numbers exponential_of_register(Numbers x, Numbers rest) {
  constexpr double per_ln2 = 0x1.71547652b82fep0, ln2 = 0x1.62e42fefa38p-1, ln2_rest = 0x1.ef35793c7673p-45;
  const Numbers rounded = fused(x, per_ln2, to_whole), k = rounded - to_whole;
  const Numbers r = fused(-k, ln2_rest, fused(-k, ln2, x)) + rest;
  // exp r = 1 + r + r^2 (1/2! + 1/3! r + ... + 1/13! r^11), in pairs that do not wait for each other.
  const Numbers r2 = r * r, r4 = r2 * r2, r8 = r4 * r4;
  const Numbers p0 = fused(r, 1.0 / 6, 0.5), p1 = fused(r, 1.0 / 120, 1.0 / 24), p2 = fused(r, 1.0 / 5040, 1.0 / 720);
  const Numbers p3 = fused(r, 1.0 / 362880, 1.0 / 40320), p4 = fused(r, 1.0 / 39916800, 1.0 / 3628800);
  const Numbers p5 = fused(r, 1.0 / 6227020800, 1.0 / 479001600);
  const Numbers p = fused(r8, fused(r2, p5, p4), fused(r4, fused(r2, p3, p2), fused(r2, p1, p0)));
  const Numbers power = fused(r2, p, r) + 1.0;
  return reinterpret_cast<Numbers>(reinterpret_cast<Bits>(power) + (reinterpret_cast<Bits>(rounded) << 52u));
}

[[gnu::noinline, gnu::cold]] inline Numbers uncommon_powers(Numbers x, Numbers y) {
  return vector_pow(x, y);
}
[[gnu::noinline, gnu::cold]] inline Numbers uncommon_sines(Numbers x) {
  return vector_sin(x);
}
[[gnu::noinline, gnu::cold]] inline Numbers uncommon_cosines(Numbers x) {
  return vector_cos(x);
}

/// x^y = exp(y log x), with log x to more digits than a double has.
[[gnu::always_inline]] inline Numbers power_of_register(Numbers x, Numbers y) {
  constexpr std::uint64_t least = std::uint64_t{1} << 52u, range = std::uint64_t{0x7fe} << 52u;  // of normal numbers
  const Bits bits = reinterpret_cast<Bits>(x);
  const LogarithmOfRegister logarithm = logarithm_of_register(bits);
  const Numbers high = y * logarithm.high, low = fused(y, logarithm.low, fused(y, logarithm.high, -high));
  const Numbers size = reinterpret_cast<Numbers>(reinterpret_cast<Bits>(high) & ~(std::uint64_t{1} << 63u));
  const Test common = reinterpret_cast<Test>(bits - least < Bits{} + range) & reinterpret_cast<Test>(size < 700.0);
  const Numbers power = exponential_of_register(high, low);
  if (any_lane(~common)) [[unlikely]]
    return common ? power : uncommon_powers(x, y);
  return power;
}

/// x = n pi/2 + r, and the series of both functions of r.
struct SineAndCosine {
  Numbers sine, cosine;
  Bits n;
  Test common;
};
[[gnu::always_inline]] inline SineAndCosine sine_and_cosine(Numbers x) {
  constexpr double per_half_pi = 0x1.45f306dc9c883p-1;
  constexpr double half_pi[] = {0x1.921fb54442d18p0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110};
  const Numbers rounded = fused(x, per_half_pi, to_whole), n = rounded - to_whole;
  // The first of these is exact.
  const Numbers r = fused(-n, half_pi[2], fused(-n, half_pi[1], fused(-n, half_pi[0], x)));
  const Numbers z = r * r, z2 = z * z, z4 = z2 * z2;
  // sin r = r - r^3 (1/3! - 1/5! z + ... ), cos r = 1 - z/2 + z^2 (1/4! - ...), in pairs that do not wait for each
  // other.
  const Numbers s0 = fused(z, 1.0 / 120, -1.0 / 6), s1 = fused(z, 1.0 / 362880, -1.0 / 5040);
  const Numbers s2 = fused(z, 1.0 / 6227020800, -1.0 / 39916800),
                s3 = fused(z, 1.0 / 355687428096000, -1.0 / 1307674368000);
  const Numbers c0 = fused(z, -1.0 / 720, 1.0 / 24), c1 = fused(z, -1.0 / 3628800, 1.0 / 40320);
  const Numbers c2 = fused(z, -1.0 / 87178291200, 1.0 / 479001600);
  const Numbers c3 = fused(z, -1.0 / 6402373705728000, 1.0 / 20922789888000);
  const Numbers s = fused(z4, fused(z2, s3, s2), fused(z2, s1, s0)),
                c = fused(z4, fused(z2, c3, c2), fused(z2, c1, c0));
  const Numbers size = reinterpret_cast<Numbers>(reinterpret_cast<Bits>(x) & ~(std::uint64_t{1} << 63u));
  return {.sine = fused(r * z, s, r),
          .cosine = fused(z, fused(z, c, -0.5), 1.0),
          .n = reinterpret_cast<Bits>(rounded),
          .common = reinterpret_cast<Test>(size <= 1e6)};
}
/// The sine of n pi/2 + r.
[[gnu::always_inline]] inline Numbers turned(const SineAndCosine& of, Bits n) {
  const Test odd = -reinterpret_cast<Test>(n & 1u);
  const Bits sign = (n & 2u) << 62u;
  return reinterpret_cast<Numbers>(reinterpret_cast<Bits>(odd ? of.cosine : of.sine) ^ sign);
}
[[gnu::always_inline]] inline Numbers sine_of_register(Numbers x) {
  const SineAndCosine both = sine_and_cosine(x);
  const Numbers sine = turned(both, both.n);
  if (any_lane(~both.common)) [[unlikely]]
    return both.common ? sine : uncommon_sines(x);
  return sine;
}
[[gnu::always_inline]] inline Numbers cosine_of_register(Numbers x) {
  const SineAndCosine both = sine_and_cosine(x);
  const Numbers cosine = turned(both, both.n + 1u);
  if (any_lane(~both.common)) [[unlikely]]
    return both.common ? cosine : uncommon_cosines(x);
  return cosine;
}

}  // namespace continuo::detail::registers

#else

namespace continuo::detail::registers {

inline constexpr auto power_of_register = vector_pow;
inline constexpr auto sine_of_register = vector_sin;
inline constexpr auto cosine_of_register = vector_cos;

}  // namespace continuo::detail::registers

#endif

#undef CONTINUO_VECTOR_FUNCTIONS
