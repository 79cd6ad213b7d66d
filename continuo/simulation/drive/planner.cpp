// continuo/simulation/drive/planner.cpp
// Takes what a run of equations needs from the experiment, else from the model, else by itself, and says what does not
// fit.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/world.hpp>
#include <continuo/simulation/drive/planner.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/simulation/program/singular_mass.hpp>

namespace continuo::model {

namespace {

constexpr double default_rtol = 1e-6;
constexpr double atol_part = 1e-3;  // of rtol, where nothing is said

}  // namespace

void Planner::begin() {
  check_parameters();
  plan_.variables = start_values(model_, experiment_.parameters, experiment_.from);
  set_start();
  set_interval();
}

void Planner::set_integration() {
  set_accuracy();
  set_method();
  set_limits();
}

std::optional<Plan> Planner::finish() {
  set_output();
  if (auto singular = singular_mass(model_, plan_.variables)) problems_.push_back(std::move(*singular));
  if (problems_.size() > before_) return std::nullopt;
  return std::move(plan_);
}

double Planner::value(const Setting& setting) const {
  return evaluate(model_, setting.node, plan_.variables);
}
std::optional<double> Planner::value(const std::optional<Setting>& setting) const {
  return setting ? std::optional(value(*setting)) : std::nullopt;
}
void Planner::fail(const char* code, std::string message, std::string help, bool overridden) {
  // The line that is shown is the model's, and innocent where a caller replaced what it says.
  if (overridden) message += ", asked for in place of what the model says";
  problems_.push_back(error(code, run_.span, std::move(message), {}, std::move(help)));
}

void Planner::check_parameters() {
  for (const auto& [name, given] : experiment_.parameters) {
    const std::size_t i = find_parameter(model_, name);
    const std::size_t input = find_input(model_, name);
    if (input != npos && !model_.inputs[input].points) continue;
    if (i == npos) {
      problems_.push_back(no_parameter(model_, name, run_.span));
    } else if (model_.parameters[i].structural && given != model_.parameters[i].value) {
      problems_.push_back(error("E343", model_.parameters[i].span,
                                fmt::format("`{}` decides how many equations there are", name), {},
                                "read the model anew with this value (CheckOptions::overrides)"));
    }
  }
}

// In the order of the names, so that u[3] comes after u, its family.
void Planner::set_start() {
  plan_.initial = experiment_.initial;
  for (const auto& [name, value] : experiment_.initial) {
    const std::vector<std::size_t> meant = states_named(model_, name);
    if (meant.empty()) problems_.push_back(no_state(model_, name, run_.span));
    for (const std::size_t i : meant) {
      if (model_.has_world() && i >= model_.world->first_measure) {
        fail("E346", fmt::format("`{}` follows from the bodies", name), "set where a body begins, such as ball.x",
             true);
        break;
      }
      plan_.variables[model_.layout.states + i] = value;
    }
  }
}

void Planner::set_interval() {
  plan_.from = plan_.variables[Layout::time];
  const auto to = experiment_.to ? experiment_.to : value(run_.to);
  if (!to) return fail("E333", "nothing says how long to run", "add `run 0..10` to the model, or give --until");
  plan_.to = *to;
  if (!std::isfinite(plan_.from) || !std::isfinite(plan_.to) || plan_.to < plan_.from) {
    fail("E333", fmt::format("a run cannot go from {} to {}", plan_.from, plan_.to), "the end comes after the start",
         experiment_.from || experiment_.to);
  }
}

void Planner::set_accuracy() {
  const auto step = experiment_.step ? experiment_.step : asks_for_tolerance() ? std::nullopt : value(run_.step);
  plan_.step = step.value_or(0);
  if (step && !(*step > 0)) {
    fail("E333", fmt::format("a step of {} leads nowhere", *step), "give a positive step",
         experiment_.step.has_value());
  }
  set_tolerances();
}

/// A fixed step that a caller asks for takes the place of the model's longest one.
void Planner::set_limits() {
  const auto limit = experiment_.max_steps ? experiment_.max_steps : run_.max_steps;
  plan_.max_steps = limit.value_or(max_steps_of(plan_));
  if (plan_.max_steps == 0) fail("E333", "a run of no steps leads nowhere", "give at least --max-steps 1", true);
  if (plan_.step > 0 && experiment_.max_step)
    fail("E333", "steps that are given have no longest one", "leave out the step, or --max-step", true);
  const auto longest = experiment_.max_step ? experiment_.max_step : value(run_.max_step);
  if (plan_.step > 0 || !longest) return;
  plan_.max_step = *longest;
  if (!(*longest > 0)) {
    fail("E333", fmt::format("steps of at most {} lead nowhere", *longest), "give a positive longest step",
         experiment_.max_step.has_value());
  }
}

bool Planner::asks_for_tolerance() const {
  return experiment_.rtol || !experiment_.atol.empty() || !experiment_.rtol_of.empty() || !experiment_.atol_of.empty();
}

void Planner::set_tolerances() {
  const std::size_t n = model_.states.size();
  plan_.rtol = experiment_.rtol.value_or(run_.rtol.value_or(default_rtol));
  if (!experiment_.rtol_of.empty()) {
    plan_.rtol_each.assign(n, plan_.rtol);
    place_by_name(experiment_.rtol_of, plan_.rtol_each);
  }
  plan_.atol = !experiment_.atol.empty() ? experiment_.atol : run_.atol;
  if (plan_.atol.empty()) {
    for (const double rtol : plan_.rtol_each) plan_.atol.push_back(rtol * atol_part);
    if (plan_.atol.empty()) plan_.atol = {plan_.rtol * atol_part};
  }
  if (plan_.atol.size() != 1 && plan_.atol.size() != n) {
    return fail("E333", fmt::format("{} absolute tolerances for {} states", plan_.atol.size(), n),
                "give one for all, or one for each");
  }
  if (!experiment_.atol_of.empty()) {
    if (plan_.atol.size() == 1) plan_.atol.resize(n, plan_.atol.front());
    place_by_name(experiment_.atol_of, plan_.atol);
  }
  if (!plan_.rtol_each.empty()) plan_.rtol = std::ranges::min(plan_.rtol_each);
  const bool usable = plan_.rtol >= 0 && std::ranges::all_of(plan_.atol, [](double atol) { return atol > 0; });
  if (!usable) {
    fail("E333", "a tolerance is not positive", "give positive ones, such as --tol 1e-6 --atol 1e-9",
         asks_for_tolerance());
  }
}

// In the order of the names, so that u[3] comes after u, its family.
void Planner::place_by_name(const Overrides& given, std::vector<double>& each) {
  for (const auto& [name, tolerance] : given) {
    const std::vector<std::size_t> meant = states_named(model_, name);
    if (meant.empty()) problems_.push_back(no_state(model_, name, run_.span));
    for (const std::size_t i : meant) each[i] = tolerance;
  }
}

void Planner::set_method() {
  const auto [name, reason] = choice();
  plan_.method = canonical_name(name);
  plan_.reason = reason;
  if (const MethodInfo* info = find_method(name)) return accept(*info);
  Diagnostic problem = no_method(name, run_.span);
  fail("E330", std::move(problem.message), std::move(problem.help), experiment_.method.has_value());
}

Choice Planner::choice() const {
  if (experiment_.method) return {*experiment_.method, "it was asked for"};
  if (run_.method) return {*run_.method, "the model names it"};
  if (plan_.step > 0 && !model_.needs_dae_solver())
    return {"tsitouras5", "a step is given, and this one costs little for its order"};
  return choose_method({.size = model_.states.size(),
                        .rtol = plan_.rtol,
                        .algebraic = model_.needs_dae_solver(),
                        .accelerations = model_.all_paired && !model_.accelerations_depend_on_velocities,
                        .sparse = true,  // the graph has the pattern of df/dx
                        .banded = is_banded()});
}

/// Only of a large model does the choice depend on it; it is differentiated for that.
bool Planner::is_banded() const {
  constexpr std::size_t smallest = 100;
  if (model_.states.size() <= smallest) return false;
  return ModelSystem(compile(model_), start_values(model_)).jacobian_pattern().is_banded();
}

void Planner::accept(const MethodInfo& method) {
  if (method.error_order == 0 && plan_.step == 0) {
    fail("E331", fmt::format("`{}` does not estimate its error, so it cannot choose its step", method.name),
         "give a step: --step 0.01, or `step 0.01` in the run statement", experiment_.method.has_value());
  }
  if (!method.implicit && model_.needs_dae_solver()) {
    fail("E320", fmt::format("`{}` cannot solve the equations `0 = ...` of this model", method.name),
         "take an implicit method, such as rodas5p or bdf, or name none", experiment_.method.has_value());
  }
  if (method.second_order && !model_.all_paired) {
    fail("E332", fmt::format("`{}` is for equations of the form x'' = a(t, x) only", method.name),
         fmt::format("{} is no position or velocity; take another method", unpaired()), experiment_.method.has_value());
  }
}

std::string Planner::unpaired() const {
  for (std::size_t i = 0; i < model_.states.size(); ++i) {
    bool found = false;
    for (const PositionVelocity& pair : model_.pairs) found = found || pair.position == i || pair.velocity == i;
    if (!found) return "`" + model_.states[i].column + "`";
  }
  return "a state";
}

void Planner::set_output() {
  using Kind = OutputPlan::Kind;
  if (experiment_.output_steps) return;
  if (experiment_.output) {
    plan_.output = Kind::every;
    plan_.interval = *experiment_.output;
  } else if (run_.output) {
    plan_.output = run_.output->kind;
    plan_.interval = value(run_.output->interval).value_or(0);
    plan_.per_decade = run_.output->per_decade;
    plan_.first = value(run_.output->first).value_or(0);
  }
  if (plan_.output == Kind::every && !(plan_.interval > 0)) {
    fail("E333", fmt::format("rows every {} are no rows", plan_.interval), "give a positive interval",
         experiment_.output.has_value());
  }
  if (plan_.output == Kind::every && (plan_.to - plan_.from) / plan_.interval > 1e9) {
    fail("E333", "that would be more than 1e9 rows", "give a longer interval");
  }
  if (plan_.output == Kind::logarithmic && (!(plan_.first > 0) || plan_.per_decade < 1)) {
    fail("E333", "rows per decade need a positive first time", "`output log 5 per decade from 1e-3`");
  }
}

}  // namespace continuo::model
