// Compares our best method with the best of Boost.odeint on five problems at equal true error and prints the ratios.
//   against_odeint [FOLDER [SECONDS [PROBLEM...]]]: tables and plots go to FOLDER; each problem is timed for SECONDS.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <bench/measure.hpp>
#include <bench/problems/arenstorf.hpp>
#include <bench/problems/kepler.hpp>
#include <bench/problems/lorenz.hpp>
#include <bench/problems/outer_planets.hpp>
#include <bench/problems/pleiades.hpp>
#include <bench/report.hpp>

namespace continuo::bench {
namespace {

void print_details(const Measured& measured) {
  std::printf("\n%s\n  %-24s %8s %12s %12s %12s\n", std::string(measured.title).c_str(), "solver", "error",
              "microseconds", "evaluations", "tolerance");
  for (const Curve& curve : measured.curves) {
    for (const double error : errors_compared) {
      const Cost cost = cost_at(curve, error);
      if (std::isinf(cost.seconds)) continue;
      std::printf("  %-24s %8.0e %12.2f %12.0f %12.1e\n", curve.solver.c_str(), error, 1e6 * cost.seconds,
                  cost.evaluations, cost.tolerance);
    }
  }
}

/// The table that counts; also as Markdown, without absolute times.
void print_ratios(const std::vector<Measured>& all, const std::string& folder) {
  std::ofstream table(folder + "/ratios.md");
  table << "| Problem | Error | Our best | Boost.odeint's best | Evaluations, ours : theirs | Time, ours : theirs |\n"
           "|---|---|---|---|---|---|\n";
  std::printf("\n%-34s %8s  %-24s %-24s %12s %10s\n", "problem", "error", "our best", "odeint's best", "evaluations",
              "time");
  for (const Measured& measured : all) {
    for (const double wanted : errors_compared) {
      const double error = smallest_shared_error(measured, wanted, of_ours, of_peers);
      if (error == 0) continue;
      const Best ours = best(measured, error, of_ours), theirs = best(measured, error, of_peers);
      const double evaluations = ours.cost.evaluations / theirs.cost.evaluations;
      const double time = ours.cost.seconds / theirs.cost.seconds;
      const std::string title(measured.title);
      std::printf("%-34s %8.1e  %-24s %-24s %12.2f %10.2f\n", title.c_str(), error, ours.curve->solver.c_str(),
                  theirs.curve->solver.c_str(), evaluations, time);
      char asked[80], line[400];
      std::snprintf(asked, sizeof asked, error == wanted ? "%.0e" : "%.0e not reached by both; %.1e", wanted, error);
      std::snprintf(line, sizeof line, "| %s | %s | %s | %s | %.2f | **%.2f** |\n", title.c_str(), asked,
                    ours.curve->solver.c_str(), theirs.curve->solver.c_str(), evaluations, time);
      table << line;
    }
  }
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  using namespace continuo::bench;
  const std::string folder = count > 1 ? arguments[1] : ".";
  const double seconds = count > 2 ? std::atof(arguments[2]) : 15;
  const std::vector<std::string> wanted(arguments + std::min(count, 3), arguments + count);
  std::vector<Measured> all;
  const auto add = [&](std::string_view name, Measured (*measure)(double)) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) return;
    all.push_back(measure(seconds));
    print_details(all.back());
    std::fflush(stdout);
    write_curves(folder, all.back());
  };
  add(Lorenz::name, measure<Lorenz>);
  add(Arenstorf::name, measure<Arenstorf>);
  add(Kepler::name, measure<Kepler>);
  add(Pleiades::name, measure<Pleiades>);
  add(OuterPlanets::name, measure<OuterPlanets>);
  print_ratios(all, folder);
}
