// continuo/simulation/drive/failure.cpp
// Endings that are no success, as diagnostics with a code.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <continuo/simulation/program/jumps.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/simulate.hpp>

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

/// The jump at which a run has come to stand: nearer than a ten-thousandth of the way that the run has been from it.
std::optional<Jump> jump_at_end(const ModelProgram& program, const Run& run) {
  constexpr double near = 1e-4;
  std::vector<Jump> jumps;
  for (std::size_t mode = 0; mode < program.model.modes.size(); ++mode)
    std::ranges::copy(jumps_of(program.model, mode), std::back_inserter(jumps));
  if (jumps.empty() || run.motion.rows() < 2) return std::nullopt;
  std::vector<NodeId> nodes;
  for (const Jump& jump : jumps) nodes.insert(nodes.end(), {jump.first, jump.second});
  const std::vector<std::vector<double>> values = values_along(program, run, nodes);
  std::optional<Jump> nearest;
  double least = near;
  for (std::size_t k = 0; k < jumps.size(); ++k) {
    const Op op = program.model.graph[jumps[k].node].op;
    double farthest = 0, last = 0;
    for (std::size_t row = 0; row < run.motion.rows(); ++row) {
      last = distance_to(op, values[2 * k][row], values[2 * k + 1][row]);
      farthest = std::max(farthest, last);
    }
    if (last < least * farthest) least = last / farthest, nearest = jumps[k];
  }
  return nearest;
}

/// Endings that a motion comes to which is held at a jump of its equations.
bool may_be_held(Ending ending) {
  return ending == Ending::step_too_small || ending == Ending::too_many_steps || ending == Ending::too_many_rejects ||
         ending == Ending::nonlinear_solve_failed;
}

}  // namespace

Diagnostic failure(const ModelProgram& program, const Run& run) {
  Diagnostic diagnostic = failure(program.model, run.outcome);
  if (!may_be_held(run.outcome.ending)) return diagnostic;
  const std::optional<Jump> jump = jump_at_end(program, run);
  if (!jump) return diagnostic;
  const Model& model = program.model;
  const State& state = model.states[jump->state];
  diagnostic.related.push_back(
      {state.span, fmt::format("the equation of `{}` jumps with `{}`, and the run has come to stand there: where both "
                               "sides lead back to a jump the motion slides along it",
                               state.algebraic ? state.column : state.column + "'", text_of(model, *jump))});
  diagnostic.help =
      "jumps are located, and slid along, where they depend on states and the time, not on unknowns, stand outside of "
      "`smooth`, and are at most 64; " +
      diagnostic.help;
  return diagnostic;
}

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
    case Ending::cannot_continue:
    case Ending::unreadable:
    case Ending::unwritable:
    case Ending::stopped_by_callback:
      break;
  }
  return make("E300", "the run ended at " + at, model.run.span);
}

}  // namespace continuo::model
