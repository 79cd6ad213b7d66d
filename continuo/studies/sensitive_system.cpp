#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <continuo/studies/sensitive_system.hpp>

namespace continuo::studies::detail {

WideEvaluation::WideEvaluation(std::shared_ptr<const model::Tape> tape, const SensitiveProgram& program,
                               std::span<const double> variables)
    : tape_(std::move(tape)),
      states_(program.program().model.layout.states),
      further_(program.registers_of_s()),
      n_(program.size()),
      registers_(tape_->register_count()) {
  std::ranges::copy(variables, registers_.begin());
  tape_->prepare<double>(registers_);
}

void WideEvaluation::operator()(double t, std::span<const double> wide, std::span<double> outputs) {
  registers_[model::Layout::time] = t;
  std::ranges::copy(wide.first(n_), registers_.begin() + states_);
  std::ranges::copy(wide.subspan(n_), registers_.begin() + further_);
  tape_->evaluate<double>(registers_, outputs);
}

std::vector<double> WideEvaluation::operator()(double t, std::span<const double> wide) {
  std::vector<double> outputs(tape_->output_count());
  if (!outputs.empty()) (*this)(t, wide, outputs);
  return outputs;
}

void WideEvaluation::set(std::uint32_t variable, double value) {
  registers_[variable] = value;
  tape_->prepare<double>(registers_);
}

SensitiveSystem::SensitiveSystem(std::shared_ptr<const SensitiveProgram> program, std::span<const double> variables)
    : program_(std::move(program)),
      plain_(program_->shared_program(), variables),
      variables_(variables.begin(), variables.end()) {
  for (std::size_t mode = 0; mode < program_->program().model.modes.size(); ++mode)
    rates_.emplace_back(program_->rates(mode), *program_, variables);
  for (const SensitiveEvent& event : program_->events()) events_.emplace_back(event.tape, *program_, variables);
}

void SensitiveSystem::set(std::uint32_t variable, double value) {
  variables_[variable] = value;
  for (WideEvaluation& rates : rates_) rates.set(variable, value);
  for (WideEvaluation& event : events_) event.set(variable, value);
  if (!jacobian_) return;
  for (WideEvaluation& entries : jacobian_->by_state) entries.set(variable, value);
  for (WideEvaluation& entries : jacobian_->by_time) entries.set(variable, value);
}

SensitiveSystem::Jacobian& SensitiveSystem::derivatives() {
  if (jacobian_) return *jacobian_;
  const SensitiveProgram::Jacobians& shared = program_->jacobians();
  jacobian_.emplace();
  for (const auto& entries : shared.by_state) {
    jacobian_->by_state.emplace_back(entries.tape, *program_, variables_);
    std::vector<std::size_t>& entry = jacobian_->entry.emplace_back();
    for (const MatrixPlace& place : entries.places) entry.push_back(shared.pattern.find(place.row, place.column));
  }
  for (const auto& entries : shared.by_time) jacobian_->by_time.emplace_back(entries.tape, *program_, variables_);
  return *jacobian_;
}

void SensitiveSystem::jacobian_values(double t, const X& x, std::span<double> values) {
  Jacobian& mine = derivatives();
  const std::vector<double> entries = mine.by_state[mode()](t, x);
  std::ranges::fill(values, 0.0);
  for (std::size_t e = 0; e < entries.size(); ++e) values[mine.entry[mode()][e]] = entries[e];
}

void SensitiveSystem::jacobian(double t, const X& x, std::span<double> rows) {
  const std::vector<double> entries = derivatives().by_state[mode()](t, x);
  const auto& places = program_->jacobians().by_state[mode()].places;
  std::ranges::fill(rows, 0.0);
  for (std::size_t e = 0; e < entries.size(); ++e) rows[places[e].row * x.size() + places[e].column] = entries[e];
}

void SensitiveSystem::time_derivative(double t, const X& x, X& dfdt) {
  const std::vector<double> entries = derivatives().by_time[mode()](t, x);
  const auto& places = program_->jacobians().by_time[mode()].places;
  std::ranges::fill(dfdt, 0.0);
  for (std::size_t e = 0; e < entries.size(); ++e) dfdt[places[e].row] = entries[e];
}

SensitiveEvents::SensitiveEvents(const SensitiveProgram& program, std::span<const double> variables, double from)
    : plain_(program.program(), variables, from),
      inputs_(program.program().step_inputs.size()),
      n_(program.size()),
      count_(program.count()),
      program_(&program),
      last_t_(std::numeric_limits<double>::quiet_NaN()) {
  const model::Model& model = program.program().model;
  const std::vector<double> values(variables.begin(), variables.end());
  for (std::size_t e = 0; e < model.event_order.size(); ++e) {
    std::optional<Schedule>& schedule = schedules_.emplace_back();
    if (!model.event_order[e].scheduled) continue;
    const SensitiveEvent& event = program.events()[e];
    const model::Scheduled& text = model.schedule[model.event_order[e].index];
    schedule.emplace();
    if (text.kind == model::Scheduled::Kind::every) {
      schedule->period = evaluate(model, text.time->node, values);
      schedule->first = text.first ? evaluate(model, text.first->node, values) : from + schedule->period;
    }
    schedule->first_moves = program.evaluate(event.first, values);
    schedule->period_moves = program.evaluate(event.period, values);
  }
}

void SensitiveEvents::guards(SensitiveSystem& system, double t, const X& x, std::span<double> values) {
  x_.assign(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n_));
  plain_.guards(system.plain(), t, x_, values);
}

