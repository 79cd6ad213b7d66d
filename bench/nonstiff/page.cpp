#include <fstream>

#include <bench/nonstiff/page.hpp>

namespace continuo::bench {
namespace {

constexpr const char* introduction = R"(# Methods for what is not stiff, ours and the peers'

`bench/nonstiff/run.sh` measures again and writes this page. Each solver is run over a range of tolerances, rtol = atol,
ours as a plain `solve`. An error is that of the end of the run against values computed in binary128, relative where a
component is greater than one; the largest counts. Time is the least of many runs, all solvers in turn in one process,
compiled with the same flags (`-O3 -march=native`, no `-ffast-math`). The time at an error is read from straight lines
through the logarithms of error and time over the tolerances around it. "-": that error is not reached (rounding adds up
over a long run), or no run that reaches it ends within a fifth of a second.

The symplectic methods mclachlan_atela4, yoshida6 and kahan_li8 run with fixed steps, shorter and shorter ones, for up to
six tenths of a second; their sums are compensated, and what ends their curves is the rounding of the accelerations. On
Pleiades, where stars pass each other closely, that is not what they are for. The last three problems are of the form
x'' = a(t, x), which the Runge-Kutta-Nystrom methods (dprkn) and the symplectic ones need.

The peers: four steppers of Boost.odeint with its own step control, first step given; `rk8pd` and `msadams` of the GNU
Scientific Library by its driver; Adams' methods of CVODE (SUNDIALS). The last two libraries as the distribution ships
them, without tuning for the machine.

)";

constexpr std::array<Wanted, 4> wanted{
    {{1e-6, 0.6, of_peers}, {1e-8, 0.6, of_peers}, {1e-10, 0.6, of_peers}, {1e-12, 0.6, of_peers}}};

void write_drifts(std::ostream& page, const std::vector<Drift>& drifts) {
  page << "\n## Energy over a hundred thousand orbits\n\nKepler, e = 0.5, with fixed steps and about as many "
          "evaluations an orbit for every method: the largest relative error\nof the energy in the first and in the "
          "last tenth of the run. That of the symplectic methods does not grow; what rounding\nadds shows where it is "
          "smallest.\n\n| Method | Symplectic | Evaluations an orbit | First tenth | Last tenth | Last : first |\n"
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
  page << "\n## No method named\n\n`solve` without a method, here `default`: its time in units of that of our best "
          "named method, which stands behind it.\n\n";
  write_head_of_defaults(page, nonstiff_errors);
  for (const Measured& measured : all) write_default(page, measured, nonstiff_errors);
  for (const Measured& measured : all) {
    page << "\n## " << measured.title << "\n\nTime at the error of the column, in units of our best.\n\n";
    write_times(page, measured, nonstiff_errors);
    page << "\n![Time against error](pictures/work_precision_" << measured.name << ".svg)\n";
  }
  write_drifts(page, drifts);
}

}  // namespace continuo::bench
