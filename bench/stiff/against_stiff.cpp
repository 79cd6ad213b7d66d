// Compares our stiff methods with rosenbrock4 of Boost.odeint and with CVODE on the stiff problems of the field at
// equal true error, and says how far every method of ours is from the tolerance it was asked for.
//   against_stiff [FOLDER [SECONDS [PROBLEM...]]]: the page stiff.md and the plots go to FOLDER.
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <bench/command.hpp>
#include <bench/report.hpp>
#include <bench/stiff/measure.hpp>
#include <bench/stiff/page.hpp>

namespace continuo::bench {
namespace {

/// Every method of ours at rtol = 1e-3 ... 1e-11; no further once a run takes longer than some seconds, for the next
/// may take ten times as long.
std::vector<Kept> kept_tolerances(const std::vector<Solver>& solvers) {
  constexpr double longest = 12;
  std::vector<Kept> kept;
  for (const Solver& solver : solvers) {
    kept.push_back({solver.name, {}});
    kept.back().error.fill(std::numeric_limits<double>::quiet_NaN());
    double seconds = 0;
    for (std::size_t i = 0; i < tolerances_asked.size() && seconds < longest; ++i) {
      const auto begin = std::chrono::steady_clock::now();
      kept.back().error[i] = solver.judge(std::pow(10, -tolerances_asked[i])).tolerances;
      seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }
  }
  return kept;
}

template <class Problem>
StiffResult measure_stiff(double seconds) {
  // A run of more than a fifth of a second is not repeated: the table then ends at larger errors.
  constexpr Tolerances tolerances{.points_per_decade = 4, .tightest_power = 14, .slowest = 0.2};
  std::vector<Solver> solvers = our_stiff_solvers<Problem>();
  if constexpr (std::is_same_v<Problem, BrusselatorLine<>>) {
    for (Solver& solver : our_brusselator_model_solvers()) solvers.push_back(std::move(solver));
  }
  std::vector<Solver> peers = cvode_solvers<Problem>();
  if constexpr (requires { Problem::size; }) {
    for (Solver& solver : odeint_stiff_solvers<Problem>()) peers.push_back(std::move(solver));
    for (Solver& solver : gsl_stiff_solvers<Problem>()) peers.push_back(std::move(solver));
  }
  for (Solver& solver : peers) solvers.push_back(std::move(solver));
  StiffResult result;
  result.measured = {Problem::name, Problem::title, sweep(solvers, 1e-2, 1e-13, seconds, tolerances)};
  return result;
}

template <class Problem>
std::vector<Kept> keep_stiff() {
  std::vector<Solver> solvers = our_stiff_solvers<Problem>();
  for (Solver& solver : our_unraced_solvers<Problem>()) solvers.push_back(std::move(solver));
  return kept_tolerances(solvers);
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  using namespace continuo::bench;
  const Command command = read_command(count, arguments);
  std::vector<StiffResult> all;
  std::vector<std::vector<Kept> (*)()> keeps;
  const auto write = [&] { write_page(command.folder + "/stiff.md", all); };  // often: what is measured is not lost
  const auto add = [&]<class Problem>(const std::vector<Wanted>& ratios) {
    if (!command.wants(Problem::name)) return;
    all.push_back(measure_stiff<Problem>(command.seconds));
    keeps.push_back(keep_stiff<Problem>);
    all.back().wanted = ratios;
    print_costs(all.back());
    write_curves(command.folder, all.back().measured);
    write();
  };
  // At most this part of the peer's time is wanted.
  add.operator()<Robertson<>>({{1e-6, 0.5, of_odeint}, {1e-10, 0.15, of_odeint}});
  add.operator()<Hires<>>({{1e-6, 0.2, of_odeint}, {1e-10, 0.045, of_odeint}});
  add.operator()<Oregonator<>>({{1e-6, 0.45, of_odeint}, {1e-8, 0.18, of_odeint}});
  add.operator()<VanDerPolScaled<>>({{1e-6, 0.5, of_odeint}, {1e-10, 0.08, of_odeint}});
  add.operator()<Pollution<>>({{1e-6, 0.13, of_odeint}, {1e-10, 0.017, of_odeint}});
  add.operator()<BrusselatorLine<>>({{1e-6, 0.12, of_cvode}, {1e-6, 0.12, of_cvode, of_model}});
  add.operator()<VanDerPol<>>({});
  // Last, as no clock is read there: the machine may do something else again.
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].kept = keeps[i]();
    print_kept(all[i]);
    write();
  }
}
