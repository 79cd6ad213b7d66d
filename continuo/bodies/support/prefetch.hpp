// continuo/bodies/support/prefetch.hpp
#pragma once

namespace continuo {

/// Asks for the cache line at `address`, to be in the cache by the time it is read. Only time depends on it.
inline void prefetch(const void* address) {
  __builtin_prefetch(address, 0, 2);
  asm volatile("" : : "r"(address));  // else GCC takes a function that does nothing else for one without effect
}

}  // namespace continuo
