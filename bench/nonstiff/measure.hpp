// bench/nonstiff/measure.hpp
// The problems that are not stiff and how they are measured.
#pragma once
#include <string>
#include <vector>

#include <bench/problems/arenstorf.hpp>
#include <bench/problems/kepler.hpp>
#include <bench/problems/lorenz.hpp>
#include <bench/problems/outer_planets.hpp>
#include <bench/problems/pleiades.hpp>
#include <bench/solver.hpp>

namespace continuo::bench {

/// Compiled problem by problem in bench/nonstiff/ours and bench/nonstiff/peers: with fixed sizes every solver becomes
/// code of its own.
template <class Problem>
std::vector<Solver> our_solvers();
template <class Problem>
std::vector<Solver> odeint_solvers(double first_step);
/// Of the GNU Scientific Library; empty where the benchmarks are built without it.
template <class Problem>
std::vector<Solver> gsl_solvers(double first_step);
/// Adams' methods of CVODE; empty where the benchmarks are built without SUNDIALS.
template <class Problem>
std::vector<Solver> cvode_adams_solvers();

/// Seconds of a run that is worth repeating.
inline constexpr double slowest_run = 0.2, slowest_of_fixed_steps = 0.6;

}  // namespace continuo::bench
