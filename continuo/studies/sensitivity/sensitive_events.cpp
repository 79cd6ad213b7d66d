// Fires a model's events, and moves sensitivities through them and through jumps of the equations.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <continuo/studies/sensitivity/sensitive_events.hpp>

namespace continuo::studies::detail {

SensitiveEvents::SensitiveEvents(const SensitiveProgram& program, std::span<const double> variables, double from,
                                 double length)
    : length_(length),
      plain_(program.program(), variables, from, true),
      n_(program.size()),
      count_(program.count()),
      program_(&program),
      instant_t_(std::numeric_limits<double>::quiet_NaN()) {
  const model::Model& model = program.program().model;
  undeclared_ = program.program().step_inputs.size();
  for (const model::SwitchedEquations& equations : program.program().switches) {
    first_jump_.push_back(undeclared_);
    undeclared_ += equations.switches.size();
  }
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

std::optional<Carried> SensitiveEvents::carried(const SensitiveSystem& system, std::size_t i, double t, const X& x,
                                                double forward) {
  x_.assign(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n_));
  return plain_.carried(system.plain(), i, t, x_, forward);
}

void SensitiveEvents::take_step(const SensitiveSystem& system, double begin, double size,
                                std::span<const X> coefficients) {
  coefficients_.resize(coefficients.size());
  for (std::size_t k = 0; k < coefficients.size(); ++k)
    coefficients_[k].assign(coefficients[k].begin(), coefficients[k].begin() + static_cast<std::ptrdiff_t>(n_));
  plain_.take_step(system.plain(), begin, size, coefficients_);
}

namespace {
/// A guard further from zero than it comes in this part of the run has not been crossed but has jumped.
constexpr double least_jump = 1e-6;

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
  const std::string_view name = plain_.name(event + undeclared_);
  // Where g is not zero it has jumped, by what its slope does not show.
  const double nearly_zero = least_jump * std::abs(rate_of(guard, values, rates)) * length_;
  if (!(std::abs(values[guard.value]) <= nearly_zero) && status_)
    status_ = {.ending = Ending::cannot_continue,
               .message = fmt::format(
                   "`{}` jumps across its threshold, so that how its time moves is not known: let the event watch "
                   "what is continuous",
                   name)};
  return crossing_moves(name, guard, values, rates);
}

/// tau' = -(dg/dx S + dg/dp) / (dg/dx x' + dg/dt).
std::vector<double> SensitiveEvents::crossing_moves(std::string_view name, const Variation& guard,
                                                    std::span<const double> values, std::span<const double> rates) {
  std::vector<double> moves(count_);
  const double rate = rate_of(guard, values, rates);
  for (std::size_t k = 0; k < count_; ++k) {
    const double along = values[guard.along + k];
    moves[k] = along == 0 ? 0 : -along / rate;
    if (!std::isfinite(moves[k]) && status_)
      status_ = {.ending = Ending::cannot_continue,
                 .message = fmt::format("`{}` is not crossed with a slope: the motion has no derivative there", name)};
  }
  return moves;
}

/// One event's effect on x and S, on top of what others of the same instant have done.
struct SensitiveEvents::Jump {
  X& x;                          // wide
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
    }
  }
}

/// The event of the same instant that has carried the guard of this one across zero; none where its own crossing
/// brought it there, and its time moves by itself.
const SensitiveEvents::Change* SensitiveEvents::set_off_by(SensitiveSystem& system, std::size_t fired, double t) {
  if (!plain_.is_guard(fired)) return nullptr;
  std::vector<double> before(size()), after(size());
  for (std::size_t c = instant_.size(); c-- > 0;) {
    guards(system, t, instant_[c].before, before);
    guards(system, t, instant_[c].after, after);
    if (before[fired] != after[fired]) return &instant_[c];
  }
  return nullptr;
}

