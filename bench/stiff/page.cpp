#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <bench/stiff/page.hpp>

namespace continuo::bench {
namespace {

constexpr std::array<double, 4> errors_shown{1e-4, 1e-6, 1e-8, 1e-10};

template <class... Values>
std::string text(const char* format, Values... values) {
  char line[200];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

/// Two digits, whatever the size; "-" where there is no number.
std::string number(double value) {
  if (!std::isfinite(value) || value <= 0) return "-";
  return text(value >= 10 ? "%.0f" : value >= 1 ? "%.1f" : value >= 0.095 ? "%.2f" : "%.3f", value);
}

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
    "tuning for the machine, its Newton iteration with dense matrices or with KLU.\n\n";

void write_ratios(std::ofstream& page, const std::vector<StiffResult>& all) {
  page
      << "| Problem | Error | Our best | The peer's best | Time, ours : theirs | Wanted |\n|---|---|---|---|---|---|\n";
  for (const StiffResult& result : all) {
    for (const Wanted& wanted : result.wanted) {
      const double error = smallest_shared_error(result.measured, wanted.error, of_ours, wanted.peer);
      page << "| " << result.measured.title << " | ";
      if (error == 0) {
        page << text("%.0e", wanted.error) << " | - | - | not measured | " << number(wanted.at_most) << " |\n";
        continue;
      }
      const Best ours = best(result.measured, error, of_ours), theirs = best(result.measured, error, wanted.peer);
      page << text(error == wanted.error ? "%.0e" : "%.0e not reached by both; %.1e", wanted.error, error) << " | "
           << ours.curve->solver << " | " << theirs.curve->solver << " | **"
           << number(ours.cost.seconds / theirs.cost.seconds) << "** | " << number(wanted.at_most) << " |\n";
    }
  }
}

/// Time of every solver in units of our best at that error.
void write_times(std::ofstream& page, const StiffResult& result) {
  page << "| Solver |";
  for (const double error : errors_shown) page << text(" %.0e |", error);
  page << "\n|---|---|---|---|---|\n";
  for (const Curve& curve : result.measured.curves) {
    page << "| " << curve.solver << " |";
    for (const double error : errors_shown)
      page << ' ' << number(cost_at(curve, error).seconds / best(result.measured, error, of_ours).cost.seconds) << " |";
    page << '\n';
  }
}

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
  std::printf("\n%s\n  %-24s %8s %12s %12s %10s\n", std::string(result.measured.title).c_str(), "solver", "error",
              "microseconds", "evaluations", "rtol");
  for (const Curve& curve : result.measured.curves) {
    for (const double error : errors_shown) {
      const Cost cost = cost_at(curve, error);
      if (!std::isinf(cost.seconds))
        std::printf("  %-24s %8.0e %12.2f %12.0f %10.1e\n", curve.solver.c_str(), error, 1e6 * cost.seconds,
                    cost.evaluations, cost.tolerance);
    }
  }
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
  write_ratios(page, all);
  for (const StiffResult& result : all) {
    page << "\n## " << result.measured.title << "\n\nTime at the error of the column, in units of our best.\n\n";
    write_times(page, result);
    page << "\n![Time against error](pictures/work_precision_" << result.measured.name << ".svg)\n";
  }
  page
      << "\n## Error in units of the tolerance\n\nThe largest error of a component at the end, in units of atol + rtol "
         "times the component, for each rtol. Above "
      << number(most_tolerances)
      << " in bold; \"-\": at the rtol before a run took\nlonger than a minute, for a method of order p needs steps in "
         "proportion to rtol^(-1/p).\n";
  for (const StiffResult& result : all) {
    page << "\n### " << result.measured.title << "\n\n";
    write_kept(page, result);
  }
}

}  // namespace continuo::bench
