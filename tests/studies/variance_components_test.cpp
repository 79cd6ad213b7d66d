// Deviations of columns, and the resulting uncertainty of the unknowns: closed forms, and restricted likelihood by a
// grid.
#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/studies/fit/chi_squared.hpp>
#include <continuo/studies/fit/variance_components.hpp>

namespace continuo::studies::variance_components_test {
namespace {

/// y = a + b t in two columns of other lengths and noise, with the residuals of some weighted fit: b and a that solve
/// it.
struct Line {
  std::size_t first, second;
  std::vector<double> y, rows;  // the derivatives 1, t

  Line(std::size_t n1, std::size_t n2, double s1, double s2, unsigned seed) : first(n1), second(n2) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0, 1);
    for (std::size_t i = 0; i < n1 + n2; ++i) {
      const bool early = i < n1;
      const double t = early ? static_cast<double>(i) : 0.37 * static_cast<double>(i - n1);
      rows.push_back(1), rows.push_back(t);
      y.push_back(2 - 0.5 * t + (early ? s1 : s2) * noise(random));
    }
  }
  std::size_t size() const { return first + second; }
  VarianceComponents noise(double v1, double v2) const {
    VarianceComponents result{
        .rows = std::vector<VarianceRow>(size()), .components = {{.variance = v1}, {.variance = v2}}, .groups = 2};
    for (std::size_t i = first; i < size(); ++i) result.rows[i] = {.shares = {{{1, 1}, {1, 0}}}, .group = 1};
    return result;
  }
  Eigen::MatrixXd design() const {
    return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>>(
        rows.data(), static_cast<Eigen::Index>(size()), 2);
  }
  Eigen::VectorXd weights(const VarianceComponents& noise) const {
    Eigen::VectorXd w(static_cast<Eigen::Index>(size()));
    for (std::size_t i = 0; i < size(); ++i) w[static_cast<Eigen::Index>(i)] = 1 / noise.variance(i);
    return w;
  }
  /// Model less measured, at the weighted least squares.
  std::vector<double> residuals(const VarianceComponents& noise) const {
    const Eigen::MatrixXd x = design();
    const Eigen::VectorXd w = weights(noise), v = Eigen::Map<const Eigen::VectorXd>(y.data(), w.size());
    const Eigen::VectorXd p = (x.transpose() * w.asDiagonal() * x).ldlt().solve(x.transpose() * w.asDiagonal() * v);
    const Eigen::VectorXd r = x * p - v;
    return {r.begin(), r.end()};
  }
  /// -2 log of the restricted likelihood.
  double badness(double v1, double v2) const {
    const VarianceComponents n = noise(v1, v2);
    const Eigen::VectorXd w = weights(n);
    const std::vector<double> off = residuals(n);
    double sum = std::log((design().transpose() * w.asDiagonal() * design()).determinant());
    for (std::size_t i = 0; i < size(); ++i) sum += std::log(n.variance(i)) + off[i] * off[i] / n.variance(i);
    return sum;
  }
};

const std::vector<double> sizes{1, 1};

TEST(VarianceComponents, OfOneColumnAreThatOfTheTextbooks) {
  const Line line(12, 0, 0.3, 1, 1);
  VarianceComponents noise = line.noise(7, 1);
  noise.components.resize(1), noise.groups = 1;
  const std::vector<double> off = line.residuals(noise);
  estimate_variances(noise, off, line.rows, Loss::squares);
  double squares = 0;
  for (const double r : off) squares += r * r;
  EXPECT_NEAR(noise.components[0].variance, squares / 10, 1e-12 * squares);
  const Uncertainty sure = uncertainty(noise, off, line.rows, Loss::squares, sizes);
  const Eigen::MatrixXd expected = squares / 10 * (line.design().transpose() * line.design()).inverse();
  for (const int i : {0, 1})
    for (const int j : {0, 1})
      EXPECT_NEAR(sure.covariance[static_cast<std::size_t>(2 * i + j)], expected(i, j), 1e-9 * expected(0, 0));
  EXPECT_NEAR(sure.degrees[0], 10, 1e-6);
  EXPECT_NEAR(sure.group_degrees[0], 10, 1e-9);
}

