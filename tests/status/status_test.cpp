// Reports of failures: endings and their descriptions, a status as text, a value or a status.
#include <memory>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <continuo/solve/outcome.hpp>
#include <continuo/status/result.hpp>
#include <continuo/status/status.hpp>

namespace continuo::status_test {
namespace {

TEST(Status, EveryEndingHasWordsOfItsOwn) {
  std::set<std::string_view> words;
  for (int k = 0; k <= static_cast<int>(last_ending); ++k) words.insert(to_string(static_cast<Ending>(k)));
  EXPECT_EQ(words.size(), static_cast<std::size_t>(last_ending) + 1);
  EXPECT_FALSE(words.contains("unknown"));
}

TEST(Status, OnlyTheEndAnEventAndACallbackAreSuccesses) {
  for (int k = 0; k <= static_cast<int>(last_ending); ++k) {
    const auto ending = static_cast<Ending>(k);
    EXPECT_EQ(static_cast<bool>(Status{.ending = ending}), ending == Ending::reached_end ||
                                                               ending == Ending::stopped_by_event ||
                                                               ending == Ending::stopped_by_callback);
  }
  EXPECT_TRUE(Status{});
}

TEST(Status, IsToldWithItsPlace) {
  EXPECT_EQ(describe(Status{}), "reached end");
  EXPECT_EQ(describe(Status{.ending = Ending::interrupted, .place = "t = 2"}), "t = 2: interrupted");
  EXPECT_EQ(describe(invalid_input("the mass must be above 0", "body 3")), "body 3: the mass must be above 0");
}

TEST(Status, NoFaultIsASuccess) {
  EXPECT_TRUE(invalid_input(""));
  EXPECT_FALSE(invalid_input("wrong"));
}

TEST(Status, OfAnOutcomeHasItsWordsAndItsTime) {
  const Outcome<double> outcome{.ending = Ending::step_too_small, .t = 1.5, .h = 1e-17};
  EXPECT_EQ(status(outcome).ending, Ending::step_too_small);
  EXPECT_EQ(status(outcome).message, describe(outcome));
  EXPECT_EQ(status(outcome).place, "t = 1.5");
  EXPECT_TRUE(status(Outcome<double>{}));
}

Result<std::unique_ptr<int>> half(int number) {
  if (number % 2 != 0) return invalid_input("an odd number has no half");
  return std::make_unique<int>(number / 2);
}

TEST(Result, IsAValueOrTheReasonWhyThereIsNone) {
  auto four = half(8);
  ASSERT_TRUE(four);
  EXPECT_EQ(**four, 4);
  EXPECT_TRUE(four.status());
  const std::unique_ptr<int> moved = *std::move(four);
  EXPECT_EQ(*moved, 4);
  const auto none = half(7);
  EXPECT_FALSE(none);
  EXPECT_FALSE(none.has_value());
  EXPECT_EQ(none.status().ending, Ending::invalid_input);
  EXPECT_EQ(none.status().message, "an odd number has no half");
}

TEST(Result, WithoutAValueIsNeverASuccess) {
  const Result<int> none = Status{};
  EXPECT_FALSE(none);
  EXPECT_FALSE(none.status());
  EXPECT_EQ(none.status().ending, Ending::cannot_continue);
}

}  // namespace
}  // namespace continuo::status_test
