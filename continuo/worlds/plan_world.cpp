// continuo/worlds/plan_world.cpp
// Chooses the method, the tolerance, the step and the rows of a world of bodies.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <continuo/language/world_methods.hpp>
#include <continuo/simulation/drive/planner.hpp>
#include <continuo/symbolic/names/suggest.hpp>
#include <continuo/worlds/plan_world.hpp>

namespace continuo::worlds {

namespace {

using model::Experiment;
using model::NodeId;
using model::Plan;
using model::Planner;

/// The value of a number of the world; nothing where the model leaves it to the motion.
std::optional<double> number(const model::Model& model, NodeId node, const Plan& plan) {
  return node.valid() ? std::optional(evaluate(model, node, plan.variables)) : std::nullopt;
}

/// Sets the method: that of the world's mode, or the one that the experiment names instead.
bool set_method(Planner& planner, const model::Model& model, const Experiment& experiment,
                std::vector<model::Diagnostic>& problems) {
  const model::WorldDescription& world = *model.world;
  Plan& plan = planner.plan();
  plan.method = experiment.method.value_or(world.mode.fast ? "fast" : "exact");
  plan.reason = experiment.method ? "it was asked for" : "the world names it";
  const std::vector<std::string> names = model::world_methods(world, model), all = model::world_methods();
  if (std::ranges::find(names, plan.method) != names.end()) return true;
  const std::vector<model::ExactRefusal> refusals = model::exact_refusals(world, model);
  if ((plan.method == "exact" || plan.method == "dop853") && !refusals.empty()) {
    problems.push_back(model::error("E334", refusals.front().span, refusals.front().message, "",
                                    fmt::format("there are {}", fmt::join(names, " and "))));
    return false;
  }
  if (std::ranges::find(all, plan.method) != all.end()) {
    planner.fail("E334", fmt::format("`{}` moves balls without joints, and this world has more", plan.method),
                 fmt::format("there are {}", fmt::join(names, " and ")), true);
    return false;
  }
  const std::string near = model::did_you_mean(plan.method, names);
  planner.fail("E334", fmt::format("there is no method `{}` for bodies", plan.method),
               near.empty() ? fmt::format("there are {}", fmt::join(names, ", ")) : near, true);
  return false;
}

bool set_tolerance(Planner& planner, const model::Model& model, const Experiment& experiment) {
  constexpr double usual_tolerance = 1e-10;
  Plan& plan = planner.plan();
  if (!experiment.rtol_of.empty() || !experiment.atol_of.empty() || !experiment.atol.empty() ||
      !model.run.atol.empty()) {
    planner.fail("E333", "a world of bodies has one tolerance, a relative one", "give --tol 1e-9 alone",
                 planner.asks_for_tolerance());
    return false;
  }
  const auto of_mode = number(model, model.world->mode.tolerance, plan);
  plan.rtol = experiment.rtol.value_or(of_mode.value_or(model.run.rtol.value_or(usual_tolerance)));
  plan.atol = {plan.rtol};
  if (!(plan.rtol > 0))
    planner.fail("E333", "a tolerance is not positive", "give a positive one, such as --tol 1e-9", true);
  return true;
}

void set_step(Planner& planner, const model::Model& model, const Experiment& experiment) {
  Plan& plan = planner.plan();
  if (plan.method == "exact" || plan.method == "dop853") return;
  const auto of_mode = number(model, model.world->mode.step, plan);
  const auto step = experiment.step ? experiment.step : of_mode ? of_mode : planner.value(model.run.step);
  if (!step)
    return planner.fail("E331", fmt::format("`{}` takes steps, and nothing says how long", plan.method),
                        "write `mode fast step 1/60` in the world, or give --step", experiment.method.has_value());
  plan.step = *step;
  if (!(*step > 0) || !std::isfinite(*step))
    planner.fail("E333", fmt::format("a step of {} leads nowhere", *step), "give a positive step",
                 experiment.step.has_value());
}

void set_motion(Planner& planner, const model::Model& model, const Experiment& experiment,
                std::vector<model::Diagnostic>& problems) {
  if (experiment.max_step || experiment.max_steps)
    return planner.fail("E333", "the steps of a world are those of its mode", "leave out --max-step and --max-steps",
                        true);
  if (!set_method(planner, model, experiment, problems)) return;
  if (set_tolerance(planner, model, experiment)) set_step(planner, model, experiment);
}

/// Sets rows at equal intervals of time, for a motion from collision to collision, which has no steps to show, unless
/// the model names other rows.
void set_usual_output(Plan& plan) {
  constexpr double usual_rows = 200;
  plan.output = model::OutputPlan::Kind::every;
  plan.interval = (plan.to - plan.from) / usual_rows;
  if (!(plan.interval > 0)) plan.interval = 1;
}

}  // namespace

std::optional<Plan> plan_world(const model::Model& model, const Experiment& experiment,
                               std::vector<model::Diagnostic>& problems) {
  Planner planner(model, experiment, problems);
  planner.begin();
  set_motion(planner, model, experiment, problems);
  if (!model.run.output) set_usual_output(planner.plan());
  return planner.finish();
}

}  // namespace continuo::worlds
