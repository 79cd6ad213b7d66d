#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/studies/fit.hpp>
#include <continuo/studies/fit/student_t.hpp>

namespace continuo::studies::fit_test {
namespace {

// x'' + c x' + k x = 0 from x = 1 at rest: x = exp(-d t) (cos w t + d/w sin w t), d = c/2, w^2 = k - d^2.
constexpr const char* spring =
    "param k = 3 in 0..20, c = 1 in 0..5\nx'' + c*x' + k*x = 0\nx(0) = 1; x'(0) = 0\noutput speed = x'\nrun 0..10\n";
double swing(double t, double k, double c) {
  const double d = c / 2, w = std::sqrt(k - d * d);
  return std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t));
}

results::Measurements spring_data(std::size_t count, double noise, std::mt19937_64& random) {
  results::Measurements data{.file = "spring.csv", .columns = {"x"}, .times = {}, .lines = {}, .values = {{}}};
  std::normal_distribution<double> error(0, 1);
  for (std::size_t i = 0; i < count; ++i) {
    data.times.push_back(10 * static_cast<double>(i + 1) / static_cast<double>(count));
    data.lines.push_back(i + 2);
    data.values[0].push_back(swing(data.times.back(), 4, 0.6) + noise * error(random));
  }
  return data;
}

FitUnknown unknown(const model::ModelProgram& program, const std::string& name) {
  return {.influence = {.index = model::find_parameter(program.model, name)}};
}
FitUnknown start_of(const model::ModelProgram& program, const std::string& name, double start) {
  return {.influence = {Influence::Kind::initial, model::find_state(program.model, name)}, .start = start};
}
FitRequest spring_request(std::size_t count, double noise, std::mt19937_64& random) {
  const auto program = program_of(spring);
  return {.program = program,
          .data = {{.measurements = spring_data(count, noise, random), .columns = {{0, "x"}}}},
          .unknowns = {unknown(*program, "k"), unknown(*program, "c")}};
}

TEST(Fit, FindsWhatMadeTheData) {  // without noise: to the runs' tolerance
  std::mt19937_64 random(1);
  const Fit result = fit(spring_request(50, 0, random));
  ASSERT_TRUE(result.found()) << result.status.message;
  EXPECT_NEAR(result.least.p[0], 4, 1e-6);
  EXPECT_NEAR(result.least.p[1], 0.6, 1e-6);
}

// In 1,000 repeats the share inside an interval of 95 % has the deviation sqrt(0.95 * 0.05/1000) = 0.7 %.
TEST(Fit, IntervalsHoldTheTruthAsOftenAsTheySayInThousandRepeats) {
  std::mt19937_64 random(20);
  FitRequest request = spring_request(100, 0.05, random);
  int k_inside = 0, c_inside = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (int repeat = 0; repeat < 1000; ++repeat) {
    request.data[0].measurements = spring_data(100, 0.05, random);
    const Fit result = fit(request);
    ASSERT_TRUE(result.found()) << result.status.message;
    k_inside += std::abs(result.least.p[0] - 4) <= result.half_width(0) ? 1 : 0;
    c_inside += std::abs(result.least.p[1] - 0.6) <= result.half_width(1) ? 1 : 0;
  }
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
  RecordProperty("milliseconds_per_fit", std::to_string(taken.count() / 1000));
  EXPECT_GE(k_inside, 930);
  EXPECT_LE(k_inside, 970);
  EXPECT_GE(c_inside, 930);
  EXPECT_LE(c_inside, 970);
}

TEST(Fit, FindsInitialValuesToo) {
  std::mt19937_64 random(3);
  FitRequest request = spring_request(50, 0, random);
  request.unknowns.push_back(start_of(*request.program, "x", 0.3));
  request.unknowns.push_back(start_of(*request.program, "x'", 0.5));
  const Fit result = fit(request);
  ASSERT_TRUE(result.found()) << result.status.message;
  EXPECT_NEAR(result.least.p[0], 4, 1e-6);
  EXPECT_NEAR(result.least.p[2], 1, 1e-6);
  EXPECT_NEAR(result.least.p[3], 0, 1e-6);
}

// One of ten values has an error of 3, sixty deviations, in the direction of a larger k.
TEST(Fit, RobustLossesForgiveOutliers) {
  std::mt19937_64 random(4);
  FitRequest request = spring_request(100, 0.05, random);
  results::Measurements& data = request.data[0].measurements;
  for (std::size_t i = 5; i < 100; i += 10)
    data.values[0][i] += swing(data.times[i], 4.01, 0.6) > swing(data.times[i], 3.99, 0.6) ? 3 : -3;
  const Fit plain = fit(request);
  for (const Loss loss : {Loss::huber, Loss::soft_l1, Loss::cauchy, Loss::tukey}) {
    request.options.loss = loss;
    const Fit robust = fit(request);
    ASSERT_TRUE(robust.found());
    // 0.05 sqrt(2/100) over dx/dk, about 0.3, is 0.02: four of it, plus the remaining influence of the outliers.
    EXPECT_NEAR(robust.least.p[0], 4, 0.1) << static_cast<int>(loss);
    EXPECT_LT(std::abs(robust.least.p[0] - 4), std::abs(plain.least.p[0] - 4) / 3);
  }
}

TEST(Fit, KeepsBoundsAndSaysWhichHolds) {
  std::mt19937_64 random(5);
  FitRequest request = spring_request(50, 0.01, random);
  request.unknowns[1].low = 0.8;
  request.unknowns[1].high = 2;
  const Fit result = fit(request);
  ASSERT_TRUE(result.found());
  EXPECT_DOUBLE_EQ(result.least.p[1], 0.8);
  EXPECT_TRUE(result.least.at_bound[1]);
  EXPECT_FALSE(result.least.at_bound[0]);
}

