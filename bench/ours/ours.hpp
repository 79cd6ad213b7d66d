// bench/ours/ours.hpp
// Our methods as anybody would call them: one `solve`, the tolerance and nothing else set.
#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <bench/measure.hpp>

#include <continuo/methods/dop853.hpp>
#include <continuo/methods/dormand_prince5.hpp>
#include <continuo/methods/dormand_prince_nystrom12.hpp>
#include <continuo/methods/dormand_prince_nystrom8.hpp>
#include <continuo/methods/tsitouras5.hpp>
#include <continuo/methods/verner7.hpp>
#include <continuo/methods/verner9.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::bench {

template <class Problem, class M>
Solver our_solver() {
  using State = std::array<double, Problem::size>;
  const auto run = [](double tolerance) {
    return solve(Problem{}, Problem::start(), {0, Problem::duration}, M{},
                 {.rtol = tolerance, .atol = tolerance, .save = Save<State>::only_end()});
  };
  return {std::string(M::name), true,
          [run](double tolerance) {
            const auto solution = run(tolerance);
            if (!solution.outcome) return Answer{};
            return Answer{end_error<Problem>(solution.final_state()), solution.statistics.evaluations};
          },
          [run](double tolerance) { return timed([&] { return run(tolerance).final_state(); }); }};
}

/// The named methods, and for problems q'' = a(t, q) the Runge-Kutta-Nystrom pairs made for them.
template <class Problem>
std::vector<Solver> our_solvers() {
  std::vector<Solver> solvers{our_solver<Problem, DormandPrince5>(), our_solver<Problem, Tsitouras5>(),
                              our_solver<Problem, Dop853>(), our_solver<Problem, Verner7>(),
                              our_solver<Problem, Verner9>()};
  if constexpr (SecondOrder<Problem>) {
    solvers.push_back(our_solver<Problem, DormandPrinceNystrom8>());
    solvers.push_back(our_solver<Problem, DormandPrinceNystrom12>());
  }
  return solvers;
}

}  // namespace continuo::bench
