// continuo/studies/periodic_orbit.cpp
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/studies/flow.hpp>
#include <continuo/studies/periodic_orbit.hpp>

namespace continuo::studies {

namespace {

using X = std::vector<double>;

constexpr double return_part = 1e-3;   // of the size of the motion: so near, and it has come back
constexpr std::size_t most_turns = 8;  // through the section within one period

PeriodicOrbit without_orbit(Outcome<double> outcome, std::string hint = {}) {
  PeriodicOrbit none;
  none.outcome = std::move(outcome);
  if (!hint.empty()) {
    none.outcome.ending = Ending::nonlinear_solve_failed;
    none.outcome.hint = std::move(hint);
  }
  return none;
}

/// Where each component ranges on the way.
struct Extent {
  X low, high;
  double size(std::size_t i) const { return high[i] - low[i]; }
};
Extent extent_of(const std::vector<X>& states) {
  Extent extent{states.front(), states.front()};
  for (const X& x : states) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      extent.low[i] = std::min(extent.low[i], x[i]);
      extent.high[i] = std::max(extent.high[i], x[i]);
    }
  }
  return extent;
}

/// The time between two points of the section that are alike; 0 where there are none.
double time_to_return(const std::vector<SectionPoint>& points, const Extent& extent) {
  for (std::size_t turns = 1; turns <= most_turns && turns < points.size(); ++turns) {
    const SectionPoint& last = points.back();
    const SectionPoint& before = points[points.size() - 1 - turns];
    bool alike = true;
    for (std::size_t i = 0; i < last.x.size(); ++i)
      alike = alike && std::abs(last.x[i] - before.x[i]) <= return_part * extent.size(i);
    if (alike) return last.t - before.t;
  }
  return 0;
}

/// x over s = t / T: dx/ds = T f(x), with T unknown.
ParametricSystem over_one_period(const ParametricSystem& system, double period) {
  ParametricSystem scaled{.size = system.size, .constants = {period}};
  scaled.names = system.names;
  scaled.constant_names = {"period"};
  scaled.derivative = [system](double, Values x, Values p, std::span<double> dxds) {
    system.derivative(0, x, system.constants, dxds);
    for (double& slope : dxds) slope *= p[0];
  };
  scaled.jacobian = [system](double, Values x, Values p, std::span<double> rows) {
    std::ranges::copy(jacobian_of(system, 0, x, system.constants), rows.begin());
    for (double& entry : rows) entry *= p[0];
  };
  scaled.constant_jacobian = [system](double, Values x, Values, std::span<double> rows) {
    system.derivative(0, x, system.constants, rows);
  };
  return scaled;
}

std::vector<std::complex<double>> multipliers_of(const ParametricSystem& system, const X& x0, double period,
                                                 Options<X> run) {
  const std::size_t n = system.size;
  const auto end = run_flow(with_variations(system), system.constants, variational_start(system, x0), {0, period}, run);
  if (!end.outcome) return {};
  std::vector<double> rows(n * n);
  for (std::size_t c = 0; c < n; ++c)
    for (std::size_t i = 0; i < n; ++i) rows[i * n + c] = end.final_state()[n * (1 + c) + i];
  auto values = eigenvalues(rows, n).values;
  std::ranges::sort(values, [](const auto& a, const auto& b) { return std::abs(a) > std::abs(b); });
  return values;
}

}  // namespace

bool depends_on_time(const ParametricSystem& system, const X& x) {
  X now(x.size()), later(x.size());
  system.derivative(0, x, system.constants, now);
  system.derivative(0.7310585786300049, x, system.constants, later);
  return now != later;
}

Section poincare_section(const ParametricSystem& system, std::vector<double> x0, std::size_t component,
                         const SectionOptions& options) {
  Section section;
  Options<X> run{.rtol = options.rtol, .atol = 1e-3 * options.rtol};
  run.interrupt = options.interrupt;
  run.progress = options.progress;
  run.save = Save<X>::only_end();
  run.events = {
      rises<X>("section", [component, level = options.level](double, const X& x) { return x[component] - level; })};
  const auto motion = run_flow(system, system.constants, std::move(x0), {0, options.settle + options.duration}, run);
  section.outcome = motion.outcome;
  for (const auto& event : motion.events)
    if (event.t >= options.settle) section.points.push_back({event.t, event.before});
  return section;
}

