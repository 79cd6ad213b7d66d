// continuo/studies/orbits/continuation/periodic_orbit.cpp
// Finds a closed orbit from a motion, by collocation over one period.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <continuo/boundary/lobatto.hpp>
#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/studies/conservation_laws.hpp>
#include <continuo/studies/orbits/continuation/orbit_return.hpp>
#include <continuo/studies/periodic_orbit.hpp>
#include <continuo/studies/support/flow.hpp>

namespace continuo::studies {

using boundary::BoundaryValueOptions;
using boundary::BoundaryValueProblem;
using boundary::BoundaryValueSolution;
using boundary::lobatto4;

namespace {

using X = std::vector<double>;
using detail::Extent;
using detail::extent_of;
using detail::goes_on;
using detail::last_return;
using detail::Return;

constexpr double return_part = 1e-3;  // of the size of the motion: so near, and it has come back

PeriodicOrbit without_orbit(Outcome<double> outcome, std::string hint = {}) {
  PeriodicOrbit none;
  none.outcome = std::move(outcome);
  if (!hint.empty()) {
    none.outcome.ending = Ending::nonlinear_solve_failed;
    none.outcome.hint = std::move(hint);
  }
  return none;
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

/// M = dx(T)/dx(0) has the multiplier 1 along the orbit, in the direction of f. The others are those of the return to
/// the section x_s = level, dP = (1 - f e_s^T / f_s) M without row and column s: what is known to be 1 does not cost
/// the small ones their digits, of which a relaxation oscillation has none to spare.
std::vector<std::complex<double>> multipliers_of(const ParametricSystem& system, const X& x0, double period,
                                                 std::size_t section, Options<X> run) {
  constexpr double rtol = 1e-12;
  const std::size_t n = system.size;
  run.rtol = rtol;
  run.atol = 1e-3 * rtol;
  const auto end = run_flow(with_variations(system), system.constants, variational_start(system, x0), {0, period}, run);
  X f(n);
  system.derivative(0, x0, system.constants, f);
  if (!end.outcome || f[section] == 0) return {};
  const auto entry = [&](std::size_t i, std::size_t c) { return end.final_state()[n * (1 + c) + i]; };
  std::vector<double> rows;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t c = 0; c < n; ++c)
      if (i != section && c != section) rows.push_back(entry(i, c) - f[i] / f[section] * entry(section, c));
  auto values = eigenvalues(rows, n - 1).values;
  leave_out_conserved(system, std::exp(-system.conserved_rate * period), values);
  values.emplace_back(1);
  std::ranges::sort(values, [](const auto& a, const auto& b) { return std::abs(a) > std::abs(b); });
  return values;
}

/// Whether all but the one along the orbit are inside the unit circle by at least `margin`.
bool attracts(std::vector<std::complex<double>> multipliers, double margin) {
  const auto shift = std::ranges::min_element(multipliers, {},
                                              [](const std::complex<double>& value) { return std::abs(value - 1.0); });
  if (shift == multipliers.end()) return false;
  multipliers.erase(shift);
  return std::ranges::all_of(multipliers, [&](const auto& value) { return std::abs(value) < 1 - margin; });
}

/// A run over one period as a solution over s = t / T.
BoundaryValueSolution over_one_period(const ParametricSystem& system, const Solution<X>& turn, double period) {
  BoundaryValueSolution orbit;
  orbit.size = system.size;
  orbit.parameters = {period};
  for (const double t : turn.t) orbit.mesh.push_back(t / period);
  X slope(system.size);
  const auto add = [&](double s) {
    const X x = turn(s * period);
    system.derivative(0, x, system.constants, slope);
    orbit.points.insert(orbit.points.end(), x.begin(), x.end());
    for (const double f : slope) orbit.slopes.push_back(period * f);
  };
  for (std::size_t k = 0; k + 1 < orbit.mesh.size(); ++k)
    for (std::size_t j = 0; j + 1 < lobatto4.stages; ++j)
      add(orbit.mesh[k] + lobatto4.c[j] * (orbit.mesh[k + 1] - orbit.mesh[k]));
  add(orbit.mesh.back());
  return orbit;
}

/// The orbit by following the motion, where it attracts: jumps that are thousands of times shorter than the period
/// leave Newton's iteration on all of it at once too little to converge in, but do not disturb who runs along. Empty
/// period where two returns in a row do not agree, or nothing says that they would from elsewhere.
PeriodicOrbit by_following(const ParametricSystem& system, const X& start, const Extent& extent,
                           const std::vector<X>& states, std::size_t section, const SectionOptions& passing,
                           double period, Options<X> run) {
  constexpr double rtol = 1e-12, atol = 1e-3 * rtol, alike = 1e-9, attraction = 0.01;
  PeriodicOrbit found;
  SectionOptions closely(passing);
  closely.duration = 4.5 * period;
  closely.rtol = rtol;
  closely.progress = {};
  const auto crossings = poincare_section(system, start, section, closely);
  const std::span<const SectionPoint> points = crossings.points;
  if (!crossings.outcome || points.size() < 3) return found;
  const Return last_one = last_return(system, points, extent, states, alike, 10 * atol);
  const double last = last_one.time;
  const double before = last_return(system, points.first(points.size() - 1), extent, states, alike, 10 * atol).time;
  if (last == 0 || !(std::abs(last - before) <= alike * last)) return found;
  found.advance = last_one.advance;
  found.multipliers = multipliers_of(system, points.back().x, last, section, run);
  found.stable = attracts(found.multipliers, attraction);
  if (!found.stable) return found;
  run.rtol = rtol;
  run.atol = 1e-3 * rtol;
  run.save = Save<X>::dense();
  const auto turn = run_flow(system, system.constants, points.back().x, {0, last}, run);
  if (!turn.outcome) return found;
  found.orbit = over_one_period(system, turn, last);
  found.period = last;
  return found;
}

}  // namespace

// Where a component turns its slope is 0: a bisection between two places of the mesh with slopes of different sign.
OrbitExtents extents_of(const ParametricSystem& system, const PeriodicOrbit& found) {
  const std::size_t n = system.size;
  X slope(n);
  const auto slope_at = [&](double s) -> const X& {
    system.derivative(0, found.orbit(s), system.constants, slope);
    return slope;
  };
  OrbitExtents extents{found.orbit(0), found.orbit(0)};
  const auto add = [&](std::size_t i, double value) {
    extents.low[i] = std::min(extents.low[i], value);
    extents.high[i] = std::max(extents.high[i], value);
  };
  const auto& mesh = found.orbit.mesh;
  X before = slope_at(mesh.front());
  for (std::size_t k = 1; k < mesh.size(); ++k) {
    const X x = found.orbit(mesh[k]), after = slope_at(mesh[k]);
    for (std::size_t i = 0; i < n; ++i) {
      add(i, x[i]);
      if ((before[i] < 0) == (after[i] < 0)) continue;
      double low = mesh[k - 1], high = mesh[k];
      for (int j = 0; j < 40 && low < (low + high) / 2 && (low + high) / 2 < high; ++j) {
        const double middle = (low + high) / 2;
        ((slope_at(middle)[i] < 0) == (before[i] < 0) ? low : high) = middle;
      }
      add(i, found.orbit(high)[i]);
    }
    before = after;
  }
  return extents;
}

bool depends_on_time(const ParametricSystem& system, const X& x) {
  X now(x.size()), later(x.size());
  system.derivative(0, x, system.constants, now);
  system.derivative(0.7310585786300049, x, system.constants, later);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (now[i] != later[i] && !(std::isnan(now[i]) && std::isnan(later[i]))) return true;
  return false;
}

Section poincare_section(const ParametricSystem& system, std::vector<double> x0, std::size_t component,
                         const SectionOptions& options) {
  Section section;
  Options<X> run{.rtol = options.rtol, .atol = 1e-3 * options.rtol};
  run.interrupt = options.interrupt;
  run.progress = options.progress;
  run.save = Save<X>::only_end();
  if (options.every_turn)
    run.events = {rises<X>(
        "section", [component, level = options.level](double, const X& x) { return std::sin(x[component] - level); })};
  else
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
  // An angle that turns over passes a plane only once: others come first.
  const auto rank = [&](std::size_t i) { return goes_on(motion.x, extent, i) ? 1e-6 : share(i); };
  for (std::size_t i = 1; i < system.size; ++i)
    if (rank(i) > rank(section)) section = i;
  if (share(section) < 1e-6)
    return without_orbit({}, "the motion converges to an equilibrium; start elsewhere, or find it with `steady`");
  const SectionOptions passing{.level = (extent.low[section] + extent.high[section]) / 2,
                               .duration = options.duration,
                               .rtol = options.rtol,
                               .every_turn = goes_on(motion.x, extent, section),
                               .interrupt = options.interrupt,
                               .progress = after(options.settle + options.duration)};
  const auto crossings = poincare_section(system, motion.final_state(), section, passing);
  if (!crossings.outcome) return without_orbit(crossings.outcome);
  const Return coming_back = last_return(system, crossings.points, extent, motion.x, return_part, 10 * run.atol);
  const double period = coming_back.time;
  const X& advance = coming_back.advance;
  if (period == 0) {
    auto none = without_orbit({}, fmt::format("the motion does not return to an earlier state within a time of {}; it "
                                              "may need longer to settle, or have no period",
                                              options.duration));
    none.wanders = true;
    return none;
  }

  X start = crossings.points.back().x;
  if (!advance.empty()) {  // f is the same some turns before, where angles are small
    const auto angle = static_cast<std::size_t>(std::ranges::find_if(advance, [](double part) { return part != 0; }) -
                                                advance.begin());
    const double turns = std::floor(start[angle] / advance[angle]);
    for (std::size_t i = 0; i < start.size(); ++i) start[i] -= turns * advance[i];
  }
  Options<X> dense = run;
  dense.progress = {};
  dense.save = Save<X>::dense();
  const auto turn = run_flow(system, system.constants, start, {0, period}, dense);
  if (!turn.outcome) return without_orbit(turn.outcome);
  // The steps of the run are a good mesh: what needs many times as many points is not found by more of them.
  BoundaryValueOptions solving{.tolerance = options.tolerance,
                               .check_error = false,
                               .most_intervals = 4000 + 8 * turn.t.size(),
                               .interrupt = options.interrupt};
  for (const double t : turn.t) solving.mesh.push_back(t / period);
  const BoundaryValueProblem problem{
      over_one_period(system, period),
      {0, 1},
      [n = system.size, section, level = start[section], advance](Values x, Values, std::span<double> g) {
        for (std::size_t i = 0; i < n; ++i) g[i] = x[i] - x[n + i] + (advance.empty() ? 0 : advance[i]);
        g[n] = x[section] - level;
      }};
  PeriodicOrbit result;
  result.orbit = solve_boundary_values(
      problem, [&](double s, std::span<double> x) { std::ranges::copy(turn(s * period), x.begin()); }, solving);
  result.outcome = result.orbit.outcome;
  to_end.progress = {};
  if (!result.outcome) {
    if (PeriodicOrbit followed = by_following(system, start, extent, motion.x, section, passing, period, to_end);
        followed.period > 0)
      return followed;
    result.outcome.hint =
        "the motion returns, but no single orbit could be solved for: a system that keeps its energy has one for "
        "each "
        "energy, and none that stands by itself";
    return result;
  }
  result.period = result.orbit.parameters[0];
  result.advance = advance;
  result.multipliers = multipliers_of(system, result.orbit(0), result.period, section, to_end);
  result.stable = attracts(result.multipliers, 0);
  return result;
}

}  // namespace continuo::studies
