// continuo/bodies/support/short_lists.hpp
// Many lists of a few numbers each, in no order; a number is in one of them at most. The first two numbers of a list
// are in the table itself, with eight lists in a cache line, so that reading them follows no chain and has no branch
// that is hard to predict.
#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <continuo/bodies/support/prefetch.hpp>

namespace continuo {

class ShortLists {
 public:
  ShortLists() = default;
  ShortLists(std::size_t lists, std::size_t numbers) : lists_(lists), rest_(lists, none), next_(numbers, none) {}

  [[nodiscard]] std::size_t size() const { return lists_.size(); }
  [[nodiscard]] bool is_empty(std::size_t at) const { return lists_[at].first == none; }

  void insert(std::size_t at, std::uint32_t number) {
    List& list = lists_[at];
    if (list.first == none) {
      list.first = number;
    } else if (list.second == none) {
      list.second = number;
    } else {
      next_[number] = std::exchange(rest_[at], number);
      list.first |= more;
    }
  }
  /// The number must be in this list.
  void remove(std::size_t at, std::uint32_t number) {
    List& list = lists_[at];
    if ((list.first & ~more) == number) {
      list.first = std::exchange(list.second, none) | (list.first & more);
    } else if (list.second == number) {
      list.second = none;
    } else {
      std::uint32_t* link = &rest_[at];
      while (*link != number) link = &next_[*link];
      *link = next_[number];
    }
    if ((list.first & more) == 0) return;
    if (list.second == none) list.second = std::exchange(rest_[at], next_[rest_[at]]);
    if (rest_[at] == none) list.first &= ~more;
  }
  void clear(std::size_t at) {
    lists_[at] = {};
    rest_[at] = none;
  }

  /// Writes the numbers of a list after the first `count` of `found`, which grows as needed and must have room for two
  /// more; returns the new count.
  [[nodiscard]] std::size_t append_to(std::vector<std::uint32_t>& found, std::size_t count, std::size_t at) const {
    const List list = lists_[at];
    found[count] = list.first & ~more;
    count += list.first != none;
    found[count] = list.second;
    count += list.second != none;
    if ((list.first & more) != 0)
      for (std::uint32_t number = rest_[at]; number != none; number = next_[number]) {
        if (found.size() < count + 3) found.resize(2 * found.size());
        found[count++] = number;
      }
    return count;
  }
  void ask_for(std::size_t at) const { prefetch(&lists_[at]); }

 private:
  static constexpr std::uint32_t none = 0x7fffffffu, more = 0x80000000u;  // more: than two, the others are chained
  struct List {
    std::uint32_t first = none, second = none;
  };

  std::vector<List> lists_;
  std::vector<std::uint32_t> rest_, next_;  // the numbers of a list beyond two, and their chain
};

}  // namespace continuo
