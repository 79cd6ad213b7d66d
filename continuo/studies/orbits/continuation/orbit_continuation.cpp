// continuo/studies/orbits/continuation/orbit_continuation.cpp
// Checks a request to follow closed orbits, and starts the follower.
#include <array>

#include <fmt/format.h>

#include <continuo/studies/orbit_continuation.hpp>
#include <continuo/studies/orbits/continuation/orbit_follower.hpp>
#include <continuo/studies/support/flow.hpp>

namespace continuo::studies {

namespace {

using Vector = std::vector<double>;

constexpr const char* forced = "the equations depend on time; an orbit is searched for where they do not";

/// Whether an orbit can be followed from this value of the constant.
Status validate(const ParametricSystem& system, const OrbitContinuationOptions& options, double begin) {
  if (options.constant >= system.parameters())
    return invalid_input(
        fmt::format("there is no constant number {}; there are {}", options.constant, system.parameters()));
  const std::string name = system.constant_name(options.constant);
  if (!(options.low < options.high)) return invalid_input(fmt::format("the range of {} is empty", name));
  if (system.size < 2) return invalid_input("one state alone never returns; an orbit needs two");
  if (!(begin >= options.low && begin <= options.high))
    return invalid_input(
        fmt::format("{} is {:.10g} at the start, outside of {:.10g}..{:.10g}", name, begin, options.low, options.high));
  return {};
}

}  // namespace

std::string_view to_string(OrbitBifurcation kind) {
  constexpr std::array<std::string_view, 6> names{
      "fold", "period doubling", "torus", "crossing of branches", "homoclinic orbit", "central homoclinic orbit"};
  return names[static_cast<std::size_t>(kind)];
}

OrbitBranch continue_orbit(const ParametricSystem& system, const PeriodicOrbit& start,
                           const OrbitContinuationOptions& options) {
  OrbitBranch branch;
  const double begin = options.constant < system.parameters() ? system.constants[options.constant] : 0;
  branch.status = validate(system, options, begin);
  if (branch.status && !start.outcome) branch.status = {.ending = start.outcome.ending, .message = start.outcome.hint};
  if (!branch.status) return branch;
  ParametricSystem turning(system);
  turning.advance = start.advance;
  return detail::OrbitFollower(turning, options)
      .from_orbit([&](double part) { return start.orbit(part); }, start.period, start.orbit.mesh);
}

OrbitBranch continue_orbit(const ParametricSystem& system, const OrbitPoint& start,
                           const OrbitContinuationOptions& options) {
  OrbitBranch branch;
  branch.status = validate(system, options, start.constant);
  if (branch.status && depends_on_time(system, start.x)) branch.status = invalid_input(forced);
  if (!branch.status) return branch;
  Vector p(system.constants);
  p[options.constant] = start.constant;
  ParametricSystem there(system);
  there.constants = p;
  there.advance = start.advance;
  const auto turn = run_flow(there, p, start.x, {0, start.period},
                             {.rtol = options.rtol,
                              .atol = 1e-3 * options.rtol,
                              .save = Save<Vector>::dense(),
                              .interrupt = options.interrupt});
  if (!turn.outcome) {
    branch.status = status(turn.outcome);
    return branch;
  }
  return detail::OrbitFollower(there, options)
      .from_orbit([&](double part) { return turn(part * start.period); }, start.period, turn.t);
}

OrbitBranch continue_orbit(const ParametricSystem& system, const HopfPoint& start,
                           const OrbitContinuationOptions& options) {
  OrbitBranch branch;
  branch.status = validate(system, options, start.constant);
  if (branch.status && depends_on_time(system, start.x)) branch.status = invalid_input(forced);
  return branch.status ? detail::OrbitFollower(system, options).from_hopf(start) : branch;
}

OrbitBranch continue_orbit(const ParametricSystem& system, const OrbitMark& start,
                           const OrbitContinuationOptions& options) {
  OrbitBranch branch;
  branch.status = validate(system, options, start.at.constant);
  const bool branches = start.kind == OrbitBifurcation::period_doubling || start.kind == OrbitBifurcation::crossing;
  if (branch.status && !branches)
    branch.status = invalid_input(fmt::format("no branch begins at a {}", to_string(start.kind)));
  if (branch.status && start.mesh.size() < 2) branch.status = invalid_input("the orbit there is not known");
  if (!branch.status) return branch;
  ParametricSystem turning(system);
  turning.advance = start.at.advance;
  if (start.kind == OrbitBifurcation::period_doubling)
    for (double& part : turning.advance) part *= 2;
  return detail::OrbitFollower(turning, options).from_mark(start);
}

}  // namespace continuo::studies
