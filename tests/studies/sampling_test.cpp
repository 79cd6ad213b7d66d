#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/studies/sweep/counter_random.hpp>
#include <continuo/studies/sweep/sampling.hpp>

namespace continuo::studies::sampling_test {
namespace {

using testing::HasSubstr;

constexpr Sampling all_kinds[] = {Sampling::monte_carlo, Sampling::latin_hypercube, Sampling::sobol};

Sampler sampler_of(const SamplingPlan& plan) {
  auto sampler = Sampler::create(plan);
  EXPECT_TRUE(sampler.has_value()) << sampler.status().message;
  return *std::move(sampler);
}

/// The sum of (counted - expected)^2 / expected: chi-squared where all are equally likely.
double chi_squared(const std::vector<int>& counts) {
  const double expected = std::accumulate(counts.begin(), counts.end(), 0.0) / static_cast<double>(counts.size());
  double sum = 0;
  for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}
/// Beyond four deviations of chi-squared; the draws are fixed, so that the test never fails by chance.
double most_chi_squared(std::size_t cells) {
  const auto degrees = static_cast<double>(cells - 1);
  return degrees + 4 * std::sqrt(2 * degrees);
}

TEST(Philox, GivesTheNumbersOfItsAuthors) {  // known answers of Random123: philox4x32, 10 rounds
  using detail::philox;
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (detail::PhiloxBlock{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (detail::PhiloxBlock{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (detail::PhiloxBlock{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Permutation, TakesEveryNumberToAnother) {
  for (std::uint64_t count : {1u, 2u, 3u, 7u, 64u, 1000u, 4097u}) {
    std::set<std::uint64_t> images;
    for (std::uint64_t i = 0; i < count; ++i) images.insert(detail::permuted(i, count, 99));
    EXPECT_EQ(images.size(), count);
    EXPECT_LT(*images.rbegin(), count);
  }
}

TEST(Permutation, IsAnyOfTheTwentyFourOfFourEquallyOften) {
  std::map<std::array<std::uint64_t, 4>, int> counts;
  for (std::uint64_t key = 0; key < 24000; ++key) {
    std::array<std::uint64_t, 4> images{};
    for (std::uint64_t i = 0; i < 4; ++i) images[i] = detail::permuted(i, 4, detail::mixed(5, key));
    ++counts[images];
  }
  ASSERT_EQ(counts.size(), 24u);
  std::vector<int> numbers;
  for (const auto& [images, count] : counts) numbers.push_back(count);
  EXPECT_LT(chi_squared(numbers), most_chi_squared(24));
}

TEST(Permutation, TakesNeighboursToPlacesThatHaveNothingInCommon) {
  constexpr std::uint64_t count = 10007;
  std::vector<int> pairs(100);
  for (std::uint64_t i = 0; i + 1 < count; ++i)
    ++pairs[10 * (detail::permuted(i, count, 3) * 10 / count) + detail::permuted(i + 1, count, 3) * 10 / count];
  EXPECT_LT(chi_squared(pairs), most_chi_squared(pairs.size()));
}

TEST(Sampling, FillsEachDimensionEvenly) {
  for (const Sampling kind : all_kinds) {
    for (const std::size_t dimension : {0u, 1u, 5u, 6u}) {
      const Sampler sampler = sampler_of({.sampling = kind, .runs = 20000, .dimensions = 7, .seed = 3});
      std::vector<int> counts(100);
      for (std::uint64_t run = 0; run < 20000; ++run)
        ++counts[static_cast<std::size_t>(sampler.at(run, dimension) * 100)];
      EXPECT_LT(chi_squared(counts), most_chi_squared(100)) << to_string(kind) << ' ' << dimension;
    }
  }
}

TEST(Sampling, DimensionsAndSeedsAndReplicatesHaveNothingInCommon) {
  constexpr std::uint64_t runs = 8192;
  for (const Sampling kind : all_kinds) {
    const Sampler one = sampler_of({.sampling = kind, .runs = runs, .dimensions = 4, .seed = 3});
    const Sampler next = sampler_of({.sampling = kind, .runs = runs, .dimensions = 4, .seed = 4});
    const Sampler two = sampler_of({.sampling = kind, .runs = 2 * runs, .dimensions = 4, .seed = 3, .replicates = 2});
    std::array<std::vector<int>, 4> cells;
    cells.fill(std::vector<int>(64));
    const auto cell = [](double a, double b) {
      return static_cast<std::size_t>(8 * a) * 8 + static_cast<std::size_t>(8 * b);
    };
    for (std::uint64_t run = 0; run < runs; ++run) {
      ++cells[0][cell(one.at(run, 0), one.at(run, 1))];
      ++cells[1][cell(one.at(run, 1), one.at(run, 3))];
      ++cells[2][cell(one.at(run, 2), next.at(run, 2))];
      ++cells[3][cell(two.at(2 * run, 2), two.at(2 * run + 1, 2))];
    }
    // Two scramblings of one dimension of a net share its first digits in a table of 8 by 8 that is a permutation.
    const int checked = kind == Sampling::sobol ? 2 : 4;
    for (int i = 0; i < checked; ++i)
      EXPECT_LT(chi_squared(cells[static_cast<std::size_t>(i)]), most_chi_squared(64)) << to_string(kind) << ' ' << i;
  }
}

TEST(Sampling, ScramblingsOfSobolPointsHaveNothingInCommon) {
  // The same point under many seeds, and its neighbour: all pairs of eighths equally often, but for what both share.
  std::vector<int> pairs(64);
  for (std::uint64_t seed = 0; seed < 6400; ++seed) {
    const Sampler a = sampler_of({.sampling = Sampling::sobol, .runs = 8, .dimensions = 1, .seed = seed});
    const Sampler b = sampler_of({.sampling = Sampling::sobol, .runs = 8, .dimensions = 1, .seed = seed + 6400});
    ++pairs[static_cast<std::size_t>(8 * a.at(5, 0)) * 8 + static_cast<std::size_t>(8 * b.at(5, 0))];
  }
  EXPECT_LT(chi_squared(pairs), most_chi_squared(64));
}

TEST(Sampling, LatinHypercubeHasOnePointInEveryPart) {
  for (const std::uint64_t runs : {1u, 2u, 3u, 10u, 1000u, 4097u}) {
    for (const std::uint64_t replicates : {1u, 3u}) {
      const Sampler sampler = sampler_of({.sampling = Sampling::latin_hypercube,
                                          .runs = runs * replicates,
                                          .dimensions = 3,
                                          .seed = runs,
                                          .replicates = replicates});
      for (std::size_t d = 0; d < 3; ++d) {
        std::vector<int> counts(runs * replicates);
        for (std::uint64_t run = 0; run < runs * replicates; ++run)
          ++counts[run % replicates * runs + static_cast<std::size_t>(sampler.at(run, d) * static_cast<double>(runs))];
        EXPECT_THAT(counts, testing::Each(1));
      }
    }
  }
}

TEST(Sampling, LatinHypercubeStaysWithinItsPartsHoweverManyThereAre) {
  const std::uint64_t runs = (std::uint64_t{1} << 40) - 1;
  const Sampler sampler = sampler_of({.sampling = Sampling::latin_hypercube, .runs = runs, .dimensions = 1, .seed = 1});
  for (std::uint64_t run = 0; run < 1000; ++run) {
    const double u = sampler.at(runs - 1 - run, 0);
    EXPECT_GT(u, 0);
    EXPECT_LT(u, 1);
  }
}

/// Whether every elementary interval of area 1 / points, 2^-a by 2^-b, has exactly one point: a (0, m, 2)-net.
bool is_net(const std::vector<std::array<double, 2>>& points) {
  for (std::size_t across = 1; across <= points.size(); across *= 2) {
    std::vector<int> counts(points.size());
    const std::size_t up = points.size() / across;
    for (const auto& [x, y] : points)
      ++counts[static_cast<std::size_t>(x * static_cast<double>(across)) * up +
               static_cast<std::size_t>(y * static_cast<double>(up))];
    if (std::ranges::any_of(counts, [](int count) { return count != 1; })) return false;
  }
  return true;
}

TEST(Sampling, SobolPointsAreANetWhateverTheSeed) {
  for (const std::uint64_t runs : {2u, 16u, 1024u}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Sampler sampler =
          sampler_of({.sampling = Sampling::sobol, .runs = 2 * runs, .dimensions = 2, .seed = seed});
      std::vector<std::array<double, 2>> first, second;  // the following block is a net as well
      for (std::uint64_t run = 0; run < runs; ++run) {
        first.push_back({sampler.at(run, 0), sampler.at(run, 1)});
        second.push_back({sampler.at(runs + run, 0), sampler.at(runs + run, 1)});
      }
      EXPECT_TRUE(is_net(first) && is_net(second)) << runs << ' ' << seed;
    }
  }
}

TEST(Sampling, SobolPointsFillEachOfAllDimensionsEvenly) {
  constexpr std::size_t dimensions = 3667;
  const Sampler sampler = sampler_of({.sampling = Sampling::sobol, .runs = 256, .dimensions = dimensions, .seed = 1});
  for (std::size_t d = 0; d < dimensions; d += d < 50 ? 1 : 97) {
    std::vector<int> counts(256);
    for (std::uint64_t run = 0; run < 256; ++run) ++counts[static_cast<std::size_t>(sampler.at(run, d) * 256)];
    EXPECT_THAT(counts, testing::Each(1)) << d;
  }
}

TEST(Sampling, SobolDirectionsAreThoseOfJoeAndKuo) {
  // Points 1, 2, 3, 5, 21, 63 of scipy.stats.qmc.Sobol(3667, scramble=False), in 64ths. Points that share their first
  // digits do so after scrambling as well, and no others: the digits of all pairs of points are tested.
  constexpr std::uint64_t numbers[] = {1, 2, 3, 5, 21, 63};  // in the order of Gray's code
  constexpr std::size_t dimensions[] = {0, 1, 2, 9, 99, 1000, 3666};
  constexpr unsigned expected[6][7] = {{32, 32, 32, 32, 32, 32, 32}, {48, 16, 16, 48, 48, 16, 16},
                                       {16, 48, 48, 16, 16, 48, 48}, {56, 56, 8, 8, 24, 24, 8},
                                       {62, 38, 22, 2, 26, 62, 54},  {1, 51, 23, 37, 5, 43, 1}};
  const Sampler sampler = sampler_of({.sampling = Sampling::sobol, .runs = 64, .dimensions = 3667, .seed = 5});
  const auto common_digits = [](unsigned a, unsigned b) {
    int digits = 0;
    while (digits < 6 && (a >> (5 - digits) & 1) == (b >> (5 - digits) & 1)) ++digits;
    return digits;
  };
  for (std::size_t i = 0; i < 7; ++i) {
    for (std::size_t a = 0; a < 6; ++a) {
      for (std::size_t b = 0; b < 6; ++b) {
        const auto ours = [&](std::size_t point) {
          const std::uint64_t n = numbers[point];
          return static_cast<unsigned>(sampler.at(n ^ n >> 1, dimensions[i]) * 64);
        };
        EXPECT_EQ(common_digits(ours(a), ours(b)), common_digits(expected[a][i], expected[b][i]))
            << dimensions[i] << ' ' << a << ' ' << b;
      }
    }
  }
}

/// The mean of all coordinates of one dimension.
double mean_of(const Sampler& sampler) {
  double sum = 0;
  for (std::uint64_t run = 0; run < sampler.plan().runs; ++run) sum += sampler.at(run, 0);
  return sum / static_cast<double>(sampler.plan().runs);
}

TEST(Sampling, MeansHaveTheVarianceOfTheory) {
  // 1/(12 n) for independent points; 1/(12 n^3) where each of n parts has one, uniformly and independently in it: a
  // mere shift of all points has 1/(12 n^2).
  constexpr std::uint64_t runs = 32, seeds = 3000;
  for (const Sampling kind : all_kinds) {
    double sum = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const double mean = mean_of(sampler_of({.sampling = kind, .runs = runs, .dimensions = 1, .seed = seed}));
      sum += (mean - 0.5) * (mean - 0.5);
    }
    const auto n = static_cast<double>(runs);
    const double expected = kind == Sampling::monte_carlo ? 1 / (12 * n) : 1 / (12 * n * n * n);
    EXPECT_NEAR(sum / seeds / expected, 1, 4 * std::sqrt(2.0 / seeds)) << to_string(kind);
  }
}

/// The square of the star discrepancy in the mean square. T. T. Warnock, "Computational investigations of
/// low-discrepancy point sets" (1972).
double discrepancy(const std::vector<std::vector<double>>& points) {
  const auto n = static_cast<double>(points.size());
  const auto d = points[0].size();
  double single = 0, pairs = 0;
  for (const auto& a : points) {
    double product = 1;
    for (const double x : a) product *= (1 - x * x) / 2;
    single += product;
    for (const auto& b : points) {
      double both = 1;
      for (std::size_t i = 0; i < d; ++i) both *= 1 - std::max(a[i], b[i]);
      pairs += both;
    }
  }
  return std::pow(3.0, -static_cast<double>(d)) - 2 / n * single + pairs / (n * n);
}

TEST(Sampling, DiscrepancyIsThatOfTheory) {
  // (2^-d - 3^-d)/n for independent points on average; 1/(6 n^2) in one dimension with a point in each part.
  constexpr std::uint64_t runs = 32;
  const auto average = [&](Sampling kind, std::size_t dimensions, std::uint64_t seeds) {
    double sum = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const Sampler sampler = sampler_of({.sampling = kind, .runs = runs, .dimensions = dimensions, .seed = seed});
      std::vector<std::vector<double>> points(runs, std::vector<double>(dimensions));
      for (std::uint64_t run = 0; run < runs; ++run) sampler.point(run, points[run]);
      sum += discrepancy(points);
    }
    return sum / static_cast<double>(seeds);
  };
  const auto n = static_cast<double>(runs);
  // One discrepancy is about as large as its own mean spreads; 400 average it to one part in twenty.
  EXPECT_NEAR(average(Sampling::monte_carlo, 3, 400) * n / (1.0 / 8 - 1.0 / 27), 1, 0.2);
  EXPECT_NEAR(average(Sampling::latin_hypercube, 1, 400) * 6 * n * n, 1, 0.05);
  EXPECT_NEAR(average(Sampling::sobol, 1, 400) * 6 * n * n, 1, 0.05);
  EXPECT_LT(average(Sampling::sobol, 3, 50), average(Sampling::monte_carlo, 3, 50) / 4);
}

TEST(Sampling, PointsDoNotChangeFromVersionToVersion) {  // results are repeated by their seed
  const auto point = [](Sampling kind) {
    return sampler_of({.sampling = kind, .runs = 10000, .dimensions = 3, .seed = 7}).at(4711, 2);
  };
  EXPECT_EQ(point(Sampling::monte_carlo), 0x1.a0ab6852ef0e9p-1);
  EXPECT_EQ(point(Sampling::latin_hypercube), 0x1.ae1bdaa8fc99ap-1);
  EXPECT_EQ(point(Sampling::sobol), 0x1.761ec1a9c5425p-1);
}

TEST(Sampling, FaultsSayHowToMendThem) {
  const auto message = [](const SamplingPlan& plan) { return Sampler::create(plan).status().message; };
  EXPECT_THAT(message({.runs = 0}), HasSubstr("at least one"));
  EXPECT_THAT(message({.runs = 1'000'000'000'000'000}), HasSubstr("more than 1099511627776"));
  EXPECT_THAT(message({.dimensions = 0}), HasSubstr("nothing is varied"));
  EXPECT_THAT(message({.sampling = Sampling::sobol, .dimensions = 3668}), HasSubstr("take latin_hypercube"));
  EXPECT_THAT(message({.runs = 10, .replicates = 3}), HasSubstr("3 equal samples"));
  EXPECT_THAT(advice({.sampling = Sampling::sobol, .runs = 10000}), HasSubstr("8192 or 16384"));
  EXPECT_EQ(advice({.sampling = Sampling::sobol, .runs = 8192}), "");
  EXPECT_EQ(advice({.sampling = Sampling::monte_carlo, .runs = 10000}), "");
}

TEST(Sampling, KindsHaveNames) {
  for (const Sampling kind : all_kinds) EXPECT_EQ(sampling_of(to_string(kind)), kind);
  EXPECT_EQ(sampling_of("halton"), std::nullopt);
}

}  // namespace
}  // namespace continuo::studies::sampling_test
