// Finds the values of a run of a sweep, and reads the model anew where they decide how many equations there are.
#include <string>
#include <utility>

#include <apps/continuo/options/models.hpp>
#include <apps/continuo/studies/run_of_sweep.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/results/summary.hpp>
#include <continuo/studies/sweep/sweep_run.hpp>

namespace continuo::app {

ExitCode take_sweep_run(Prepared& prepared, std::uint64_t run) {
  const model::Model& model = prepared.program->model;
  if (!model.sweep || model.sweep->axes.empty()) {
    say("--sweep-run: nothing says what is varied; write sweep { k from 1 to 10 count 50 } in the model, or give "
        "--vary");
    return usage;
  }
  const auto sweep = studies::PreparedSweep::create(model, prepared.experiment);
  if (!sweep) {
    say(describe(sweep.status()));
    return wrong_model;
  }
  if (run >= sweep->runs()) {
    say(fmt::format("--sweep-run {}: the runs are 0 to {}", run, sweep->runs() - 1));
    return usage;
  }
  const model::Experiment of_run = sweep->experiment(run);
  const std::vector<double> values = sweep->values(run);
  std::string text = fmt::format("run {} of the sweep:", run);
  for (std::size_t a = 0; a < values.size(); ++a)
    text +=
        fmt::format("{} {} = {}", a == 0 ? "" : ",", model.sweep->axes[a].column(), results::short_number(values[a]));
  mention(text);
  prepared.experiment.parameters = of_run.parameters;
  prepared.experiment.initial = of_run.initial;
  if (!sweep->decides_size()) return done;
  model::CheckOptions options;
  for (const auto& [name, value] : of_run.parameters)
    if (find_parameter(model, name) != model::npos) options.overrides.emplace(name, value);
  const auto native = model.native;
  prepared.loaded = load_model(prepared.loaded.source, options);
  if (!prepared.loaded) return wrong_model;
  prepared.loaded.model->native = native;
  prepared.decides_size = true;
  prepared.program = model::compile(*std::exchange(prepared.loaded.model, std::nullopt));
  return done;
}

}  // namespace continuo::app
