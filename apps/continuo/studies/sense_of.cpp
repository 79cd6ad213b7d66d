// Sensitivities of event times, periods and equilibria: computed and printed.
#include <cmath>

#include <apps/continuo/studies/influences.hpp>
#include <apps/continuo/studies/orbit_text.hpp>
#include <apps/continuo/studies/sense_of.hpp>
#include <apps/continuo/studies/studied_model.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/studies/equilibrium.hpp>
#include <continuo/studies/hybrid_orbit.hpp>
#include <continuo/studies/support/forcing_period.hpp>

namespace continuo::app {
namespace {

constexpr std::size_t name_width = 26;

std::string line_of(const model::Model& model, const std::string& of, const std::string& unit, double value,
                    const model::Parameter& parameter, double p, double derivative) {
  return fmt::format("{:<{}} {:>14} {:<14} {:>12}\n", fmt::format("d {} / d {}", of, parameter.name), name_width,
                     results::short_number(derivative),
                     model.has_units ? studies::unit_of_ratio(unit, parameter.unit) : "",
                     value == 0 ? "-" : fmt::format("{:.3g}", p / value * derivative));
}

std::string head() {
  return fmt::format("{:<{}} {:>14} {:<14} {:>12}\n", "", name_width, "value", "", "p/x dx/dp");
}

double value_of_parameter(const model::Model& model, const model::Overrides& set, const model::Parameter& parameter) {
  return model::start_values(model, set)[parameter.variable];
}

}  // namespace

std::string events_table(const model::Model& model, const studies::SensitivityRun& run,
                         const std::vector<studies::Influence>& influences) {
  std::string text =
      fmt::format("{:>14}  {:<30}", model.time_unit.empty() ? "t" : "t [" + model.time_unit + "]", "event");
  for (const studies::Influence& influence : influences)
    text += fmt::format(" {:>14}", "d t / d " + name_of(model, influence));
  text += "\n";
  for (const studies::SensitivityEvent& event : run.events) {
    text += fmt::format("{:>14}  {:<30}", results::short_number(event.t), event.name);
    for (const double moves : event.time_moves) text += fmt::format(" {:>14}", results::short_number(moves));
    text += "\n";
  }
  return text;
}

ExitCode sense_period(const ExperimentOptions& options, const std::vector<std::string>& parameters, bool json) {
  const Studied studied = study(options, "");
  if (studied.prepared.exit != done) return studied.prepared.exit;
  const model::Model& model = studied.prepared.program->model;
  const auto influences = influences_named(model, parameters, {});
  if (!influences) return usage;
  if (const auto refused = studies::no_sensitivity(model, *influences)) {
    show(std::span(&*refused, 1), studied.prepared.loaded.source);
    return wrong_model;
  }
  const model::Overrides& set = studied.prepared.experiment.parameters;
  const studies::Forcing forcing = studies::forcing_of(*studied.prepared.program, set);
  if (forcing.period || !forcing.status) {
    say("--of period: the model depends on time, so its period is a multiple of that of the forcing");
    return wrong_model;
  }
  const double to = studied.prepared.experiment.to.value_or(model.run.to ? model.run.to->value : 100);
  const double run = to - (model.run.from ? model.run.from->value : 0);
  studies::HybridOrbitOptions search{.settle = run, .duration = run, .interrupt = &interrupt_flag()};
  for (const studies::Influence& influence : *influences) search.parameters.push_back(influence.index);
  const auto found = studies::find_hybrid_orbit(studied.prepared.program, studied.prepared.experiment, search);
  if (!found.outcome) return failed_exit(found.outcome);
  if (found.period_by.empty()) {
    say("the orbit is one of a family with different periods, so its period is not a function of the parameters alone");
    return numerical_failure;
  }
  if (json) {
    answer("continuo.sense_period/1", {{"period", found.period}, {"by", parameters}, {"period_by", found.period_by}});
    return done;
  }
  std::string text = fmt::format("period {}\n", with_time_unit(found.period, model)) + head();
  for (std::size_t k = 0; k < influences->size(); ++k) {
    const model::Parameter& parameter = model.parameters[(*influences)[k].index];
    text += line_of(model, "period", model.time_unit, found.period, parameter,
                    value_of_parameter(model, set, parameter), found.period_by[k]);
  }
  print(text);
  return done;
}

// f(x, p) = 0 differentiated: dx/dp = -(df/dx)^-1 df/dp.
ExitCode sense_equilibrium(const ExperimentOptions& options, const std::vector<std::string>& parameters, bool json) {
  Studied studied = study(options, "", parameters);
  if (studied.prepared.exit != done) return studied.prepared.exit;
  const model::Model& model = studied.prepared.program->model;
  const auto influences = influences_named(model, parameters, {});
  if (!influences) return usage;
  if (!stands_still_in_time(studied, "equilibria are searched for")) return wrong_model;
  hold_conserved(studied);
  const ParametricSystem& system = studied.system;
  const auto search = studies::find_equilibrium(system, studied.start, system.constants);
  if (search.ending != studies::EquilibriumEnding::found) {
    say(fmt::format("no equilibrium was found near the start ({})", to_string(search.ending)));
    return numerical_failure;
  }
  const std::size_t n = system.size, m = parameters.size();
  const studies::Linearization linear = studies::linearize(system, search.x, system.constants);
  DenseLU<double> lu(n);
  for (std::size_t i = 0; i < n * n; ++i) lu.matrix()[i] = linear.a[i];
  if (!studies::describe_equilibrium(system, search.x, system.constants).isolated || !lu.factor()) {
    say("the equilibrium is not isolated, so it is not a function of the parameters alone");
    return numerical_failure;
  }
  std::vector<std::vector<double>> by(m, std::vector<double>(n));  // by parameter
  for (std::size_t k = 0; k < m; ++k) {
    for (std::size_t i = 0; i < n; ++i) by[k][i] = -linear.b[i * m + k];
    lu.solve(by[k].data());
  }
  if (json) {
    nlohmann::json object{{"states", system.names}, {"x", search.x}, {"by", parameters}, {"x_by", by}};
    add_events(object, studied, search.x);
    answer("continuo.sense_equilibrium/1", object);
    return done;
  }
  std::string text = "equilibrium:";
  for (std::size_t i = 0; i < n; ++i)
    text += fmt::format("{} {} = {}", i == 0 ? "" : ",", model.states[i].column, results::short_number(search.x[i]));
  text += "\n" + events_text(studied, search.x) + head();
  for (std::size_t k = 0; k < m; ++k)
    for (std::size_t i = 0; i < n; ++i)
      text += line_of(model, model.states[i].column, model.states[i].unit, search.x[i],
                      model.parameters[(*influences)[k].index], system.constants[k], by[k][i]);
  print(text);
  return done;
}

}  // namespace continuo::app
