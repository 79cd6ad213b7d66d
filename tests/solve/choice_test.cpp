// The method that is chosen where none is named.
#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include <bench/problems/kepler.hpp>
#include <gtest/gtest.h>

#include <continuo/solve/automatic.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::choice_test {
namespace {

TEST(Choice, GoesByToleranceSizeAndKind) {
  const auto name = [](const SystemTraits& traits) { return choose_method(traits).method; };
  EXPECT_EQ(name({.size = 3, .rtol = 1e-6}), "tsitouras5_rodas5p");
  EXPECT_EQ(name({.size = 3, .rtol = 1e-7}), "dop853_radau");
  EXPECT_EQ(name({.size = 1000, .rtol = 1e-4, .sparse = true}), "tsitouras5_bdf");
  EXPECT_EQ(name({.size = 1000, .rtol = 1e-9, .sparse = true}), "dop853_radau");
  EXPECT_EQ(name({.size = 1000, .rtol = 1e-4, .sparse = true, .banded = true}), "tsitouras5_rodas5p");
  EXPECT_EQ(name({.size = 1000, .rtol = 1e-9}), "tsitouras5_bdf");
  EXPECT_EQ(name({.size = 4, .rtol = 1e-4, .accelerations = true}), "dprkn8_radau");
  EXPECT_EQ(name({.size = 4, .rtol = 1e-9, .accelerations = true}), "dprkn12_radau");
}

TEST(Choice, WhatItNamesExistsAndHasAReason) {
  for (const std::size_t size : {std::size_t{2}, std::size_t{1000}}) {
    for (const double rtol : {1e-3, 1e-9}) {
      for (int kind = 0; kind < 8; ++kind) {
        const Choice choice = choose_method({.size = size,
                                             .rtol = rtol,
                                             .algebraic = (kind & 1) != 0,
                                             .accelerations = (kind & 2) != 0,
                                             .sparse = (kind & 4) != 0});
        const MethodInfo* method = find_method(choice.method);
        ASSERT_NE(method, nullptr) << choice.method;
        EXPECT_TRUE(method->implicit);
        EXPECT_EQ(method->automatic, (kind & 1) == 0) << choice.method;
        EXPECT_GT(choice.reason.size(), 20U);
      }
    }
  }
}

TEST(Choice, AccelerationsAreSeenInTheSystem) {
  const auto start = bench::Kepler::start();
  const Options<std::array<double, 4>> options{.rtol = 1e-9};
  const auto chosen = solve(bench::Kepler{}, start, {0.0, 10.0}, options);
  const auto named = solve(bench::Kepler{}, start, {0.0, 10.0}, DormandPrinceNystrom12Radau{}, options);
  EXPECT_EQ(chosen.final_state(), named.final_state());
  EXPECT_EQ(chosen.statistics.evaluations, named.statistics.evaluations);
}

TEST(Choice, DampingIsNoAccelerationOfTheKind) {
  auto damped = second_order(
      [](double, const std::array<double, 1>& q, const std::array<double, 1>& v) { return std::array{-q[0] - v[0]}; });
  EXPECT_FALSE(traits_of(damped, std::array{1.0, 0.0}, 1e-9).accelerations);
  auto free = second_order([](double, const std::array<double, 1>& q) { return std::array{-q[0]}; });
  EXPECT_TRUE(traits_of(free, std::array{1.0, 0.0}, 1e-9).accelerations);
}

}  // namespace
}  // namespace continuo::choice_test