PeriodicOrbit find_periodic_orbit(const ParametricSystem& system, std::vector<double> x0,
                                  const PeriodicOrbitOptions& options) {
  if (depends_on_time(system, x0))
    return without_orbit({}, "the equations depend on time; an orbit is looked for where they do not");
  Options<X> run{.rtol = options.rtol, .atol = 1e-3 * options.rtol};
  run.interrupt = options.interrupt;
  Options<X> to_end = run;
  to_end.save = Save<X>::only_end();
  // Three runs one after the other: to settle, to see the extent, through the section.
  const double whole = options.settle + 2 * options.duration;
  const auto after = [&](double before) -> std::function<void(double)> {
    if (!options.progress) return {};
    return [&options, before, whole](double t) { options.progress((before + t) / whole); };
  };
  to_end.progress = after(0);
  run.progress = after(options.settle);
  const auto settled = run_flow(system, system.constants, x0, {0, options.settle}, to_end);
  if (!settled.outcome) return without_orbit(settled.outcome);
  const auto motion = run_flow(system, system.constants, settled.final_state(), {0, options.duration}, run);
  if (!motion.outcome) return without_orbit(motion.outcome);

  const Extent extent = extent_of(motion.x);
  std::size_t section = 0;  // the component that moves most for its size, which it had at the start or has now
  const auto share = [&](std::size_t i) {
    return extent.size(i) / std::max({std::abs(extent.low[i]), std::abs(extent.high[i]), std::abs(x0[i]), 1e-300});
  };
  for (std::size_t i = 1; i < system.size; ++i)
    if (share(i) > share(section)) section = i;
  if (share(section) < 1e-6)
    return without_orbit({}, "the motion comes to rest; start elsewhere, or see where with `steady`");
  const double level = (extent.low[section] + extent.high[section]) / 2;
  const auto crossings = poincare_section(system, motion.final_state(), section,
                                          {.level = level,
                                           .duration = options.duration,
                                           .rtol = options.rtol,
                                           .interrupt = options.interrupt,
                                           .progress = after(options.settle + options.duration)});
  if (!crossings.outcome) return without_orbit(crossings.outcome);
  const double period = time_to_return(crossings.points, extent);
  if (period == 0)
    return without_orbit({}, fmt::format("the motion does not come back to where it was within a time of {}; it may "
                                         "need longer to settle, or have no period",
                                         options.duration));

  const X start = crossings.points.back().x;
  Options<X> dense = run;
  dense.progress = {};
  dense.save = Save<X>::dense();
  const auto turn = run_flow(system, system.constants, start, {0, period}, dense);
  if (!turn.outcome) return without_orbit(turn.outcome);
  BoundaryValueOptions solving{.tolerance = options.tolerance, .interrupt = options.interrupt};
  for (const double t : turn.t) solving.mesh.push_back(t / period);
  const BoundaryValueProblem problem{over_one_period(system, period),
                                     {0, 1},
                                     [n = system.size, section, level](Values x, Values, std::span<double> g) {
                                       for (std::size_t i = 0; i < n; ++i) g[i] = x[i] - x[n + i];
                                       g[n] = x[section] - level;
                                     }};
  PeriodicOrbit result;
  result.orbit = solve_boundary_values(
      problem, [&](double s, std::span<double> x) { std::ranges::copy(turn(s * period), x.begin()); }, solving);
  result.outcome = result.orbit.outcome;
  if (!result.outcome) {
    result.outcome.hint =
        "the motion comes back, but no single orbit could be solved for: a system that keeps its energy has one for "
        "each "
        "energy, and none that stands by itself";
    return result;
  }
  result.period = result.orbit.parameters[0];
  to_end.progress = {};
  result.multipliers = multipliers_of(system, result.orbit(0), result.period, to_end);
  // One multiplier is 1, of a shift along the orbit: that nearest to it.
  auto others = result.multipliers;
  const auto shift =
      std::ranges::min_element(others, {}, [](const std::complex<double>& value) { return std::abs(value - 1.0); });
  if (shift != others.end()) others.erase(shift);
  result.stable = std::ranges::all_of(others, [](const auto& value) { return std::abs(value) < 1; });
  return result;
}

}  // namespace continuo::studies
