// continuo/simulation/program/model_events.cpp
// Maps the events, schedules, inputs and jumps of a model to the events of solve/.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/simulation/program/model_events.hpp>

namespace continuo::model {

ModelEvents::Entry ModelEvents::entry_of(const When& when, std::size_t index) const {
  Entry entry{.kind = Kind::guard, .index = index, .name = when.name};
  entry.direction = when.direction;
  entry.in_one_mode = when.mode.has_value();
  entry.mode = when.mode.value_or(0);
  entry.is_condition = when.truth.valid();
  entry.has_limit = when.has_limit;
  return entry;
}

ModelEvents::Entry ModelEvents::entry_of(const ModelProgram& program, const Scheduled& scheduled, std::size_t index,
                                         std::span<const double> variables, double from) const {
  Entry entry{.kind = Kind::scheduled, .index = index, .name = scheduled.name};
  const auto value = [&](const Setting& setting) { return evaluate(program.model, setting.node, variables); };
  switch (scheduled.kind) {
    case Scheduled::Kind::initially:
      entry.times = {from};
      break;
    case Scheduled::Kind::at:
      entry.times = {value(*scheduled.time)};
      break;
    case Scheduled::Kind::every: {
      const double period = value(*scheduled.time);
      const double first = scheduled.first ? value(*scheduled.first) : DecimalTicks<double>(from, period)[1];
      entry.ticks = DecimalTicks<double>(first, period);
      break;
    }
  }
  return entry;
}

namespace {

bool assigns(const std::vector<ProgramAction>& actions) {
  return std::ranges::any_of(actions, [](const ProgramAction& action) {
    return action.kind == ProgramAction::Kind::assign || action.kind == ProgramAction::Kind::go ||
           assigns(action.then) || assigns(action.otherwise);
  });
}

/// Whether the actions may do more than to mark and to count.
bool may_restart(const ModelProgram& program, const std::vector<ProgramAction>& actions) {
  return std::ranges::any_of(actions, [&](const ProgramAction& action) {
    switch (action.kind) {
      case ProgramAction::Kind::mark:
        return false;
      case ProgramAction::Kind::assign:
        return program.counters[action.target] == 0;
      case ProgramAction::Kind::branch:
        return may_restart(program, action.then) || may_restart(program, action.otherwise);
      case ProgramAction::Kind::go:
      case ProgramAction::Kind::stop:
        break;
    }
    return true;
  });
}

}  // namespace

/// `v = 0`, `t/2 at a whole number`.
std::string name_of(const ModelProgram& program, const Switch& one) {
  const auto name = [&](std::uint32_t v) {
    return v < program.model.layout.size ? variable_name(program.model, v) : std::string("...");
  };
  constexpr std::size_t longest = 60;
  const std::string text = to_text(program.model.graph, one.surface, name, longest);
  return text + (one.kind == Switch::Kind::floor ? " at a whole number" : " = 0");
}

void ModelEvents::add_jumps(const ModelProgram& program) {
  std::size_t most = 0;
  for (std::size_t mode = 0; mode < program.switches.size(); ++mode) {
    const std::vector<Switch>& switches = program.switches[mode].switches;
    most = std::max(most, switches.size());
    for (std::size_t k = 0; k < switches.size(); ++k) {
      Entry entry{.kind = Kind::jump, .index = k, .name = name_of(program, switches[k])};
      entry.in_one_mode = true;
      entry.mode = mode;
      entry.can_assign = false;
      events_.push_back(std::move(entry));
    }
  }
  switch_values_.resize(most);
}

ModelEvents::ModelEvents(const ModelProgram& program, std::span<const double> variables, double from, bool jumps)
    : begin_(from) {
  const Model& model = program.model;
  // Inputs step first, so that the actions of the same instant see their new values.
  for (std::size_t i = 0; i < program.step_inputs.size(); ++i) {
    const TableInput& input = program.step_inputs[i];
    Entry entry{.kind = Kind::input, .index = i, .name = "step of " + input.name};
    entry.times.assign(input.table.x().begin(), input.table.x().end());
    events_.push_back(std::move(entry));
  }
  if (jumps) add_jumps(program);
  guard_place_.resize(model.events.size());
  for (const EventOrder& place : model.event_order) {
    if (!place.scheduled) guard_place_[place.index] = events_.size();
    events_.push_back(place.scheduled ? entry_of(program, model.schedule[place.index], place.index, variables, from)
                                      : entry_of(model.events[place.index], place.index));
    const auto& block = place.scheduled ? program.schedule_blocks[place.index] : program.event_blocks[place.index];
    events_.back().can_restart = may_restart(program, block.actions);
    events_.back().can_assign = assigns(block.actions);
  }
  guard_values_.resize(model.events.size());
  stop_counts_.resize(program.stops);
  const auto number_of_jump = [&](std::size_t mode, std::size_t k) {
    const auto found = std::ranges::find_if(events_, [&](const Entry& entry) {
      return entry.kind == Kind::jump && entry.mode == mode && entry.index == k;
    });
    return static_cast<std::size_t>(found - events_.begin());
  };
  auto guards = enclosed_guards(program, [&](std::size_t event) { return guard_place_[event]; }, number_of_jump);
  for (auto& of_mode : guards)
    std::erase_if(of_mode, [&](const GuardEnclosures::Guard& guard) { return guard.number == events_.size(); });
  enclosures_ = GuardEnclosures(program, std::move(guards), events_.size());
}

std::optional<Carried> ModelEvents::carried(const ModelSystem& system, std::size_t i, double t, const X& x,
                                            double forward) {
  if (events_[i].kind != Kind::guard || system.slides()) return std::nullopt;
  if (!series_) series_.emplace(system.program(), system.variables());
  motions_.resize(guard_values_.size());
  series_->guards(system.mode(), t, x, forward, motions_);
  const GuardMotion& motion = motions_[events_[i].index];
  const int side = model::carried(motion);
  if (side == 0) {
    // Unknowns are solved for to a tolerance, which hides what little a guard of theirs moves.
    const bool unknown =
        system.has_mass() || std::ranges::any_of(motion.rounding, [](double r) { return !std::isfinite(r); });
    return unknown ? std::nullopt : std::optional(Carried{});
  }
  int order = 1;
  while (order < 3 &&
         std::abs(motion.c[static_cast<std::size_t>(order)]) <= motion.rounding[static_cast<std::size_t>(order)])
    ++order;
  const auto k = static_cast<std::size_t>(order);
  return Carried{side, order, std::abs(motion.c[k]) > Carried::far_beyond * motion.rounding[k]};
}

double ModelEvents::next_time(std::size_t i, double t, bool inclusive) const {
  const Entry& entry = events_[i];
  if (t == resumed_) inclusive = false;
  double next = std::numeric_limits<double>::infinity();
  const auto found = inclusive ? std::ranges::lower_bound(entry.times, t) : std::ranges::upper_bound(entry.times, t);
  if (found != entry.times.end()) next = *found;
  if (entry.ticks.period() > 0) next = std::min(next, entry.ticks.next(t, inclusive));
  return next;
}

void ModelEvents::guards(ModelSystem& system, double t, const X& x, std::span<double> values) {
  system.guards(t, x, guard_values_);
  for (std::size_t k = 0; k < guard_place_.size(); ++k) values[guard_place_[k]] = guard_values_[k];
  if (switch_values_.empty() || !system.has_switches()) return;
  system.switch_guards(t, x, switch_values_);
  for (std::size_t i = 0; i < events_.size(); ++i)
    if (is_jump(i) && events_[i].mode == system.mode()) values[i] = switch_values_[events_[i].index];
}

void ModelEvents::perform(const std::vector<ProgramAction>& actions, std::span<const double> values, double t, X& x,
                          Effect& effect) {
  for (const ProgramAction& action : actions) {
    switch (action.kind) {
      case ProgramAction::Kind::assign:
        x[action.target] = values[action.expression];
        break;
      case ProgramAction::Kind::branch:
        perform(values[action.expression] != 0 ? action.then : action.otherwise, values, t, x, effect);
        break;
      case ProgramAction::Kind::go:
        effect.mode = action.target;
        break;
      case ProgramAction::Kind::mark:
        marks_.push_back({t, action.text, effect.event});
        break;
      case ProgramAction::Kind::stop:
        if (++stop_counts_[action.target] != action.after) break;
        effect.stop = true;
        stop_text_ = action.text;
        break;
    }
  }
}

EventResponse ModelEvents::fire(ModelSystem& system, std::size_t i, double t, const X& before, X& x) {
  const Entry& entry = events_[i];
  if (entry.kind == Kind::input) {
    const TableInput& input = system.program().step_inputs[entry.index];
    const double value = input.table.value(t);
    const bool changes = system.value(input.variable) != value;
    if (changes) {
      system.set(input.variable, value);
      enclosures_.set(input.variable, value);
      if (series_) series_->set(input.variable, value);
      system.settle_switches(t, before, &before);
    }
    return {.restart = changes};
  }
  if (entry.kind == Kind::jump) return pass(system, i, t, before);
  const bool guard = entry.kind == Kind::guard;
  const ProgramBlock& block =
      guard ? system.program().event_blocks[entry.index] : system.program().schedule_blocks[entry.index];
  const std::vector<double> values =
      guard ? system.event_expressions(entry.index, t, before) : system.schedule_expressions(entry.index, t, before);
  return act(system, block, values, i, t, before, x);
}

EventResponse ModelEvents::at_limit(ModelSystem& system, std::size_t i, double t, const X& before, X& x) {
  const std::size_t index = events_[i].index;
  return act(system, system.program().limit_blocks[index], system.limit_expressions(index, t, before), i, t, before, x);
}

EventResponse ModelEvents::act(ModelSystem& system, const ProgramBlock& block, std::span<const double> values,
                               std::size_t i, double t, const X& before, X& x) {
  Effect effect{.event = i, .mode = system.mode()};
  perform(block.actions, values, t, x, effect);
  EventResponse response{.stop = effect.stop, .restart = effect.mode != system.mode()};
  const std::vector<char>& counters = system.program().counters;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (x[k] == before[k]) continue;
    response.changed = true;
    response.restart = response.restart || counters[k] == 0;
  }
  system.go(effect.mode);
  if (response.restart) system.settle_switches(t, x, &before);
  return response;
}

/// The motion has come to a surface where the equations jump.
EventResponse ModelEvents::pass(ModelSystem& system, std::size_t i, double t, const X& x) {
  const Passage passage = system.pass_switch(events_[i].index, t, x);
  if (passage == Passage::begins_to_slide) marks_.push_back({t, "begins to slide along", i});
  if (passage == Passage::leaves) marks_.push_back({t, "leaves", i});
  return {.restart = passage != Passage::none};
}

}  // namespace continuo::model
