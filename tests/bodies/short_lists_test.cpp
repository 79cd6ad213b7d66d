// Short lists against sets.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/support/short_lists.hpp>

namespace continuo::short_lists_test {
namespace {

TEST(ShortLists, HoldWhatWasInsertedAndNotRemoved) {
  constexpr std::uint32_t numbers = 60;
  constexpr std::size_t lists = 7, nowhere = lists;
  ShortLists short_lists(lists, numbers);
  std::vector<std::set<std::uint32_t>> sets(lists);
  std::vector<std::size_t> list_of(numbers, nowhere);
  std::mt19937 engine(5);
  for (int k = 0; k < 20000; ++k) {
    const auto number = static_cast<std::uint32_t>(engine() % numbers);
    std::size_t& at = list_of[number];
    if (at != nowhere) {
      short_lists.remove(at, number);
      sets[at].erase(number);
    }
    at = engine() % (lists + 4) % (lists + 1);  // some lists have more than others; some numbers are in none
    if (at != nowhere) {
      short_lists.insert(at, number);
      sets[at].insert(number);
    }
    if (k % 1000 == 999) {
      const std::size_t cleared = engine() % lists;
      short_lists.clear(cleared);
      sets[cleared].clear();
      std::ranges::replace(list_of, cleared, nowhere);
    }
    for (std::size_t list = 0; list < lists; ++list) {
      std::vector<std::uint32_t> found{77, 0, 0};
      const std::size_t count = short_lists.append_to(found, 1, list);
      ASSERT_EQ(count - 1, sets[list].size());
      EXPECT_EQ(found[0], 77u);
      found.resize(count);
      EXPECT_EQ(std::set<std::uint32_t>(found.begin() + 1, found.end()), sets[list]);
      EXPECT_EQ(short_lists.is_empty(list), sets[list].empty());
    }
  }
}

}  // namespace
}  // namespace continuo::short_lists_test
