// Compiled with -mavx2 -mfma. It includes nothing of the standard library, whose inline functions other sources share.
#include <tests/numerics/wide_functions.hpp>

#if defined(__AVX2__) && defined(__FMA__)

#include <continuo/numerics/registers/vector_power.hpp>

namespace continuo::wide_functions {

bool available() {
  return detail::has_vector_functions && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}
void powers(const double* x, const double* y, double* result) {
  _mm256_storeu_pd(result, detail::registers::power_of_register(_mm256_loadu_pd(x), _mm256_loadu_pd(y)));
}
void sines(const double* x, double* result) {
  _mm256_storeu_pd(result, detail::registers::sine_of_register(_mm256_loadu_pd(x)));
}
void cosines(const double* x, double* result) {
  _mm256_storeu_pd(result, detail::registers::cosine_of_register(_mm256_loadu_pd(x)));
}

}  // namespace continuo::wide_functions

#else

namespace continuo::wide_functions {

bool available() {
  return false;
}
void powers(const double*, const double*, double*) {}
void sines(const double*, double*) {}
void cosines(const double*, double*) {}

}  // namespace continuo::wide_functions

#endif
