// The tail of the chi-squared distribution, by Boost.Math.
#include <algorithm>

#include <boost/math/special_functions/gamma.hpp>

#include <continuo/studies/fit/chi_squared.hpp>

namespace continuo::studies {

double chi_squared_tail(double x, double degrees) {
  return boost::math::gamma_q(degrees / 2, std::max(x, 0.0) / 2);
}

}  // namespace continuo::studies
