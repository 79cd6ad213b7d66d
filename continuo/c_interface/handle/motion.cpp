// Advances a motion to the times that a caller asks for; keeps what the last step has found beyond.
#include <algorithm>
#include <cmath>
#include <utility>

#include <continuo/c_interface/handle/motion.hpp>

namespace continuo::c {

namespace {

constexpr double lengths_ahead = 1e6;  // so much further than the model's run the motion may go before it is extended

double length_of(const model::Plan& plan) {
  const double length = std::abs(plan.to - plan.from);
  return length > 0 ? length : 1;
}

}  // namespace

Motion::Motion(const std::shared_ptr<const model::ModelProgram>& program, const model::Plan& plan,
               const model::Experiment& experiment)
    : run_(model::begin_integration(plan.method, model::integration_of(program, plan, experiment),
                                    {plan.from, plan.from + lengths_ahead * length_of(plan)})),
      length_(length_of(plan)),
      t_(plan.from),
      x_(run_->x()),
      step_begin_(instant()) {}

model::Instant Motion::instant() const {
  const auto stops = run_->events().stops();
  return {run_->t(), run_->x(), run_->system().mode(), {stops.begin(), stops.end()}};
}

void Motion::on_segment(model::Stepping& run, double to) {
  // The dense output is made now: once an event has put another state at the end of the step, it cannot be.
  run.at(step_begin_.t + 0.5 * (to - step_begin_.t), scratch_);
}

void Motion::on_event(model::Stepping& run, const EventOccurrence<model::ModelSystem::X>& now) {
  const auto stops = run.events().stops();
  for (const model::EventName& name : names_.of(run.events(), now.events)) {
    fired_.push_back(
        {{now.t, name.mark.empty() ? name.event : name.mark}, run.system().mode(), {stops.begin(), stops.end()}});
  }
}

bool Motion::advance(double t) {
  if (has_ended_ && run_->outcome().ending == Ending::interrupted) go_on(x_, variables());
  while (!has_ended_ && run_->t() < t) {
    step_begin_ = instant();
    if (run_->advance(*this)) continue;
    if (run_->outcome().ending == Ending::reached_end) {
      run_->extend_to(run_->t() + lengths_ahead * length_);
    } else {
      has_ended_ = true;
    }
  }
  t_ = std::min(t, run_->t());
  if (t_ == run_->t()) {
    x_ = run_->x();
  } else {
    run_->at(t_, x_);
  }
  return t_ == t;
}

void Motion::go_on(std::vector<double> x, std::span<const double> variables) {
  model::Instant now = t_ == run_->t() ? instant() : step_begin_;
  while (!fired_.empty() && fired_.back().event.t > t_) fired_.pop_back();
  // Events within the last step that have changed the mode, or been counted, before t.
  if (!fired_.empty() && fired_.back().event.t >= step_begin_.t) {
    now.mode = fired_.back().mode;
    now.stops = fired_.back().stops;
  }
  now.t = t_;
  now.x = x;
  x_ = std::move(x);
  names_.restart();
  run_->go_on(now, variables, {});
  step_begin_ = now;
  has_ended_ = false;
}

std::vector<PassedEvent> Motion::events() const {
  std::vector<PassedEvent> passed;
  for (const Fired& fired : fired_) {
    if (fired.event.t <= t_) passed.push_back(fired.event);
  }
  return passed;
}

}  // namespace continuo::c
