// bench/stiff/ours/ours.hpp
// Our stiff methods as anybody would call them: one `solve`, the tolerances and nothing else set.
#pragma once
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <bench/stiff/measure.hpp>

#include <continuo/methods/automatic.hpp>
#include <continuo/methods/bdf.hpp>
#include <continuo/methods/implicit_euler.hpp>
#include <continuo/methods/kencarp4.hpp>
#include <continuo/methods/kvaerno5.hpp>
#include <continuo/methods/radau.hpp>
#include <continuo/methods/rodas4.hpp>
#include <continuo/methods/rodas5p.hpp>
#include <continuo/methods/rosenbrock23.hpp>
#include <continuo/methods/tr_bdf2.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::bench {

/// `System` is the problem, or the problem with a sparse Jacobian. A method of order 2 needs more steps at 1e-11 than a
/// run may take by default.
template <class Problem, class M, class System = Problem>
Solver our_stiff_solver() {
  const auto run = [](double tolerance) {
    System system;
    auto start = system.start();
    using State = decltype(start);
    return solve(std::move(system), std::move(start), {0, Problem::duration}, M{},
                 {.rtol = tolerance,
                  .atol = tolerance * absolute_part<Problem>,
                  .max_steps = std::numeric_limits<std::size_t>::max(),
                  .save = Save<State>::only_end()});
  };
  return {std::string(M::name), true,
          [run](double tolerance) {
            const auto solution = run(tolerance);
            if (!solution.outcome) return Answer{};
            return judged<Problem>(solution.final_state(), tolerance, solution.statistics.evaluations);
          },
          [run](double tolerance) { return timed([&] { return run(tolerance).final_state(); }); }};
}

template <class Problem, class System = Problem>
std::vector<Solver> all_our_stiff_solvers() {
  return {our_stiff_solver<Problem, Rodas5P, System>(),     our_stiff_solver<Problem, Rodas4, System>(),
          our_stiff_solver<Problem, Radau, System>(),       our_stiff_solver<Problem, Radau5, System>(),
          our_stiff_solver<Problem, Bdf, System>(),         our_stiff_solver<Problem, Kvaerno5, System>(),
          our_stiff_solver<Problem, KenCarp4, System>(),    our_stiff_solver<Problem, TrBdf2, System>(),
          our_stiff_solver<Problem, Rosenbrock23, System>()};
}

template <class Problem, class System = Problem>
std::vector<Solver> all_our_unraced_solvers() {
  return {our_stiff_solver<Problem, Tsitouras5Rodas5P, System>(), our_stiff_solver<Problem, Dop853Radau, System>(),
          our_stiff_solver<Problem, Tsitouras5Bdf, System>(), our_stiff_solver<Problem, ImplicitEuler, System>()};
}

}  // namespace continuo::bench
