// Compares our methods with Boost.odeint, GSL and CVODE on five problems at equal true error, and follows the energy of
// a planet over a hundred thousand orbits.
//   against_nonstiff [FOLDER [SECONDS [PROBLEM...]]]: the page nonstiff.md and the plots go to FOLDER.
#include <string>
#include <utility>
#include <vector>

#include <bench/command.hpp>
#include <bench/nonstiff/drift.hpp>
#include <bench/nonstiff/measure.hpp>
#include <bench/nonstiff/page.hpp>

namespace continuo::bench {
namespace {

template <class Problem>
Measured measure(double seconds) {
  // A run of more than a fifth of a second is not repeated: the table then ends at larger errors.
  constexpr Tolerances tolerances{.points_per_decade = 6, .tightest_power = 15.5, .slowest = slowest_run};
  // A thousandth of the run suits all five problems; the peer's control finds its own size within a few steps.
  constexpr double first_step = Problem::duration / 1000;
  std::vector<Solver> solvers = our_solvers<Problem>();
  for (std::vector<Solver> peers :
       {odeint_solvers<Problem>(first_step), gsl_solvers<Problem>(first_step), cvode_adams_solvers<Problem>()})
    for (Solver& solver : peers) solvers.push_back(std::move(solver));
  return {Problem::name, Problem::title, sweep(solvers, 1e-3, 1e-14, seconds, tolerances)};
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  using namespace continuo::bench;
  const Command command = read_command(count, arguments);
  std::vector<Drift> drifts;
  if (command.wants("drift")) {
    drifts = measure_drift();
    write_drift(command.folder, drifts);
  }
  std::vector<Measured> all;
  const auto add = [&](std::string_view name, Measured (*measure)(double)) {
    if (!command.wants(name)) return;
    all.push_back(measure(command.seconds));
    print_costs(all.back(), nonstiff_errors);
    write_curves(command.folder, all.back());
    write_nonstiff_page(command.folder + "/nonstiff.md", all, drifts);  // after every problem: nothing is lost
  };
  add(Lorenz::name, measure<Lorenz>);
  add(Arenstorf::name, measure<Arenstorf>);
  add(Kepler::name, measure<Kepler>);
  add(Pleiades::name, measure<Pleiades>);
  add(OuterPlanets::name, measure<OuterPlanets>);
}
