// Products, lengths and distances of vectors, for what follows branches.
#pragma once
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace continuo::studies::detail {

[[nodiscard]] inline double product(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}
[[nodiscard]] inline double length(std::span<const double> v) {
  return std::sqrt(product(v, v));
}
/// Each component in its own unit; without units all are 1.
[[nodiscard]] inline double distance(std::span<const double> a, std::span<const double> b,
                                     std::span<const double> units = {}) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double apart = units.empty() ? a[i] - b[i] : (a[i] - b[i]) / units[i];
    sum += apart * apart;
  }
  return std::sqrt(sum);
}
/// a + part (b - a)
[[nodiscard]] inline std::vector<double> between(std::vector<double> a, std::span<const double> b, double part) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += part * (b[i] - a[i]);
  return a;
}
inline void normalize(std::vector<double>& v) {
  const double size = length(v);
  for (double& part : v) part /= size;
}

}  // namespace continuo::studies::detail
