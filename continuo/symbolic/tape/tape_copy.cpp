// Finds the regular copies, and those that take turns, in a list of places.
#include <algorithm>
#include <utility>

#include <continuo/symbolic/tape/tape_copy.hpp>

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

/// One side of a copy.
struct Side {
  std::uint32_t Copy::* begin;
  std::uint32_t Copy::* step;
};
constexpr Side from_side{&Copy::from_begin, &Copy::from_step}, to_side{&Copy::to_begin, &Copy::to_step};

/// A copy without its first `begin` numbers and those from `end` on.
Copy cut(Copy copy, std::uint32_t begin, std::uint32_t end) {
  copy.from_begin += begin * copy.from_step;
  copy.to_begin += begin * copy.to_step;
  copy.count = end - begin;
  return copy;
}

void add(const Copy& copy, Copies& copies) {
  if (copy.count >= smallest_copy) {
    copies.regular.push_back(copy);
    return;
  }
  for (std::uint32_t k = 0; k < copy.count; ++k)
    copies.alone.push_back({copy.from_begin + k * copy.from_step, copy.to_begin + k * copy.to_step});
}

/// Takes copies out of the regular ones whose numbers take turns on one side; what one has in excess stays a copy.
std::vector<Turns> take_turns(Copies& copies, const Side& together, const Side& apart) {
  std::vector<Turns> all;
  const auto fits = [&](const Copy& copy) { return copy.*together.step == 2 && copy.*apart.step == 1; };
  std::vector<Copy> left = std::exchange(copies.regular, {});
  while (!left.empty()) {
    const Copy a = left.front();
    left.erase(left.begin());
    const auto partner = std::ranges::find_if(left, [&](const Copy& b) {
      const std::uint32_t first = std::min(a.*together.begin, b.*together.begin);
      const std::uint32_t last = std::max(a.*together.begin, b.*together.begin);
      const std::uint32_t ahead = a.*together.begin < b.*together.begin ? a.count : b.count;
      return fits(a) && fits(b) && (last - first) % 2 == 1 && (last - first) / 2 + smallest_copy <= ahead;
    });
    if (partner == left.end()) {
      add(a, copies);
      continue;
    }
    Copy first = a, second = *partner;
    left.erase(partner);
    if (second.*together.begin < first.*together.begin) std::swap(first, second);
    const std::uint32_t before = (second.*together.begin - first.*together.begin) / 2;
    const std::uint32_t count = std::min(first.count - before, second.count);
    all.push_back({.first = first.*apart.begin + before,
                   .second = second.*apart.begin,
                   .together = second.*together.begin - 1,
                   .count = count});
    add(cut(first, 0, before), copies);
    add(cut(first, before + count, first.count), copies);
    add(cut(second, count, second.count), copies);
  }
  return all;
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
  copies.joined = take_turns(copies, to_side, from_side);
  copies.parted = take_turns(copies, from_side, to_side);
  return copies;
}

}  // namespace continuo::model::tape
