// continuo/simulation/experiment.cpp
// Makes a plan of a model's `run` statement and a caller's experiment, or names what does not fit.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/world.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/simulation/program/singular_mass.hpp>
#include <continuo/solve/catalogue.hpp>
#include <continuo/solve/choice.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model {

namespace {

constexpr double default_rtol = 1e-6;
constexpr double atol_part = 1e-3;  // of rtol, where nothing is said

class Planner {
 public:
  Planner(const Model& model, const Experiment& experiment, std::vector<Diagnostic>& problems)
      : model_(model), experiment_(experiment), run_(model.run), problems_(problems) {}

  std::optional<Plan> plan() {
    const std::size_t before = problems_.size();
    check_parameters();
    plan_.variables = start_values(model_, experiment_.parameters, experiment_.from);
    set_interval();
    if (model_.has_world()) {
      set_world();
    } else {
      set_accuracy();
      set_method();
      set_limits();
    }
    set_output();
    if (auto singular = singular_mass(model_, plan_.variables)) problems_.push_back(std::move(*singular));
    if (problems_.size() > before) return std::nullopt;
    return std::move(plan_);
  }

 private:
  double value(const Setting& setting) const { return evaluate(model_, setting.node, plan_.variables); }
  std::optional<double> value(const std::optional<Setting>& setting) const {
    return setting ? std::optional(value(*setting)) : std::nullopt;
  }
  void fail(const char* code, std::string message, std::string help, bool overridden = false) {
    // The line that is shown is the model's, and innocent where a caller replaced what it says.
    if (overridden) message += ", asked for in place of what the model says";
    problems_.push_back(error(code, run_.span, std::move(message), {}, std::move(help)));
  }

  void check_parameters() {
    for (const auto& [name, given] : experiment_.parameters) {
      const std::size_t i = find_parameter(model_, name);
      if (i == npos) {
        problems_.push_back(no_parameter(model_, name, run_.span));
      } else if (model_.parameters[i].structural && given != model_.parameters[i].value) {
        problems_.push_back(error("E343", model_.parameters[i].span,
                                  fmt::format("`{}` decides how many equations there are", name), {},
                                  "read the model anew with this value (CheckOptions::overrides)"));
      }
    }
  }

  void set_interval() {
    plan_.from = plan_.variables[Layout::time];
    const auto to = experiment_.to ? experiment_.to : value(run_.to);
    if (!to) return fail("E333", "nothing says how long to run", "add `run 0..10` to the model, or give --until");
    plan_.to = *to;
    if (!std::isfinite(plan_.from) || !std::isfinite(plan_.to) || plan_.to < plan_.from) {
      fail("E333", fmt::format("a run cannot go from {} to {}", plan_.from, plan_.to), "the end comes after the start",
           experiment_.from || experiment_.to);
    }
  }

  void set_accuracy() {
    const auto step = experiment_.step ? experiment_.step : asks_for_tolerance() ? std::nullopt : value(run_.step);
    plan_.step = step.value_or(0);
    if (step && !(*step > 0)) {
      fail("E333", fmt::format("a step of {} leads nowhere", *step), "give a positive step",
           experiment_.step.has_value());
    }
    set_tolerances();
  }