// The referee does not use leverages: it evaluates the restricted likelihood itself on a grid.
TEST(VarianceComponents, OfTwoColumnsAreTheLeastOfRestrictedLikelihood) {
  for (const auto& [n1, n2, seed] : {std::tuple{5, 5, 2U}, {6, 40, 3U}, {30, 5, 4U}, {100, 7, 5U}}) {
    const Line line(static_cast<std::size_t>(n1), static_cast<std::size_t>(n2), 0.2, 3, seed);
    VarianceComponents noise = line.noise(1, 1);
    for (int round = 0; round < 200; ++round)
      estimate_variances(noise, line.residuals(noise), line.rows, Loss::squares);
    const double v1 = noise.components[0].variance, v2 = noise.components[1].variance, best = line.badness(v1, v2);
    for (const double f : {0.5, 0.8, 0.95, 1.05, 1.25, 2.0})
      for (const double g : {0.5, 0.8, 0.95, 1.0, 1.05, 1.25, 2.0}) EXPECT_GT(line.badness(f * v1, g * v2), best);
    for (const double g : {0.5, 0.8, 0.95, 1.05, 1.25, 2.0}) EXPECT_GT(line.badness(v1, g * v2), best);
  }
}

TEST(VarianceComponents, KnownOnesStayAndLeaveNoDoubt) {
  const Line line(8, 6, 0.2, 3, 6);
  VarianceComponents noise = line.noise(0.04, 9);
  for (VarianceComponent& component : noise.components) component.known = true;
  const std::vector<double> off = line.residuals(noise);
  estimate_variances(noise, off, line.rows, Loss::squares);
  EXPECT_EQ(noise.components[1].variance, 9);
  const Uncertainty sure = uncertainty(noise, off, line.rows, Loss::squares, sizes);
  EXPECT_TRUE(std::isinf(sure.degrees[0]));
  const Eigen::MatrixXd expected =
      (line.design().transpose() * line.weights(noise).asDiagonal() * line.design()).inverse();
  EXPECT_NEAR(sure.covariance[3], expected(1, 1), 1e-9 * expected(1, 1));
}

// Two unknowns of which the data determine only the sum, and one that is well determined.
TEST(VarianceComponents, WhatIsNotDeterminedHidesNothingElse) {
  const Line line(10, 0, 0.1, 1, 7);
  VarianceComponents noise = line.noise(0.01, 1);
  noise.components.resize(1), noise.groups = 1;
  std::vector<double> rows;
  for (std::size_t i = 0; i < line.size(); ++i)
    rows.insert(rows.end(), {line.rows[2 * i], line.rows[2 * i], line.rows[2 * i + 1]});
  const std::vector<double> off = line.residuals(noise), three{1, 4, 1};
  const Uncertainty plain = uncertainty(noise, off, line.rows, Loss::squares, sizes);
  const Uncertainty sure = uncertainty(noise, off, rows, Loss::squares, three);
  EXPECT_EQ(sure.undetermined, (std::vector<char>{1, 1, 0}));
  EXPECT_TRUE(std::isinf(sure.covariance[0]));
  EXPECT_NEAR(sure.covariance[8], plain.covariance[3], 1e-9 * plain.covariance[3]);
  ASSERT_EQ(sure.directions.size(), 1u);
  EXPECT_NEAR(sure.directions[0][0], 1, 1e-9);  // +1 of 1 against -1 of 4
  EXPECT_NEAR(sure.directions[0][1], -0.25, 1e-9);
  EXPECT_NEAR(sure.directions[0][2], 0, 1e-9);
}

// R: pchisq(3.841458820694124, 1, lower = FALSE) = 0.05; e^(-x/2) of two degrees.
TEST(ChiSquared, TailIsThatOfTheTables) {
  EXPECT_NEAR(chi_squared_tail(3.841458820694124, 1), 0.05, 1e-12);
  EXPECT_NEAR(chi_squared_tail(7, 2), std::exp(-3.5), 1e-15);
  EXPECT_EQ(chi_squared_tail(0, 5), 1);
}

}  // namespace
}  // namespace continuo::studies::variance_components_test
