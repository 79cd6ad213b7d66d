// bench/solver.hpp
// One solver on one problem, ours or a peer's, behind the same few lines: a tolerance in, the end of the run out.
#pragma once
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>

#include <bench/reference/end_values.hpp>

namespace continuo::bench {

/// What a run costs and what it is worth.
struct Answer {
  double error = std::numeric_limits<double>::infinity();
  std::size_t evaluations = 0;
  double tolerances = std::numeric_limits<double>::infinity();  // the error in units of what was asked
};

struct Solver {
  std::string name;
  bool ours = false;
  std::function<Answer(double)> judge;    // tolerance -> error and evaluations, by a run that counts
  std::function<double(double)> seconds;  // tolerance -> wall time of a run that does nothing else
};

/// The largest error of a component, relative where the component is greater than one.
template <class Problem>
double end_error(const std::array<double, Problem::size>& x) {
  double worst = 0;
  for (std::size_t i = 0; i < Problem::size; ++i) {
    const double exact = end_value<Problem>[i];
    worst = std::max(worst, std::abs(x[i] - exact) / std::max(1.0, std::abs(exact)));
  }
  return std::isfinite(worst) ? worst : std::numeric_limits<double>::infinity();
}

/// Wall time of `run()`, whose result is kept from being optimised away.
template <class Run>
double timed(Run&& run) {
  const auto begin = std::chrono::steady_clock::now();
  const auto result = run();
  const auto end = std::chrono::steady_clock::now();
  volatile double sink = result[0];
  static_cast<void>(sink);
  return std::chrono::duration<double>(end - begin).count();
}

}  // namespace continuo::bench
