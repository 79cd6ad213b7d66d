// bench/measure.hpp
// All solvers on one problem.
#pragma once
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include <bench/work_precision.hpp>

namespace continuo::bench {

/// Compiled problem by problem in bench/ours and bench/peers: with fixed sizes every solver becomes code of its own.
template <class Problem>
std::vector<Solver> our_solvers();
template <class Problem>
std::vector<Solver> odeint_solvers(double first_step);

struct Measured {
  std::string_view name, title;
  std::vector<Curve> curves;
};

/// The errors at which solvers are compared, and the range of errors that is measured.
inline constexpr std::array<double, 2> errors_compared{1e-6, 1e-10};
inline constexpr double loosest_error = 1e-4, tightest_error = 1e-12;

template <class Problem>
Measured measure(double seconds_to_spend) {
  std::vector<Solver> solvers = our_solvers<Problem>();
  // A thousandth of the run suits all five problems; the peer's control finds its own size within a few steps.
  for (Solver& solver : odeint_solvers<Problem>(Problem::duration / 1000)) solvers.push_back(std::move(solver));
  return {Problem::name, Problem::title, sweep(solvers, loosest_error, tightest_error, seconds_to_spend)};
}

}  // namespace continuo::bench
