#include <cmath>

#include <gtest/gtest.h>

#include <continuo/studies/fit/student_t.hpp>

namespace continuo::studies::student_t_test {
namespace {

TEST(StudentT, QuantilesAreThoseOfTheTables) {  // to the digits that tables print
  EXPECT_NEAR(student_t_quantile(0.95, 1), 12.7062, 5e-5);
  EXPECT_NEAR(student_t_quantile(0.95, 4), 2.7764, 5e-5);
  EXPECT_NEAR(student_t_quantile(0.95, 10), 2.2281, 5e-5);
  EXPECT_NEAR(student_t_quantile(0.99, 30), 2.7500, 5e-5);
  EXPECT_NEAR(student_t_quantile(0.95, 1e9), 1.95996, 5e-6);
}

TEST(StudentT, IsCauchysDistributionForOneDegree) {  // 1/2 + atan(t)/pi
  for (const double t : {-3.0, -0.5, 0.0, 0.1, 2.0, 50.0})
    EXPECT_NEAR(student_t_probability(t, 1), 0.5 + std::atan(t) / std::acos(-1), 1e-14) << t;
}

TEST(StudentT, HasNoValueWithoutDegreesOfFreedom) {
  EXPECT_TRUE(std::isnan(student_t_quantile(0.95, 0)));
  EXPECT_TRUE(std::isnan(student_t_quantile(0.95, -1)));
  EXPECT_TRUE(std::isnan(student_t_quantile(0.95, std::nan(""))));
}

}  // namespace
}  // namespace continuo::studies::student_t_test
