// The values of a solution between the points of its mesh.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <continuo/boundary/boundary_value.hpp>
#include <continuo/boundary/lobatto.hpp>

namespace continuo::boundary {

namespace {

/// The interval of t and where t lies in it.
std::pair<std::size_t, double> place_of(const std::vector<double>& mesh, double t) {
  const auto above = std::upper_bound(mesh.begin() + 1, mesh.end() - 1, t);
  const auto k = static_cast<std::size_t>(above - mesh.begin()) - 1;
  return {k, (t - mesh[k]) / (mesh[k + 1] - mesh[k])};
}

}  // namespace

Status validate(const BoundaryValueProblem& problem) {
  if (problem.system.size == 0) return invalid_input("a system of at least one component is needed");
  if (!problem.system.derivative || !problem.conditions) return invalid_input("a derivative and conditions are needed");
  if (problem.times.size() < 2) return invalid_input("conditions at two times at least are needed");
  for (std::size_t i = 0; i + 1 < problem.times.size(); ++i)
    if (!(problem.times[i] < problem.times[i + 1])) return invalid_input("the times of the conditions must ascend");
  if (!std::isfinite(problem.times.front()) || !std::isfinite(problem.times.back()))
    return invalid_input("the times of the conditions must be finite");
  for (const MatrixPlace& place : problem.condition_places)
    if (place.row >= problem.system.size + problem.system.parameters() ||
        place.column >= problem.times.size() * problem.system.size + problem.system.parameters())
      return invalid_input("a place of the conditions lies outside their Jacobian");
  return {};
}

void BoundaryValueSolution::at(double t, std::span<double> x) const {
  const auto [k, theta] = place_of(mesh, t);
  const double h = mesh[k + 1] - mesh[k];
  const auto weights = lobatto4.rises(theta);
  const std::size_t first = k * (lobatto4.stages - 1) * size;
  for (std::size_t i = 0; i < size; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < lobatto4.stages; ++j) sum += weights[j] * slopes[first + j * size + i];
    x[i] = points[first + i] + h * sum;
  }
}

void BoundaryValueSolution::slope_at(double t, std::span<double> dxdt) const {
  const auto [k, theta] = place_of(mesh, t);
  const auto weights = lobatto4.slopes(theta);
  const std::size_t first = k * (lobatto4.stages - 1) * size;
  for (std::size_t i = 0; i < size; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < lobatto4.stages; ++j) sum += weights[j] * slopes[first + j * size + i];
    dxdt[i] = sum;
  }
}

std::vector<double> BoundaryValueSolution::operator()(double t) const {
  std::vector<double> x(size);
  at(t, x);
  return x;
}

}  // namespace continuo::boundary
