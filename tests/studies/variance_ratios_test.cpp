// Intervals with an unknown ratio of two variances, against integrals by plain sums.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/studies/fit/student_t.hpp>
#include <continuo/studies/fit/variance_ratios.hpp>

namespace continuo::studies::variance_ratios_test {
namespace {

const std::vector<double> measured{2.3, 1.1, 2.9, 2.0, 4.4};

/// A constant that was measured with noise of two kinds, and the residuals of its mean by the weights of some
/// variances.
struct Constant {
  VarianceComponents noise;
  std::vector<double> off, rows;

  explicit Constant(const std::vector<double>& factors)
      : noise{.rows = {}, .components = {{.variance = 0.4}, {.variance = 0.1}}}, off{}, rows(measured.size(), 1) {
    for (const double factor : factors) noise.rows.push_back({.shares = {{{0, 1}, {1, factor}}}});
    double sum = 0, weights = 0;
    const auto weigh = [&] {
      sum = weights = 0;
      for (std::size_t i = 0; i < measured.size(); ++i)
        sum += measured[i] / noise.variance(i), weights += 1 / noise.variance(i);
      off.clear();
      for (const double value : measured) off.push_back(sum / weights - value);
    };
    weigh();
    for (int round = 0; round < 50; ++round) {
      estimate_variances(noise, off, rows, Loss::squares);
      weigh();
    }
  }
  double mean() const { return measured[0] + off[0]; }
};

double half_width(const Constant& constant) {
  const std::vector<double> sizes{1};
  Uncertainty sure = uncertainty(constant.noise, constant.off, constant.rows, Loss::squares, sizes);
  detail::widen_by_ratios(sure, constant.noise, constant.off, constant.rows, sizes, 1e-12);
  return sure.factors[0] * std::sqrt(sure.covariance[0]);
}

/// The probability of the constant's being within `half` of `middle`: Student's t for each part w of the second kind,
/// weighted by restricted likelihood and the root of the information about log w, tr(P D P D)/2 - (tr P D)^2/(2 (n -
/// 1)).
double probability(const std::vector<double>& factors, double middle, double half) {
  constexpr int many = 6000;
  constexpr double farthest = 60;  // of the ratio's logarithm
  const auto n = static_cast<Eigen::Index>(measured.size());
  const double degrees = static_cast<double>(n) - 1;
  double all = 0, within = 0;
  for (int k = 0; k < many; ++k) {
    const double ratio = std::exp(farthest * (2 * (k + 0.5) / many - 1)), w = ratio / (1 + ratio);
    Eigen::VectorXd v(n), d(n), y(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double factor = factors[static_cast<std::size_t>(i)];
      v[i] = 1 / (1 + ratio) + w * factor, d[i] = factor, y[i] = measured[static_cast<std::size_t>(i)];
    }
    const Eigen::VectorXd u = v.cwiseInverse();
    const Eigen::MatrixXd inverse = u.asDiagonal();
    const Eigen::MatrixXd p = inverse - u * u.transpose() / u.sum();
    const Eigen::MatrixXd pd = w * p * d.asDiagonal();  // d v/d log w at the same constant part
    const double information = (pd * pd).trace() - std::pow(pd.trace(), 2) / degrees;
    const double mean = u.dot(y) / u.sum(), squares = (y.array() - mean).square().matrix().dot(u);
    const double likelihood = std::pow(v.prod() * u.sum(), -0.5) * std::pow(squares, -degrees / 2);
    const double weight = likelihood * std::sqrt(std::max(information, 0.0));
    const double s = std::sqrt(squares / degrees / u.sum());
    all += weight;
    within += weight * (student_t_probability((middle + half - mean) / s, degrees) -
                        student_t_probability((middle - half - mean) / s, degrees));
  }
  return within / all;
}

// Rows with equal factors contain no information on the ratio, and need none: the mean of five values as in textbooks.
TEST(VarianceRatios, AreNothingWhereAllRowsAreAlike) {
  const Constant constant({1, 1, 1, 1, 1});
  double squares = 0;
  for (const double off : constant.off) squares += off * off;
  const double expected = student_t_quantile(0.95, 4) * std::sqrt(squares / 4 / 5);
  EXPECT_NEAR(half_width(constant), expected, 1e-4 * expected);
}

TEST(VarianceRatios, AreIntegratedOver) {
  for (const std::vector<double>& factors : {std::vector{0.2, 0.5, 1.0, 2.0, 5.0},
                                             {9.0, 0.1, 3.0, 1.0, 0.4},
                                             {1.0, 1.0, 1.0, 1.0, 30.0},
                                             {1e-6, 1e-3, 1.0, 1e3, 1e6},
                                             {1e-9, 1e-9, 1.0, 1.0, 1e9}}) {
    const Constant constant(factors);
    // The quadrature of a smooth density with 48 points has an error of a tenth of a percent.
    EXPECT_NEAR(probability(factors, constant.mean(), half_width(constant)), 0.95, 1e-3);
  }
}

// Where one of the two variances is known and negligible, only the other one matters: Student's t again.
TEST(VarianceRatios, AreWhereTheLikelihoodIsThoughOneVarianceIsKnownToBeTiny) {
  for (const double known : {1e-120, 1e-24, 1e-12, 1e-6}) {
    Constant constant({1, 1, 1, 1, 1});
    constant.noise.components = {{.variance = known, .known = true}, {.variance = 0.1}};
    for (int round = 0; round < 50; ++round)
      estimate_variances(constant.noise, constant.off, constant.rows, Loss::squares);
    double squares = 0;
    for (const double off : constant.off) squares += off * off;
    const double expected = student_t_quantile(0.95, 4) * std::sqrt(squares / 4 / 5);
    EXPECT_NEAR(half_width(constant), expected, 1e-3 * expected) << known;
  }
}

// Where no ratio has any likelihood, the factors remain unchanged, and this is reported.
TEST(VarianceRatios, SayWhereTheyCannotBeIntegratedOver) {
  Constant constant({0.2, 0.5, 1, 2, 5});
  const std::vector<double> sizes{1};
  Uncertainty sure = uncertainty(constant.noise, constant.off, constant.rows, Loss::squares, sizes);
  Uncertainty good = sure;
  detail::widen_by_ratios(good, constant.noise, constant.off, constant.rows, sizes, 1e-12);
  EXPECT_FALSE(good.ratios_failed);
  EXPECT_FALSE(good.ratios.empty());
  constant.off[2] = std::numeric_limits<double>::quiet_NaN();
  const double before = sure.factors[0];
  detail::widen_by_ratios(sure, constant.noise, constant.off, constant.rows, sizes, 1e-12);
  EXPECT_TRUE(sure.ratios_failed);
  EXPECT_EQ(sure.factors[0], before);
}

}  // namespace
}  // namespace continuo::studies::variance_ratios_test
