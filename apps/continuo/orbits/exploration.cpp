// Explores a model: its run, equilibria, orbit, sliders and influences.
#include <algorithm>
#include <cmath>

#include <apps/continuo/orbits/exploration.hpp>
#include <apps/continuo/orbits/hybrid_orbit.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <fmt/format.h>

#include <continuo/simulation/of_model.hpp>
#include <continuo/studies/support/forcing_period.hpp>
#include <continuo/studies/support/unseen.hpp>

namespace continuo::app {
namespace {

void run_it(const Studied& studied, Exploration& found) {
  model::Experiment experiment = studied.prepared.experiment;
  experiment.interrupt = &interrupt_flag();
  found.simulated = model::simulate(studied.prepared.program, experiment);
  found.low = found.high = studied.start;
  for (std::size_t row = 0; found.simulated.run && row < found.simulated.run->motion.rows(); ++row) {
    const auto x = found.simulated.run->motion.state(row);
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!std::isfinite(x[i])) continue;
      found.low[i] = std::min(found.low[i], x[i]);
      found.high[i] = std::max(found.high[i], x[i]);
    }
  }
}

/// A motion has converged where its distance to the equilibrium is a thousandth of the extent of the run.
std::optional<std::size_t> equilibrium_at_end(const Exploration& found, const model::Simulated& simulated) {
  if (!simulated.run || !succeeded(simulated.run->outcome.ending)) return std::nullopt;
  const std::span<const double> end = simulated.run->final_state();
  for (std::size_t k = 0; k < found.equilibria.size(); ++k) {
    bool near = true;
    for (std::size_t i = 0; i < end.size(); ++i)
      near = near && std::abs(end[i] - found.equilibria[k].at.x[i]) <=
                         1e-3 * std::max(found.high[i] - found.low[i], 1e-9 * std::abs(end[i]));
    if (near) return k;
  }
  return std::nullopt;
}

void find_all_equilibria(const Studied& studied, const ExplorationLimits& limits, Exploration& found) {
  studies::EquilibriumBox box{.low = {}, .high = {}, .starts = limits.starts, .interrupt = &interrupt_flag()};
  if (!set_box(studied, {}, box)) return;
  const studies::Equilibria equilibria = studies::find_equilibria(studied.system, box);
  found.searches = equilibria.searches;
  for (const studies::Equilibrium& e : equilibria.equilibria)
    found.equilibria.push_back(
        {e, studies::jump_at(*studied.prepared.program, studied.mode, e.x, studied.prepared.experiment.parameters)});
  if (equilibria.outside > 0)
    found.notes.push_back(
        fmt::format("{} searches converged outside of twice the range of the run: `continuo steady --box "
                    "NAME=LOW..HIGH` searches there",
                    equilibria.outside));
  found.comes_to = equilibrium_at_end(found, found.simulated);
}

/// Where the run has not converged yet, a longer one may.
void run_on(const Studied& studied, const ExplorationLimits& limits, Exploration& found) {
  if (found.comes_to || !found.simulated.run) return;
  model::Experiment experiment = studied.prepared.experiment;
  experiment.to = found.simulated.run->plan.to + limits.settle.value_or(run_length(studied.prepared.program->model));
  experiment.keep_rows = false;
  experiment.interrupt = &interrupt_flag();
  found.comes_to = equilibrium_at_end(found, model::simulate(studied.prepared.program, experiment));
  found.comes_later = found.comes_to.has_value();
}

/// How long to look for orbits.
struct Times {
  double settle, duration;
  bool patient;  // none was named
};
Times times_of(const Studied& studied, const ExplorationLimits& limits) {
  const double run = run_length(studied.prepared.program->model);
  return {limits.settle.value_or(run), limits.duration.value_or(run), !limits.settle && !limits.duration};
}

