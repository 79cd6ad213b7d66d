// Finds which runs can go together, and judges each when it has ended.
#include <algorithm>
#include <utility>

#include <continuo/simulation/drive/run_checks.hpp>
#include <continuo/simulation/many_runs.hpp>
#include <continuo/simulation/program/event_names.hpp>
#include <continuo/simulation/stepping.hpp>
#include <continuo/simulation/together/integrate_together.hpp>
#include <continuo/simulation/together/lane_code.hpp>

namespace continuo::model {

namespace {

using X = ModelSystem::X;

/// A run of many, planned.
struct Planned {
  std::shared_ptr<const Plan> plan{};  // but for the variables; none where it cannot begin: `problems` say why
  std::vector<double> variables{};     // the register file at the start
  std::vector<Diagnostic> problems{};
  std::vector<SampledState> samples{};  // at the times that checks ask for
  std::size_t next_sample = 0;
  std::vector<RecordedEvent> events{};
  EventNames names{};
};

/// What runs of a model can go together by.
enum class Company { none, plain, with_events };

bool agree(const Plan& a, const Plan& b) {
  return a.method == b.method && a.rtol == b.rtol && a.rtol_each == b.rtol_each && a.atol == b.atol &&
         a.step == b.step && a.max_step == b.max_step && a.max_steps == b.max_steps && a.from == b.from && a.to == b.to;
}

bool is_plain(const Experiment& experiment) {
  return !experiment.estimate_error && !experiment.doubts && !experiment.progress;
}

/// Whether the plans of runs of a model differ in nothing but the values at the start.
bool plans_agree(const Model& model) {
  const RunSettings& run = model.run;
  std::vector<NodeId> nodes;
  const auto add = [&](const std::optional<Setting>& setting) {
    if (setting) nodes.push_back(setting->node);
  };
  for (const auto* setting : {&run.from, &run.to, &run.step, &run.max_step}) add(*setting);
  if (run.output) add(run.output->interval), add(run.output->first);
  return model.masses.empty() && model.schedule.empty() && variables_of(model.graph, nodes).empty();
}

/// The register files of runs of one plan at their start, which differ in the values of the same names.
class StartsOfRuns {
 public:
  /// `one` is the experiment of any of them.
  StartsOfRuns(const Model& model, const Experiment& one)
      : model_(model), common_(start_values(model, one.parameters, one.from)) {
    for (const auto& [name, value] : one.parameters) {
      const std::size_t i = find_parameter(model, name);
      parameters_.push_back(i != npos ? model.parameters[i].variable : model.inputs[find_input(model, name)].variable);
    }
    for (const auto& [name, value] : one.initial) initial_.push_back(states_named(model, name));
    follows_ = is_followed(one);
  }

  /// As their plan has them.
  [[nodiscard]] std::vector<double> of(const Experiment& one) const {
    std::vector<double> variables = follows_ ? start_values(model_, one.parameters, one.from) : common_;
    auto parameter = parameters_.begin();
    for (const auto& [name, value] : one.parameters) variables[*parameter++] = value;
    auto states = initial_.begin();
    for (const auto& [name, value] : one.initial)
      for (const std::size_t i : *states) variables[model_.layout.states + i] = value;
    return variables;
  }

 private:
  /// Whether another value at the start depends on those that are given.
  [[nodiscard]] bool is_followed(const Experiment& one) const {
    std::vector<NodeId> nodes;
    for (const Parameter& parameter : model_.parameters)
      if (!one.parameters.contains(parameter.name)) nodes.push_back(parameter.expression);
    for (const Unknown& unknown : model_.unknowns) nodes.push_back(unknown.guess);
    for (const State& state : model_.states) nodes.push_back(state.initial);
    return std::ranges::any_of(variables_of(model_.graph, nodes), [&](std::uint32_t variable) {
      return std::ranges::find(parameters_, variable) != parameters_.end();
    });
  }

