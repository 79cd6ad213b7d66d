// bench/stiff/ours/ours.hpp
// Our stiff methods as anybody would call them: one `solve`, the tolerances and nothing else set.
#pragma once
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <bench/stiff/measure.hpp>

#include <continuo/methods/automatic.hpp>
#include <continuo/methods/collocation/radau.hpp>
#include <continuo/methods/dirk/implicit_euler.hpp>
#include <continuo/methods/dirk/kencarp4.hpp>
#include <continuo/methods/dirk/kvaerno5.hpp>
#include <continuo/methods/dirk/tr_bdf2.hpp>
#include <continuo/methods/extrapolation/seulex.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/rosenbrock/rodas4.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/methods/rosenbrock/rosenbrock23.hpp>
#include <continuo/solve/automatic.hpp>

namespace continuo::bench {

/// `System` is the problem, or the problem with a sparse Jacobian; `M` a method, or none for what `solve` takes by
/// itself. A method of order 2 needs more steps at 1e-11 than a run may take by default.
template <class Problem, class System, class... M>
Solver our_stiff_solver(std::string_view name) {
  const auto run = [](double tolerance) {
    System system;
    auto start = system.start();
    using State = decltype(start);
    return solve(std::move(system), std::move(start), {0, Problem::duration}, M{}...,
                 Options<State>{.rtol = tolerance,
                                .atol = tolerance * absolute_part<Problem>,
                                .max_steps = std::numeric_limits<std::size_t>::max(),
                                .save = Save<State>::only_end()});
  };
  return {std::string(name), true,
          [run](double tolerance) {
            const auto solution = run(tolerance);
            if (!solution.outcome) return Answer{};
            return judged<Problem>(solution.final_state(), tolerance, solution.statistics.evaluations);
          },
          [run](double tolerance) { return timed([&] { return run(tolerance).final_state(); }); }};
}

template <class Problem, class System, class... M>
std::vector<Solver> our_stiff_solvers_by() {
  return {our_stiff_solver<Problem, System, M>(M::name)...};
}
template <class Problem, class System = Problem>
std::vector<Solver> all_our_stiff_solvers() {
  std::vector<Solver> solvers = our_stiff_solvers_by<Problem, System, Rodas5P, Rodas4, Radau, Radau5, Bdf, Seulex,
                                                     Kvaerno5, KenCarp4, TrBdf2, Rosenbrock23>();
  solvers.insert(solvers.begin(), our_stiff_solver<Problem, System>(default_choice));
  return solvers;
}

template <class Problem, class System = Problem>
std::vector<Solver> all_our_unraced_solvers() {
  return our_stiff_solvers_by<Problem, System, Tsitouras5Rodas5P, Dop853Radau, Tsitouras5Bdf, ImplicitEuler>();
}

}  // namespace continuo::bench
