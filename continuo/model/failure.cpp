// continuo/model/failure.cpp
// Endings that are no success, as diagnostics with a code.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <continuo/model/simulate.hpp>

namespace continuo::model {

namespace {

std::string in_units(double t, const std::string& unit) {
  return unit.empty() ? fmt::format("t = {:.6g}", t) : fmt::format("t = {:.6g} {}", t, unit);
}

Span span_of_event(const Model& model, const std::string& name) {
  for (const When& when : model.events) {
    if (when.name == name) return when.span;
  }
  return model.run.span;
}

/// Where the equation stands whose state is worst.
Span span_of_state(const Model& model, const std::string& column) {
  const std::size_t i = find_state(model, column);
  return i == npos ? model.run.span : model.states[i].span;
}

std::string with_component(std::string message, const Outcome<double>& outcome) {
  return outcome.component.empty() ? message : message + fmt::format("; `{}` is the worst", outcome.component);
}

}  // namespace

Diagnostic failure(const Model& model, const Outcome<double>& outcome) {
  const std::string at = in_units(outcome.t, model.time_unit);
  const Span state = span_of_state(model, outcome.component);
  const auto make = [&](const char* code, std::string message, Span span) {
    return error(code, span, with_component(std::move(message), outcome), {}, outcome.hint);
  };
  switch (outcome.ending) {
    case Ending::not_finite:
      return make("E301", "the equations give no finite number at " + at, state);
    case Ending::step_too_small:
      return make("E302", fmt::format("the step shrinks to nothing ({:.2g}) at {}", outcome.h, at), state);
    case Ending::too_many_steps:
      return make("E303", "too many steps; stopped at " + at, model.run.span);
    case Ending::too_many_rejects:
      return make("E304", "every step is rejected at " + at, state);
    case Ending::nonlinear_solve_failed:
      return make("E305", "the implicit equations find no solution at " + at, state);
    case Ending::invalid_input:
      return make("E306", "the run cannot begin", model.run.span);
    case Ending::interrupted:
      return make("E307", "interrupted at " + at, model.run.span);
    case Ending::events_accumulate:
      return make("E310",
                  fmt::format("`{}` happens ever faster, towards {}", outcome.event,
                              in_units(outcome.limit_time, model.time_unit)),
                  span_of_event(model, outcome.event));
    case Ending::reached_end:
    case Ending::stopped_by_event:
      break;
  }
  return make("E300", "the run ended at " + at, model.run.span);
}

}  // namespace continuo::model