  const Model& model_;
  std::vector<double> common_;
  std::vector<std::size_t> parameters_;            // the variable of each parameter or input that is given
  std::vector<std::vector<std::size_t>> initial_;  // the states of each initial value that is given
  bool follows_ = false;
};

std::vector<Planned> plan_all(const ModelProgram& program, const ManyExperiments& experiments) {
  const bool is_one_plan = plans_agree(program.model);
  Experiment one = experiments.common;
  std::shared_ptr<const Plan> plan;
  std::optional<StartsOfRuns> starts;
  std::vector<Planned> planned(experiments.count);
  for (std::size_t i = 0; i < planned.size(); ++i) {
    experiments.set(i, one);
    if (plan && is_one_plan) {
      if (!starts) starts.emplace(program.model, one);
      planned[i].variables = starts->of(one);
      planned[i].plan = plan;
      continue;
    }
    std::optional<Plan> made = plan_run(program, one, planned[i].problems);
    if (!made) continue;
    planned[i].variables = made->variables;
    if (!plan || !agree(*plan, *made)) plan = std::make_shared<const Plan>(*std::move(made));
    planned[i].plan = plan;
  }
  return planned;
}

/// A run that stiffness slows may be ended by `simulate` before its limit of steps, but not earlier than this
/// (solve/steps/step_budget.hpp). One that takes more steps is made alone.
std::size_t steps_together(const Plan& plan, std::size_t limit) {
  constexpr std::size_t first_probe = 1000, windows = 50;
  return plan.step > 0 ? limit : std::min(limit, std::max(first_probe, limit / windows));
}

/// The runs [first, last) go together.
class Together final : public RunWatcher<X>, public SeenRuns {
 public:
  Together(const std::shared_ptr<const ModelProgram>& program, bool has_events, LaneCode& code,
           const ManyExperiments& experiments, std::span<MotionWatcher* const> watchers, std::span<Planned> planned,
           const OnJudged& done)
      : program_(program),
        has_events_(has_events),
        code_(code),
        experiments_(experiments),
        one_(experiments.common),
        watchers_(watchers),
        planned_(planned),
        done_(done) {
    asks_for_samples_ = std::ranges::any_of(
        program_->model.checks, [](const Check& check) { return check.moment.time || !check.samples.empty(); });
    run_.motion.states = program_->model.states.size();
    run_.motion.columns.resize(1 + run_.motion.states);
  }

  /// Makes them. False where no more are wanted, or they were interrupted.
  [[nodiscard]] bool run(std::size_t first, std::size_t last) {
    first_ = first;
    goes_on_ = true;
    run_.plan = *planned_[first].plan;
    const Plan& plan = run_.plan;
    if (method_ != plan.method) make_equations(plan.method);
    is_watched_ = false;
    for (std::size_t i = first; i < last; ++i) begin(i);
    TogetherRuns::Equations equations = equations_ ? &*equations_ : nullptr;
    if (has_events_) equations = &*mode_equations_;
    integrate_together(method_, {.equations = equations,
                                 .interval = {plan.from, plan.to},
                                 .options = options(),
                                 .count = last - first,
                                 .start = [this](std::size_t run) { return start(run); }});
    const std::atomic<bool>* interrupt = experiments_.common.interrupt;
    return goes_on_ && !(interrupt && interrupt->load());
  }

  /// Makes one by `simulate`.
  [[nodiscard]] bool run_alone(std::size_t i) {
    experiments_.set(i, one_);
    Simulated simulated = simulate(program_, one_, {.watcher = watcher(i)});
    JudgedRun judged{.outcome = {}, .readings = {}, .diagnostics = std::move(simulated.diagnostics)};
    if (simulated.run) {
      judged.outcome = std::move(simulated.run->outcome);
      judged.readings = readings_of(simulated.run->checks);
    }
    return done_(i, std::move(judged));
  }

