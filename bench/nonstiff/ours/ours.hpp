// bench/nonstiff/ours/ours.hpp
// Our methods as anybody would call them: one `solve`, the tolerance (or the step) and nothing else set.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <bench/nonstiff/measure.hpp>

#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/dormand_prince5.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/explicit_rk/verner7.hpp>
#include <continuo/methods/explicit_rk/verner9.hpp>
#include <continuo/methods/extrapolation/odex.hpp>
#include <continuo/methods/multistep/adams.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom12.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom6.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom8.hpp>
#include <continuo/methods/symplectic/kahan_li8.hpp>
#include <continuo/methods/symplectic/mclachlan_atela4.hpp>
#include <continuo/methods/symplectic/yoshida6.hpp>
#include <continuo/solve/automatic.hpp>

namespace continuo::bench {

/// `M` is a method, or none for what `solve` takes by itself; `set(options, tolerance)` says how accurate.
template <class Problem, class... M, class Set>
Solver our_solver(std::string_view name, Set set) {
  using State = std::array<double, Problem::size>;
  const auto run = [set](double tolerance) {
    Options<State> options{.save = Save<State>::only_end()};
    set(options, tolerance);
    return solve(Problem{}, Problem::start(), {0, Problem::duration}, M{}..., options);
  };
  return {std::string(name), true,
          [run](double tolerance) {
            const auto solution = run(tolerance);
            if (!solution.outcome) return Answer{};
            return Answer{end_error<Problem>(solution.final_state()), solution.statistics.evaluations};
          },
          [run](double tolerance) { return timed([&] { return run(tolerance).final_state(); }); }};
}

template <class Problem, class... M>
Solver our_adaptive_solver(std::string_view name) {
  return our_solver<Problem, M...>(name,
                                   [](auto& options, double tolerance) { options.rtol = options.atol = tolerance; });
}

/// The step with which the error would be 1, were it proportional to step^order for long steps too: from the first of
/// ever shorter steps whose error is small enough for that to hold.
template <class Problem, class M>
double step_of_error_one() {
  using State = std::array<double, Problem::size>;
  constexpr double small = 1e-4;
  double step = Problem::duration / 64, error = 1;
  for (int halvings = 0; halvings < 12 && !(error < small); ++halvings) {
    step /= 2;
    const Options<State> options{.step = step, .save = Save<State>::only_end()};
    error = end_error<Problem>(solve(Problem{}, Problem::start(), {0, Problem::duration}, M{}, options).final_state());
  }
  return step * std::pow(error, -1.0 / M::order);
}
/// Methods with fixed steps have no tolerance: they are given the step from which an error of that size is expected.
/// Many short steps are what they are made of: their runs may take longer.
template <class Problem, class M>
Solver our_fixed_solver() {
  Solver solver = our_solver<Problem, M>(
      M::name, [of_error_one = step_of_error_one<Problem, M>()](auto& options, double tolerance) {
        options.step = of_error_one * std::pow(tolerance, 1.0 / M::order);
      });
  solver.slowest = slowest_of_fixed_steps;
  return solver;
}

template <class Problem, class... M>
void add_adaptive(std::vector<Solver>& solvers) {
  (solvers.push_back(our_adaptive_solver<Problem, M>(M::name)), ...);
}
template <class Problem, class... M>
void add_fixed(std::vector<Solver>& solvers) {
  (solvers.push_back(our_fixed_solver<Problem, M>()), ...);
}

/// The named methods, and for problems q'' = a(t, q) those made for them: Runge-Kutta-Nystrom and symplectic ones.
template <class Problem>
std::vector<Solver> our_solvers() {
  std::vector<Solver> solvers{our_adaptive_solver<Problem>(default_choice)};
  add_adaptive<Problem, DormandPrince5, Tsitouras5, Dop853, Verner7, Verner9, Adams, Odex>(solvers);
  if constexpr (SecondOrder<Problem>) {
    add_adaptive<Problem, DormandPrinceNystrom6, DormandPrinceNystrom8, DormandPrinceNystrom12>(solvers);
    add_fixed<Problem, McLachlanAtela4, Yoshida6, KahanLi8>(solvers);
  }
  return solvers;
}

}  // namespace continuo::bench
