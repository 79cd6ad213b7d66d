// continuo/live/track.cpp
#include <algorithm>
#include <limits>
#include <utility>

#include <continuo/live/track.hpp>

namespace continuo::live {

namespace {

/// The text says how long a run takes; a view goes on for as long as somebody looks.
constexpr double lengths_ahead = 1e6;

model::Experiment endless(double longest_step) {
  model::Experiment experiment;
  experiment.max_step = longest_step;
  experiment.max_steps = std::numeric_limits<std::size_t>::max() / 256;
  return experiment;
}

double length_of(const model::Plan& plan) {
  return plan.to > plan.from ? plan.to - plan.from : 1;
}

}  // namespace

Track::Track(const std::shared_ptr<const model::ModelProgram>& program, const model::Plan& plan)
    : plan_(plan),
      reach_(length_of(plan)),
      run_(model::begin_integration(plan.method, model::integration_of(program, plan, endless(reach_)),
                                    {plan.from, plan.from + lengths_ahead * reach_})),
      variables_(plan.variables) {
  remember();
}

void Track::remember() {
  mode_ = run_->system().mode();
  const auto stops = run_->events().stops();
  stops_.assign(stops.begin(), stops.end());
  passed_.clear();
}

bool Track::advance() {
  remember();
  if (marks_seen_ > most_marks) go_on(instant_at(t()), variables_, held_);  // which forgets them
  if (run_->advance(*this)) return true;
  if (run_->outcome().ending != Ending::reached_end) return false;
  run_->extend_to(t() + lengths_ahead * reach_);
  return true;
}

void Track::happening(model::Stepping& run, const Happening<X>& now) {
  const model::ModelEvents& events = run.events();
  const auto marks = events.marks().subspan(marks_seen_);
  const auto stops = events.stops();
  Passed passed{now.t, {}, now.before, now.after, run.system().mode(), {stops.begin(), stops.end()}};
  for (const std::size_t i : now.events) {
    if (!events.is_declared(i)) continue;
    const auto mark = std::ranges::find(marks, i, &model::Marked::event);
    passed.names.push_back({std::string(events.name(i)), mark == marks.end() ? std::string() : mark->text});
  }
  marks_seen_ = events.marks().size();
  passed_.push_back(std::move(passed));
}

model::Instant Track::instant_at(double t) {
  model::Instant instant{.t = t, .x = run_->x(), .mode = mode_, .stops = stops_};
  run_->at(t, instant.x);
  for (const Passed& passed : passed_) {
    if (passed.t > t) break;
    instant.mode = passed.mode;
    instant.stops = passed.stops;
  }
  return instant;
}

void Track::go_on(const model::Instant& instant, std::span<const double> variables, std::span<const std::size_t> held) {
  variables_.assign(variables.begin(), variables.end());
  held_.assign(held.begin(), held.end());
  run_->go_on(instant, variables_, held_);
  marks_seen_ = 0;
  remember();
}

}  // namespace continuo::live
