#include <continuo/model/tape_copy.hpp>

namespace continuo::model::tape {

namespace {

constexpr std::size_t smallest_copy = 8;  // fewer numbers are as quickly copied one by one
constexpr std::size_t most_mixed = 16;    // so many copies are looked for at a time

/// From here on each place follows the one `mixed` before it at the same distance: how many places do.
std::size_t reach(std::span<const Place> places, std::size_t mixed) {
  if (places.size() <= mixed) return 0;
  const auto follows = [&](std::size_t i) {
    return places[i].from - places[i - mixed].from == places[mixed].from - places[0].from &&
           places[i].to - places[i - mixed].to == places[mixed].to - places[0].to;
  };
  if (places[mixed].from < places[0].from || places[mixed].to < places[0].to) return 0;
  std::size_t end = mixed;
  while (end < places.size() && follows(end)) ++end;
  return end;
}

}  // namespace

Copies regular_copies(std::span<const Place> places) {
  Copies copies;
  while (!places.empty()) {
    std::size_t mixed = 1, end = reach(places, mixed);
    while (mixed <= most_mixed && end < smallest_copy * mixed) end = reach(places, ++mixed);
    if (mixed > most_mixed) {
      copies.alone.push_back(places.front());
      places = places.subspan(1);
      continue;
    }
    for (std::size_t i = 0; i < mixed; ++i) {
      copies.regular.push_back({.from_begin = places[i].from,
                                .from_step = places[i + mixed].from - places[i].from,
                                .to_begin = places[i].to,
                                .to_step = places[i + mixed].to - places[i].to,
                                .count = static_cast<std::uint32_t>((end - i + mixed - 1) / mixed)});
    }
    places = places.subspan(end);
  }
  return copies;
}

}  // namespace continuo::model::tape
