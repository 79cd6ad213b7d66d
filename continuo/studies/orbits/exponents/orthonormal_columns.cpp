// The modified process of Gram and Schmidt, and means over parts of a run.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <continuo/studies/orbits/exponents/orthonormal_columns.hpp>

namespace continuo::studies {

namespace {

constexpr std::size_t parts_of_run = 20;

double inner_product_of(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// What of a column lies along those before it goes.
void take_out(std::span<double> columns, std::size_t n, std::size_t k) {
  const auto column = [&](std::size_t j) { return columns.subspan(n * j, n); };
  for (std::size_t j = 0; j < k; ++j) {
    const double share = inner_product_of(column(j), column(k));
    for (std::size_t i = 0; i < n; ++i) column(k)[i] -= share * column(j)[i];
  }
}

/// Some direction that those before it do not have.
void renew(std::span<double> columns, std::size_t n, std::size_t k) {
  const auto column = columns.subspan(n * k, n);
  for (std::size_t axis = 0; axis < n; ++axis) {
    std::ranges::fill(column, 0.0);
    column[axis] = 1;
    take_out(columns, n, k);
    if (inner_product_of(column, column) > 0.5 / static_cast<double>(n)) return;
  }
}

/// Mean and standard error of exponent k.
struct Mean {
  double value, error;
};
Mean mean_of(const std::vector<Stretch>& stretches, std::size_t k, double averaged) {
  const std::size_t count = stretches.size(), groups = std::min(parts_of_run, count);
  double sum = 0, square = 0;
  for (const Stretch& stretch : stretches) sum += stretch.logarithms[k];
  const double mean = sum / averaged;
  for (std::size_t g = 0; g < groups; ++g) {
    double part = 0, duration = 0;
    for (std::size_t s = g * count / groups; s < (g + 1) * count / groups; ++s) {
      part += stretches[s].logarithms[k];
      duration += stretches[s].duration;
    }
    square += std::pow(part / duration - mean, 2);
  }
  const auto of = static_cast<double>(groups);
  return {mean, groups > 1 ? std::sqrt(square / (of * (of - 1))) : std::abs(mean)};
}

}  // namespace

std::vector<double> orthonormalise(std::span<double> columns, std::size_t n) {
  std::vector<double> logarithms(n == 0 ? 0 : columns.size() / n);
  for (std::size_t k = 0; k < logarithms.size(); ++k) {
    const auto column = columns.subspan(n * k, n);
    take_out(columns, n, k);
    double length = std::sqrt(inner_product_of(column, column));
    logarithms[k] = std::log(length);
    if (!(length > 0)) {
      renew(columns, n, k);
      length = std::sqrt(inner_product_of(column, column));
    }
    for (double& entry : column) entry /= length;
  }
  return logarithms;
}

void average(LyapunovExponents& result, const std::vector<Stretch>& stretches) {
  if (stretches.empty()) return;
  for (const Stretch& stretch : stretches) result.averaged += stretch.duration;
  std::vector<Mean> means;
  for (std::size_t k = 0; k < stretches.front().logarithms.size(); ++k)
    means.push_back(mean_of(stretches, k, result.averaged));
  // Directions that nothing mixes keep the order that they began in.
  std::ranges::sort(means, std::greater<>(), &Mean::value);
  for (const Mean& mean : means) {
    result.exponents.push_back(mean.value);
    result.spread.push_back(mean.error);
  }
}

}  // namespace continuo::studies
