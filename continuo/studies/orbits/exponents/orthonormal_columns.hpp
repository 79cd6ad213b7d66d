// Distances of neighbours in independent directions, and the averages of their logarithms. Internal to lyapunov.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include <continuo/studies/lyapunov.hpp>

namespace continuo::studies {

/// The logarithms of one interval, and how long it was.
struct Stretch {
  double duration;
  std::vector<double> logarithms;
};

/// The columns become orthonormal (Gram, Schmidt, modified), each of n numbers; the logarithms of what each was long.
/// One without a length of its own gets a direction of its own.
[[nodiscard]] std::vector<double> orthonormalise(std::span<double> columns, std::size_t n);

/// Mean of each exponent over twenty parts of the run, and the standard error of that mean.
void average(LyapunovExponents& result, const std::vector<Stretch>& stretches);

}  // namespace continuo::studies
