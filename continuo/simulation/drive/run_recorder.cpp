// continuo/simulation/drive/run_recorder.cpp
// Records rows, events, energies and samples while a model is integrated.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/simulation/drive/run_recorder.hpp>

namespace continuo::model {

namespace {

std::vector<NodeId> quantity_nodes(const Model& model) {
  std::vector<NodeId> nodes;
  for (const Quantity& output : model.outputs) nodes.push_back(output.node);
  for (const Quantity& energy : model.energies) nodes.push_back(energy.node);
  if (model.total_energy.valid()) nodes.push_back(model.total_energy);
  return nodes;
}

std::vector<Column> columns_of(const Model& model) {
  std::vector<Column> columns = {{"t", model.time_unit}};
  for (const State& state : model.states) columns.push_back({state.column, state.unit});
  for (const Quantity& output : model.outputs) columns.push_back({output.name, output.unit});
  for (const Quantity& energy : model.energies) columns.push_back({energy.name, energy.unit});
  return columns;
}

}  // namespace

RunRecorder::RunRecorder(const ModelProgram& program, const Plan& plan, bool keep_rows,
                         std::vector<double> sample_times, std::span<const NodeId> watched, OnRow on_row)
    : program_(program),
      times_(plan),
      start_(plan.from),
      every_step_(plan.output == OutputPlan::Kind::steps),
      keep_rows_(keep_rows),
      on_row_(std::move(on_row)),
      has_energy_(program.model.total_energy.valid()) {
  const Model& model = program.model;
  motion_.columns = columns_of(model);
  motion_.states = model.states.size();
  const std::vector<NodeId> quantities = quantity_nodes(model);
  quantities_ = Evaluation(program.shared_tape_of(quantities), plan.variables);
  quantity_values_.resize(quantities.size());
  std::vector<NodeId> all;
  if (has_energy_) all = {model.total_energy, program.energy_scale};
  all.insert(all.end(), watched.begin(), watched.end());
  watched_ = Evaluation(program.shared_tape_of(all), plan.variables);
  watched_values_.resize(all.size());
  for (const double t : sample_times) samples_.push_back({t, {}});
  const auto reads_start = [](const Check& check) {
    return check.measure == Measure::always && !check.samples.empty();
  };
  if (std::ranges::any_of(model.checks, reads_start)) start_variables_ = plan.variables;
}

void RunRecorder::set_inputs(Evaluation& evaluation, double t) const {
  for (const TableInput& input : program_.step_inputs) evaluation.set(input.variable, input.table.value(t));
}

/// `check always x < x(0) + 1`: what x(0) is.
void RunRecorder::set_start_values(double t, const X& x) {
  if (start_variables_.empty()) return;
  const Model& model = program_.model;
  start_variables_[Layout::time] = t;
  std::ranges::copy(x, start_variables_.begin() + model.layout.states);
  for (const TableInput& input : program_.step_inputs) start_variables_[input.variable] = input.table.value(t);
  for (const Check& check : model.checks) {
    if (check.measure != Measure::always) continue;
    for (const Sample& sample : check.samples)
      watched_.set(sample.variable, evaluate(model, sample.of, start_variables_));
  }
}

void RunRecorder::add_row(double t, const X& x) {
  last_row_ = t;
  row_.assign(1, t);
  row_.insert(row_.end(), x.begin(), x.end());
  if (!quantity_values_.empty()) {
    set_inputs(quantities_, t);
    quantities_(t, x, quantity_values_);
    row_.insert(row_.end(), quantity_values_.begin(), quantity_values_.end());
  }
  hand_over();
  keep_row();
  if (!collects_parts_) return;
  part_rows_.insert(part_rows_.end(), row_.begin(), row_.begin() + static_cast<std::ptrdiff_t>(motion_.columns.size()));
  if (has_energy_) part_energies_.push_back(row_.back());
}

void RunRecorder::hand_over() {
  if (on_row_ && !is_refused_)
    is_refused_ = !on_row_({.columns = motion_.columns, .states = motion_.states, .values = row_});
}

void RunRecorder::keep_row() {
  const std::size_t size = motion_.columns.size();
  if (!keep_rows_ && motion_.rows() == 2) {  // the last one gives way
    motion_.values.resize(size);
    if (has_energy_) total_energy_.resize(1);
  }
  motion_.values.insert(motion_.values.end(), row_.begin(), row_.begin() + static_cast<std::ptrdiff_t>(size));
  if (has_energy_) total_energy_.push_back(row_.back());
}

void RunRecorder::watch(double t, const X& x) {
  if (watched_values_.empty()) return;
  set_inputs(watched_, t);
  watched_(t, x, watched_values_);
  if (!any_) {
    for (const double value : watched_values_) extremes_.push_back({value, value, t, t});
    if (has_energy_) energy_ = {watched_values_[0], watched_values_[0], 0, program_.model.total_energy_unit};
  }
  any_ = true;
  for (std::size_t k = 0; k < watched_values_.size(); ++k) {
    const double value = watched_values_[k];
    Extremes& e = extremes_[k];
    // Not a number is below everything: it must not pass for anything.
    if (!(value >= e.low)) e.low = value, e.t_low = t;
    if (!(value <= e.high)) e.high = value, e.t_high = t;
  }
  if (has_energy_) energy_->last = watched_values_[0];
}

void RunRecorder::begin(double t, const X& x) {
  x_ = x;
  set_start_values(t, x);
  add_row(t, x);
  watch(t, x);
  while (times_[next_output_] <= t) ++next_output_;
  take_samples(t, [&](SampledState& sample) {
    if (sample.t == t) sample.x = x;
  });
}

void RunRecorder::on_segment(double to, const At& at) {
  if (wants_rows() && !every_step_) {
    for (; times_[next_output_] <= to; ++next_output_) {
      at(times_[next_output_], x_);
      add_row(times_[next_output_], x_);
      watch(times_[next_output_], x_);
    }
  }
  take_samples(to, [&](SampledState& sample) {
    sample.x.resize(x_.size());
    at(sample.t, sample.x);
  });
  const bool adds_row = every_step_ && wants_rows();
  if (watched_values_.empty() && !adds_row) return;
  at(to, x_);
  watch(to, x_);
  if (adds_row) add_row(to, x_);
}

double RunRecorder::quiet_until() const {
  if (!watched_values_.empty() || (every_step_ && wants_rows())) return -std::numeric_limits<double>::infinity();
  return wants_rows() ? std::min(times_[next_output_], next_sample()) : next_sample();
}

void RunRecorder::on_event(double t, std::span<const EventName> names, const X& before, const X& after) {
  for (const EventName& name : names) events_.push_back({name.event, name.mark, t, before, after});
  if (!samples_.empty() && t == start_) set_start_values(t, after);
  watch(t, after);
  for (std::size_t k = next_sample_; k-- > 0 && samples_[k].t == t;) samples_[k].x = after;
  if (!wants_rows() || (names.empty() && before == after)) return;
  if (last_row_ != t) add_row(t, before);
  if (before != after) add_row(t, after);
}

void RunRecorder::sample_until(double t, const X& x) {
  take_samples(t, [&](SampledState& sample) { sample.x = x; });
}

void RunRecorder::contact(double t, std::string name, double impulse) {
  events_.push_back({.name = std::move(name), .mark = {}, .t = t, .before = {}, .after = {}, .impulse = impulse});
}

void RunRecorder::finish(double t, const X& x) {
  if (last_row_ != t) add_row(t, x);
}

RecordedPart RunRecorder::part() {
  const auto first_event = static_cast<std::ptrdiff_t>(std::exchange(events_parted_, events_.size()));
  return {.rows = std::exchange(part_rows_, {}),
          .total_energy = std::exchange(part_energies_, {}),
          .events = {events_.begin() + first_event, events_.end()},
          .next_output = next_output_,
          .next_sample = next_sample_,
          .samples = {samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(next_sample_)},
          .extremes = extremes_,
          .energy = energy_,
          .x = x_,
          .last_row = last_row_,
          .any = any_};
}

bool RunRecorder::add(const RecordedPart& part) {
  const std::size_t columns = motion_.columns.size(), states = motion_.states;
  const std::size_t rows = part.rows.size() / columns;
  const auto is_state = [&](const X& x) { return x.empty() || x.size() == states; };
  const bool fits =
      rows * columns == part.rows.size() && part.x.size() == states &&
      part.total_energy.size() == (has_energy_ ? rows : 0) && part.next_sample <= samples_.size() &&
      part.samples.size() == part.next_sample && part.extremes.size() == (part.any ? watched_values_.size() : 0) &&
      part.energy.has_value() == (has_energy_ && part.any) &&
      std::ranges::all_of(
          part.events,
          [&](const RecordedEvent& event) { return event.before.size() == states && event.after.size() == states; }) &&
      std::ranges::all_of(part.samples, [&](const SampledState& sample) { return is_state(sample.x); });
  if (!fits) return false;
  for (std::size_t k = 0; k < part.next_sample; ++k)
    if (part.samples[k].t != samples_[k].t) return false;
  for (std::size_t row = 0; row < rows; ++row) {
    const auto first = part.rows.begin() + static_cast<std::ptrdiff_t>(row * columns);
    row_.assign(first, first + static_cast<std::ptrdiff_t>(columns));
    if (has_energy_) row_.push_back(part.total_energy[row]);
    hand_over();
    keep_row();
  }
  events_.insert(events_.end(), part.events.begin(), part.events.end());
  next_output_ = part.next_output;
  next_sample_ = part.next_sample;
  std::ranges::copy(part.samples, samples_.begin());
  if (const auto start = std::ranges::find(samples_, start_, &SampledState::t);
      start != samples_.end() && !start->x.empty())
    set_start_values(start->t, start->x);
  extremes_ = part.extremes;
  energy_ = part.energy;
  x_ = part.x;
  last_row_ = part.last_row;
  any_ = part.any;
  events_parted_ = events_.size();
  return true;
}

double RunRecorder::next_sample() const {
  return next_sample_ < samples_.size() ? samples_[next_sample_].t : std::numeric_limits<double>::infinity();
}

void RunRecorder::give(Run& run) {
  if (energy_ && !extremes_.empty()) {
    const Extremes& e = extremes_.front();
    const double largest = std::max(e.high - energy_->first, energy_->first - e.low);
    // Kinetic and potential energy that cancel at the start leave rounding, which is no measure.
    energy_->relative = std::abs(energy_->first) > 1e-12 * extremes_[1].high;
    energy_->drift = energy_->relative ? largest / std::abs(energy_->first) : largest;
    extremes_.erase(extremes_.begin(), extremes_.begin() + 2);
  }
  run.motion = std::move(motion_);
  run.total_energy = std::move(total_energy_);
  run.events = std::move(events_);
  run.statistics.events = run.events.size();  // without the steps of inputs
  run.energy = energy_;
}

}  // namespace continuo::model
