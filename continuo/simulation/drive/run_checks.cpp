// continuo/simulation/drive/run_checks.cpp
// Evaluates the checks of a model on a finished run, and lists the times that they need.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <continuo/simulation/drive/run_checks.hpp>

namespace continuo::model {

namespace {

constexpr double no_reading = std::numeric_limits<double>::quiet_NaN();

double snapped(double t, const Plan& plan) {
  return std::abs(t - plan.to) <= 1e-12 * std::max(std::abs(plan.to), std::abs(plan.from)) ? plan.to : t;
}

double time_of(const Model& model, const Setting& setting, const Plan& plan) {
  return snapped(evaluate(model, setting.node, plan.variables), plan);
}

bool holds(Relation relation, double value, double expected, double tolerance) {
  switch (relation) {
    case Relation::equal:
      return std::abs(value - expected) <= tolerance;
    case Relation::less:
      return value < expected + tolerance;
    case Relation::less_equal:
      return value <= expected + tolerance;
    case Relation::greater:
      return value > expected - tolerance;
    case Relation::greater_equal:
      return value >= expected - tolerance;
  }
  return false;
}

class Judge {
 public:
  Judge(const Model& model, const Run& run, std::span<const SampledState> samples, std::span<const Extremes> extremes)
      : model_(model), run_(run), samples_(samples), extremes_(extremes) {}

  std::vector<CheckResult> results() {
    std::vector<CheckResult> all;
    for (const Check& check : model_.checks) all.push_back(result(check));
    return all;
  }

  std::vector<double> readings() {
    std::vector<double> all;
    all.reserve(model_.checks.size());
    std::vector<double> variables;
    std::string message;
    for (const Check& check : model_.checks) {
      variables = run_.plan.variables;
      const bool can_read = succeeded(run_.outcome.ending) && place_moment(check, variables, message) &&
                            place_samples(check, variables, message);
      all.push_back(can_read ? measured(check, variables) : no_reading);
    }
    return all;
  }

 private:
  CheckResult result(const Check& check) {
    CheckResult r;
    r.text = check.text;
    r.unit = check.unit;
    std::vector<double> variables = run_.plan.variables;
    r.evaluated = place_moment(check, variables, r.message) && place_samples(check, variables, r.message);
    if (!r.evaluated) return r;
    r.tolerance = check.tolerance.valid() ? evaluate(model_, check.tolerance, variables) : 0;
    r.expected = evaluate(model_, check.value, variables);
    if (check.measure == Measure::always) return always(check, std::move(r));
    r.value = measured(check, variables);
    r.passed = holds(check.relation, r.value, r.expected, r.tolerance);
    return succeeded(run_.outcome.ending) ? r : not_evaluated(std::move(r));
  }

  CheckResult always(const Check& check, CheckResult r) {
    const Extremes& e = extremes_[always_++];
    const bool upper = check.relation == Relation::less || check.relation == Relation::less_equal;
    const bool lower = check.relation == Relation::greater || check.relation == Relation::greater_equal;
    const double worst = upper || (!lower && std::abs(e.high) > std::abs(e.low)) ? e.high : e.low;
    r.value = r.expected + worst;
    const bool kept = holds(check.relation, worst, 0, r.tolerance);
    r.passed = kept;
    if (!kept) r.message = fmt::format("worst at t = {}", worst == e.high ? e.t_high : e.t_low);
    return !kept || succeeded(run_.outcome.ending) ? r : not_evaluated(std::move(r));
  }
  static CheckResult not_evaluated(CheckResult r) {
    r.passed = r.evaluated = false;
    r.message = "the run failed";
    return r;
  }

  double measured(const Check& check, const std::vector<double>& variables) const {
    switch (check.measure) {
      case Measure::energy_drift:
        return run_.energy ? run_.energy->drift : 0;
      case Measure::event_time:
        return find_event(check.moment)->t;
      case Measure::event_count:
        return static_cast<double>(count_events(check.moment));
      case Measure::end_time:
        return run_.final_time();
      case Measure::value:
      case Measure::always:
        break;
    }
    return evaluate(model_, check.node, variables);
  }

