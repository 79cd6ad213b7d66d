#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <bench/work_precision.hpp>

namespace continuo::bench {
namespace {

/// y = mean_y + slope (x - mean_x), least squares.
struct Line {
  double mean_x = 0, mean_y = 0, slope = 0;

  Line(const std::vector<double>& x, const std::vector<double>& y) {
    const auto n = static_cast<double>(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      mean_x += x[i] / n;
      mean_y += y[i] / n;
    }
    double over = 0, under = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      over += (x[i] - mean_x) * (y[i] - mean_y);
      under += (x[i] - mean_x) * (x[i] - mean_x);
    }
    slope = over / under;
  }
  double operator()(double x) const { return mean_y + slope * (x - mean_x); }
  double solve(double y) const { return mean_x + (y - mean_y) / slope; }
};

}  // namespace

std::vector<Curve> sweep(const std::vector<Solver>& solvers, double loosest_error, double tightest_error,
                         double seconds_to_spend, const Tolerances& tolerances) {
  std::vector<Curve> curves;
  const auto slowest = [&](const Solver& solver) { return solver.slowest > 0 ? solver.slowest : tolerances.slowest; };
  for (const Solver& solver : solvers) {
    Curve curve{solver.name, solver.ours, {}};
    for (double power = 2; power <= tolerances.tightest_power; power += 1 / tolerances.points_per_decade) {
      const double tolerance = std::pow(10, -power);
      const auto start = std::chrono::steady_clock::now();
      const Answer answer = solver.judge(tolerance);
      if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > slowest(solver)) break;
      if (answer.error <= loosest_error && answer.error >= tightest_error)
        curve.points.push_back({tolerance, answer.error, std::numeric_limits<double>::infinity(), answer.evaluations});
    }
    curves.push_back(std::move(curve));
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  for (int round = 0; round < 5 || elapsed() < seconds_to_spend; ++round) {
    for (std::size_t i = 0; i < solvers.size(); ++i) {
      for (Point& point : curves[i].points) {
        if (round >= 2 && point.seconds > slowest(solvers[i]) / 4) continue;  // noise is little in a long run
        point.seconds = std::min(point.seconds, solvers[i].seconds(point.tolerance));
      }
    }
  }
  return curves;
}

Cost cost_at(const Curve& curve, double error) {
  constexpr double window = 30;
  std::vector<double> tolerance, reached, seconds, evaluations;
  for (const Point& point : curve.points) {
    if (point.error > error * window || point.error < error / window) continue;
    tolerance.push_back(std::log(point.tolerance));
    reached.push_back(std::log(point.error));
    seconds.push_back(std::log(point.seconds));
    evaluations.push_back(std::log(static_cast<double>(point.evaluations)));
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (tolerance.size() < 4) return {infinity, infinity, 0};
  const double at = Line(tolerance, reached).solve(std::log(error));
  // Outside of what was measured: the error does not follow the tolerance there, round-off has taken over.
  if (at > tolerance.front() || at < tolerance.back()) return {infinity, infinity, 0};
  return {std::exp(Line(tolerance, seconds)(at)), std::exp(Line(tolerance, evaluations)(at)), std::exp(at)};
}

}  // namespace continuo::bench
