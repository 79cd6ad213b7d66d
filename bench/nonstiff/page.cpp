#include <fstream>

#include <bench/nonstiff/page.hpp>

namespace continuo::bench {
namespace {

constexpr const char* introduction = R"(# Nonstiff methods, ours and the peers'

`bench/nonstiff/run.sh` repeats the measurements and writes this page. Each solver is run over a range of tolerances
with rtol = atol; our methods are called through `solve`. The error is the largest error of a component at the end of
the run, compared with values computed in binary128, and relative for components greater than one. The time is the
minimum of many runs. All solvers run in turn in one process, compiled with the same flags (`-O3 -march=native`, no
`-ffast-math`). The time at a given error is interpolated linearly between the neighbouring tolerances, in the
logarithms of error and time. "-" means that the error is not reached (rounding accumulates over a long run), or only by
runs longer than a fifth of a second.

The symplectic methods mclachlan_atela4, yoshida6 and kahan_li8 run with fixed steps of decreasing size, for up to six
tenths of a second. Their sums are compensated, so the rounding of the accelerations limits their accuracy. On Pleiades,
with its close encounters, fixed steps are not suitable. The last three problems have the form x'' = a(t, x), which the
Runge-Kutta-Nystrom methods (dprkn) and the symplectic methods require.

The peers are four steppers of Boost.odeint with its own step size control and a given first step; `rk8pd` and `msadams`
of the GNU Scientific Library with its driver; and Adams' methods of CVODE (SUNDIALS). The last two libraries are the
packages of the distribution, not tuned for the machine.

)";

constexpr std::array<Wanted, 4> wanted{
    {{1e-6, 0.6, of_peers}, {1e-8, 0.6, of_peers}, {1e-10, 0.6, of_peers}, {1e-12, 0.6, of_peers}}};

void write_drifts(std::ostream& page, const std::vector<Drift>& drifts) {
  page
      << "\n## Energy over a hundred thousand orbits\n\nKepler, e = 0.5, with fixed steps and about "
         "the same number of evaluations per orbit for each method. The table\nshows the largest relative error of the "
         "energy in the first and in the last tenth of the run. The error of the symplectic\nmethods does not grow, "
         "except by rounding, which is visible only where the error is smallest.\n\n| Method | Symplectic | "
         "Evaluations per orbit | First tenth | Last tenth | Last : first |\n"
         "|---|---|---|---|---|---|\n";
  for (const Drift& drift : drifts) {
    page << text("| %s | %s | %.0f | %.1e | %.1e | %.3f |\n", std::string(drift.method).c_str(),
                 drift.symplectic ? "yes" : "no", drift.evaluations_per_orbit, drift.in_first_tenth(),
                 drift.in_last_tenth(), drift.in_last_tenth() / drift.in_first_tenth());
  }
  page << "\n![Energy against orbits](pictures/energy_drift.svg)\n";
}

}  // namespace

void write_nonstiff_page(const std::string& file, const std::vector<Measured>& all, const std::vector<Drift>& drifts) {
  std::ofstream page(file);
  page << introduction << "## Time at equal true error\n\n";
  write_head_of_ratios(page);
  for (const Measured& measured : all) write_ratios(page, measured, wanted);
  page << "\n## The default method\n\n`default` is `solve` without a method. The table shows its time relative to "
          "that of our best named method (in brackets).\n\n";
  write_head_of_defaults(page, nonstiff_errors);
  for (const Measured& measured : all) write_default(page, measured, nonstiff_errors);
  for (const Measured& measured : all) {
    page << "\n## " << measured.title << "\n\nTime at the error of the column, relative to our best method.\n\n";
    write_times(page, measured, nonstiff_errors);
    page << "\n![Time against error](pictures/work_precision_" << measured.name << ".svg)\n";
  }
  write_drifts(page, drifts);
}

}  // namespace continuo::bench