  /// Contacts of bodies are meant only where they are named.
  bool matches(const Moment& moment, const RecordedEvent& event) const {
    return event.name.starts_with(moment.event) && !(moment.event.empty() && event.is_contact());
  }

  std::size_t count_events(const Moment& moment) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(run_.events, [&](const RecordedEvent& event) { return matches(moment, event); }));
  }

  const RecordedEvent* find_event(const Moment& moment) const {
    std::size_t number = 0;
    for (const RecordedEvent& event : run_.events) {
      if (matches(moment, event) && ++number == moment.number) return &event;
    }
    return nullptr;
  }

  void place(std::vector<double>& variables, double t, std::span<const double> x) const {
    variables[Layout::time] = t;
    std::copy(x.begin(), x.end(), variables.begin() + model_.layout.states);
    for (const Input& input : model_.inputs) {
      if (input.points) variables[input.variable] = input.points->value(t);
    }
  }

  const SampledState* sampled_at(double t) const {
    const auto found = std::ranges::find(samples_, t, &SampledState::t);
    return found == samples_.end() || found->x.empty() ? nullptr : &*found;
  }

  bool place_at(std::vector<double>& variables, double t, std::string& message) const {
    if (const SampledState* sample = sampled_at(t)) {
      place(variables, t, sample->x);
      return true;
    }
    message = t > run_.final_time() || t < run_.plan.from
                  ? fmt::format("the run went from {} to {}", run_.plan.from, run_.final_time())
                  : fmt::format("the state at t = {} was not kept", t);
    return false;
  }

  bool place_moment(const Check& check, std::vector<double>& variables, std::string& message) const {
    const bool needs_event = check.measure == Measure::event_time ||
                             (check.measure == Measure::value && check.moment.kind == Moment::Kind::event);
    if (needs_event) {
      const RecordedEvent* event = find_event(check.moment);
      if (event == nullptr) {
        message = fmt::format("there were only {} such events", count_events(check.moment));
        return false;
      }
      if (check.measure == Measure::event_time) return true;
      if (event->is_contact()) {
        message = "the state at a contact is not kept; take a time a little before or after it";
        return false;
      }
      place(variables, event->t, check.moment.after ? event->after : event->before);
      return true;
    }
    if (check.measure == Measure::value && check.moment.kind == Moment::Kind::time) {
      return place_at(variables, time_of(model_, *check.moment.time, run_.plan), message);
    }
    place(variables, run_.final_time(), run_.final_state());
    return true;
  }

  bool place_samples(const Check& check, std::vector<double>& variables, std::string& message) const {
    for (const Sample& sample : check.samples) {
      std::vector<double> there = run_.plan.variables;
      if (!place_at(there, time_of(model_, sample.when, run_.plan), message)) return false;
      variables[sample.variable] = evaluate(model_, sample.of, there);
    }
    return true;
  }

  const Model& model_;
  const Run& run_;
  std::span<const SampledState> samples_;
  std::span<const Extremes> extremes_;
  std::size_t always_ = 0;
};

}  // namespace

std::vector<double> sample_times(const Model& model, const Plan& plan) {
  std::vector<double> times;
  for (const Check& check : model.checks) {
    if (check.moment.time) times.push_back(time_of(model, *check.moment.time, plan));
    for (const Sample& sample : check.samples) times.push_back(time_of(model, sample.when, plan));
  }
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

std::vector<CheckResult> judge(const Model& model, const Run& run, const RunRecorder& recorder) {
  return judge(model, run, recorder.samples(), recorder.extremes());
}

std::vector<CheckResult> judge(const Model& model, const Run& run, std::span<const SampledState> samples,
                               std::span<const Extremes> extremes) {
  return Judge(model, run, samples, extremes).results();
}

std::vector<double> readings(const Model& model, const Run& run, std::span<const SampledState> samples) {
  return Judge(model, run, samples, {}).readings();
}

std::vector<double> readings_of(std::span<const CheckResult> checks) {
  std::vector<double> all;
  for (const CheckResult& check : checks) all.push_back(check.evaluated ? check.value : no_reading);
  return all;
}

}  // namespace continuo::model