void find_whole_orbit(const Studied& studied, const Times& times, Exploration& found) {
  const studies::Forcing forcing =
      studies::forcing_of(*studied.prepared.program, studied.prepared.experiment.parameters);
  if (!forcing.status) {
    found.notes.push_back(
        fmt::format("no closed orbit was searched for: {}: {}; `continuo orbit --period T` sets the period",
                    place_text(studied.prepared, forcing.span), forcing.status.message));
    return;
  }
  const HybridOrbitRequest request{
      .settle = times.settle, .duration = times.duration, .tolerance = 1e-9, .patient = times.patient};
  auto orbit = find_hybrid_orbit(
      studied, request,
      {.settle = times.settle, .duration = times.duration, .forcing = forcing.period, .interrupt = &interrupt_flag()});
  if (orbit.outcome) {
    found.hybrid_orbit = std::move(orbit);
  } else {
    found.notes.push_back("no closed orbit: " +
                          (orbit.outcome.hint.empty() ? describe(orbit.outcome) : orbit.outcome.hint));
  }
}

/// By the equations alone, which are all that moves the model.
void find_smooth_orbit(const Studied& studied, const Times& times, Exploration& found) {
  if (studied.system.size < 2) return;
  studies::PeriodicOrbitOptions search{
      .settle = times.settle, .duration = times.duration, .interrupt = &interrupt_flag()};
  auto orbit = studies::find_periodic_orbit(studied.system, studied.start, search);
  if (!orbit.outcome && orbit.wanders && times.patient && !interrupt_flag()) {
    search.settle *= 10;
    search.duration *= 10;
    orbit = studies::find_periodic_orbit(studied.system, studied.start, search);
  }
  if (orbit.outcome) {
    found.orbit = std::move(orbit);
  } else if (!orbit.wanders && !interrupt_flag()) {  // it comes back: perhaps one of many, where something is conserved
    find_whole_orbit(studied, times, found);
  } else {
    found.notes.push_back("no closed orbit: " +
                          (orbit.outcome.hint.empty() ? describe(orbit.outcome) : orbit.outcome.hint));
  }
}

/// An orbit where the motion comes back; else how fast its neighbours part.
void find_orbit(const Studied& studied, const ExplorationLimits& limits, bool all_seen, Exploration& found) {
  if (found.comes_to || studied.system.size < 1) return;
  const Times times = times_of(studied, limits);
  if (all_seen) {
    find_smooth_orbit(studied, times, found);
  } else {
    find_whole_orbit(studied, times, found);
  }
  if (found.orbit || found.hybrid_orbit || interrupt_flag()) return;
  constexpr double averaged_runs = 20;
  const studies::LyapunovOptions averaging{.duration = limits.duration.value_or(averaged_runs * times.duration),
                                           .settle = times.settle,
                                           .interrupt = &interrupt_flag()};
  auto exponents =
      all_seen ? studies::lyapunov_exponents(
                     model::of_model(studied.prepared.program,
                                     {.parameters = studied.prepared.experiment.parameters, .mode = studied.mode}),
                     studied.start, averaging)
               : studies::lyapunov_exponents(studied.prepared.program, studied.prepared.experiment, averaging);
  if (!exponents.exponents.empty()) {
    found.exponents = std::move(exponents);
  } else {
    found.notes.push_back("no Lyapunov exponents: " + describe(exponents.outcome));
  }
}

void move_sliders(const Studied& studied, const ExplorationLimits& limits, Exploration& found) {
  const model::Model& model = studied.prepared.program->model;
  const auto& set = studied.prepared.experiment.parameters;
  for (const model::Parameter& parameter : model.parameters) {
    if (!parameter.independent || parameter.structural) continue;
    if (!parameter.range || !(parameter.range->low < parameter.range->high)) {
      found.not_varied.push_back(parameter.name);
      continue;
    }
    if (found.sliders.size() == limits.sliders) {
      found.notes.push_back(
          fmt::format("`{}` and the parameters after it were not varied: `continuo steady --along`", parameter.name));
      return;
    }
    Slider slider{parameter.name, parameter.range->low, parameter.range->high, {}};
    const ParametricSystem system = holding_laws(
        studied, model::of_model(studied.prepared.program,
                                 {.constants = {parameter.name}, .parameters = set, .mode = studied.mode}));
    const double here = set.contains(parameter.name) ? set.at(parameter.name) : parameter.value;
    std::vector<studies::BranchStart> starts;
    std::vector<std::size_t> numbers;
    for (std::size_t k = 0; k < found.equilibria.size(); ++k) {
      if (found.equilibria[k].jump) continue;
      starts.push_back({here, found.equilibria[k].at.x});
      numbers.push_back(k);
    }
    if (!starts.empty() && !interrupt_flag())
      slider.branches = studies::continue_equilibria(
          system, starts, {.low = slider.low, .high = slider.high, .interrupt = &interrupt_flag()});
    for (studies::BranchOfDiagram& one : slider.branches)
      for (std::size_t& start : one.starts) start = numbers[start];
    found.sliders.push_back(std::move(slider));
  }
}

