// Products and lengths of vectors, for what follows branches.
#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

namespace continuo::studies::detail {

inline double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}
inline double length(const std::vector<double>& v) {
  return std::sqrt(product(v, v));
}
inline void normalize(std::vector<double>& v) {
  const double size = length(v);
  for (double& part : v) part /= size;
}

}  // namespace continuo::studies::detail
