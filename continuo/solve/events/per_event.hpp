// Values for each event of a source.
#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

namespace continuo::detail {

/// The number of events of a source that is not known when it is compiled.
inline constexpr std::size_t any_count = std::numeric_limits<std::size_t>::max();

template <class Events>
inline constexpr std::size_t count_of_events = any_count;
template <class Events>
  requires requires {
    { Events::count } -> std::convertible_to<std::size_t>;
  }
inline constexpr std::size_t count_of_events<Events> = Events::count;

/// An array that is made, like a vector, of a size, which is its own.
template <class T, std::size_t count>
struct ArrayOfSize : std::array<T, count> {
  explicit ArrayOfSize(std::size_t) : std::array<T, count>{} {}
};

/// `each` values for each of `count` events: an array where their number is known, which is copied without a call.
template <class T, std::size_t count, std::size_t each = 1>
using PerEvent =
    std::conditional_t<count == any_count, std::vector<T>, ArrayOfSize<T, count == any_count ? 0 : count * each>>;

}  // namespace continuo::detail
