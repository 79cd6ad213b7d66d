#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/studies/sweep/distribution.hpp>
#include <continuo/studies/sweep/outcome_summary.hpp>
#include <continuo/studies/sweep/sampling.hpp>

namespace continuo::studies::outcome_summary_test {
namespace {

using Integer = boost::multiprecision::cpp_int;
using Precise = boost::multiprecision::cpp_bin_float_100;

/// value * 2^1074.
Integer scaled(double value) {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  const int shift = exponent - 53 + 1074;
  const Integer integer = static_cast<long long>(std::ldexp(fraction, 53));
  return shift >= 0 ? Integer(integer << shift) : Integer(integer / (Integer(1) << -shift));  // without a rest
}

/// By integers of any size, and a square root of 100 digits.
struct Referee {
  Integer sum = 0, squares = 0;
  long long count = 0;
  void add(double value) {
    const Integer integer = scaled(value);
    sum += integer, squares += integer * integer, ++count;
  }
  double mean() const { return static_cast<double>(ldexp(Precise(sum) / count, -1074)); }
  double deviation() const {
    const Integer spread = count * squares - sum * sum;
    return static_cast<double>(ldexp(sqrt(Precise(spread) / count / (count - 1)), -1074));
  }
};

OutcomeSummary summary_of(const std::vector<double>& values, std::size_t capacity = 1000) {
  OutcomeSummary summary(capacity);
  for (const double value : values) summary.add(value);
  return summary;
}

/// Numbers in which sums lose all digits: of all sizes, that cancel, near each other and far from zero, tiny.
std::vector<double> hostile_values(std::mt19937_64& random, int kind, int count) {
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> exponent(-1070, 1000);
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    const double z = normal(random);
    if (kind == 0) values.push_back(std::ldexp(z, exponent(random)));
    if (kind == 1) values.push_back(1e15 + std::round(8 * z) / 8);
    if (kind == 2) values.push_back(i % 2 == 0 ? std::ldexp(z, 900) : -values.back());
    if (kind == 3) values.push_back(std::ldexp(z, -1070));
    if (kind == 4) values.push_back(z);
    if (kind == 5) values.push_back(z < 0 ? -1.7e308 : 1.7e308);
  }
  return values;
}

TEST(OutcomeSummary, MeanAndDeviationAreThoseOfIntegerArithmetic) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 60; ++trial) {
    const auto values = hostile_values(random, trial % 6, 2 + trial * 5);
    Referee referee;
    for (const double value : values) referee.add(value);
    const OutcomeSummary summary = summary_of(values);
    EXPECT_DOUBLE_EQ(summary.mean(), referee.mean()) << trial;
    EXPECT_DOUBLE_EQ(summary.deviation(), referee.deviation()) << trial;
  }
}

TEST(OutcomeSummary, IsTheSameToTheBitInWhateverOrderItIsMade) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 30; ++trial) {
    auto values = hostile_values(random, trial % 6, 500);
    const OutcomeSummary one = summary_of(values);
    std::ranges::shuffle(values, random);
    std::vector<OutcomeSummary> parts(1 + random() % 8, OutcomeSummary(1000));
    for (const double value : values) parts[random() % parts.size()].add(value);
    OutcomeSummary all(1000);
    for (const OutcomeSummary& part : parts) all.merge(part);
    const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
    EXPECT_EQ(bits(all.mean()), bits(one.mean()));
    EXPECT_EQ(bits(all.deviation()), bits(one.deviation()));
    EXPECT_EQ(all.lowest(), one.lowest());
    EXPECT_EQ(all.highest(), one.highest());
    EXPECT_EQ(all.quantiles(std::array{0.1, 0.5, 0.9}), one.quantiles(std::array{0.1, 0.5, 0.9}));
    EXPECT_EQ(all.histogram(10).counts, one.histogram(10).counts);
  }
}

TEST(OutcomeSummary, CountsFailedRunsApart) {
  const OutcomeSummary with = summary_of({1, std::nan(""), 2, INFINITY, 4, -INFINITY});
  const OutcomeSummary without = summary_of({1, 2, 4});
  EXPECT_EQ(with.count(), 3u);
  EXPECT_EQ(with.missing(), 3u);
  EXPECT_EQ(with.mean(), without.mean());
  EXPECT_EQ(with.deviation(), without.deviation());
  EXPECT_EQ(with.highest(), 4);
  EXPECT_EQ(with.quantiles(std::array{0.5}), std::vector{2.0});
}

TEST(OutcomeSummary, OfNothingHasNoValues) {
  const OutcomeSummary nothing = summary_of({std::nan("")});
  EXPECT_TRUE(std::isnan(nothing.mean()) && std::isnan(nothing.deviation()) && std::isnan(nothing.lowest()));
  EXPECT_TRUE(std::isnan(nothing.quantiles(std::array{0.5})[0]));
  EXPECT_EQ(nothing.quantile_error(), 0);
  EXPECT_THAT(nothing.histogram(3).counts, testing::Each(0));
  const OutcomeSummary one = summary_of({3});
  EXPECT_EQ(one.mean(), 3);
  EXPECT_TRUE(std::isnan(one.deviation()));
  EXPECT_EQ(one.quantiles(std::array{0.0, 0.3, 1.0}), (std::vector{3.0, 3.0, 3.0}));
}

