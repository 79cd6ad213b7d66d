// What of an orbit's multipliers goes through zero where its stability changes. Internal to what follows orbits.
#pragma once
#include <complex>
#include <cstddef>
#include <span>

namespace continuo::studies::detail {

/// Of size 1 at most.
struct MultiplierTests {
  double unity = 0;     // a multiplier is 1
  double doubling = 0;  // a multiplier is -1
  double torus = 0;     // the product of two multipliers is 1
};

/// Products over the multipliers, each factor of size 1 at most.
[[nodiscard]] inline MultiplierTests tests_of(std::span<const std::complex<double>> values) {
  std::complex<double> unity = 1, doubling = 1, torus = 1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    unity *= (1.0 - values[i]) / (1 + std::abs(values[i]));
    doubling *= (1.0 + values[i]) / (1 + std::abs(values[i]));
    for (std::size_t j = i + 1; j < values.size(); ++j)
      torus *= (1.0 - values[i] * values[j]) / (1 + std::abs(values[i] * values[j]));
  }
  return {unity.real(), doubling.real(), values.size() > 1 ? torus.real() : 1};
}

}  // namespace continuo::studies::detail
