// continuo/studies/orbits/curves/orbit_curve.cpp
// Starts curves of bifurcations of orbits from marks, and names their special points.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/orbit_curve.hpp>
#include <continuo/studies/orbits/curves/homoclinic_curve.hpp>
#include <continuo/studies/orbits/curves/orbit_curve_course.hpp>
#include <continuo/studies/orbits/curves/orbit_curve_follower.hpp>

namespace continuo::studies {

namespace {

/// Whether a curve passes through this orbit, by the chords between its points.
bool passes_orbit(const OrbitCurve& curve, const OrbitMark& mark, double second, const OrbitCurveOptions& options) {
  const auto coordinates = [&](const std::array<double, 2>& constants, double period, const std::vector<double>& low,
                               const std::vector<double>& high) {
    std::vector<double> z;
    for (std::size_t k = 0; k < 2; ++k) z.push_back(constants[k] / (options.high[k] - options.low[k]));
    z.push_back(period / mark.at.period);
    for (std::size_t i = 0; i < low.size(); ++i) {
      const double size = std::max({std::abs(mark.at.low[i]), std::abs(mark.at.high[i]), 1e-12});
      z.push_back(low[i] / size);
      z.push_back(high[i] / size);
    }
    return z;
  };
  const auto wanted = coordinates({mark.at.constant, second}, mark.at.period, mark.at.low, mark.at.high);
  for (std::size_t k = 1; k < curve.points.size(); ++k) {
    const OrbitCurvePoint &from = curve.points[k - 1], &to = curve.points[k];
    const auto a = coordinates(from.constants, from.period, from.low, from.high),
               b = coordinates(to.constants, to.period, to.low, to.high);
    if (a.size() != wanted.size() || b.size() != wanted.size()) continue;
    double along = 0, whole = 0, apart = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      along += (b[i] - a[i]) * (wanted[i] - a[i]);
      whole += (b[i] - a[i]) * (b[i] - a[i]);
    }
    const double part = std::clamp(along / whole, 0.0, 1.0);
    for (std::size_t i = 0; i < a.size(); ++i) apart += std::pow(a[i] + part * (b[i] - a[i]) - wanted[i], 2);
    if (std::sqrt(apart) < detail::same_orbit_on_chord) return true;
  }
  return false;
}

}  // namespace

std::string_view to_string(OrbitDegeneracy kind) {
  constexpr std::array<std::string_view, orbit_degeneracies> names{"cusp of orbits",
                                                                   "1:1 resonance",
                                                                   "1:2 resonance",
                                                                   "1:3 resonance",
                                                                   "1:4 resonance",
                                                                   "fold-flip point",
                                                                   "fold-torus point",
                                                                   "flip-torus point",
                                                                   "double torus point",
                                                                   "neutral saddle",
                                                                   "neutral saddle-focus",
                                                                   "neutral focus-focus",
                                                                   "neutrally divergent saddle-focus",
                                                                   "double leading stable eigenvalue",
                                                                   "double leading unstable eigenvalue",
                                                                   "three leading stable eigenvalues",
                                                                   "three leading unstable eigenvalues",
                                                                   "saddle-node",
                                                                   "Hopf point",
                                                                   "orbit flip of the stable side",
                                                                   "orbit flip of the unstable side",
                                                                   "inclination flip of the stable manifold",
                                                                   "inclination flip of the unstable manifold",
                                                                   "non-central homoclinic orbit"};
  return names[static_cast<std::size_t>(kind)];
}

OrbitCurve follow_orbit_bifurcation(const ParametricSystem& system, const OrbitMark& start,
                                    const OrbitCurveOptions& options) {
  return std::move(follow_orbit_bifurcations(system, start, options, 1).front());
}

std::vector<OrbitCurve> follow_orbit_bifurcations(const ParametricSystem& system, const OrbitMark& start,
                                                  const OrbitCurveOptions& options, std::size_t most) {
  OrbitCurve curve{.kind = start.kind};
  if (start.kind == OrbitBifurcation::crossing) {
    curve.status = invalid_input("where branches of orbits cross is not followed in two parameters");
    return {curve};
  }
  if (start.mesh.size() < 2) {
    curve.status = invalid_input("the orbit there is not known");
    return {curve};
  }
  ParametricSystem turning(system);
  turning.advance = start.at.advance;
  if (start.kind == OrbitBifurcation::homoclinic) return detail::homoclinic_curves(turning, start, options, most);
  return {detail::OrbitCurveFollower(turning, start.kind, options).from(start)};
}

std::vector<OrbitCurveOfDiagram> orbit_curves(const ParametricSystem& system, const std::vector<OrbitMark>& starts,
                                              const OrbitCurveOptions& options, std::size_t most_curves) {
  std::vector<OrbitCurveOfDiagram> diagram;
  const double second = system.constants[options.constants[1]];
  for (std::size_t k = 0; k < starts.size() && diagram.size() < most_curves; ++k) {
    if (starts[k].kind == OrbitBifurcation::crossing) continue;
    if (options.interrupt && options.interrupt->load()) break;
    const auto known = std::ranges::find_if(diagram, [&](const OrbitCurveOfDiagram& of) {
      const bool is_alike = is_homoclinic(of.curve.kind) ? starts[k].kind == OrbitBifurcation::homoclinic
                                                         : of.curve.kind == starts[k].kind;
      return is_alike && passes_orbit(of.curve, starts[k], second, options);
    });
    if (known != diagram.end()) {
      known->starts.push_back(k);
      continue;
    }
    const std::size_t first = diagram.size();
    for (OrbitCurve& curve : follow_orbit_bifurcations(system, starts[k], options, most_curves - first))
      diagram.push_back({std::move(curve), {}});
    diagram[first].starts.push_back(k);
  }
  return diagram;
}

}  // namespace continuo::studies
