#include <cmath>
#include <fstream>
#include <string>

#include <bench/report.hpp>

namespace continuo::bench {

Best best(const Measured& measured, double error, Which which) {
  Best result;
  for (const Curve& curve : measured.curves) {
    if (!which(curve)) continue;
    const Cost cost = cost_at(curve, error);
    if (!result.curve || cost.seconds < result.cost.seconds) result = {&curve, cost};
  }
  return result;
}

double smallest_shared_error(const Measured& measured, double wanted, Which one, Which other) {
  const double finer_than_points = std::pow(10, 1.0 / 16);
  const auto reached = [&](double error, Which which) {
    const Best found = best(measured, error, which);
    return found.curve && !std::isinf(found.cost.seconds);
  };
  for (double error = wanted; error < loosest_error; error *= finer_than_points)
    if (reached(error, one) && reached(error, other)) return error;
  return 0;
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

}  // namespace continuo::bench
