// continuo/studies/orbit_curve_waiting.cpp
//
// How near an orbit of long period is to a homoclinic one, for which it stands.
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include <continuo/studies/equilibrium.hpp>
#include <continuo/studies/orbit_curve_steps.hpp>

namespace continuo::studies::detail {

std::size_t OrbitCurveSteps::slowest_node(const OrbitCollocation& orbit, const OrbitCurvePlace& place) const {
  const std::size_t n = system_.size;
  const std::vector<double> field = orbit.field(std::vector<double>(place.z.begin(), place.z.end() - 2));
  std::size_t slowest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < orbit.nodes(); ++k) {
    double speed = 0;
    for (std::size_t i = 0; i < n; ++i) speed += std::pow(field[k * n + i] / sizes_[i], 2);
    if (speed < least) least = speed, slowest = k;
  }
  return slowest;
}

double OrbitCurveSteps::rate_over_period(const OrbitCurvePlace& place) {
  use(place.mesh);
  measure(place.z);
  const ParametricSystem one = there(place.z);
  const OrbitCollocation orbit(one, mesh_);
  const auto begin = place.z.begin() + static_cast<std::ptrdiff_t>(slowest_node(orbit, place) * system_.size);
  const auto rest = find_equilibrium(one, std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(system_.size)),
                                     one.constants);
  if (rest.ending != EquilibriumEnding::found) return 0;
  double rate = std::numeric_limits<double>::infinity();
  for (const std::complex<double>& value : describe_equilibrium(one, rest.x, one.constants).eigenvalues)
    rate = std::min(rate, std::abs(value.real()));
  return std::isfinite(rate) ? rate * place.point.period : 0;
}

double OrbitCurveSteps::waiting_part(const OrbitCurvePlace& place) {
  use(place.mesh);
  measure(place.z);
  const ParametricSystem one = there(place.z);
  const OrbitCollocation orbit(one, mesh_);
  const std::size_t n = system_.size, nodes = orbit.nodes(), slowest = slowest_node(orbit, place);
  const auto square = [&](const auto& component) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += std::pow(component(i) / sizes_[i], 2);
    return sum;
  };
  std::vector<double> apart(nodes);
  const std::vector<double>& advance = system_.advance;
  for (std::size_t k = 0; k < nodes; ++k) {
    const auto after = [&](double turns) {
      return square([&](std::size_t i) {
        return place.z[k * n + i] - place.z[slowest * n + i] + (advance.empty() ? 0 : turns * advance[i]);
      });
    };
    apart[k] = advance.empty() ? after(0) : std::min({after(-1), after(0), after(1)});
  }
  const double near = std::ranges::max(apart) / 2500;
  double part = 0;
  for (std::size_t k = 0; k < nodes; ++k)
    if (apart[k] < near) part += orbit.weight(k);
  return part;
}

}  // namespace continuo::studies::detail