namespace {
/// dv/dx x' + dv/dt.
double rate_of(const Variation& variation, std::span<const double> values, std::span<const double> rates) {
  double rate = values[variation.by_time];
  for (std::size_t s = 0; s < variation.states.size(); ++s)
    rate += values[variation.by_state + s] * rates[variation.states[s]];
  return rate;
}
}  // namespace

std::vector<double> SensitiveEvents::time_moves(std::size_t event, std::span<const double> values, double t,
                                                std::span<const double> rates) {
  std::vector<double> moves(count_);
  if (const auto& schedule = schedules_[event]) {
    const double number = schedule->period > 0 ? std::round((t - schedule->first) / schedule->period) : 0;
    for (std::size_t k = 0; k < count_; ++k) moves[k] = schedule->first_moves[k] + number * schedule->period_moves[k];
    return moves;
  }
  const Variation& guard = *program_->events()[event].guard;
  const double rate = rate_of(guard, values, rates);
  for (std::size_t k = 0; k < count_; ++k) {
    const double along = values[guard.along + k];
    moves[k] = along == 0 ? 0 : -along / rate;
    if (!std::isfinite(moves[k]) && problem_.empty())
      problem_ = fmt::format("`{}` is not crossed with a slope: the motion has no derivative there",
                             plain_.name(event + inputs_));
  }
  return moves;
}

/// One event's effect on x, S and the mode, on top of what others of the same instant have done.
struct SensitiveEvents::Jump {
  X& x;  // wide
  std::size_t mode;
  std::vector<double> total;     // dA/dx (S- + f- tau') + dA/dt tau' + dA/dp of assigned states, by k n + i
  std::vector<char> assigned{};  // by state
};

void SensitiveEvents::perform(const std::vector<SensitiveAction>& actions, std::span<const double> values,
                              std::span<const double> rates, std::span<const double> moves, Jump& jump) const {
  for (const SensitiveAction& action : actions) {
    switch (action.kind) {
      case SensitiveAction::Kind::assign: {
        jump.x[action.target] = values[action.value.value];
        jump.assigned[action.target] = 1;
        const double rate = rate_of(action.value, values, rates);
        for (std::size_t k = 0; k < count_; ++k)
          jump.total[k * n_ + action.target] = values[action.value.along + k] + rate * moves[k];
        break;
      }
      case SensitiveAction::Kind::branch:
        perform(values[action.condition] != 0 ? action.then : action.otherwise, values, rates, moves, jump);
        break;
      case SensitiveAction::Kind::go:
        jump.mode = action.target;
        break;
    }
  }
}

/// An event whose guard the event before it at the same instant has carried across zero; else its own crossing brought
/// it there, and its time moves by itself.
bool SensitiveEvents::set_off_by_jump(SensitiveSystem& system, std::size_t fired, double t, const X& before) {
  if (!plain_.is_guard(fired) || !last_changed_ || t != last_t_ || before != last_after_) return false;
  std::vector<double> now(size()), earlier(size());
  guards(system, t, before, now);
  guards(system, t, last_before_, earlier);
  return now[fired] != earlier[fired];
}

EventResponse SensitiveEvents::fire(SensitiveSystem& system, std::size_t fired, double t, const X& before, X& x) {
  const auto of_model = [this](const X& wide) {
    return X(wide.begin(), wide.begin() + static_cast<std::ptrdiff_t>(n_));
  };
  const bool follows = set_off_by_jump(system, fired, t, before);
  const std::size_t mode = system.mode();
  X rates(before.size()), new_rates(before.size());
  system.rates(mode, t, before, rates);
  const X plain_before = of_model(before);
  X plain_after = plain_before;
  const EventResponse response = plain_.fire(system.plain(), fired, t, plain_before, plain_after);
  X now = before;
  if (!plain_.is_declared(fired)) {
    const model::TableInput& input = program_->program().step_inputs[fired];
    system.set(input.variable, input.table.value(t));
    last_moves_.assign(count_, 0);
  } else {
    const std::size_t event = fired - inputs_;
    const std::vector<double> values = system.event(event, t, before);
    const std::vector<double> moves = follows ? last_moves_ : time_moves(event, values, t, rates);
    Jump jump{now, mode, std::vector<double>(n_ * count_), std::vector<char>(n_)};
    perform(program_->events()[event].actions, values, rates, moves, jump);
    system.rates(jump.mode, t, now, new_rates);
    for (std::size_t k = 0; k < count_; ++k) {
      for (std::size_t s = 0; s < n_; ++s) {
        double& sensitivity = now[program_->place(s, k)];
        const double total = jump.assigned[s] != 0 ? jump.total[k * n_ + s] : sensitivity + rates[s] * moves[k];
        // Where nothing bends, nothing may be lost to rounding either.
        if (jump.assigned[s] != 0 || rates[s] != new_rates[s]) sensitivity = total - new_rates[s] * moves[k];
      }
    }
    last_moves_ = moves;
    happened_.push_back({event, t, moves});
  }
  std::ranges::copy(plain_after, now.begin());
  last_t_ = t;
  last_before_ = before;
  last_after_ = now;
  last_changed_ = response.restart || now != before;
  x = std::move(now);
  return {response.stop || !problem_.empty(), last_changed_};
}

}  // namespace continuo::studies::detail
