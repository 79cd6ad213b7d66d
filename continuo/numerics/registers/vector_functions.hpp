// The elementary functions of several doubles at once from the C library's libmvec, where there is one: each is within
// four units in the last place, and what it gives for a number does not depend on the other numbers. They are called by
// the names that the vector ABI of x86-64 gives them, so that every compiler finds them without -ffast-math.
#pragma once
#include <cstddef>

#if defined(__x86_64__) && defined(__GLIBC__)
#if __GLIBC_PREREQ(2, 35)
#include <immintrin.h>
#define CONTINUO_VECTOR_FUNCTIONS
#endif
#endif

namespace continuo::detail {

#ifdef CONTINUO_VECTOR_FUNCTIONS

inline constexpr bool has_vector_functions = true;
#if defined(__AVX512F__)
using NumbersOfRegister = __m512d;
extern "C" {
__m512d _ZGVeN8v_sin(__m512d);
__m512d _ZGVeN8v_cos(__m512d);
__m512d _ZGVeN8v_tan(__m512d);
__m512d _ZGVeN8v_asin(__m512d);
__m512d _ZGVeN8v_acos(__m512d);
__m512d _ZGVeN8v_atan(__m512d);
__m512d _ZGVeN8v_sinh(__m512d);
__m512d _ZGVeN8v_cosh(__m512d);
__m512d _ZGVeN8v_tanh(__m512d);
__m512d _ZGVeN8v_exp(__m512d);
__m512d _ZGVeN8v_log(__m512d);
__m512d _ZGVeN8v_log10(__m512d);
__m512d _ZGVeN8v_cbrt(__m512d);
__m512d _ZGVeN8vv_pow(__m512d, __m512d);
__m512d _ZGVeN8vv_atan2(__m512d, __m512d);
__m512d _ZGVeN8vv_hypot(__m512d, __m512d);
}
inline constexpr auto* vector_sin = &_ZGVeN8v_sin;
inline constexpr auto* vector_cos = &_ZGVeN8v_cos;
inline constexpr auto* vector_tan = &_ZGVeN8v_tan;
inline constexpr auto* vector_asin = &_ZGVeN8v_asin;
inline constexpr auto* vector_acos = &_ZGVeN8v_acos;
inline constexpr auto* vector_atan = &_ZGVeN8v_atan;
inline constexpr auto* vector_sinh = &_ZGVeN8v_sinh;
inline constexpr auto* vector_cosh = &_ZGVeN8v_cosh;
inline constexpr auto* vector_tanh = &_ZGVeN8v_tanh;
inline constexpr auto* vector_exp = &_ZGVeN8v_exp;
inline constexpr auto* vector_log = &_ZGVeN8v_log;
inline constexpr auto* vector_log10 = &_ZGVeN8v_log10;
inline constexpr auto* vector_cbrt = &_ZGVeN8v_cbrt;
inline constexpr auto* vector_pow = &_ZGVeN8vv_pow;
inline constexpr auto* vector_atan2 = &_ZGVeN8vv_atan2;
inline constexpr auto* vector_hypot = &_ZGVeN8vv_hypot;
#elif defined(__AVX2__)
using NumbersOfRegister = __m256d;
extern "C" {
__m256d _ZGVdN4v_sin(__m256d);
__m256d _ZGVdN4v_cos(__m256d);
__m256d _ZGVdN4v_tan(__m256d);
__m256d _ZGVdN4v_asin(__m256d);
__m256d _ZGVdN4v_acos(__m256d);
__m256d _ZGVdN4v_atan(__m256d);
__m256d _ZGVdN4v_sinh(__m256d);
__m256d _ZGVdN4v_cosh(__m256d);
__m256d _ZGVdN4v_tanh(__m256d);
__m256d _ZGVdN4v_exp(__m256d);
__m256d _ZGVdN4v_log(__m256d);
__m256d _ZGVdN4v_log10(__m256d);
__m256d _ZGVdN4v_cbrt(__m256d);
__m256d _ZGVdN4vv_pow(__m256d, __m256d);
__m256d _ZGVdN4vv_atan2(__m256d, __m256d);
__m256d _ZGVdN4vv_hypot(__m256d, __m256d);
}
inline constexpr auto* vector_sin = &_ZGVdN4v_sin;
inline constexpr auto* vector_cos = &_ZGVdN4v_cos;
inline constexpr auto* vector_tan = &_ZGVdN4v_tan;
inline constexpr auto* vector_asin = &_ZGVdN4v_asin;
inline constexpr auto* vector_acos = &_ZGVdN4v_acos;
inline constexpr auto* vector_atan = &_ZGVdN4v_atan;
inline constexpr auto* vector_sinh = &_ZGVdN4v_sinh;
inline constexpr auto* vector_cosh = &_ZGVdN4v_cosh;
inline constexpr auto* vector_tanh = &_ZGVdN4v_tanh;
inline constexpr auto* vector_exp = &_ZGVdN4v_exp;
inline constexpr auto* vector_log = &_ZGVdN4v_log;
inline constexpr auto* vector_log10 = &_ZGVdN4v_log10;
inline constexpr auto* vector_cbrt = &_ZGVdN4v_cbrt;
inline constexpr auto* vector_pow = &_ZGVdN4vv_pow;
inline constexpr auto* vector_atan2 = &_ZGVdN4vv_atan2;
inline constexpr auto* vector_hypot = &_ZGVdN4vv_hypot;
#else
using NumbersOfRegister = __m128d;
extern "C" {
__m128d _ZGVbN2v_sin(__m128d);
__m128d _ZGVbN2v_cos(__m128d);
__m128d _ZGVbN2v_tan(__m128d);
__m128d _ZGVbN2v_asin(__m128d);
__m128d _ZGVbN2v_acos(__m128d);
__m128d _ZGVbN2v_atan(__m128d);
__m128d _ZGVbN2v_sinh(__m128d);
__m128d _ZGVbN2v_cosh(__m128d);
__m128d _ZGVbN2v_tanh(__m128d);
__m128d _ZGVbN2v_exp(__m128d);
__m128d _ZGVbN2v_log(__m128d);
__m128d _ZGVbN2v_log10(__m128d);
__m128d _ZGVbN2v_cbrt(__m128d);
__m128d _ZGVbN2vv_pow(__m128d, __m128d);
__m128d _ZGVbN2vv_atan2(__m128d, __m128d);
__m128d _ZGVbN2vv_hypot(__m128d, __m128d);
}
inline constexpr auto* vector_sin = &_ZGVbN2v_sin;
inline constexpr auto* vector_cos = &_ZGVbN2v_cos;
inline constexpr auto* vector_tan = &_ZGVbN2v_tan;
inline constexpr auto* vector_asin = &_ZGVbN2v_asin;
inline constexpr auto* vector_acos = &_ZGVbN2v_acos;
inline constexpr auto* vector_atan = &_ZGVbN2v_atan;
inline constexpr auto* vector_sinh = &_ZGVbN2v_sinh;
inline constexpr auto* vector_cosh = &_ZGVbN2v_cosh;
inline constexpr auto* vector_tanh = &_ZGVbN2v_tanh;
inline constexpr auto* vector_exp = &_ZGVbN2v_exp;
inline constexpr auto* vector_log = &_ZGVbN2v_log;
inline constexpr auto* vector_log10 = &_ZGVbN2v_log10;
inline constexpr auto* vector_cbrt = &_ZGVbN2v_cbrt;
inline constexpr auto* vector_pow = &_ZGVbN2vv_pow;
inline constexpr auto* vector_atan2 = &_ZGVbN2vv_atan2;
inline constexpr auto* vector_hypot = &_ZGVbN2vv_hypot;
#endif

#else

inline constexpr bool has_vector_functions = false;
using NumbersOfRegister = double;
inline constexpr decltype(nullptr) vector_sin = nullptr;
inline constexpr decltype(nullptr) vector_cos = nullptr;
inline constexpr decltype(nullptr) vector_tan = nullptr;
inline constexpr decltype(nullptr) vector_asin = nullptr;
inline constexpr decltype(nullptr) vector_acos = nullptr;
inline constexpr decltype(nullptr) vector_atan = nullptr;
inline constexpr decltype(nullptr) vector_sinh = nullptr;
inline constexpr decltype(nullptr) vector_cosh = nullptr;
inline constexpr decltype(nullptr) vector_tanh = nullptr;
inline constexpr decltype(nullptr) vector_exp = nullptr;
inline constexpr decltype(nullptr) vector_log = nullptr;
inline constexpr decltype(nullptr) vector_log10 = nullptr;
inline constexpr decltype(nullptr) vector_cbrt = nullptr;
inline constexpr decltype(nullptr) vector_pow = nullptr;
inline constexpr decltype(nullptr) vector_atan2 = nullptr;
inline constexpr decltype(nullptr) vector_hypot = nullptr;

#endif

inline constexpr std::size_t vector_width = sizeof(NumbersOfRegister) / sizeof(double);

}  // namespace continuo::detail
