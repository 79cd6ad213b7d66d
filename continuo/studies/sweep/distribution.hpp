// How a quantity that is not known exactly is distributed: normal, uniform, lognormal, triangular.
//
//   const Result<Distribution> c = distribution_named("normal", std::array{0.5, 0.1});
//   quantile(*c, 0.975);  // 0.69600
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <continuo/status/result.hpp>

namespace continuo::studies {

/// Every value from low to high is as likely as any other.
struct Uniform {
  double low = 0, high = 1;
};
/// The bell curve.
struct Normal {
  double mean = 0, deviation = 1;
};
/// The logarithm is normal. The median has the unit of the quantity; the deviation is that of the logarithm, a relative
/// deviation where it is small. A prior of a fit has the same two numbers.
struct Lognormal {
  double median = 1, deviation_of_logarithm = 1;
};
/// The density rises in a straight line from low to the mode and falls in a straight line to high.
struct Triangular {
  double low = 0, mode = 0.5, high = 1;
};
/// Any of them, in whatever unit its numbers have.
using Distribution = std::variant<Uniform, Normal, Lognormal, Triangular>;

/// The names by which `distribution_named` knows them.
inline constexpr std::array<std::string_view, 4> distribution_names{"uniform", "normal", "lognormal", "triangular"};

/// What the numbers of a distribution mean: "low, high", "mean, deviation", "median, deviation of the logarithm",
/// "low, mode, high"; empty for another name.
[[nodiscard]] std::string_view distribution_parameters(std::string_view name);

/// The distribution of this name with these numbers, in the order of `distribution_parameters`; the reason where there
/// is none.
[[nodiscard]] Result<Distribution> distribution_named(std::string_view name, std::span<const double> parameters);

/// What is wrong with a distribution, and how to mend it; a success where nothing is.
Status check(const Distribution& distribution);

/// The value that the quantity stays below with probability u, from 0 to 1; NaN for any other u. The distribution must
/// have passed `check`. Accurate to rounding.
[[nodiscard]] double quantile(const Distribution& distribution, double u);

/// The mean of the quantity.
[[nodiscard]] double mean(const Distribution& distribution);
/// The standard deviation of the quantity.
[[nodiscard]] double deviation(const Distribution& distribution);

}  // namespace continuo::studies