  /// A fixed step that a caller asks for takes the place of the model's longest one.
  void set_limits() {
    const bool limited = experiment_.max_step || experiment_.max_steps;
    if (limited && model_.needs_boundary_solver())
      fail("E333", "conditions at several times are met without steps in time", "leave out --max-step and --max-steps",
           true);
    plan_.max_steps = experiment_.max_steps.value_or(run_.max_steps.value_or(usual_max_steps));
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

  bool asks_for_tolerance() const {
    return experiment_.rtol || !experiment_.atol.empty() || !experiment_.rtol_of.empty() ||
           !experiment_.atol_of.empty();
  }

  void set_tolerances() {
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
  void place_by_name(const Overrides& given, std::vector<double>& each) {
    for (const auto& [name, tolerance] : given) {
      const std::vector<std::size_t> meant = states_named(model_, name);
      if (meant.empty()) problems_.push_back(no_state(model_, name, run_.span));
      for (const std::size_t i : meant) each[i] = tolerance;
    }
  }

  void set_method() {
    const auto [name, reason] = choice();
    plan_.method = canonical_name(name);
    plan_.reason = reason;
    std::vector<std::string> names;
    for (const MethodInfo& info : method_catalogue()) {
      names.emplace_back(info.name);
      if (info.name == plan_.method) return accept(info);
    }
    const std::string near = did_you_mean(name, names);
    fail("E330", fmt::format("there is no method `{}`", name), near.empty() ? "`continuo methods` lists them" : near,
         experiment_.method.has_value());
  }

  /// Bodies are moved by the mode of their world, or by what a caller names instead.
  void set_world() {
    constexpr double usual_tolerance = 1e-10;
    const WorldMode& mode = model_.world->mode;
    const auto number = [&](NodeId node) {
      return node.valid() ? std::optional(evaluate(model_, node, plan_.variables)) : std::nullopt;
    };
    if (experiment_.max_step || experiment_.max_steps)
      return fail("E333", "the steps of a world are those of its mode", "leave out --max-step and --max-steps", true);
    plan_.method = experiment_.method.value_or(mode.fast ? "fast" : "exact");
    plan_.reason = experiment_.method ? "it was asked for" : "the world names it";
    const std::vector<std::string> names = world_methods();
    if (std::ranges::find(names, plan_.method) == names.end()) {
      const std::string near = did_you_mean(plan_.method, names);
      return fail("E334", fmt::format("there is no method `{}` for bodies", plan_.method),
                  near.empty() ? fmt::format("there are {}", fmt::join(names, ", ")) : near, true);
    }
    if (!experiment_.rtol_of.empty() || !experiment_.atol_of.empty() || !experiment_.atol.empty() || !run_.atol.empty())
      return fail("E333", "a world of bodies has one tolerance, a relative one", "give --tol 1e-9 alone",
                  asks_for_tolerance());
    plan_.rtol = experiment_.rtol.value_or(number(mode.tolerance).value_or(run_.rtol.value_or(usual_tolerance)));
    plan_.atol = {plan_.rtol};
    if (!(plan_.rtol > 0)) fail("E333", "a tolerance is not positive", "give a positive one, such as --tol 1e-9", true);
    if (plan_.method == "exact" || plan_.method == "dop853") return;
    const auto step = experiment_.step ? experiment_.step : mode.step.valid() ? number(mode.step) : value(run_.step);
    if (!step)
      return fail("E331", fmt::format("`{}` takes steps, and nothing says how long", plan_.method),
                  "write `mode fast step 1/60` in the world, or give --step", experiment_.method.has_value());
    plan_.step = *step;
    if (!(*step > 0) || !std::isfinite(*step))
      fail("E333", fmt::format("a step of {} leads nowhere", *step), "give a positive step",
           experiment_.step.has_value());
  }

  Choice choice() const {
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
  bool is_banded() const {
    constexpr std::size_t smallest = 100;
    if (model_.states.size() <= smallest) return false;
    return ModelSystem(compile(model_), start_values(model_)).jacobian_pattern().is_banded();
  }

  void accept(const MethodInfo& method) {
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
           fmt::format("{} is no position or velocity; take another method", unpaired()),
           experiment_.method.has_value());
    }
  }

  std::string unpaired() const {
    for (std::size_t i = 0; i < model_.states.size(); ++i) {
      bool found = false;
      for (const PositionVelocity& pair : model_.pairs) found = found || pair.position == i || pair.velocity == i;
      if (!found) return "`" + model_.states[i].column + "`";
    }
    return "a state";
  }

  void set_output() {
    using Kind = OutputPlan::Kind;
    if (model_.has_world() && !run_.output) {  // motions from collision to collision have no steps to show
      constexpr double usual_rows = 200;
      plan_.output = Kind::every;
      plan_.interval = (plan_.to - plan_.from) / usual_rows;
      if (!(plan_.interval > 0)) plan_.interval = 1;
    }
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

  const Model& model_;
  const Experiment& experiment_;
  const RunSettings& run_;
  std::vector<Diagnostic>& problems_;
  Plan plan_;
};

}  // namespace

std::optional<Plan> plan(const Model& model, const Experiment& experiment, std::vector<Diagnostic>& problems) {
  return Planner(model, experiment, problems).plan();
}

double OutputTimes::operator[](std::size_t k) const {
  constexpr double none = std::numeric_limits<double>::infinity();
  // One part in a million of an interval is rounding, not another row.
  constexpr double slack = 1e-6;
  const auto within = [this](double t, double room) {
    return t <= plan_.to ? t : t < none && t <= plan_.to + slack * room ? plan_.to : none;
  };
  if (plan_.output == OutputPlan::Kind::every) {
    return within(plan_.from + static_cast<double>(k) * plan_.interval, plan_.interval);
  }
  if (plan_.output == OutputPlan::Kind::logarithmic) {
    if (k == 0) return plan_.from;
    const double decades = static_cast<double>(k - 1) / plan_.per_decade;
    const double elapsed = plan_.first * std::pow(10, decades);
    return within(plan_.from + elapsed, elapsed);
  }
  return none;
}

}  // namespace continuo::model
