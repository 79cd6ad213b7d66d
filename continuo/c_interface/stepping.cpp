// Motions of continuo.h: a model advanced step by step, with parameters and states changed on the way.
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <continuo/c_interface/handle/model_handle.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/simulation/simulate.hpp>

using namespace continuo;
using continuo::c::call_with_program;
using continuo::c::fail;

namespace {

int start(continuo_model& m) {
  m.run.reset(), m.motion.reset(), m.events.clear(), m.outcome.clear();
  m.interrupt = false;
  if (runs::kind_of(m.program->model).solver != runs::Solver::integration) {
    return fail(m, CONTINUO_ERROR,
                "this model cannot be moved step by step: it has bodies, or conditions at several times",
                "run it as a whole: continuo_run");
  }
  model::Experiment experiment = m.experiment;
  experiment.interrupt = &m.interrupt;
  experiment.max_steps = m.experiment.max_steps.value_or(std::numeric_limits<std::size_t>::max() / 256);
  std::vector<model::Diagnostic> problems;
  const auto plan = model::plan_run(*m.program, experiment, problems);
  if (!plan) return fail(m, CONTINUO_ERROR, problems);
  if (plan->to < plan->from) return fail(m, CONTINUO_ERROR, "the run of this model goes back in time", "continuo_run");
  m.motion = std::make_unique<c::Motion>(m.program, *plan, experiment);
  return CONTINUO_OK;
}

int no_motion(continuo_model& m) {
  return fail(m, CONTINUO_MISUSE, "no motion is under way", "continuo_start begins one");
}

int advance(continuo_model& m, double t) {
  if (!m.motion) return no_motion(m);
  if (!std::isfinite(t) || t < m.motion->t()) {
    return fail(m, CONTINUO_MISUSE, fmt::format("the motion stands at {} and cannot move to {}", m.motion->t(), t),
                "continuo_start begins anew");
  }
  m.interrupt = false;
  const bool is_there = m.motion->advance(t);
  m.events = m.motion->events();
  if (is_there) return CONTINUO_OK;
  m.outcome = describe(m.motion->outcome());
  if (succeeded(m.motion->outcome().ending)) return CONTINUO_ENDED;
  return fail(m, CONTINUO_FAILED, {model::failure(m.program->model, m.motion->outcome())});
}

int set_state(continuo_model& m, const double* buffer, std::size_t count) {
  if (!m.motion) return no_motion(m);
  const std::size_t n = m.motion->x().size();
  if (!buffer || count != n)
    return fail(m, CONTINUO_MISUSE,
                fmt::format("the buffer has {} numbers, and there are {} states", buffer ? count : 0, n));
  std::vector<double> x(buffer, buffer + count);
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(x[i]))
      return fail(m, CONTINUO_MISUSE, fmt::format("`{}` cannot be {}", m.program->model.states[i].column, x[i]));
  }
  const std::vector<double> variables = m.motion->variables();
  m.motion->go_on(std::move(x), variables);
  return CONTINUO_OK;
}

}  // namespace

extern "C" {

int continuo_start(continuo_model* model) {
  return call_with_program(model, start);
}

int continuo_advance(continuo_model* model, double t) {
  return call_with_program(model, [&](continuo_model& m) { return advance(m, t); });
}

double continuo_time(const continuo_model* model) {
  return model && model->motion ? model->motion->t() : std::numeric_limits<double>::quiet_NaN();
}

int continuo_get_state(continuo_model* model, double* buffer, size_t count) {
  return call_with_program(model, [&](continuo_model& m) {
    return m.motion ? c::copy(m, m.motion->x(), buffer, count, "the state") : no_motion(m);
  });
}

int continuo_set_state(continuo_model* model, const double* buffer, size_t count) {
  return call_with_program(model, [&](continuo_model& m) { return set_state(m, buffer, count); });
}

}  // extern "C"