  bool wants(std::size_t run, double to) override {
    const std::size_t i = first_ + run;
    const Planned& one = planned_[i];
    return watcher(i) || (one.next_sample < one.samples.size() && one.samples[one.next_sample].t <= to);
  }
  void on_piece(std::size_t run, double to, const std::function<void(double t, X& x)>& at) override {
    const std::size_t i = first_ + run;
    Planned& one = planned_[i];
    for (; one.next_sample < one.samples.size() && one.samples[one.next_sample].t <= to; ++one.next_sample) {
      SampledState& sample = one.samples[one.next_sample];
      sample.x.resize(run_.motion.states);
      at(sample.t, sample.x);
    }
    if (MotionWatcher* seeing = watcher(i)) seeing->on_piece(to, at);
  }
  [[nodiscard]] Integration integration(std::size_t run) override {
    const std::size_t i = first_ + run;
    return integration_of(program_, plan_of(i), experiments_.common);
  }
  void on_event(std::size_t run, const ModelEvents& events, const EventOccurrence<X>& now) override {
    const std::size_t i = first_ + run;
    Planned& one = planned_[i];
    for (const EventName& name : one.names.of(events, now.events, true))
      one.events.push_back({name.event, name.mark, now.t, now.before, now.after});
    for (std::size_t k = one.next_sample; k-- > 0 && one.samples[k].t == now.t;) one.samples[k].x = now.after;
    if (MotionWatcher* seeing = watcher(i)) seeing->on_jump(now.t, now.before, now.after);
  }

 private:
  void make_equations(const std::string& method) {
    method_ = method;
    if (!has_events_) {
      equations_.emplace(equations_of(0));
      return;
    }
    std::vector<LaneEquations> modes;
    for (std::size_t mode = 0; mode < program_->derivatives.size(); ++mode) modes.push_back(equations_of(mode));
    mode_equations_.emplace(program_, std::move(modes), *this);
  }
  [[nodiscard]] LaneEquations equations_of(std::size_t mode) {
    std::optional<LaneDerivatives> derivatives;
    if (asks_for_derivatives(method_)) derivatives = code_.derivatives(mode);
    return {*program_, code_.rates(method_, mode), mode, std::move(derivatives)};
  }
  [[nodiscard]] MotionWatcher* watcher(std::size_t i) const { return watchers_.empty() ? nullptr : watchers_[i]; }

  [[nodiscard]] X first_state(std::size_t i) const {
    const Model& model = program_->model;
    const auto begin = planned_[i].variables.begin() + model.layout.states;
    return {begin, begin + static_cast<std::ptrdiff_t>(model.states.size())};
  }
  [[nodiscard]] RunStart<X, X> start(std::size_t run) const {
    const std::size_t i = first_ + run;
    const std::vector<double>& variables = planned_[i].variables;
    return {first_state(i),
            has_events_ ? mode_equations_->parameters(i + 1, variables) : LaneEquations::parameters(i + 1, variables)};
  }

  /// The plan of a run of those that go together now.
  [[nodiscard]] const Plan& plan_of(std::size_t i) {
    run_.plan.variables = planned_[i].variables;
    return run_.plan;
  }

  void begin(std::size_t i) {
    if (watchers_.empty() && !asks_for_samples_) return;
    Planned& one = planned_[i];
    const Plan& plan = plan_of(i);
    const X x = first_state(i);
    for (const double t : sample_times(program_->model, plan)) one.samples.push_back({t, {}});
    for (; one.next_sample < one.samples.size() && one.samples[one.next_sample].t <= plan.from; ++one.next_sample)
      if (one.samples[one.next_sample].t == plan.from) one.samples[one.next_sample].x = x;
    if (MotionWatcher* seeing = watcher(i)) seeing->begin(plan, x);
    is_watched_ = is_watched_ || watcher(i) || one.next_sample < one.samples.size();
  }

  [[nodiscard]] EnsembleOptions<X, X> options() {
    const Plan& plan = run_.plan;
    const Options<X> one = integration_of(program_, plan, experiments_.common).options;
    EnsembleOptions<X, X> options;
    options.rtol = one.rtol;
    options.atol = one.atol;
    options.rtol_each = one.rtol_each;
    options.atol_each = one.atol_each;
    options.step = one.step;
    options.max_step = one.max_step;
    options.max_steps = steps_together(plan, one.max_steps);
    options.interrupt = one.interrupt;
    options.threads = 1;
    options.watcher = is_watched_ && !has_events_ ? this : nullptr;
    options.finished = [this](const RunResult<X, X>& result) { return goes_on_ = goes_on_ && finish(result); };
    return options;
  }

