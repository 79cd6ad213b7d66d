#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <bench/stiff/page.hpp>

namespace continuo::bench {
namespace {

constexpr std::array<double, 4> errors_shown{1e-4, 1e-6, 1e-8, 1e-10};

constexpr const char* introduction =
    "# Stiff methods, ours and the peers'\n\n"
    "`bench/stiff/run.sh` measures again and writes this page. Each solver is run over a range of tolerances with the "
    "same\n"
    "right-hand side and the same exact Jacobian, ours as a plain `solve`; rtol and atol go together, see "
    "`absolute_part` in\n"
    "`bench/stiff/measure.hpp`. An error is that of the end of the run against values computed in binary128, relative "
    "to\n"
    "each component; the largest counts. Time is the least of many runs, all solvers in turn in one process, compiled "
    "with\n"
    "the same flags (`-O3 -march=native`, no `-ffast-math`). The time at an error is read from straight lines through "
    "the\n"
    "logarithms of error and time over the tolerances around it. \"-\": that error is not reached, or no run that "
    "reaches it\n"
    "ends within a fifth of a second.\n\n"
    "The peers: `rosenbrock4` of Boost.odeint, whose matrices are dense (therefore not on the Brusselator), with its "
    "step\n"
    "control as `controlled` and as `dense` stepper, first step given. CVODE of SUNDIALS as the distribution ships it, "
    "without\n"
    "tuning for the machine, its Newton iteration with dense matrices or with KLU. `msbdf` and `bsimp` of the GNU "
    "Scientific\n"
    "Library by its driver, first step given, dense matrices too.\n\n"
    "`model METHOD` runs the equations as they stand in `models/brusselator_line.sim`, on the tape, with the Jacobian "
    "of "
    "their\n"
    "graph; the others have them compiled.\n\n";

void write_kept(std::ofstream& page, const StiffResult& result) {
  page << "| Method |";
  for (const int power : tolerances_asked) page << " 1e-" << power << " |";
  page << "\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Kept& kept : result.kept) {
    page << "| " << kept.method << " |";
    for (const double error : kept.error) {
      const std::string shown = std::isinf(error) ? "failed" : number(error);
      page << ' ' << (std::isnan(error) || error <= most_tolerances ? shown : "**" + shown + "**") << " |";
    }
    page << '\n';
  }
}

}  // namespace

void print_costs(const StiffResult& result) {
  print_costs(result.measured, errors_shown);
  std::fflush(stdout);
}

void print_kept(const StiffResult& result) {
  std::printf("%.*s: error in tolerances\n", static_cast<int>(result.measured.title.size()),
              result.measured.title.data());
  for (const Kept& kept : result.kept) {
    std::printf("  %-24s", kept.method.c_str());
    for (const double error : kept.error) std::printf(" %8.2g", error);
    std::printf("\n");
  }
  std::fflush(stdout);
}

void write_page(const std::string& file, const std::vector<StiffResult>& all) {
  std::ofstream page(file);
  page << introduction << "## Time at equal true error\n\n";
  write_head_of_ratios(page);
  for (const StiffResult& result : all) write_ratios(page, result.measured, result.wanted);
  page << "\n## No method named\n\n`solve` without a method, here `default`: its time in units of that of our best "
          "named method, which stands behind it.\n\n";
  write_head_of_defaults(page, errors_shown);
  for (const StiffResult& result : all) write_default(page, result.measured, errors_shown);
  for (const StiffResult& result : all) {
    page << "\n## " << result.measured.title << "\n\nTime at the error of the column, in units of our best.\n\n";
    write_times(page, result.measured, errors_shown);
    page << "\n![Time against error](pictures/work_precision_" << result.measured.name << ".svg)\n";
  }
  page
      << "\n## Error in units of the tolerance\n\nThe largest error of a component at the end, in units of atol + rtol "
         "times the component, for each rtol. Above "
      << number(most_tolerances)
      << " in bold; \"-\": at the rtol before a run took\nlonger than twelve seconds, for a method of order p needs "
         "steps in "
         "proportion to rtol^(-1/p).\n";
  for (const StiffResult& result : all) {
    page << "\n### " << result.measured.title << "\n\n";
    write_kept(page, result);
  }
}

}  // namespace continuo::bench
