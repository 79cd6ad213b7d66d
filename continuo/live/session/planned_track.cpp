// Plans a run by the settings of the page and makes its track.
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <continuo/live/session/planned_track.hpp>
#include <continuo/runs/run.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::live {

namespace {

model::Experiment experiment_of(const LiveModel& shown, const MethodChoice& choice,
                                const model::Overrides& parameters) {
  model::Experiment experiment;
  experiment.method = choice.name;
  experiment.step = choice.step;
  experiment.rtol = choice.rtol;
  experiment.parameters = parameters;
  const MethodInfo* info = choice.name ? find_method(*choice.name) : nullptr;
  // Who names an adaptive method means it to choose its steps, though the text gives one for another method.
  if (info && info->error_order > 0 && !choice.step && !choice.rtol)
    experiment.rtol = shown.model().run.rtol.value_or(1e-6);
  return experiment;
}

std::optional<model::Plan> plan_by(const LiveModel& shown, const Settings& settings, const MethodChoice& choice,
                                   Notices& notices) {
  std::vector<model::Diagnostic> problems;
  const model::Experiment experiment = experiment_of(shown, choice, settings.parameters);
  auto plan = runs::plan_from_start(*shown.program, experiment, problems);
  for (const model::Diagnostic& problem : problems) notices.say(problem);
  if (!plan) {
    notices.set_problems(std::move(problems));
    return std::nullopt;
  }
  for (const auto& [name, value] : settings.inputs) {
    const std::size_t i = find_input(shown.model(), name);
    if (i != model::npos) plan->variables[shown.model().inputs[i].variable] = value;
  }
  return plan;
}

}  // namespace

std::unique_ptr<Track> planned_track(const LiveModel& shown, const Settings& settings, const MethodChoice& choice,
                                     StepInterrupt& interrupt, Notices& notices) {
  const auto plan = plan_by(shown, settings, choice, notices);
  if (!plan) return nullptr;
  Result<std::unique_ptr<Track>> made = make_track(shown.program, *plan, &interrupt);
  if (!made) {
    const model::Diagnostic problem = model::error("", {}, made.status().message);
    notices.set_problems({problem});
    notices.say(problem);
    return nullptr;
  }
  return *std::move(made);
}

}  // namespace continuo::live
