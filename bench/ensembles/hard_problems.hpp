// The ensembles of ensemble_ratios that are harder than Lorenz, after tutorials of the program MPGOS, and how both
// sides are compared: at the same largest error over all runs.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include <bench/processor_time.hpp>

namespace continuo::bench {

/// The bubble of Keller and Miksis under two frequencies: stiff collapses, a right-hand side with powers and sines.
void compare_bubbles();
/// The pressure relief valve of Hos and Champneys, whose body strikes its seat: impacts within each run.
void compare_valves();
/// Stiff ones: the reaction of Robertson, the equation of Van der Pol.
void compare_stiff_runs();

/// The largest error of all runs, in units of 1 + |x|.
template <class X>
[[nodiscard]] double largest_error_of(const std::vector<X>& ends, const std::vector<X>& exact) {
  double largest = 0;
  for (std::size_t run = 0; run < ends.size(); ++run)
    for (std::size_t i = 0; i < ends[run].size(); ++i) {
      const double error = std::abs(ends[run][i] - exact[run][i]) / (1 + std::abs(exact[run][i]));
      largest = std::isfinite(error) ? std::max(largest, error) : HUGE_VAL;
    }
  return largest;
}

/// What runs cost at the loosest tolerance, in steps of a quarter of a power of ten, that keeps their largest error
/// below `allowed`.
struct Cost {
  double seconds = HUGE_VAL, tolerance = 0, error = HUGE_VAL;
};
template <class X, class Run>
[[nodiscard]] Cost cost_at(double allowed, const std::vector<X>& exact, Run&& run) {
  Cost cost;
  for (double exponent = 5; exponent <= 13; exponent += 0.25) {
    cost.tolerance = std::pow(10, -exponent);
    cost.error = largest_error_of(run(cost.tolerance), exact);
    if (cost.error < allowed) break;
  }
  for (int i = 0; i < 3; ++i) {
    const double begin = processor_seconds();
    static_cast<void>(run(cost.tolerance));
    cost.seconds = std::min(cost.seconds, processor_seconds() - begin);
  }
  return cost;
}

inline void print_cost(const std::string& who, const Cost& cost, std::size_t runs, const Cost& unit) {
  std::printf("  %-34s tol %-7.1e %9.0f runs/s  largest error %.1e  %6.2f times odeint\n", who.c_str(), cost.tolerance,
              static_cast<double>(runs) / cost.seconds, cost.error, unit.seconds / cost.seconds);
}

}  // namespace continuo::bench