/// At a surface of the equations x goes on as it is, and S by the jump of x'. Where the motion leaves a surface that it
/// has slid along, x' does not jump.
void SensitiveEvents::cross_surface(std::size_t fired, const Surface& surface, SensitiveSystem& system, double t,
                                    const X& rates, X& now) {
  X after(now.size());
  system.rates(t, now, after);
  moves_.assign(count_, 0);
  const auto differs = [](double a, double b) {
    return std::abs(a - b) > 64 * std::numeric_limits<double>::epsilon() * (std::abs(a) + std::abs(b));
  };
  bool any = false;
  for (std::size_t s = 0; s < n_; ++s) any = any || differs(rates[s], after[s]);
  if (surface.slid || !any) return;
  moves_ = crossing_moves(plain_.name(fired), *surface.variation, surface.values, rates);
  for (std::size_t k = 0; k < count_; ++k)
    for (std::size_t s = 0; s < n_; ++s)
      if (rates[s] != after[s]) now[program_->place(s, k)] += (rates[s] - after[s]) * moves_[k];
}

/// An event of the text: its actions, and S as they make it.
void SensitiveEvents::act(std::size_t fired, SensitiveSystem& system, double t, const Acting& acting, X& now) {
  const std::size_t event = fired - undeclared_;
  const std::vector<double> moves =
      acting.set_off_by != nullptr ? acting.set_off_by->moves : time_moves(event, acting.values, t, acting.rates);
  Jump jump{now, std::vector<double>(n_ * count_), std::vector<char>(n_)};
  perform(program_->events()[event].actions, acting.values, acting.rates, moves, jump);
  X after(now.size());
  system.rates(t, now, after);
  for (std::size_t k = 0; k < count_; ++k) {
    for (std::size_t s = 0; s < n_; ++s) {
      double& sensitivity = now[program_->place(s, k)];
      const double total = jump.assigned[s] != 0 ? jump.total[k * n_ + s] : sensitivity + acting.rates[s] * moves[k];
      // Where nothing bends, nothing may be lost to rounding either.
      if (jump.assigned[s] != 0 || acting.rates[s] != after[s]) sensitivity = total - after[s] * moves[k];
    }
  }
  moves_ = moves;
  occurrences_.push_back({event, t, moves});
}

EventResponse SensitiveEvents::fire(SensitiveSystem& system, std::size_t fired, double t, const X& before, X& x) {
  // Evaluate everything that depends on the equations before the event first.
  if (t != instant_t_) instant_.clear();
  instant_t_ = t;
  Acting acting{.set_off_by = set_off_by(system, fired, t), .values = {}, .rates = X(before.size())};
  system.rates(t, before, acting.rates);
  std::optional<Surface> surface;
  if (plain_.is_jump(fired)) {
    const std::size_t k = fired - first_jump_[system.mode()];
    surface = {&program_->surfaces(system.mode()).surface[k], system.surfaces(t, before),
               system.plain().slides_along(k)};
  }
  if (plain_.is_declared(fired)) acting.values = system.event(fired - undeclared_, t, before);
  const X plain_before(before.begin(), before.begin() + static_cast<std::ptrdiff_t>(n_));
  X plain_after = plain_before, now = before;
  const EventResponse response = plain_.fire(system.plain(), fired, t, plain_before, plain_after);
  system.place_switches();
  if (surface) {
    cross_surface(fired, *surface, system, t, acting.rates, now);
  } else if (plain_.is_declared(fired)) {
    act(fired, system, t, acting, now);
  } else {
    const model::TableInput& input = program_->program().step_inputs[fired];
    system.set(input.variable, input.table.value(t));
    moves_.assign(count_, 0);
  }
  std::ranges::copy(plain_after, now.begin());
  const bool changed = response.restart || now != before;
  if (changed) instant_.push_back({before, now, moves_});
  x = std::move(now);
  return {response.stop || !status_, changed};
}

}  // namespace continuo::studies::detail
