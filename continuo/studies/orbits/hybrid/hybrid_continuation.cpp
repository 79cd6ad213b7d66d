// Starts a branch of closed orbits through events from an orbit or a mark.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/hybrid_continuation.hpp>
#include <continuo/studies/orbits/hybrid/hybrid_follower.hpp>
#include <continuo/studies/support/forcing_period.hpp>
#include <continuo/studies/support/hybrid_run.hpp>

namespace continuo::studies {

namespace {

struct Wanted {
  std::string name;
  double now = 0;
  Status status;  // a failure where nothing can be followed
};

Wanted wanted_of(const model::ModelProgram& program, const model::Experiment& experiment,
                 const HybridContinuationOptions& options) {
  Wanted wanted;
  if (options.constant >= program.model.parameters.size()) {
    wanted.status = invalid_input(fmt::format("there is no parameter number {}; there are {}", options.constant,
                                              program.model.parameters.size()));
    return wanted;
  }
  const model::Parameter& parameter = program.model.parameters[options.constant];
  wanted.name = parameter.name;
  const auto set = experiment.parameters.find(parameter.name);
  wanted.now = set == experiment.parameters.end() ? parameter.value : set->second;
  if (!(options.low < options.high))
    wanted.status = invalid_input(fmt::format("the range of {} is empty", wanted.name));
  return wanted;
}

/// A forcing's phase is that of t: as near to its beginning as the model allows, so that it hardly moves where the
/// forcing's period does. What happens once at a set time is not to happen again.
model::Instant early(const model::ModelProgram& program, const model::Experiment& experiment, model::Instant start,
                     double forcing) {
  for (const model::Scheduled& event : program.model.schedule)
    if (event.kind == model::Scheduled::Kind::at || event.first) return start;
  Outcome<double> outcome;
  const std::optional<model::Plan> plan = plan_of(program, exactly(program, experiment, 1e-12), outcome);
  if (plan) start.t -= forcing * std::max(0.0, std::floor((start.t - plan->from) / forcing));
  return start;
}

}  // namespace

OrbitBranch continue_hybrid_orbit(const std::shared_ptr<const model::ModelProgram>& program,
                                  const model::Experiment& experiment, const HybridOrbit& start,
                                  const HybridContinuationOptions& options) {
  OrbitBranch branch;
  const Wanted wanted = wanted_of(*program, experiment, options);
  branch.status = wanted.status;
  if (branch.status && !start.outcome) branch.status = {.ending = start.outcome.ending, .message = start.outcome.hint};
  if (branch.status && !(wanted.now >= options.low && wanted.now <= options.high))
    branch.status = invalid_input(fmt::format("{} is {:.10g} at the start, outside of {:.10g}..{:.10g}", wanted.name,
                                              wanted.now, options.low, options.high));
  if (branch.status && start.family)
    branch.status = invalid_input(
        "the orbit is one of a family: a quantity is conserved, and there is one for each of its values, all at one "
        "value of the parameter");
  if (!branch.status) return branch;
  const model::Instant begin =
      options.forcing ? early(*program, experiment, start.start, *options.forcing) : start.start;
  detail::HybridBranchSteps steps(program, experiment, options, start.period, start.low, start.high);
  if (!steps.begin(begin, start.period, wanted.now)) {
    branch.status = steps.status();
    return branch;
  }
  return detail::HybridFollower(options, wanted.name, steps).from_orbit(begin, start.period, wanted.now);
}

OrbitBranch continue_hybrid_orbit(const std::shared_ptr<const model::ModelProgram>& program,
                                  const model::Experiment& experiment, const OrbitMark& start,
                                  const HybridContinuationOptions& options) {
  OrbitBranch branch;
  const Wanted wanted = wanted_of(*program, experiment, options);
  branch.status = wanted.status;
  const bool branches = start.kind == OrbitBifurcation::period_doubling || start.kind == OrbitBifurcation::crossing;
  if (branch.status && !branches)
    branch.status = invalid_input(fmt::format("no branch begins at a {}", to_string(start.kind)));
  if (branch.status && !start.begin) branch.status = invalid_input("the orbit there is not known");
  if (!branch.status) return branch;
  const double period = start.kind == OrbitBifurcation::period_doubling ? 2 * start.at.period : start.at.period;
  detail::HybridBranchSteps steps(program, experiment, options, period, start.at.low, start.at.high);
  if (!steps.begin(*start.begin, period, start.at.constant)) {
    branch.status = steps.status();
    return branch;
  }
  return detail::HybridFollower(options, wanted.name, steps).from_mark(start);
}

}  // namespace continuo::studies
