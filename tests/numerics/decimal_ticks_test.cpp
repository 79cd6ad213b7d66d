#include <charconv>
#include <cstdio>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <continuo/numerics/decimal_ticks.hpp>

namespace continuo::decimal_ticks_test {
namespace {

double read(const std::string& text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

TEST(DecimalTicks, TheThirdTenthIsTheDecimal) {
  const DecimalTicks<double> tenths(0.1, 0.1);
  EXPECT_EQ(tenths[2], 0.3);
  EXPECT_NE(0.1 + 2 * 0.1, 0.3);
  EXPECT_EQ(tenths[9999999], 1e6);
}

// first + k period in whole numbers of 10^-places, read back from the text of the sum: the number nearest to it.
TEST(DecimalTicks, AreTheNumbersNearestToTheDecimalSum) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 20000; ++trial) {
    const int places = static_cast<int>(random() % 7);
    const long first = static_cast<long>(random() % 2000000) - 1000000,
               period = 1 + static_cast<long>(random() % 100000);
    const std::string scale = "e-" + std::to_string(places);
    const DecimalTicks<double> ticks(read(std::to_string(first) + scale), read(std::to_string(period) + scale));
    const long k = static_cast<long>(random() % 1000000);
    EXPECT_EQ(ticks[static_cast<double>(k)], read(std::to_string(first + k * period) + scale))
        << first << ' ' << period << ' ' << places << ' ' << k;
  }
}

TEST(DecimalTicks, NextIsTheFirstAfterAndAtWhereItIsMeant) {
  const DecimalTicks<double> ticks(0.1, 0.1);
  for (int k = 0; k < 5000; ++k) {
    const double here = ticks[k];
    EXPECT_EQ(ticks.next(here, true), here);
    EXPECT_EQ(ticks.next(here, false), ticks[k + 1]);
    EXPECT_EQ(ticks.next(std::nextafter(here, 0.0), false), here);
  }
  EXPECT_EQ(ticks.next(-5, false), 0.1);
}

TEST(DecimalTicks, APeriodThatIsNoDecimalIsCountedFromItsNumber) {
  const DecimalTicks<double> thirds(0, 1.0 / 3);
  EXPECT_EQ(thirds[3], 1.0);
}

TEST(DecimalTicks, APeriodBelowTheSpacingOfNumbersLeadsNowhere) {
  EXPECT_FALSE(DecimalTicks<double>(-1, 1e-17).advances(1));
  EXPECT_FALSE(DecimalTicks<double>(0, 1e-12).advances(1e6));
  EXPECT_TRUE(DecimalTicks<double>(0, 1e-9).advances(1e6));
}

}  // namespace
}  // namespace continuo::decimal_ticks_test