TEST(OutcomeSummary, QuantilesAreThoseOfNumpyWhileExact) {  // numpy.quantile([1, 2, 4, 8, 16], [0, .1, .5, .8, 1])
  const auto quantiles = summary_of({8, 1, 16, 2, 4}).quantiles(std::array{0.0, 0.1, 0.5, 0.8, 1.0});
  EXPECT_THAT(quantiles, testing::Pointwise(testing::DoubleEq(), std::vector{1.0, 1.4, 4.0, 9.6, 16.0}));
}

/// How far the place of a value among all values is from the one asked for, in values.
double rank_distance(const std::vector<double>& sorted, double value, double p) {
  const auto low = static_cast<double>(std::ranges::lower_bound(sorted, value) - sorted.begin());
  const auto high = static_cast<double>(std::ranges::upper_bound(sorted, value) - sorted.begin()) - 1;
  const double place = p * static_cast<double>(sorted.size() - 1);
  return std::max({0.0, low - place, place - high});
}

TEST(OutcomeSummary, QuantilesInLittleMemoryKeepTheirBound) {
  std::mt19937_64 random(3);
  for (const int order : {0, 1, 2, 3, 4}) {
    std::vector<double> values(50000);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto place = static_cast<double>(i);
      const double any = static_cast<double>(random() >> 11);
      const double orders[] = {any, place, -place, std::fmod(place, 777), std::fmod(any, 5)};
      values[i] = orders[order];
    }
    OutcomeSummary summary(256);  // by parts of any size, as chunks of runs come
    for (std::size_t i = 0; i < values.size();) {
      OutcomeSummary part(256);
      for (std::size_t k = random() % 2000; k > 0 && i < values.size(); --k) part.add(values[i++]);
      summary.merge(part);
    }
    EXPECT_EQ(summary.count(), values.size());
    EXPECT_GT(summary.quantile_error(), 0);
    EXPECT_LT(summary.quantile_error(), 10.0 / 256);  // half a value of 256 for each of the levels, and for merging
    std::ranges::sort(values);
    std::vector<double> parts(101);
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = static_cast<double>(i) / 100;
    const auto quantiles = summary.quantiles(parts);
    for (std::size_t i = 0; i < parts.size(); ++i)
      EXPECT_LE(rank_distance(values, quantiles[i], parts[i]), summary.quantile_error() * 50000 + 1)
          << order << ' ' << i;
  }
}

TEST(OutcomeSummary, QuantilesAreThoseOfTheDistribution) {
  // One point in each of n equal parts: the place of a quantile is at most one part away from the closed form.
  const Distribution distributions[] = {Normal{1, 2}, Lognormal{1, 0.5}, Triangular{0, 1, 4}, Uniform{-1, 1}};
  constexpr std::uint64_t runs = 20000;
  const auto sampler =
      Sampler::create({.sampling = Sampling::latin_hypercube, .runs = runs, .dimensions = 1, .seed = 1});
  for (const Distribution& d : distributions) {
    OutcomeSummary exact(runs), small(512);
    for (std::uint64_t run = 0; run < runs; ++run) {
      const double value = quantile(d, sampler->at(run, 0));
      exact.add(value), small.add(value);
    }
    for (const double p : {0.025, 0.25, 0.5, 0.75, 0.975}) {
      const auto lies_within = [&](double value, double part) {
        return value >= quantile(d, p - part) && value <= quantile(d, p + part);
      };
      EXPECT_TRUE(lies_within(exact.quantiles(std::array{p})[0], 1.5 / runs));
      EXPECT_TRUE(lies_within(small.quantiles(std::array{p})[0], 2.5 / runs + small.quantile_error()));
    }
    EXPECT_EQ(exact.quantile_error(), 0);
    EXPECT_NEAR(exact.mean(), mean(d), deviation(d) / runs * 10);
  }
}

TEST(OutcomeSummary, HistogramCountsEveryValueOnce) {
  const Histogram histogram = summary_of({0, 0.5, 1, 1.5, 2, 2.5, 3, 4}).histogram(4);
  EXPECT_EQ(histogram.low, 0);
  EXPECT_EQ(histogram.high, 4);
  EXPECT_THAT(histogram.counts, testing::ElementsAre(2, 2, 2, 2));
  EXPECT_THAT(summary_of({7, 7, 7}).histogram(3).counts, testing::ElementsAre(3, 0, 0));
  EXPECT_THAT(summary_of({-1.7e308, 1.7e308}).histogram(2).counts, testing::ElementsAre(1, 1));
}

TEST(OutcomeSummary, FitsIntoTheMemoryThatIsGiven) {
  EXPECT_GE(summary_capacity(1, 1'000'000), 1'000'000u);  // exact
  for (const std::uint64_t runs : {std::uint64_t{1'000'000}, std::uint64_t{1} << 40}) {
    const std::size_t capacity = summary_capacity(101, runs);
    const auto levels = 2 + static_cast<std::size_t>(std::bit_width(runs / capacity));
    EXPECT_LE(101 * (sizeof(OutcomeSummary) + sizeof(double) * capacity * levels), 150'000'000u);
    EXPECT_GE(capacity, 4096u);
  }
}

}  // namespace
}  // namespace continuo::studies::outcome_summary_test
