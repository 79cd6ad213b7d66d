#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <bench/stiff/page.hpp>

namespace continuo::bench {
namespace {

constexpr std::array<double, 4> errors_shown{1e-4, 1e-6, 1e-8, 1e-10};

constexpr const char* introduction = R"(# Stiff methods, ours and the peers'

`bench/stiff/run.sh` repeats the measurements and writes this page. Each solver is run over a range of tolerances with
the same right-hand side and the same exact Jacobian; our methods are called through `solve`. rtol and atol are varied
together, see `absolute_part` in `bench/stiff/measure.hpp`. The error is the largest relative error of a component at
the end of the run, compared with values computed in binary128. The time is the minimum of many runs. All solvers run in
turn in one process, compiled with the same flags (`-O3 -march=native`, no `-ffast-math`). The time at a given error is
interpolated linearly between the neighbouring tolerances, in the logarithms of error and time. "-" means that the error
is not reached, or only by runs longer than a fifth of a second.

The peers are:

- `rosenbrock4` of Boost.odeint, as `controlled` and as `dense` stepper, with a given first step; its matrices are
  dense, therefore it is not run on the Brusselator;
- CVODE of SUNDIALS, the package of the distribution, not tuned for the machine; its Newton iteration uses dense
  matrices or KLU;
- `msbdf` and `bsimp` of the GNU Scientific Library with its driver, a given first step, and dense matrices.

`model METHOD` evaluates the equations of `models/brusselator_line.sim` on the tape, with the Jacobian derived from
their expression graph; all other solvers use compiled equations.

)";

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
  page << "\n## The default method\n\n`default` is `solve` without a method. The table shows its time relative to "
          "that of our best named method (in brackets).\n\n";
  write_head_of_defaults(page, errors_shown);
  for (const StiffResult& result : all) write_default(page, result.measured, errors_shown);
  for (const StiffResult& result : all) {
    page << "\n## " << result.measured.title << "\n\nTime at the error of the column, relative to our best method.\n\n";
    write_times(page, result.measured, errors_shown);
    page << "\n![Time against error](pictures/work_precision_" << result.measured.name << ".svg)\n";
  }
  page << "\n## Error in units of the tolerance\n\nThe largest error of a component at the end, divided by atol + rtol "
          "times the component, for each rtol. Values above "
       << number(most_tolerances)
       << "\nare in bold. \"-\": not run, because at the previous rtol the run took longer than twelve seconds; the "
          "number of steps of\na method of order p grows like rtol^(-1/p).\n";
  for (const StiffResult& result : all) {
    page << "\n### " << result.measured.title << "\n\n";
    write_kept(page, result);
  }
}

}  // namespace continuo::bench
