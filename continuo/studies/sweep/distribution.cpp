// Distributions of uncertain quantities. Their formulas are evaluated in long double, and rounded once.
#include <cmath>
#include <limits>

#include <boost/math/special_functions/erf.hpp>
#include <fmt/format.h>

#include <continuo/studies/sweep/distribution.hpp>

namespace continuo::studies {
namespace {

namespace policies = boost::math::policies;

/// Of the normal distribution with mean 0 and deviation 1.
long double standard_quantile(double u) {
  using WithoutExceptions =
      policies::policy<policies::domain_error<policies::ignore_error>, policies::overflow_error<policies::ignore_error>,
                       policies::evaluation_error<policies::ignore_error>>;
  if (u <= 0) return -std::numeric_limits<long double>::infinity();
  if (u >= 1) return std::numeric_limits<long double>::infinity();
  constexpr long double root_of_two = 1.41421356237309504880168872420969808L;
  return -root_of_two * boost::math::erfc_inv(2 * static_cast<long double>(u), WithoutExceptions());
}

/// The value without spread, where infinity times zero would be no number.
long double stretched(long double middle, long double deviation, long double z) {
  return deviation > 0 ? middle + deviation * z : middle;
}

long double value_at(const Uniform& d, long double u) {
  return (1 - u) * d.low + u * d.high;  // the ends exactly
}
long double value_at(const Normal& d, double u) {
  return stretched(d.mean, d.deviation, standard_quantile(u));
}
long double value_at(const Lognormal& d, double u) {
  return d.median * std::exp(stretched(0, d.deviation_of_logarithm, standard_quantile(u)));
}
long double value_at(const Triangular& d, long double u) {
  const long double low = d.low, mode = d.mode, high = d.high;
  if (u * (high - low) <= mode - low) return low + std::sqrt(u * (high - low) * (mode - low));
  return high - std::sqrt((1 - u) * (high - low) * (high - mode));
}

std::string fault_of(const Uniform& d) {
  if (d.low > d.high)
    return fmt::format("uniform({}, {}): the ends are out of order; write uniform({}, {})", d.low, d.high, d.high,
                       d.low);
  return {};
}
std::string fault_of(const Normal& d) {
  if (d.deviation < 0)
    return fmt::format("normal({}, {}): the deviation is below 0; write the mean first, then the standard deviation",
                       d.mean, d.deviation);
  return {};
}
std::string fault_of(const Lognormal& d) {
  if (d.median <= 0)
    return fmt::format(
        "lognormal({0}, {1}): the median is not above 0; write the median of the quantity first, exp(m) where m is the "
        "mean "
        "of its logarithm, then the standard deviation of the logarithm",
        d.median, d.deviation_of_logarithm);
  if (d.deviation_of_logarithm < 0)
    return fmt::format(
        "lognormal({}, {}): the deviation is below 0; write the median first, then the standard deviation of the "
        "logarithm",
        d.median, d.deviation_of_logarithm);
  return {};
}
std::string fault_of(const Triangular& d) {
  if (d.low > d.high)
    return fmt::format("triangular({}, {}, {}): the ends are out of order; write low, mode, high", d.low, d.mode,
                       d.high);
  if (d.mode < d.low || d.mode > d.high)
    return fmt::format("triangular({}, {}, {}): the mode is not between the ends; write low, mode, high", d.low, d.mode,
                       d.high);
  return {};
}

bool is_finite(const Uniform& d) {
  return std::isfinite(d.low) && std::isfinite(d.high);
}
bool is_finite(const Normal& d) {
  return std::isfinite(d.mean) && std::isfinite(d.deviation);
}
bool is_finite(const Lognormal& d) {
  return std::isfinite(d.median) && std::isfinite(d.deviation_of_logarithm);
}
bool is_finite(const Triangular& d) {
  return std::isfinite(d.low) && std::isfinite(d.mode) && std::isfinite(d.high);
}

double mean_of(const Uniform& d) {
  return d.low / 2 + d.high / 2;
}
double mean_of(const Normal& d) {
  return d.mean;
}
double mean_of(const Lognormal& d) {
  const long double s = d.deviation_of_logarithm;
  return static_cast<double>(d.median * std::exp(s * s / 2));
}
double mean_of(const Triangular& d) {
  return d.low / 3 + d.mode / 3 + d.high / 3;
}

double deviation_of(const Uniform& d) {
  return static_cast<double>((static_cast<long double>(d.high) - d.low) / std::sqrt(12.0L));
}
double deviation_of(const Normal& d) {
  return d.deviation;
}
double deviation_of(const Lognormal& d) {
  const long double s = d.deviation_of_logarithm;
  return static_cast<double>(d.median * std::exp(s * s / 2) * std::sqrt(std::expm1(s * s)));
}
double deviation_of(const Triangular& d) {
  const long double left = static_cast<long double>(d.mode) - d.low, right = static_cast<long double>(d.high) - d.mode;
  return static_cast<double>(std::sqrt((left * left + left * right + right * right) / 18));
}

}  // namespace

std::string_view distribution_parameters(std::string_view name) {
  if (name == "uniform") return "low, high";
  if (name == "normal") return "mean, deviation";
  if (name == "lognormal") return "median, deviation of the logarithm";
  if (name == "triangular") return "low, mode, high";
  return {};
}

Result<Distribution> distribution_named(std::string_view name, std::span<const double> parameters) {
  const std::string_view meaning = distribution_parameters(name);
  if (meaning.empty())
    return invalid_input(fmt::format("{} is no distribution; there are {}", name, fmt::join(distribution_names, ", ")));
  if (parameters.size() != (name == "triangular" ? 3u : 2u))
    return invalid_input(fmt::format("{} has {} numbers; write {}({})", name, parameters.size(), name, meaning));
  Distribution result;
  if (name == "uniform") result = Uniform{parameters[0], parameters[1]};
  if (name == "normal") result = Normal{parameters[0], parameters[1]};
  if (name == "lognormal") result = Lognormal{parameters[0], parameters[1]};
  if (name == "triangular") result = Triangular{parameters[0], parameters[1], parameters[2]};
  if (Status status = check(result); !status) return status;
  return result;
}

Status check(const Distribution& distribution) {
  if (!std::visit([](const auto& d) { return is_finite(d); }, distribution))
    return invalid_input(fmt::format("{}: a number is not finite", distribution_names[distribution.index()]));
  return invalid_input(std::visit([](const auto& d) { return fault_of(d); }, distribution));
}

double quantile(const Distribution& distribution, double u) {
  if (!(u >= 0 && u <= 1)) return std::numeric_limits<double>::quiet_NaN();
  return std::visit([u](const auto& d) { return static_cast<double>(value_at(d, u)); }, distribution);
}

double mean(const Distribution& distribution) {
  return std::visit([](const auto& d) { return mean_of(d); }, distribution);
}

double deviation(const Distribution& distribution) {
  return std::visit([](const auto& d) { return deviation_of(d); }, distribution);
}

}  // namespace continuo::studies
