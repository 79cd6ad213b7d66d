// continuo/simulation/run_along.cpp
// Records a motion that is known already, as an integration would be recorded.
#include <utility>

#include <continuo/simulation/drive/run_checks.hpp>
#include <continuo/simulation/drive/run_recorder.hpp>
#include <continuo/simulation/run_along.hpp>

namespace continuo::model {

Run run_along(const ModelProgram& program, Plan plan, std::span<const double> steps,
              const std::function<void(double t, std::vector<double>& x)>& at) {
  using Function = std::function<void(double t, std::vector<double>& x)>;
  Run run;
  run.plan = std::move(plan);
  RunRecorder recorder(program, run.plan, true, sample_times(program.model, run.plan), program.always);
  std::vector<double> x(program.model.states.size());
  at(run.plan.from, x);
  recorder.begin(run.plan.from, x);
  Function motion = at;
  const At call{&motion,
                [](void* of, double t, std::vector<double>& state) { (*static_cast<Function*>(of))(t, state); }};
  for (const double t : steps)
    if (t > run.plan.from && t < run.plan.to) recorder.on_segment(t, call);
  recorder.on_segment(run.plan.to, call);
  at(run.plan.to, x);
  recorder.finish(run.plan.to, x);
  run.outcome.ending = Ending::reached_end;
  run.outcome.t = run.plan.to;
  recorder.give(run);
  run.checks = judge(program.model, run, recorder);
  return run;
}

}  // namespace continuo::model
