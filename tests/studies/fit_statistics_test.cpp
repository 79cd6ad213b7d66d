// The statistics of a fit, on straight lines, for which they are closed forms.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/studies/fit.hpp>
#include <continuo/studies/fit/chi_squared.hpp>
#include <continuo/studies/fit/student_t.hpp>

namespace continuo::studies::fit_statistics_test {
namespace {

using testing::HasSubstr;

constexpr const char* line =
    "param a = 1, b = 1, c = 1\ns' = 0\ns(0) = 0\noutput y = a + b*t\noutput z = 10*y\nrun 0..10\n";

FitData data_of(const std::string& quantity, std::vector<double> t, std::vector<double> values) {
  FitData data;
  data.measurements = {.file = quantity + ".csv", .columns = {quantity}, .times = t, .lines = {}, .values = {values}};
  for (std::size_t i = 0; i < t.size(); ++i) data.measurements.lines.push_back(i + 2);
  data.columns = {{.column = 0, .quantity = quantity}};
  return data;
}
std::vector<double> times(std::size_t count) {
  std::vector<double> t;
  for (std::size_t i = 0; i < count; ++i) t.push_back(10 * static_cast<double>(i) / static_cast<double>(count));
  return t;
}
std::vector<double> noisy(const std::vector<double>& t, double factor, double deviation, std::mt19937_64& random) {
  std::normal_distribution<double> noise(0, deviation);
  std::vector<double> y;
  for (const double at : t) y.push_back(factor * (2 + 0.5 * at) + noise(random));
  return y;
}
FitRequest request_of(const char* model, std::vector<std::string> unknowns, std::vector<FitData> data) {
  FitRequest request{.program = program_of(model), .data = std::move(data), .unknowns = {}};
  for (const std::string& name : unknowns)
    request.unknowns.push_back({.influence = {.index = model::find_parameter(request.program->model, name)}});
  return request;
}

struct Straight {  // by the normal equations
  double a, b, squares, deviation_a, deviation_b;
};
Straight straight(const std::vector<double>& t, const std::vector<double>& y, double deviation = 0) {
  const double n = static_cast<double>(t.size());
  double st = 0, sy = 0, stt = 0, sty = 0;
  for (std::size_t i = 0; i < t.size(); ++i) st += t[i], sy += y[i], stt += t[i] * t[i], sty += t[i] * y[i];
  const double d = n * stt - st * st;
  Straight result{(stt * sy - st * sty) / d, (n * sty - st * sy) / d, 0, 0, 0};
  for (std::size_t i = 0; i < t.size(); ++i) result.squares += std::pow(result.a + result.b * t[i] - y[i], 2);
  const double s = deviation > 0 ? deviation : std::sqrt(result.squares / (n - 2));
  result.deviation_a = s * std::sqrt(stt / d);
  result.deviation_b = s * std::sqrt(n / d);
  return result;
}

// Linear problems are solved in one step, up to the rounding of sums.
TEST(FitStatistics, OfAStraightLineAreThoseOfTheTextbooks) {
  std::mt19937_64 random(1);
  for (const std::size_t rows : {3U, 5U, 20U, 100U}) {
    const auto t = times(rows), y = noisy(t, 1, 0.3, random);
    const Straight expected = straight(t, y);
    const Fit found = fit(request_of(line, {"a", "b"}, {data_of("y", t, y)}));
    ASSERT_TRUE(found.found()) << found.status.message;
    EXPECT_NEAR(found.estimates[0].value, expected.a, 1e-9);
    EXPECT_NEAR(found.estimates[1].deviation, expected.deviation_b, 1e-6 * expected.deviation_b);
    const double n = static_cast<double>(rows), quantile = student_t_quantile(0.95, n - 2);
    EXPECT_NEAR(found.half_width(0), quantile * expected.deviation_a, 1e-6 * quantile * expected.deviation_a);
    EXPECT_NEAR(*found.statistics.sum_of_squares, expected.squares, 1e-9 * expected.squares);
    EXPECT_NEAR(found.columns[0].residual_deviation, std::sqrt(expected.squares / (n - 2)), 1e-6);
    const double minus_two_log = n * (std::log(2 * std::numbers::pi * expected.squares / n) + 1);
    EXPECT_NEAR(*found.statistics.aic, minus_two_log + 6, 1e-6);
    EXPECT_NEAR(*found.statistics.bic, minus_two_log + 3 * std::log(n), 1e-6);
    EXPECT_FALSE(found.statistics.chi_squared);
  }
}

TEST(FitStatistics, SayWhatWasMetAndNotWhatWasGiven) {
  std::mt19937_64 random(2);
  const auto t = times(40), y = noisy(t, 1, 0.3, random);
  FitRequest request = request_of(line, {"a", "b"}, {data_of("y", t, y)});
  request.data[0].columns[0].deviation = 0.25;
  const Fit found = fit(request);
  const Straight expected = straight(t, y, 0.25);
  EXPECT_NEAR(found.columns[0].residual_deviation, std::sqrt(expected.squares / 38), 1e-6);
  EXPECT_NEAR(found.estimates[0].deviation, expected.deviation_a, 1e-6);
  EXPECT_NEAR(*found.statistics.chi_squared, expected.squares / 0.0625, 1e-6);
  EXPECT_NEAR(*found.statistics.chi_squared_p, chi_squared_tail(expected.squares / 0.0625, 38), 1e-6);
  EXPECT_FALSE(found.doubts_of(FitDoubt::Kind::residuals_too_large));
  request.data[0].columns[0].deviation = 0.003;
  const Fit wrong = fit(request);
  EXPECT_NEAR(wrong.columns[0].residual_deviation, found.columns[0].residual_deviation, 1e-6);
  EXPECT_TRUE(wrong.doubts_of(FitDoubt::Kind::residuals_too_large));
  EXPECT_EQ(wrong.least.starts_done, 11u);
}

// A deviation estimated from n values is known to 1/sqrt(2 n): four of that.
TEST(FitStatistics, EveryColumnHasADeviationOfItsOwn) {
  std::mt19937_64 random(3);
  const auto t = times(50), few = times(6);
  const Fit found = fit(request_of(line, {"a", "b"},
                                   {data_of("y", t, noisy(t, 1, 0.1, random)), data_of("y", t, noisy(t, 1, 2, random)),
                                    data_of("z", few, noisy(few, 10, 30, random))}));
  ASSERT_TRUE(found.found()) << found.status.message;
  EXPECT_NEAR(found.columns[0].residual_deviation, 0.1, 0.04);
  EXPECT_NEAR(found.columns[1].residual_deviation, 2, 0.8);
  EXPECT_NEAR(found.columns[2].residual_deviation, 30, 4 * 30 / std::sqrt(12));
  EXPECT_NEAR(found.columns[0].degrees + found.columns[1].degrees + found.columns[2].degrees, 106 - 2, 1e-9);
  // Only the best column loses degrees of freedom to the unknowns, since it alone determines them.
  EXPECT_NEAR(found.columns[0].degrees, 48, 0.1);
}

// A first row copied from the model has no noise. Of the other three values one determines the unknown. With a
// deviation of its own, the single value of the first column would be met exactly and have all the weight.
TEST(FitStatistics, ShortColumnsShareADeviation) {
  const char* fading = "param a = 1\nx' = -a*x\nx(0) = 1\noutput y = 100*x\nrun 0..2\n";
  const Fit found =
      fit(request_of(fading, {"a"}, {data_of("x", {0, 1}, {1, 0.60}), data_of("y", {1, 2}, {61.5, 36.2})}));
  ASSERT_TRUE(found.found()) << found.status.message;
  EXPECT_NEAR(found.estimates[0].degrees, 2, 1e-6);
  EXPECT_NEAR(found.columns[0].degrees + found.columns[1].degrees, 2, 1e-9);
  EXPECT_GT(found.half_width(0), 0.01);  // 4.3 times a hundredth of x over dx/da = 0.6, over the root of three values
  EXPECT_LT(found.half_width(0), 0.1);
}

TEST(FitStatistics, WhatTheDataDoNotDetermineHidesNothingElse) {
  std::mt19937_64 random(4);
  const auto t = times(20), y = noisy(t, 1, 0.3, random);
  const char* product = "param a = 1, b = 0.5, c = 1\ns' = 0\ns(0) = 0\noutput y = a + b*c*t\nrun 0..10\n";
  const Fit found = fit(request_of(product, {"a", "b", "c"}, {data_of("y", t, y)}));
  ASSERT_TRUE(found.found()) << found.status.message;
  const Straight expected = straight(t, y);
  EXPECT_NEAR(found.estimates[0].deviation, expected.deviation_a, 0.05 * expected.deviation_a);  // 17 and 18 degrees
  EXPECT_TRUE(found.estimates[1].undetermined);
  EXPECT_TRUE(found.estimates[2].undetermined);
  ASSERT_EQ(found.sure.directions.size(), 1u);
  EXPECT_NEAR(found.sure.directions[0][1], -found.sure.directions[0][2], 1e-4);  // b c stays
}

TEST(FitStatistics, ALimitOfIterationsIsNoMinimum) {
  std::mt19937_64 random(5);
  const auto t = times(20);
  const char* wave = "param a = 5, w = 1.3\ns' = 0\ns(0) = 0\noutput y = a*sin(w*t) + exp(-w*t)\nrun 0..10\n";
  std::vector<double> y;
  for (const double at : t) y.push_back(2 * std::sin(at) + std::exp(-at));
  FitRequest request = request_of(wave, {"a", "w"}, {data_of("y", t, y)});
  request.options.most_iterations = 2;
  request.starts_in_doubt = 0;
  const Fit found = fit(request);
  ASSERT_TRUE(found.found());
  EXPECT_FALSE(found.least.converged);
  EXPECT_TRUE(found.doubts_of(FitDoubt::Kind::not_converged));
}

// sin(w t) has a minimum of its own near every multiple of some frequency: from w = 3 the search ends in one.
TEST(FitStatistics, AFalseMinimumIsLeftForABetterOne) {
  std::mt19937_64 random(6);
  const auto t = times(60);
  const char* wave = "param w = 3 in 0.1..6\ns' = 0\ns(0) = 0\noutput y = sin(w*t)\nrun 0..10\n";
  std::normal_distribution<double> noise(0, 0.05);
  std::vector<double> y;
  for (const double at : t) y.push_back(std::sin(1.5 * at) + noise(random));
  FitRequest request = request_of(wave, {"w"}, {data_of("y", t, y)});
  request.unknowns[0].low = 0.1, request.unknowns[0].high = 6;
  request.data[0].columns[0].deviation = 0.05;
  request.starts_in_doubt = 0;
  const Fit stuck = fit(request);
  EXPECT_GT(std::abs(stuck.estimates[0].value - 1.5), 0.5);
  EXPECT_TRUE(stuck.doubts_of(FitDoubt::Kind::residuals_too_large));
  request.starts_in_doubt = 10;
  const Fit found = fit(request);
  EXPECT_NEAR(found.estimates[0].value, 1.5, 0.01);
  EXPECT_TRUE(found.doubts_of(FitDoubt::Kind::better_start));
  EXPECT_FALSE(found.doubts_of(FitDoubt::Kind::residuals_too_large));
}

// Of a straight line the profile is a parabola, and its interval that of Student.
TEST(FitStatistics, ProfilesOfAStraightLineAreItsIntervals) {
  std::mt19937_64 random(7);
  const auto t = times(9), y = noisy(t, 1, 0.3, random);
  const FitRequest request = request_of(line, {"a", "b"}, {data_of("y", t, y)});
  const Fit found = fit(request);
  for (const Profile& profile : profiles_of(request, found)) {
    const FitEstimate& estimate = found.estimates[profile.unknown];
    EXPECT_NEAR(profile.low, estimate.low, 1e-3 * estimate.deviation);  // it ends at 1e-4 of the threshold's root
    EXPECT_NEAR(profile.high, estimate.high, 1e-3 * estimate.deviation);
    EXPECT_FALSE(profile.better);
  }
}

// y = a/(a + t) hardly depends on a if a is large: the profile has a lower limit and no upper one.
TEST(FitStatistics, AProfileMayHaveNoLimit) {
  const char* saturation = "param a = 50\ns' = 0\ns(0) = 0\noutput y = a/(a + t)\nrun 0..10\n";
  FitRequest request = request_of(saturation, {"a"}, {data_of("y", {1, 2, 3}, {0.99, 0.97, 0.98})});
  request.data[0].columns[0].deviation = 0.02;
  const Fit found = fit(request);
  const Profile profile = profiles_of(request, found)[0];
  EXPECT_TRUE(std::isinf(profile.high));
  double rise = 0, best = 0;
  const double y[] = {0.99, 0.97, 0.98};
  for (int i = 0; i < 3; ++i) {
    rise += std::pow((profile.low / (profile.low + i + 1) - y[i]) / 0.02, 2);
    best += std::pow((found.estimates[0].value / (found.estimates[0].value + i + 1) - y[i]) / 0.02, 2);
  }
  EXPECT_NEAR(rise - best, std::pow(1.959964, 2), 2e-3);  // twice 1e-4 of the root
}

// A prior is one more measurement: of normal ones the weights add.
TEST(FitStatistics, PriorsAddWhatWasKnown) {
  std::mt19937_64 random(8);
  const auto t = times(12), y = noisy(t, 1, 0.3, random);
  FitRequest request = request_of(line, {"a"}, {data_of("y", t, y)});
  request.experiment.parameters["b"] = 0.5;
  request.data[0].columns[0].deviation = 0.3;
  request.unknowns[0].prior = {.kind = FitPrior::Kind::normal, .center = 3, .deviation = 0.1};
  const Fit found = fit(request);
  double mean = 0;
  for (std::size_t i = 0; i < t.size(); ++i) mean += (y[i] - 0.5 * t[i]) / 12;
  const double of_data = 12 / 0.09, of_prior = 1 / 0.01;
  EXPECT_NEAR(found.estimates[0].value, (of_data * mean + of_prior * 3) / (of_data + of_prior), 1e-8);
  EXPECT_NEAR(found.estimates[0].deviation, 1 / std::sqrt(of_data + of_prior), 1e-8);
  EXPECT_EQ(found.statistics.values, 12u);
}

// y = a with values whose logarithm is normal: the geometric mean, and on its own scale an interval of factors.
TEST(FitStatistics, LogarithmsOfUnknownsAndOfValues) {
  const char* constant = "param a = 1\ns' = 0\ns(0) = 0\noutput y = a\nrun 0..10\n";
  const std::vector<double> y{1, 10, 100, 50, 20};
  FitRequest request = request_of(constant, {"a"}, {data_of("y", {0, 1, 2, 3, 4}, y)});
  request.unknowns[0].logarithmic = true;
  request.data[0].columns[0].error = ErrorModel::lognormal;
  const Fit found = fit(request);
  ASSERT_TRUE(found.found()) << found.status.message;
  double mean = 0, square = 0;
  for (const double value : y) mean += std::log(value) / 5;
  for (const double value : y) square += std::pow(std::log(value) - mean, 2) / 4;
  EXPECT_NEAR(found.estimates[0].value, std::exp(mean), 1e-8 * std::exp(mean));
  EXPECT_NEAR(found.estimates[0].high, std::exp(mean + student_t_quantile(0.95, 4) * std::sqrt(square / 5)), 1e-4);
  EXPECT_NEAR(found.columns[0].residual_deviation, std::sqrt(square), 1e-8);
}

// y = a: of counts the mean is most likely, of errors in proportion to a the mean again, with a^2 (mean square)/n.
TEST(FitStatistics, DeviationsMayDependOnWhatTheModelSays) {
  const char* constant = "param a = 30\ns' = 0\ns(0) = 0\noutput y = a\nrun 0..10\n";
  const std::vector<double> y{12, 18, 15, 20, 15, 10};
  FitRequest request = request_of(constant, {"a"}, {data_of("y", {0, 1, 2, 3, 4, 5}, y)});
  request.data[0].columns[0].error = ErrorModel::poisson;
  Fit found = fit(request);
  EXPECT_NEAR(found.estimates[0].value, 15, 1e-6);
  EXPECT_NEAR(found.estimates[0].deviation, std::sqrt(15.0 / 6), 1e-2);  // deviations settle to 1e-3
  request.data[0].columns[0].error = ErrorModel::proportional;
  found = fit(request);
  EXPECT_NEAR(found.estimates[0].value, 15, 1e-6);
  EXPECT_NEAR(found.columns[0].residual_deviation_relative, std::sqrt(68.0 / 5) / 15, 1e-3);
}

TEST(FitStatistics, RefusesValuesThatTheirErrorsMakeImpossible) {
  FitRequest request = request_of(line, {"a"}, {data_of("y", {0, 1}, {1, -1})});
  request.data[0].columns[0].error = ErrorModel::lognormal;
  EXPECT_THAT(fit(request).status.message, HasSubstr("y.csv:3: -1 in column `y` cannot have a lognormal error"));
  request.data[0].columns[0].error = ErrorModel::poisson;
  EXPECT_THAT(fit(request).status.message, HasSubstr("y.csv:3: -1 in column `y` is no count"));
  request.data[0].columns[0].error = ErrorModel::constant;
  // The squares of these values are infinite or zero: a fit would report that the data do not determine a.
  for (const double size : {1e200, 1e-200}) {
    request.data[0].measurements.values[0] = {size, 2 * size};
    EXPECT_THAT(fit(request).status.message, HasSubstr("to be squared: give it in another unit"));
  }
  request.data[0].measurements.values[0] = {1, 2};
  request.data[0].columns[0].deviation = 1e-200;
  EXPECT_EQ(fit(request).status.message, "y.csv: y: a deviation of 1e-200 is too small to be squared (--sigma)");
  request.data[0].columns[0].deviation.reset();
  request.data[0].measurements.columns.push_back("s");
  request.data[0].measurements.values.push_back({1, 1e-80});
  request.data[0].columns[0].deviations_in = 1;
  EXPECT_EQ(fit(request).status.message,
            "y.csv:3: 1e-80 in column `s` is too small to be squared: give it in another unit");
  request.data[0].columns[0].deviations_in.reset();
  request.unknowns[0].prior = {.center = 1e300, .deviation = 1};
  EXPECT_EQ(fit(request).status.message, "a: a prior about 1e+300 is too far away to be squared (--prior)");
  request.unknowns[0].prior = {.center = 1, .deviation = 1e-300};
  EXPECT_EQ(fit(request).status.message, "a: a deviation of 1e-300 is too small to be squared (--prior)");
  request.unknowns[0].prior.reset();
  request.unknowns[0].start = -1, request.unknowns[0].logarithmic = true;
  EXPECT_THAT(fit(request).status.message, HasSubstr("only what is positive has a logarithm"));
}

/// How likely a new measurement of y = a (1 + t) at a time is within `half` of `middle`: Student's t for each ratio of
/// the two variances, weighted by restricted likelihood and the reference prior, in a plain sum over its logarithm.
double probability_of_measurement(const std::vector<double>& t, const std::vector<double>& y, double fitted, double at,
                                  double middle, double half) {
  const std::size_t n = t.size();
  const double degrees = static_cast<double>(n) - 1;
  double all = 0, within = 0;
  for (double ratio = std::exp(-40.0); ratio < std::exp(40.0); ratio *= std::exp(0.02)) {
    const auto variance = [&](double time) { return (1 + ratio * std::pow(fitted * (1 + time), 2)) / (1 + ratio); };
    double weights = 0, sum = 0, logarithms = 0, squares = 0;
    for (std::size_t i = 0; i < n; ++i) {
      weights += std::pow(1 + t[i], 2) / variance(t[i]), sum += (1 + t[i]) * y[i] / variance(t[i]);
      logarithms += std::log(variance(t[i]));
    }
    const double a = sum / weights;
    double trace = 0, square_trace = 0, of_squares = 0;  // of P D, D = dV/d log ratio at the same constant part
    for (std::size_t i = 0; i < n; ++i) {
      squares += std::pow(y[i] - a * (1 + t[i]), 2) / variance(t[i]);
      const double part = 1 - 1 / (1 + ratio) / variance(t[i]), h = std::pow(1 + t[i], 2) / variance(t[i]) / weights;
      trace += part * (1 - h), square_trace += part * part * (1 - 2 * h), of_squares += part * h;
    }
    square_trace += of_squares * of_squares;
    const double information = std::max(square_trace - trace * trace / degrees, 0.0);
    const double weight =
        std::exp(-logarithms / 2 - std::log(weights) / 2 - degrees / 2 * std::log(squares)) * std::sqrt(information);
    const double s = std::sqrt(squares / degrees * (variance(at) + std::pow(1 + at, 2) / weights));
    const double off = a * (1 + at) - middle;
    all += weight;
    within +=
        weight * (student_t_probability((half - off) / s, degrees) - student_t_probability((-half - off) / s, degrees));
  }
  return within / all;
}

TEST(FitStatistics, BandsMixTheRatiosOfTwoDeviationsAsIntervalsDo) {
  const std::vector<double> t{0, 1, 2, 5, 9}, y{1.3, 1.7, 3.2, 5.1, 10.9};
  FitRequest request =
      request_of("param a = 1\ns' = 0\ns(0) = 0\noutput y = a*(1 + t)\nrun 0..10\n", {"a"}, {data_of("y", t, y)});
  request.data[0].columns[0].error = ErrorModel::both;
  const Fit found = fit(request);
  ASSERT_TRUE(found.found()) << found.status.message;
  const std::vector<FitCurve> curves = curves_of(request, found, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const double half = curves[0].high[i] - curves[0].y[i];
    // The quadrature of a smooth density with 48 points has an error of a tenth of a percent; the increase of the
    // deviation by Kenward and Roger's correction cancels.
    EXPECT_NEAR(probability_of_measurement(t, y, found.estimates[0].value, curves[0].t[i], curves[0].y[i], half), 0.95,
                1.5e-3)
        << curves[0].t[i];
  }
}

// Of 200 intervals of 95 % 190 are expected with a deviation of 3.1; four of that to both sides.
TEST(FitStatistics, RobustIntervalsHoldTheTruthAsOftenAsTheySay) {
  std::mt19937_64 random(9);
  const auto t = times(25);
  FitRequest request = request_of(line, {"a", "b"}, {data_of("y", t, {})});
  for (const Loss loss : {Loss::huber, Loss::soft_l1, Loss::cauchy, Loss::tukey}) {
    request.options.loss = loss;
    int inside = 0;
    for (int repeat = 0; repeat < 200; ++repeat) {
      request.data[0].measurements.values[0] = noisy(t, 1, 0.3, random);
      const Fit found = fit(request);
      inside += found.estimates[1].low <= 0.5 && 0.5 <= found.estimates[1].high ? 1 : 0;
    }
    EXPECT_GE(inside, 178) << static_cast<int>(loss);
  }
}

/// The number of intervals of a and b and of bands of y and z that contain the true value, for y = a + b t and z = 10 y
/// in rows of two deviations each.
std::array<int, 4> held_by_two_columns(std::size_t rows, int fits) {
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal(0, 1);
  const auto t = times(rows);
  FitRequest request = request_of(line, {"a", "b"}, {data_of("y", t, {}), data_of("z", t, {})});
  for (FitData& data : request.data) data.columns[0].error = ErrorModel::both;
  request.starts_in_doubt = 0;
  const auto measure = [&](double at, double factor) {
    const double y = factor * (2 + 0.5 * at);
    return y + 0.15 * factor * normal(random) + 0.04 * y * normal(random);
  };
  std::array<int, 4> held{};
  for (int repeat = 0; repeat < fits; ++repeat) {
    for (const std::size_t d : {0U, 1U}) {
      request.data[d].measurements.values[0].clear();
      for (const double at : t) request.data[d].measurements.values[0].push_back(measure(at, d == 0 ? 1 : 10));
    }
    const Fit found = fit(request);
    EXPECT_TRUE(found.found()) << found.status.message;
    EXPECT_FALSE(found.sure.ratios_failed);
    held[0] += found.estimates[0].low <= 2 && 2 <= found.estimates[0].high ? 1 : 0;
    held[1] += found.estimates[1].low <= 0.5 && 0.5 <= found.estimates[1].high ? 1 : 0;
    const std::vector<FitCurve> curves = curves_of(request, found, 2);
    for (const std::size_t d : {0U, 1U}) {
      const double value = measure(curves[d].t[1], d == 0 ? 1 : 10);
      held[2 + d] += curves[d].low[1] <= value && value <= curves[d].high[1] ? 1 : 0;
    }
  }
  return held;
}

// Of n intervals of 95 % 0.95 n are expected with a deviation of (0.95 0.05 n)^(1/2): of each kind within three of
// that.
TEST(FitStatistics, SeveralColumnsOfTwoDeviationsEachHoldTheTruthAsOftenAsTheySay) {
  constexpr int fits = 100;
  const double expected = 0.95 * fits, deviation = std::sqrt(0.95 * 0.05 * fits);
  for (const std::size_t rows : {5U, 8U}) {
    const auto held = held_by_two_columns(rows, fits);
    for (const int inside : held) EXPECT_GE(inside, expected - 3 * deviation) << rows;
    RecordProperty("inside " + std::to_string(rows), fmt::format("{} {} {} {}", held[0], held[1], held[2], held[3]));
  }
}

}  // namespace
}  // namespace continuo::studies::fit_statistics_test