TEST(Fit, TakesSeveralSetsEachWithItsOwnParametersAndGaps) {
  const auto program = program_of("param a = 1, x0 = 1\nx' = -a*x\nx(0) = x0\noutput twice = 2*x\nrun 0..2\n");
  const double nan = std::numeric_limits<double>::quiet_NaN(), a = 0.7;
  const results::Measurements first{"1.csv", {"x"}, {0, 1, 2}, {2, 3, 4}, {{nan, std::exp(-a), nan}}};
  const results::Measurements second{
      "2.csv", {"twice"}, {0.5, 0.5}, {2, 3}, {{6 * std::exp(-a / 2), 6 * std::exp(-a / 2)}}};
  const Fit result =
      fit({.program = program,
           .data = {{.measurements = first, .columns = {{0, "x", 0.1}}},
                    {.measurements = second, .columns = {{0, "twice", 0.1}}, .parameters = {{"x0", 3.0}}}},
           .unknowns = {unknown(*program, "a")}});
  ASSERT_TRUE(result.found()) << result.status.message;
  EXPECT_NEAR(result.least.p[0], a, 1e-7);
  // Known deviations: 1/s^2 = sum of (dq/da)^2 / 0.1^2.
  const double one = std::exp(-a), two = 3 * std::exp(-a / 2);
  EXPECT_NEAR(result.estimates[0].deviation, 0.1 / std::sqrt(one * one + 2 * two * two), 1e-6);
}

TEST(Fit, SearchesFromSeveralStarts) {  // k = 0.2 leads to a swing that is far too slow, and to a minimum there
  std::mt19937_64 random(6);
  FitRequest request = spring_request(100, 0.01, random);
  request.unknowns[0].start = 18;
  request.unknowns[0].low = 0.1;
  request.unknowns[0].high = 20;
  request.unknowns[1].low = 0;
  request.unknowns[1].high = 1;
  request.options.starts = 12;
  const Fit result = fit(request);
  ASSERT_TRUE(result.found());
  EXPECT_NEAR(result.least.p[0], 4, 0.05);
  EXPECT_EQ(result.least.starts_done, 12u);
  EXPECT_GE(result.least.starts_agreeing, 1u);
}

TEST(Fit, WeighsQuantitiesOfDifferentSizeByTheirOwnNoise) {
  const auto program = program_of("param a = 1\nx' = -a*x\nx(0) = 1\noutput big = 1e6*x\nrun 0..2\n");
  std::mt19937_64 random(7);
  std::normal_distribution<double> error(0, 1);
  results::Measurements data{"d.csv", {"x", "big"}, {}, {}, {{}, {}}};
  for (std::size_t i = 1; i <= 200; ++i) {
    data.times.push_back(0.01 * static_cast<double>(i));
    data.lines.push_back(i);
    data.values[0].push_back(std::exp(-0.7 * data.times.back()) + 1e-4 * error(random));
    data.values[1].push_back(1e6 * std::exp(-0.7 * data.times.back()) + 1e4 * error(random));
  }
  const Fit result = fit({.program = program,
                          .data = {{.measurements = data, .columns = {{0, "x"}, {1, "big"}}}},
                          .unknowns = {unknown(*program, "a")}});
  ASSERT_TRUE(result.found());
  // dx/da = -t x is about 0.4 in the mean square: 1e-4/(0.4 sqrt(200)) = 1.8e-5; a deviation of 200 values is known to
  // 5 %, taken as four of that.
  EXPECT_NEAR(result.least.p[0], 0.7, 1e-4);
  EXPECT_NEAR(result.columns[0].residual_deviation, 1e-4, 2e-5);
  EXPECT_NEAR(result.columns[1].residual_deviation, 1e4, 2e3);
}

TEST(Fit, BandHoldsTheMeasurementsItShould) {
  std::mt19937_64 random(8);
  const FitRequest request = spring_request(100, 0.05, random);
  const Fit result = fit(request);
  const auto curves = curves_of(request, result, 100);
  ASSERT_EQ(curves.size(), 1u);
  // Far from where x depends on k and c the band is the noise alone; nowhere it is narrower. 98 degrees of freedom.
  const double narrowest = student_t_quantile(0.95, 98) * result.columns[0].residual_deviation;
  for (std::size_t i = 0; i < curves[0].y.size(); ++i)
    EXPECT_GE((curves[0].high[i] - curves[0].low[i]) / 2, narrowest * (1 - 1e-6));
  EXPECT_NEAR(curves[0].high[0] - curves[0].y[0], narrowest, 1e-9);
}

TEST(Fit, SaysWhyThereIsNone) {
  std::mt19937_64 random(9);
  FitRequest request = spring_request(1, 0, random);
  EXPECT_NE(fit(request).status.message.find("1 measured values cannot determine 2 unknowns"), std::string::npos);
  request = spring_request(10, 0, random);
  request.data[0].measurements.times[0] = -1;
  EXPECT_EQ(fit(request).status.message, "spring.csv:2: the time -1 is before the model's start at 0");
  const auto explodes = program_of("param a = 1\nx' = a*x^2\nx(0) = 1\nrun 0..10\n");
  request.program = explodes;
  request.data[0].measurements = spring_data(10, 0, random);
  request.unknowns = {unknown(*explodes, "a")};
  EXPECT_NE(fit(request).status.message.find("the run from the starting values fails"), std::string::npos);
}

}  // namespace
}  // namespace continuo::studies::fit_test