/// Of each parameter the state that it moves most, at its time.
std::vector<Influenced> strongest(const model::Model& model, const studies::SensitivityRun& run,
                                  const std::vector<studies::Influence>& influences, const Exploration& found) {
  std::vector<Influenced> list;
  for (std::size_t k = 0; k < influences.size(); ++k) {
    const model::Parameter& parameter = model.parameters[influences[k].index];
    Influenced most{parameter.name, "", 0, 0};
    for (std::size_t r = 0; r < run.rows(); ++r) {
      for (std::size_t i = 0; i < run.states; ++i) {
        const double size = std::max(std::abs(found.low[i]), std::abs(found.high[i]));
        const double part = std::abs(run.sensitivity(r, i, k) * run.variables[parameter.variable]) / size;
        if (size > 0 && part > most.part) most = {parameter.name, model.states[i].column, part, run.times[r]};
      }
    }
    list.push_back(most);
  }
  std::ranges::sort(list, std::ranges::greater(), &Influenced::part);
  return list;
}

void weigh_parameters(const Studied& studied, Exploration& found) {
  const auto& program = studied.prepared.program;
  constexpr std::size_t most_parameters = 60;
  std::vector<studies::Influence> influences;
  for (std::size_t i = 0; i < program->model.parameters.size(); ++i) {
    const model::Parameter& parameter = program->model.parameters[i];
    if (parameter.independent && !parameter.structural) influences.push_back({.index = i});
  }
  if (influences.empty()) return;
  if (influences.size() > most_parameters) {
    found.notes.push_back(
        fmt::format("{} parameters are too many for sensitivities here: `continuo sense --param`", influences.size()));
    return;
  }
  if (const auto refused = studies::no_sensitivity(program->model, influences)) {
    found.notes.push_back("no sensitivities: " + refused->message);
    return;
  }
  model::Experiment experiment = studied.prepared.experiment;
  experiment.interrupt = &interrupt_flag();
  const studies::SensitivityStudy study(program, influences, experiment.parameters);
  const studies::SensitivityRun run = study.run({.experiment = experiment});
  if (!run.good()) found.notes.push_back("sensitivities only of a part of the run: " + run.status.message);
  found.influences = strongest(program->model, run, influences, found);
}

}  // namespace

Exploration explore(const Studied& studied, const ExplorationLimits& limits) {
  const model::ModelProgram& program = *studied.prepared.program;
  Exploration found;
  Progress progress;
  const auto done_part = progress.parts();
  const auto report = [&](double part) {
    if (done_part) done_part(part);
  };
  run_it(studied, found);
  report(0.1);
  const auto timed = studies::depends_on_time(program, studied.mode);
  const auto unseen = studies::unseen_of(program, studied.mode);
  if (timed) {
    found.notes.push_back(fmt::format("no equilibria were searched for: the equation of `{}` depends on time",
                                      program.model.states[*timed].column));
  } else {
    find_all_equilibria(studied, limits, found);
    run_on(studied, limits, found);
    if (unseen) found.notes.push_back(fmt::format("the equilibria are those of the equations alone: {}", unseen->what));
  }
  report(0.3);
  if (!interrupt_flag()) find_orbit(studied, limits, !timed && !unseen, found);
  report(0.6);
  if (!interrupt_flag() && !timed) move_sliders(studied, limits, found);
  report(0.9);
  if (!interrupt_flag()) weigh_parameters(studied, found);
  found.complete = !interrupt_flag();
  return found;
}

}  // namespace continuo::app
