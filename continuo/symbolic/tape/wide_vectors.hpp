// Whether this machine has vectors of 256 bits: code for them is compiled beside the plain one, which every machine
// has.
#pragma once

namespace continuo::model {

#if defined(__x86_64__)
[[nodiscard]] inline bool has_wide_vectors() {
  return __builtin_cpu_supports("avx2") != 0;
}
#else
[[nodiscard]] constexpr bool has_wide_vectors() {
  return false;
}
#endif

}  // namespace continuo::model
