// continuo/bodies/support/prefetch.hpp
#pragma once

namespace continuo {

/// Prefetches the cache line at `address`, so that it is in the cache by the time it is read. This affects run time
/// only.
inline void prefetch(const void* address) {
  __builtin_prefetch(address, 0, 2);
  asm volatile("" : : "r"(address));  // else GCC takes a function that does nothing else for one without effect
}

}  // namespace continuo
