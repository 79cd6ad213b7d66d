// bench/boundary/ours.cpp: for each problem and tolerance the residual and the time, one line each.
#include <algorithm>
#include <chrono>
#include <cmath>

#include <bench/boundary/problems.hpp>
#include <fmt/format.h>

namespace {

using namespace continuo;

double residual_of(const boundary::BoundaryValueProblem& problem, const boundary::BoundaryValueSolution& solution) {
  constexpr int samples = 40;
  const std::size_t n = problem.system.size;
  std::vector<double> x(n), slope(n), f(n);
  double worst = 0;
  for (std::size_t k = 0; k + 1 < solution.mesh.size(); ++k) {
    double mean = 0;
    for (int i = 0; i < samples; ++i) {
      const double t = solution.mesh[k] + (i + 0.5) / samples * (solution.mesh[k + 1] - solution.mesh[k]);
      solution.at(t, x);
      solution.slope_at(t, slope);
      problem.system.derivative(t, x, solution.parameters, f);
      for (std::size_t c = 0; c < n; ++c) mean += std::pow((slope[c] - f[c]) / (1 + std::abs(f[c])), 2) / samples;
    }
    worst = std::max(worst, std::sqrt(mean));
  }
  return worst;
}

}  // namespace

int main() {
  using Clock = std::chrono::steady_clock;
  for (const auto& [name, problem, guess] : bench::boundary_cases()) {
    for (double tolerance = 1e-3; tolerance > 5e-11; tolerance /= 10) {
      boundary::BoundaryValueSolution solution;
      double seconds = 1e9;
      for (int run = 0; run < 20; ++run) {
        const auto begin = Clock::now();
        solution = boundary::solve_boundary_values(problem, guess, {.tolerance = tolerance});
        seconds = std::min(seconds, std::chrono::duration<double>(Clock::now() - begin).count());
      }
      if (!solution.outcome) continue;
      fmt::print("{};{};{};{};{}\n", name, tolerance, residual_of(problem, solution), seconds,
                 solution.mesh.size() - 1);
    }
  }
}
