// Bodies that lie in each other by the thousands, which no motion can hold in memory.
#pragma once
#include <algorithm>
#include <cstddef>
#include <string>

#include <continuo/status/status.hpp>

namespace continuo {

/// The most pairs of parts that may touch, for a number of parts. In a heap a part has about ten; of n parts at one
/// point there are n^2/2, each with some kilobytes where it is a contact.
[[nodiscard]] inline std::size_t most_near_pairs(std::size_t parts) {
  constexpr std::size_t always = 1'000'000, of_each = 32;
  return std::max(always, of_each * parts);
}

/// An error where more than `most_near_pairs` may touch.
[[nodiscard]] inline Status check_crowd(std::size_t pairs, std::size_t parts) {
  if (pairs <= most_near_pairs(parts)) return {};
  return invalid_input("more than " + std::to_string(most_near_pairs(parts)) + " pairs of " + std::to_string(parts) +
                       " bodies or parts of bodies may touch: too many lie in each other; place them apart, or let "
                       "them not collide");
}

}  // namespace continuo
