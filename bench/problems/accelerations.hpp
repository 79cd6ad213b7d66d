// bench/problems/accelerations.hpp
#pragma once
#include <cstddef>

#include <continuo/system/system.hpp>

namespace continuo::bench {

/// The problem reads q'' = a(q), its state is q, then v.
struct Accelerations {
  static std::size_t pair_count(std::size_t size) { return size / 2; }
  static PositionVelocity pair(std::size_t i, std::size_t size) { return {i, i + size / 2}; }
  template <class X>
  static bool ignores_velocity(const X&) {
    return true;
  }
};

}  // namespace continuo::bench
