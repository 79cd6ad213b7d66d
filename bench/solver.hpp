// bench/solver.hpp
// One solver on one problem, ours or a peer's, behind the same few lines: a tolerance in, the end of the run out.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

#include <bench/processor_time.hpp>
#include <bench/reference/end_values.hpp>

namespace continuo::bench {

/// What a run costs and what it is worth.
struct Answer {
  double error = std::numeric_limits<double>::infinity();
  std::size_t evaluations = 0;
  double tolerances = std::numeric_limits<double>::infinity();  // the error in units of what was asked
};

/// The solver that is no method of its own: what `solve` takes where nobody names one.
inline constexpr std::string_view default_choice = "default";

struct Solver {
  std::string name;
  bool ours = false;
  std::function<Answer(double)> judge;    // tolerance -> error and evaluations, by a run that counts
  std::function<double(double)> seconds;  // tolerance -> wall time of a run that does nothing else
  double slowest = 0;                     // a longer run is not worth repeating; 0: as the sweep says
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

/// Time of the processor for `run()`, whose result is kept from being optimised away. Not by the clock on the wall:
/// others may have the processor in between, and of a long run not even the least of many times is free of that.
template <class Run>
double timed(Run&& run) {
  const double begin = processor_seconds();
  const auto result = run();
  const double end = processor_seconds();
  volatile double sink = result[0];
  static_cast<void>(sink);
  return end - begin;
}

}  // namespace continuo::bench
