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

namespace continuo::bench {
namespace {

struct Best {
  const Curve* curve = nullptr;
  Cost cost{};
};

Best best(const Measured& measured, double error, bool ours) {
  Best result;
  for (const Curve& curve : measured.curves) {
    if (curve.ours != ours) continue;
    const Cost cost = cost_at(curve, error);
    if (!result.curve || cost.seconds < result.cost.seconds) result = {&curve, cost};
  }
  return result;
}

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

void write_curves(const std::string& folder, const Measured& measured) {
  const std::string stem = folder + "/work_precision_" + std::string(measured.name);
  std::ofstream table(stem + ".csv"), plot(stem + ".gp");
  table << "solver,tolerance,error,seconds,evaluations\n";
  plot << "set terminal svg size 800,560 background 'white'\nset output '" << stem << ".svg'\nset title '"
       << measured.title << "'\nset logscale xy\nset format '10^{%T}'\nset xlabel 'error at the end'\n"
       << "set ylabel 'seconds'\nset grid\nset key outside right\nset datafile separator ','\nplot ";
  for (const Curve& curve : measured.curves) {
    for (const Point& point : curve.points)
      table << curve.solver << ',' << point.tolerance << ',' << point.error << ',' << point.seconds << ','
            << point.evaluations << '\n';
    if (curve.points.empty()) continue;
    plot << "'" << stem << ".csv' using (strcol(1) eq '" << curve.solver << "' ? $3 : NaN):4 with "
         << (curve.ours ? "linespoints pt 7 ps 0.4" : "linespoints dt 2 pt 6 ps 0.4") << " title '" << curve.solver
         << "' noenhanced, ";
  }
  plot << '\n';
}

/// `wanted`, or the smallest error above it that both sides reach.
double smallest_shared_error(const Measured& measured, double wanted) {
  const double finer_than_points = std::pow(10, 1.0 / 16);
  for (double error = wanted; error < loosest_error; error *= finer_than_points) {
    if (!std::isinf(best(measured, error, true).cost.seconds) && !std::isinf(best(measured, error, false).cost.seconds))
      return error;
  }
  return 0;
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
      const double error = smallest_shared_error(measured, wanted);
      if (error == 0) continue;
      const Best ours = best(measured, error, true), theirs = best(measured, error, false);
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
