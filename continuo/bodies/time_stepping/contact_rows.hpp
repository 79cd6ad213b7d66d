// Rows of entries, one row for each body, all in one array; several threads can make them together.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/bodies/support/large_array.hpp>
#include <continuo/bodies/support/thread_team.hpp>

namespace continuo {

/// Entries first[k] ... first[k + 1] - 1 are those of row k.
template <class Entry>
struct Rows {
  std::vector<std::uint32_t> first{0};
  LargeArray<Entry> entries{};

  [[nodiscard]] std::size_t rows() const { return first.size() - 1; }
  [[nodiscard]] std::span<const Entry> row(std::size_t k) const {
    return {entries.data() + first[k], entries.data() + first[k + 1]};
  }
  [[nodiscard]] std::span<Entry> row(std::size_t k) {
    return {entries.data() + first[k], entries.data() + first[k + 1]};
  }

  void clear() {
    first.assign(1, 0);
    entries.clear();
  }
  void end_row() { first.push_back(static_cast<std::uint32_t>(entries.size())); }
  void append(const Rows& more) {
    const auto before = static_cast<std::uint32_t>(entries.size());
    entries.insert(entries.end(), more.entries.begin(), more.entries.end());
    for (std::size_t k = 1; k < more.first.size(); ++k) first.push_back(before + more.first[k]);
  }
  /// Releases unused capacity, which after doubling would be a good part of all memory.
  void fit() {
    if (entries.capacity() > entries.size() + entries.size() / 16) entries.shrink_to_fit();
    if (first.capacity() > first.size() + first.size() / 16) first.shrink_to_fit();
  }
  [[nodiscard]] std::size_t memory() const {
    return first.capacity() * sizeof(first[0]) + entries.capacity() * sizeof(Entry);
  }
};

/// make_row(k, result) appends the entries of row k.
template <class AnyRows, class MakeRow>
void make_rows(ThreadTeam& team, std::size_t rows, AnyRows& result, MakeRow&& make_row) {
  const auto make = [&](std::size_t from, std::size_t to, AnyRows& part) {
    for (std::size_t k = from; k < to; ++k) {
      make_row(static_cast<std::uint32_t>(k), part);
      part.end_row();
    }
  };
  result.clear();
  if (team.is_alone()) return make(0, rows, result);
  constexpr std::size_t length = 512;
  std::vector<AnyRows> parts((rows + length - 1) / length);
  team.for_each(0, parts.size(), 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t part = from; part < to; ++part)
      make(part * length, std::min(rows, (part + 1) * length), parts[part]);
  });
  for (const AnyRows& part : parts) result.append(part);
}

}  // namespace continuo
