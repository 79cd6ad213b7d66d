// Runs a model with its sensitivities, by the method that its size and tolerances ask for.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <continuo/methods/automatic.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/runs/run.hpp>
#include <continuo/simulation/program/jumps.hpp>
#include <continuo/simulation/program/switches.hpp>
#include <continuo/solve/choice.hpp>
#include <continuo/studies/sensitivity.hpp>
#include <continuo/studies/sensitivity/boundary_sensitivity.hpp>
#include <continuo/studies/sensitivity/sensitive_integration.hpp>
#include <continuo/studies/sensitivity/world_sensitivity.hpp>
#include <continuo/studies/support/unseen.hpp>

namespace continuo::studies {

namespace detail {

template <>
SensitiveEnding integrate_sensitive<Tsitouras5Rodas5P>(SensitiveIntegration, SensitiveRows&);
template <>
SensitiveEnding integrate_sensitive<Dop853Radau>(SensitiveIntegration, SensitiveRows&);
template <>
SensitiveEnding integrate_sensitive<Tsitouras5Bdf>(SensitiveIntegration, SensitiveRows&);

namespace {

SensitiveEnding integrate(SensitiveIntegration integration, SensitiveRows& rows) {
  const std::string_view method =
      choose_method(
          {.size = integration.x0.size(), .rtol = integration.options.rtol, .algebraic = integration.system.has_mass()})
          .method;
  if (method == Dop853Radau::name || method == Radau::name)
    return integrate_sensitive<Dop853Radau>(std::move(integration), rows);
  if (method == Tsitouras5Bdf::name || method == Bdf::name)
    return integrate_sensitive<Tsitouras5Bdf>(std::move(integration), rows);
  return integrate_sensitive<Tsitouras5Rodas5P>(std::move(integration), rows);
}

}  // namespace
}  // namespace detail

namespace {

/// S has the unit of x by that of p, so what is small for x is small for S at |p| times that. A. C. Hindmarsh et al.,
/// "SUNDIALS", ACM TOMS 31 (2005), section 3.1 on CVODES.
Options<std::vector<double>> options_of(const model::Plan& plan, const model::Experiment& experiment,
                                        std::size_t states, std::span<const double> sizes) {
  Options<std::vector<double>> options{.rtol = plan.rtol, .atol = plan.atol.front()};
  for (std::size_t k = 0; k <= sizes.size(); ++k) {
    const double size = k == 0 ? 1 : sizes[k - 1];
    for (std::size_t i = 0; i < states; ++i) {
      options.atol_each.push_back(plan.atol_of(i) / size);
      options.rtol_each.push_back(plan.rtol_of(i));
    }
  }
  options.max_step = plan.max_step;
  options.max_steps = plan.max_steps;
  options.interrupt = experiment.interrupt;
  options.progress = experiment.progress;
  return options;
}

/// A jump of the equations that a run does not locate (simulation/program/switches.hpp): it depends on an unknown, or
/// is one of too many. What the text calls smooth does not jump.
std::optional<model::Jump> jump_not_located(const model::Model& model, std::size_t mode) {
  const auto moves = [&](model::NodeId node) {
    return std::ranges::any_of(model::variables_of(model.graph, node), [&](std::uint32_t v) {
      return v == model::Layout::time || (v >= model.layout.states && v < model.layout.parameters);
    });
  };
  const auto reads_unknown = [&](model::NodeId node) {
    return std::ranges::any_of(model::variables_of(model.graph, node), [&](std::uint32_t v) {
      return v >= model.layout.unknowns && v < model.layout.parameters;
    });
  };
  std::vector<model::NodeId> smooth;
  for (const model::NodeId id : model::reachable(model.graph, model.modes[mode].derivatives))
    if (model.graph[id].op == model::Op::smooth) smooth.push_back(id);
  const std::vector<model::NodeId> below = model::reachable(model.graph, smooth);
  std::vector<model::Jump> jumps = model::jumps_of(model, mode);
  std::erase_if(jumps, [&](const model::Jump& jump) {
    return !moves(jump.node) || std::ranges::find(below, jump.node) != below.end();
  });
  std::vector<model::NodeId> different;
  for (const model::Jump& jump : jumps) {
    if (reads_unknown(jump.node)) return jump;
    if (std::ranges::find(different, jump.node) == different.end()) different.push_back(jump.node);
    if (different.size() > model::most_switches) return jump;
  }
  return std::nullopt;
}

}  // namespace

std::optional<model::Diagnostic> no_sensitivity(const model::Model& model, std::span<const Influence> influences) {
  const runs::Kind kind = runs::kind_of(model);
  if (!kind.has_start)
    if (auto refused = detail::no_boundary_sensitivity(model, influences)) return refused;
  for (const Influence& influence : influences) {
    if (influence.kind == Influence::Kind::initial) {
      const model::State& state = model.states[influence.index];
      if (!state.algebraic) continue;
      return model::error("E361", state.span, fmt::format("`{}` has no initial value of its own", state.column),
                          "this is a guess", "its equation `0 = ...` determines it");
    }
    const model::Parameter& parameter = model.parameters[influence.index];
    if (parameter.structural)
      return model::error("E361", parameter.span, fmt::format("nothing can be differentiated by `{}`", parameter.name),
                          {}, "it decides how many equations there are");
  }
  const bool by_events = kind.solver == runs::Solver::integration;
  for (std::size_t mode = 0; by_events && mode < model.modes.size(); ++mode) {
    const std::optional<model::Jump> jump = jump_not_located(model, mode);
    if (!jump) continue;
    return model::error(
        "E361", model.states[jump->state].span,
        fmt::format("no sensitivities through the jump `{}`", model::text_of(model, *jump)), "in this equation",
        "it depends on an unknown, or is one of too many to be located: an event (`when`) can do the same");
  }
  if (!model.needs_dae_solver()) return std::nullopt;
  const auto refuse = [](const model::Span& span) {
    return model::error("E361", span, "no sensitivities through an event that changes a model with equations `0 = ...`",
                        "this event", "without it, or with the equations solved by hand, they can be had");
  };
  for (const model::When& when : model.events)
    if (changes_something(when.actions) || changes_something(when.limit_actions)) return refuse(when.span);
  for (const model::Scheduled& scheduled : model.schedule)
    if (changes_something(scheduled.actions)) return refuse(scheduled.span);
  return std::nullopt;
}

std::string unit_of_ratio(const std::string& of, const std::string& by) {
  const auto is_number = [](const std::string& unit) { return unit.empty() || unit == "1"; };
  if (of.empty() && by.empty()) return "";
  if (of == by) return "1";
  const auto in_brackets = [](const std::string& unit) {
    return unit.find_first_of("*/ ^") == std::string::npos ? unit : "(" + unit + ")";
  };
  if (is_number(by)) return of;
  const bool product = of.find('/') == std::string::npos;
  return (is_number(of) ? "1" : product ? of : "(" + of + ")") + "/" + in_brackets(by);
}

SensitivityStudy::SensitivityStudy(std::shared_ptr<const model::ModelProgram> program,
                                   std::vector<Influence> influences, const model::Overrides& overrides,
                                   bool start_is_given)
    : program_(std::make_shared<detail::SensitiveProgram>(std::move(program), std::move(influences), overrides,
                                                          start_is_given)) {}

const model::ModelProgram& SensitivityStudy::program() const {
  return program_->program();
}
const std::vector<Influence>& SensitivityStudy::influences() const {
  return program_->influences();
}

SensitivityRun SensitivityStudy::run(const SensitivityRequest& request) const {
  SensitivityRun run = integrated(request);
  if (!run.diagnostics.empty()) {
    run.status = {.ending = run.outcome ? Ending::invalid_input : run.outcome.ending,
                  .message = run.diagnostics.front().message};
  } else if (run.status) {
    run.status = status(run.outcome);
  }
  return run;
}

/// Its status is a failure only where the motion has no derivative.
SensitivityRun SensitivityStudy::integrated(const SensitivityRequest& request) const {
  const model::Model& model = program().model;
  const runs::Kind kind = runs::kind_of(model);
  if (!kind.has_start && !no_sensitivity(model, influences())) return detail::boundary_sensitivity(program_, request);
  if (!kind.has_exact_derivatives) return detail::world_sensitivity(program_, request);
  SensitivityRun run;
  run.states = model.states.size();
  run.influences = influences().size();
  model::Experiment experiment = request.experiment;
  // A plan wants one that chooses its steps; which it is, is decided where the size is known.
  experiment.method = model.needs_dae_solver() ? Radau::name : Dop853Radau::name;
  experiment.step.reset();
  auto planned = runs::plan(model, experiment, run.diagnostics);
  if (auto refused = no_sensitivity(model, influences())) run.diagnostics.push_back(std::move(*refused));
  if (!planned || !run.diagnostics.empty()) return run;
  std::vector<double>& variables = planned->variables;
  const double from = request.begin ? request.begin->t : planned->from;
  for (const model::TableInput& input : program().step_inputs) variables[input.variable] = input.table.value(from);
  for (const auto& [state, value] : request.initial) variables[model.states[state].variable] = value;
  if (request.begin) std::ranges::copy(request.begin->x, variables.begin() + model.layout.states);

  detail::SensitiveSystem system(program_, variables);
  std::vector<double> x0(run.states * (1 + run.influences)), rates(x0.size());
  std::copy_n(variables.begin() + model.layout.states, run.states, x0.begin());
  if (request.begin) system.plain().go(request.begin->mode);
  system.hold_switches(from, x0);
  system.rates(from, x0, rates);
  std::ranges::copy(program_->start(variables, rates), x0.begin() + static_cast<std::ptrdiff_t>(run.states));

  std::vector<double> sizes;
  for (const Influence& influence : influences()) {
    const std::uint32_t variable = influence.kind == Influence::Kind::parameter
                                       ? model.parameters[influence.index].variable
                                       : model.states[influence.index].variable;
    sizes.push_back(variables[variable] != 0 ? std::abs(variables[variable]) : 1);
  }
  detail::SensitiveRows rows{.time = {}, .events = request.times.empty()};
  const model::OutputTimes output(*planned);
  if (!request.times.empty()) {
    rows.time = [&](std::size_t row) {
      return row < request.times.size() ? request.times[row] : std::numeric_limits<double>::infinity();
    };
  } else if (planned->output != model::OutputPlan::Kind::steps) {
    rows.time = [&](std::size_t row) { return output[row]; };
  }
  run.variables = variables;
  detail::SensitiveEvents events(*program_, variables, planned->from, std::abs(planned->to - from));
  if (request.begin) events.resume(from, request.begin->stops);
  const detail::SensitiveEnding ending = detail::integrate({std::move(system),
                                                            std::move(x0),
                                                            {from, planned->to},
                                                            options_of(*planned, experiment, run.states, sizes),
                                                            std::move(events)},
                                                           rows);
  run.times = std::move(rows.times);
  run.values = std::move(rows.values);
  run.outcome = ending.outcome;
  run.statistics = ending.statistics;
  run.status = ending.status;
  run.mode = ending.mode;
  for (const detail::SensitiveEventOccurrence& occurrence : ending.occurrences) {
    const model::EventOrder& place = model.event_order[occurrence.event];
    run.events.push_back({place.scheduled ? model.schedule[place.index].name : model.events[place.index].name,
                          occurrence.t, occurrence.time_moves});
  }
  return run;
}

SensitivityStudy::Along SensitivityStudy::along(std::span<const model::NodeId> quantities) const {
  const auto tape = program_->along({quantities.begin(), quantities.end()});
  return [program = program_, tape](const SensitivityRun& run) {
    detail::WideEvaluation evaluation(tape, *program, run.variables);
    const std::size_t width = tape->output_count();
    std::vector<double> values(run.rows() * width);
    for (std::size_t r = 0; r < run.rows(); ++r) {
      for (const model::TableInput& input : program->program().step_inputs)
        evaluation.set(input.variable, input.table.value(run.times[r]));
      evaluation(run.times[r], run.row(r), std::span(values).subspan(r * width, width));
    }
    return values;
  };
}

}  // namespace continuo::studies
