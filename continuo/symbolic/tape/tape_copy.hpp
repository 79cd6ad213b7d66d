// Numbers brought from where they lie to where they are wanted, in few loops. Internal to the tape.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include <continuo/symbolic/tape/wide_vectors.hpp>

namespace continuo::model::tape {

/// to[to_begin + k*to_step] = from[from_begin + k*from_step] for k in 0..count.
struct Copy {
  std::uint32_t from_begin, from_step, to_begin, to_step, count;
};

struct Place {
  std::uint32_t from, to;
  friend auto operator<=>(const Place&, const Place&) = default;
};

/// Two families that take turns on one side and lie apart on the other: together + 2*k and together + 2*k + 1 there,
/// first + k and second + k here, for k in 0..count.
struct Turns {
  std::uint32_t first, second, together, count;
};

struct Copies {
  std::vector<Place> alone;
  std::vector<Copy> regular;
  std::vector<Turns> joined, parted;  // taking turns where they go; where they come from

  [[nodiscard]] std::size_t loops() const { return regular.size() + joined.size() + parted.size(); }
  [[nodiscard]] bool is_empty() const { return alone.empty() && loops() == 0; }
};

/// The copies for these places: the numbers of a family lie at equal distances, several families mixed, as do their
/// derivatives among the outputs.
[[nodiscard]] Copies regular_copies(std::span<const Place> places);

/// Kept apart: small tapes have none, and the code round it stays small.
template <class Real>
[[gnu::noinline]] void run(const Copy& copy, const Real* from, Real* __restrict to) {
  from += copy.from_begin;
  to += copy.to_begin;
  const std::size_t from_step = copy.from_step, to_step = copy.to_step, count = copy.count;
  if (from_step == 1 && to_step == 1) {
    std::copy_n(from, count, to);
  } else if (from_step == 0 && to_step == 1) {
    std::fill_n(to, count, *from);
  } else if (from_step == 2 && to_step == 1) {
    for (std::size_t k = 0; k < count; ++k) to[k] = from[2 * k];
  } else {
    std::size_t k = 0;
    for (; k + 4 <= count; k += 4) {  // a tenth faster than one by one (measured)
      const Real* four = from + k * from_step;
      Real* places = to + k * to_step;
      places[0] = four[0];
      places[to_step] = four[from_step];
      places[2 * to_step] = four[2 * from_step];
      places[3 * to_step] = four[3 * from_step];
    }
    for (; k < count; ++k) to[k * to_step] = from[k * from_step];
  }
}

// What is read or written in one piece is whole: three times as fast as two copies.
template <class Real>
[[gnu::always_inline]] inline void join_turns(const Turns& turns, const Real* from, Real* __restrict to) {
  const Real *first = from + turns.first, *second = from + turns.second;
  to += turns.together;
  for (std::size_t k = 0; k < turns.count; ++k) to[2 * k] = first[k], to[2 * k + 1] = second[k];
}
template <class Real>
[[gnu::always_inline]] inline void part_turns(const Turns& turns, const Real* from, Real* __restrict to) {
  Real* __restrict first = to + turns.first;
  Real* __restrict second = to + turns.second;
  from += turns.together;
  for (std::size_t k = 0; k < turns.count; ++k) first[k] = from[2 * k], second[k] = from[2 * k + 1];
}
template <class Real>
[[gnu::noinline]] void join(const Turns& turns, const Real* from, Real* to) {
  join_turns(turns, from, to);
}
template <class Real>
[[gnu::noinline]] void part(const Turns& turns, const Real* from, Real* to) {
  part_turns(turns, from, to);
}
#if defined(__x86_64__)
template <class Real>
[[gnu::noinline, gnu::target("avx2")]] void join_wide(const Turns& turns, const Real* from, Real* to) {
  join_turns(turns, from, to);
}
template <class Real>
[[gnu::noinline, gnu::target("avx2")]] void part_wide(const Turns& turns, const Real* from, Real* to) {
  part_turns(turns, from, to);
}
#else
template <class Real>
void join_wide(const Turns& turns, const Real* from, Real* to) {
  join(turns, from, to);
}
template <class Real>
void part_wide(const Turns& turns, const Real* from, Real* to) {
  part(turns, from, to);
}
#endif

/// No number that is read is one that is written.
template <class Real>
void run(const Copies& copies, const Real* from, Real* to) {
  for (const Place& place : copies.alone) to[place.to] = from[place.from];
  for (const Copy& copy : copies.regular) run(copy, from, to);
  if constexpr (std::is_arithmetic_v<Real>) {
    if (has_wide_vectors()) {
      for (const Turns& turns : copies.joined) join_wide(turns, from, to);
      for (const Turns& turns : copies.parted) part_wide(turns, from, to);
      return;
    }
  }
  for (const Turns& turns : copies.joined) join(turns, from, to);
  for (const Turns& turns : copies.parted) part(turns, from, to);
}

}  // namespace continuo::model::tape
