// bench/stiff/measure.hpp
// The stiff problems and how they are measured: which absolute tolerance goes with a relative one, and what an error
// is.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

#include <bench/problems/brusselator_line.hpp>
#include <bench/problems/brusselator_line_reference.hpp>
#include <bench/problems/hires.hpp>
#include <bench/problems/oregonator.hpp>
#include <bench/problems/pollution.hpp>
#include <bench/problems/robertson.hpp>
#include <bench/problems/van_der_pol.hpp>
#include <bench/solver.hpp>

namespace continuo::bench {

/// Compiled problem by problem in bench/stiff/ours and bench/stiff/peers.
template <class Problem>
std::vector<Solver> our_stiff_solvers();
/// Ours that must keep their tolerance but take no part in the race: the automatic pairs, whose stiff half does, and
/// implicit Euler.
template <class Problem>
std::vector<Solver> our_unraced_solvers();
/// Ours on the problem as a model of the gallery, with the Jacobian of its graph; only where there is one that large.
std::vector<Solver> our_brusselator_model_solvers();
/// Boost.odeint's only stiff method, with the problem's own dense Jacobian.
template <class Problem>
std::vector<Solver> odeint_stiff_solvers();
/// CVODE of SUNDIALS; empty where the benchmarks are built without it.
template <class Problem>
std::vector<Solver> cvode_solvers();
/// The GNU Scientific Library's stiff methods, with the problem's own dense Jacobian; empty where the benchmarks are
/// built without it.
template <class Problem>
std::vector<Solver> gsl_stiff_solvers();

/// atol = absolute_part<Problem> * rtol, for all solvers alike: small enough for the components to count relative to
/// their size. HIRES, Oregonator and van der Pol as in F. Mazzia and others, Test Set for IVP Solvers, and Hairer's
/// drivers; Robertson's first component ends at 2e-8, the substances of the air at 4e-18 to 0.3.
template <class Problem>
inline constexpr double absolute_part = 1;
template <>
inline constexpr double absolute_part<Robertson<>> = 1e-10;
template <>
inline constexpr double absolute_part<Hires<>> = 1e-4;
template <>
inline constexpr double absolute_part<Oregonator<>> = 1e-6;
template <>
inline constexpr double absolute_part<Pollution<>> = 1e-8;

/// The state at the end of the run and the components of `x` that go with it.
template <class Problem>
std::vector<double> exact_end() {
  if constexpr (std::is_same_v<Problem, BrusselatorLine<>>) {
    return brusselator_line_end<double>();
  } else {
    const auto x = end_of<Problem>();
    return {x.begin(), x.end()};
  }
}
template <class Problem, class X>
std::vector<double> compared(const X& x) {
  if constexpr (std::is_same_v<Problem, BrusselatorLine<>>) {
    return every_seventh(x);
  } else {
    return {x.begin(), x.end()};
  }
}

/// Errors are relative to each component; in tolerances, to atol + rtol times the component. The largest counts.
template <class Problem, class X>
Answer judged(const X& end, double rtol, std::size_t evaluations) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> exact = exact_end<Problem>(), x = compared<Problem>(end);
  Answer answer{0, evaluations, 0};
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double error = std::abs(x[i] - exact[i]), size = std::abs(exact[i]);
    answer.error = std::max(answer.error, std::isfinite(error) ? error / size : infinity);
    answer.tolerances =
        std::max(answer.tolerances, std::isfinite(error) ? error / (rtol * (absolute_part<Problem> + size)) : infinity);
  }
  return answer;
}

}  // namespace continuo::bench
