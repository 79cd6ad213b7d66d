// Runs a model by the same machinery as `simulate`, with somebody who watches what happens.
#include <algorithm>
#include <utility>

#include <continuo/simulation/simulate.hpp>
#include <continuo/studies/support/hybrid_run.hpp>

namespace continuo::studies {

model::Experiment exactly(const model::ModelProgram& program, model::Experiment experiment, double tolerance) {
  experiment.method = program.model.needs_dae_solver() ? "radau" : "dop853_radau";
  experiment.step.reset();
  experiment.rtol = tolerance;
  experiment.atol = {tolerance};
  experiment.rtol_of.clear();
  experiment.atol_of.clear();
  experiment.max_steps = std::size_t{1} << 40;
  experiment.progress = {};
  return experiment;
}

std::optional<model::Plan> plan_of(const model::ModelProgram& program, const model::Experiment& exact,
                                   Outcome<double>& outcome) {
  std::vector<model::Diagnostic> problems;
  std::optional<model::Plan> plan = model::plan_run(program, exact, problems);
  if (!plan) {
    outcome.ending = Ending::invalid_input;
    if (!problems.empty()) outcome.hint = problems.front().message;
  }
  return plan;
}

HybridRun::HybridRun(const std::shared_ptr<const model::ModelProgram>& program, const model::Plan& plan,
                     const model::Experiment& experiment)
    : variables_(plan.variables),
      run_(model::begin_integration(plan.method, model::integration_of(program, plan, experiment),
                                    {plan.from, plan.to})),
      from_(plan.from),
      mode_(run_->system().mode()) {}

bool HybridRun::advance_to(double t) {
  run_->extend_to(t);
  while (run_->advance(*this)) {
  }
  return run_->outcome().ending == Ending::reached_end && run_->t() == t;
}

void HybridRun::go_on(const model::Instant& instant) {
  run_->go_on(instant, variables_, {});
  from_ = instant.t;
  mode_ = instant.mode;
}

model::Instant HybridRun::instant() const {
  const auto stops = run_->events().stops();
  return {run_->t(), run_->x(), run_->system().mode(), {stops.begin(), stops.end()}};
}

void HybridRun::on_segment(model::Stepping& run, double to) {
  if (on_stretch && to > from_) on_stretch(from_, to, [&run](double t, X& x) { run.at(t, x); });
  from_ = to;
}

void HybridRun::on_event(model::Stepping& run, const EventOccurrence<X>& now) {
  const bool jumps = std::ranges::any_of(now.events, [&](std::size_t i) { return run.events().is_jump(i); });
  const std::size_t mode = run.system().mode();
  if (now.before == now.after && mode == mode_ && !jumps) return;
  mode_ = mode;
  ++discontinuities_;
  last_ = now.t;
  if (on_jump && now.before != now.after) on_jump(now.t, now.before, now.after);
}

}  // namespace continuo::studies
