#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <ostream>
#include <string>

#include <bench/report.hpp>

namespace continuo::bench {
namespace {

void write_errors(std::ostream& page, std::string_view first, std::span<const double> errors) {
  page << "| " << first << " |";
  for (const double error : errors) page << text(" %.0e |", error);
  page << "\n|---|";
  for (std::size_t i = 0; i < errors.size(); ++i) page << "---|";
  page << '\n';
}

}  // namespace

Best best(const Measured& measured, double error, Which which) {
  Best result;
  for (const Curve& curve : measured.curves) {
    if (!which(curve)) continue;
    const Cost cost = cost_at(curve, error);
    if (!result.curve || cost.seconds < result.cost.seconds) result = {&curve, cost};
  }
  return result;
}

double smallest_shared_error(const Measured& measured, double wanted, double loosest, Which one, Which other) {
  const double finer_than_points = std::pow(10, 1.0 / 16);
  const auto reached = [&](double error, Which which) {
    const Best found = best(measured, error, which);
    return found.curve && !std::isinf(found.cost.seconds);
  };
  for (double error = wanted; error < loosest; error *= finer_than_points)
    if (reached(error, one) && reached(error, other)) return error;
  return 0;
}

namespace {
// Okabe and Ito's, told apart by all common kinds of colour vision, without the yellow that is too pale on white.
constexpr std::array colors{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};
}  // namespace

std::string line_of(std::size_t number, bool dashed) {
  return text("dt %d lc rgb '%s'", dashed ? 2 : 1, colors[number % colors.size()]);
}

namespace {
/// What tells curves of one colour apart.
std::string points_of(std::size_t number, bool ours) {
  constexpr std::array full{7, 5, 9, 13}, empty{6, 4, 8, 12};
  const std::size_t round = number / colors.size() % full.size();
  return text("pt %d ps 0.45", ours ? full[round] : empty[round]);
}
}  // namespace

void write_curves(const std::string& folder, const Measured& measured) {
  const std::string stem = folder + "/work_precision_" + std::string(measured.name);
  std::ofstream table(stem + ".csv"), plot(stem + ".gp");
  table << "solver,tolerance,error,seconds,evaluations\n";
  plot << "set terminal svg size 800,560 background 'white'\nset output '" << stem << ".svg'\nset title '"
       << measured.title << "'\nset logscale xy\nset format '10^{%T}'\nset xlabel 'error at the end'\n"
       << "set ylabel 'seconds'\nset grid\nset key outside right\nset datafile separator ','\nplot ";
  std::size_t shown = 0;
  for (const Curve& curve : measured.curves) {
    for (const Point& point : curve.points)
      table << curve.solver << ',' << point.tolerance << ',' << point.error << ',' << point.seconds << ','
            << point.evaluations << '\n';
    if (curve.points.empty()) continue;
    plot << "'" << stem << ".csv' using (strcol(1) eq '" << curve.solver << "' ? $3 : NaN):4 with "
         << "linespoints " << line_of(shown, !curve.ours) << ' ' << points_of(shown, curve.ours) << " title '"
         << curve.solver << "' noenhanced, ";
    ++shown;
  }
  plot << '\n';
}

void print_costs(const Measured& measured, std::span<const double> errors) {
  std::printf("\n%s\n  %-28s %8s %12s %12s %10s\n", std::string(measured.title).c_str(), "solver", "error",
              "microseconds", "evaluations", "tolerance");
  for (const Curve& curve : measured.curves) {
    for (const double error : errors) {
      const Cost cost = cost_at(curve, error);
      if (!std::isinf(cost.seconds))
        std::printf("  %-28s %8.0e %12.2f %12.0f %10.1e\n", curve.solver.c_str(), error, 1e6 * cost.seconds,
                    cost.evaluations, cost.tolerance);
    }
  }
  std::fflush(stdout);
}

std::string number(double value) {
  if (!std::isfinite(value) || value <= 0) return "-";
  return text(value >= 10 ? "%.0f" : value >= 1 ? "%.1f" : value >= 0.095 ? "%.2f" : "%.3f", value);
}

void write_head_of_ratios(std::ostream& page) {
  page << "| Problem | Error | Our best | Best peer | Time, ours : theirs | Target |\n|---|---|---|---|---|---|\n";
}

void write_ratios(std::ostream& page, const Measured& measured, std::span<const Wanted> ratios) {
  for (const Wanted& wanted : ratios) {
    const double error = smallest_shared_error(measured, wanted.error, 1e-4, wanted.ours, wanted.peer);
    page << "| " << measured.title << " | ";
    if (error == 0) {
      page << text("%.0e", wanted.error) << " | - | - | not measured | " << number(wanted.at_most) << " |\n";
      continue;
    }
    const Best ours = best(measured, error, wanted.ours), theirs = best(measured, error, wanted.peer);
    page << text(error == wanted.error ? "%.0e" : "%.0e not reached by both; %.1e", wanted.error, error) << " | "
         << ours.curve->solver << " | " << theirs.curve->solver << " | **"
         << number(ours.cost.seconds / theirs.cost.seconds) << "** | " << number(wanted.at_most) << " |\n";
  }
}

void write_head_of_defaults(std::ostream& page, std::span<const double> errors) {
  write_errors(page, "Problem", errors);
}

void write_default(std::ostream& page, const Measured& measured, std::span<const double> errors) {
  page << "| " << measured.title << " |";
  for (const double error : errors) {
    const Best ours = best(measured, error, of_ours), chosen = best(measured, error, of_default);
    page << ' ' << number(ours.curve && chosen.curve ? chosen.cost.seconds / ours.cost.seconds : 0);
    if (ours.curve && !std::isinf(ours.cost.seconds)) page << " (" << ours.curve->solver << ")";
    page << " |";
  }
  page << '\n';
}

void write_times(std::ostream& page, const Measured& measured, std::span<const double> errors) {
  write_errors(page, "Solver", errors);
  for (const Curve& curve : measured.curves) {
    page << "| " << curve.solver << " |";
    for (const double error : errors)
      page << ' ' << number(cost_at(curve, error).seconds / best(measured, error, of_ours).cost.seconds) << " |";
    page << '\n';
  }
}

}  // namespace continuo::bench
