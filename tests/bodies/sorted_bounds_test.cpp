// Bounds in order along an axis: the pairs that they give, against a search through all of them.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "random_bounds.hpp"
#include <continuo/bodies/bounds/sorted_bounds.hpp>

namespace continuo::bounds_test {
namespace {

constexpr std::size_t no_limit = 1000000;

template <class Real, int Dim>
Pairs overlapping(const std::vector<Bounds<Real, Dim>>& set) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < set.size(); ++i)
    for (std::uint32_t j = i + 1; j < set.size(); ++j)
      if (overlap(set[i], set[j])) pairs.emplace_back(i, j);
  return pairs;
}
/// In two parts, as two threads would find them.
template <class Real, int Dim>
Pairs found_in(const SortedBounds<Real, Dim>& sorted) {
  Pairs pairs;
  const auto visit = [&](std::uint32_t i, std::uint32_t j) { pairs.emplace_back(std::min(i, j), std::max(i, j)); };
  const std::size_t middle = sorted.size() / 3;
  EXPECT_TRUE(sorted.for_each_pair(0, middle, no_limit, visit));
  EXPECT_TRUE(sorted.for_each_pair(middle, sorted.size(), no_limit, visit));
  std::ranges::sort(pairs);
  return pairs;
}

template <class Real, int Dim>
void pairs_are_all_found() {
  std::mt19937 engine(5);
  for (const Kind kind : {Kind::uniform, Kind::six_decades, Kind::one_point, Kind::line})
    for (const std::size_t count : {0u, 1u, 2u, 3u, 15u, 16u, 17u, 300u}) {
      SCOPED_TRACE(testing::Message() << Dim << "D, kind " << static_cast<int>(kind) << ", " << count);
      SortedBounds<Real, Dim> sorted;
      auto set = random_set<Real, Dim>(engine, kind, count);
      ASSERT_TRUE(sorted.sort(set, no_limit));
      EXPECT_EQ(found_in(sorted), overlapping(set));
      // Some have moved a little, then all are elsewhere, also along another axis.
      for (auto& box : set)
        if (engine() % 3 == 0) box = grown(box, Real(0.02));
      ASSERT_TRUE(sorted.sort(set, no_limit));
      EXPECT_EQ(found_in(sorted), overlapping(set));
      set = random_set<Real, Dim>(engine, kind, count);
      for (auto& box : set) box.lower[Dim - 1] *= 3, box.upper[Dim - 1] *= 3;
      if (!std::ranges::all_of(set, [](const auto& box) { return !is_empty(box); })) continue;
      ASSERT_TRUE(sorted.sort(set, no_limit));
      EXPECT_EQ(found_in(sorted), overlapping(set));
    }
}
TEST(SortedBounds, PairsAreAllFound) {
  pairs_are_all_found<float, 2>(), pairs_are_all_found<float, 3>();
  pairs_are_all_found<double, 2>(), pairs_are_all_found<double, 3>();
}

// What has no end, or is no number, has no place in an order.
TEST(SortedBounds, RefusesWhatIsEmptyOrNotFinite) {
  std::mt19937 engine(9);
  int refused = 0;
  for (const Kind kind : {Kind::unbounded, Kind::empty, Kind::all_empty})
    for (int k = 0; k < 100; ++k) {
      const auto set = random_set<double, 3>(engine, kind, 5);
      const bool has_place = std::ranges::all_of(set, [](const auto& box) {
        bool is_so = true;
        for (std::size_t i = 0; i < 3; ++i)
          is_so = is_so && std::isfinite(box.lower[i]) && std::isfinite(box.upper[i]) && box.lower[i] <= box.upper[i];
        return is_so;
      });
      SortedBounds<double, 3> sorted;
      EXPECT_EQ(sorted.sort(set, no_limit), has_place);
      refused += has_place ? 0 : 1;
    }
  EXPECT_GT(refused, 100);
}

// A thousand of which each overlaps all others along every axis: half a million comparisons.
TEST(SortedBounds, SaysWhereThereIsTooMuchToCompare) {
  const std::vector<Bounds<float, 2>> same(1000, around<float, 2>({{1, 2}}, 1));
  SortedBounds<float, 2> sorted;
  EXPECT_FALSE(sorted.sort(same, 100));
  ASSERT_TRUE(sorted.sort(same, 1000));
  std::size_t pairs = 0;
  const auto count = [&](std::uint32_t, std::uint32_t) { ++pairs; };
  EXPECT_FALSE(sorted.for_each_pair(0, 1000, 100000, count));
  pairs = 0;
  EXPECT_TRUE(sorted.for_each_pair(0, 1000, 510000, count));
  EXPECT_EQ(pairs, 1000u * 999 / 2);
}

}  // namespace
}  // namespace continuo::bounds_test
