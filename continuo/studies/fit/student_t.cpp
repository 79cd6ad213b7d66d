// Student's t distribution, by Boost.Math.
#include <boost/math/distributions/students_t.hpp>

#include <continuo/studies/fit/student_t.hpp>

namespace continuo::studies {

namespace {

namespace policies = boost::math::policies;

/// No exceptions: what has no value is NaN, what is too large infinite.
using Quiet =
    policies::policy<policies::domain_error<policies::ignore_error>, policies::overflow_error<policies::ignore_error>,
                     policies::evaluation_error<policies::ignore_error>,
                     // long double would be five times as slow, and mixtures need probabilities by the million.
                     policies::promote_double<false>>;
using StudentT = boost::math::students_t_distribution<double, Quiet>;

}  // namespace

double student_t_probability(double t, double degrees) {
  return boost::math::cdf(StudentT(degrees), t);
}

double student_t_quantile(double confidence, double degrees) {
  return boost::math::quantile(StudentT(degrees), 0.5 + confidence / 2);
}

}  // namespace continuo::studies
