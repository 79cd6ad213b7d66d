// Loops found in lists of members: each member is in one of them or alone, and has there the addresses it had.
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/symbolic/native/loop_nests.hpp>

namespace continuo::model::loop_nests_test {
namespace {

constexpr std::size_t width = 3;

/// Visits the members of a nest with the addresses that its loops give.
void for_each_member(const LoopNest& nest, std::span<const std::int32_t> addresses,
                     const std::function<void(std::size_t, const std::vector<std::int32_t>&)>& visit) {
  const std::span first = addresses.subspan(nest.member * width, width);
  std::function<void(std::size_t, std::size_t, std::vector<std::int32_t>)> go = [&](std::size_t d, std::size_t member,
                                                                                    std::vector<std::int32_t> at) {
    if (d == nest.dimensions.size()) return visit(member, at);
    for (std::size_t k = 0; k < nest.dimensions[d].count; ++k) {
      go(d + 1, member + k * nest.dimensions[d].member_step, at);
      for (std::size_t c = 0; c < width; ++c) at[c] += nest.dimensions[d].steps[c];
    }
  };
  go(0, nest.member, {first.begin(), first.end()});
}

void expect_all_members_once(std::span<const std::int32_t> addresses) {
  const Loops loops = loops_of(addresses, width);
  std::vector<int> seen(addresses.size() / width);
  for (const std::size_t member : loops.alone) ++seen[member];
  for (const LoopNest& nest : loops.nests) {
    for_each_member(nest, addresses, [&](std::size_t member, const std::vector<std::int32_t>& at) {
      ++seen[member];
      EXPECT_THAT(at, ::testing::ElementsAreArray(addresses.subspan(member * width, width))) << member;
    });
  }
  EXPECT_THAT(seen, ::testing::Each(1));
}

/// Rows of random lengths at random distances, some of them taking turns, with members that fit nowhere.
std::vector<std::int32_t> random_addresses(std::mt19937& random) {
  const auto any = [&](std::uint32_t most) { return static_cast<std::int32_t>(random() % most); };
  std::vector<std::int32_t> addresses;
  for (int part = any(5); part >= 0; --part) {
    const std::int32_t rows = 1 + any(7), length = 1 + any(9), mixed = 1 + any(3), step = any(5) - 2,
                       row_step = any(40);
    for (std::int32_t j = 0; j < rows; ++j)
      for (std::int32_t i = 0; i < length; ++i)
        for (std::int32_t turn = 0; turn < mixed; ++turn)
          for (std::int32_t c = 0; c < static_cast<std::int32_t>(width); ++c)
            addresses.push_back(any(60) == 0 ? any(1000) : 100 * turn + row_step * j + step * i * (c + 1));
  }
  return addresses;
}

TEST(LoopNests, HaveEachMemberOnceWithItsAddresses) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    expect_all_members_once(random_addresses(random));
  }
}

TEST(LoopNests, FindTheInnerPointsOfAGrid) {
  constexpr std::int32_t rows = 20, columns = 30;
  std::vector<std::int32_t> addresses;
  for (std::int32_t j = 1; j + 1 < rows; ++j)
    for (std::int32_t i = 1; i + 1 < columns; ++i)
      for (const std::int32_t offset : {0, -1, columns}) addresses.push_back(j * columns + i + offset);
  const Loops loops = loops_of(addresses, width);
  ASSERT_EQ(loops.nests.size(), 1u);
  EXPECT_TRUE(loops.alone.empty());
  ASSERT_EQ(loops.nests[0].dimensions.size(), 2u);
  EXPECT_EQ(loops.nests[0].dimensions[0].count, columns - 2u);
  EXPECT_EQ(loops.nests[0].dimensions[1].steps[0], columns);
}

TEST(LoopNests, AreWrittenAsSums) {
  EXPECT_EQ(sum_text(0, std::vector<std::int64_t>{0}), "0");
  EXPECT_EQ(sum_text(0, std::vector<std::int64_t>{1, 20}), "20*j + i");
  EXPECT_EQ(sum_text(7, std::vector<std::int64_t>{-1, 20}), "7 + 20*j - i");
  EXPECT_EQ(sum_text(0, std::vector<std::int64_t>{-2}), "-2*i");
}

}  // namespace
}  // namespace continuo::model::loop_nests_test