  [[nodiscard]] bool finish(const RunResult<X, X>& result) {
    const std::size_t i = first_ + result.run;
    const Ending ending = result.outcome.ending;
    if (!succeeded(ending) && ending != Ending::interrupted) return run_alone(i);
    run_.plan.variables.swap(planned_[i].variables);
    run_.outcome = result.outcome;
    run_.events = std::move(planned_[i].events);
    run_.motion.values.assign(1, result.outcome.t);
    run_.motion.values.insert(run_.motion.values.end(), result.x.begin(), result.x.end());
    JudgedRun judged{
        .outcome = result.outcome, .readings = readings(program_->model, run_, planned_[i].samples), .diagnostics = {}};
    if (!succeeded(ending)) judged.diagnostics.push_back(failure(*program_, run_));
    return done_(i, std::move(judged));
  }

  const std::shared_ptr<const ModelProgram>& program_;
  bool has_events_;
  LaneCode& code_;
  std::string method_;                      // that the code of the equations is for
  std::optional<LaneEquations> equations_;  // one of the two is used
  std::optional<ModeEquations> mode_equations_;
  const ManyExperiments& experiments_;
  Experiment one_;  // the last one that was made of them
  std::span<MotionWatcher* const> watchers_;
  std::span<Planned> planned_;
  const OnJudged& done_;
  std::size_t first_ = 0;
  bool goes_on_ = true;
  bool asks_for_samples_;    // checks read the motion at times
  bool is_watched_ = false;  // somebody may want to see pieces of their motion
  Run run_;                  // with what differs from run to run put in
};

/// The end of the runs from `first` on that have the plan of that one.
std::size_t end_of_group(const Model& model, std::span<const Planned> planned, const Experiment& common,
                         std::size_t first) {
  const Planned& one = planned[first];
  const auto is_in_lanes = [&] {
    return has_lanes(one.plan->method, {.has_fixed_steps = one.plan->step > 0, .states = model.states.size()});
  };
  if (!one.plan || !is_in_lanes() || !is_plain(common) || one.plan->from == one.plan->to) return first + 1;
  std::size_t last = first + 1;
  while (last < planned.size() && planned[last].plan == one.plan) ++last;
  return last;
}

// With more of them there is enough to do at once in a run alone, and eight runs do not fit the cache (measured: chains
// of N equations by rk4).
constexpr std::size_t most_states_together = 64;

Company company_of(const ModelProgram& program) {
  const Model& model = program.model;
  const auto asks_for_extremes = [](const Check& check) {
    return check.measure == Measure::always || check.measure == Measure::energy_drift;
  };
  if (model.has_world() || model.needs_boundary_solver() || model.needs_dae_solver()) return Company::none;
  if (model.states.empty() || model.states.size() > most_states_together) return Company::none;
  const bool can = program.step_inputs.empty() &&
                   std::ranges::all_of(program.switches, [](const SwitchedEquations& one) { return one.empty(); }) &&
                   std::ranges::none_of(model.checks, asks_for_extremes);
  if (!can) return Company::none;
  const bool is_plain = model.modes.size() == 1 && model.events.empty() && model.schedule.empty();
  return is_plain ? Company::plain : Company::with_events;
}

}  // namespace

ManyRuns::ManyRuns(std::shared_ptr<const ModelProgram> program)
    : program_(std::move(program)),
      can_go_together_(company_of(*program_) != Company::none),
      code_(std::make_shared<LaneCode>(program_)) {}

void ManyRuns::make(const ManyExperiments& experiments, std::span<MotionWatcher* const> watchers,
                    const OnJudged& done) const {
  std::vector<Planned> planned;
  if (can_go_together_) planned = plan_all(*program_, experiments);
  const bool has_events = company_of(*program_) == Company::with_events;
  Together runs(program_, has_events, *code_, experiments, watchers, planned, done);
  for (std::size_t first = 0, last = 0; first < experiments.count; first = last) {
    last = can_go_together_ ? end_of_group(program_->model, planned, experiments.common, first) : first + 1;
    if (!(last > first + 1 ? runs.run(first, last) : runs.run_alone(first))) return;
  }
}

}  // namespace continuo::model
