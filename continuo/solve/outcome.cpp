#include <cmath>
#include <cstdio>

#include <continuo/solve/outcome.hpp>

namespace continuo {

std::string_view to_string(Ending ending) {
  switch (ending) {
    case Ending::reached_end:
      return "reached end";
    case Ending::stopped_by_event:
      return "stopped by event";
    case Ending::step_too_small:
      return "step too small";
    case Ending::too_many_steps:
      return "too many steps";
    case Ending::too_many_rejects:
      return "too many rejects";
    case Ending::not_finite:
      return "not finite";
    case Ending::nonlinear_solve_failed:
      return "nonlinear solve failed";
    case Ending::events_accumulate:
      return "events accumulate";
    case Ending::interrupted:
      return "interrupted";
    case Ending::invalid_input:
      return "invalid input";
  }
  return "unknown";
}

namespace {
std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}
}  // namespace

std::string where_steps_lie(double from, double to) {
  const std::string first = number(from), last = number(to);
  return first == last ? "half of the steps lie at t = " + first
                       : "half of the steps lie between t = " + first + " and t = " + last;
}

std::string describe(const Outcome<double>& outcome) {
  std::string text(to_string(outcome.ending));
  text += " at t = " + number(outcome.t);
  if (!outcome.event.empty()) text += ", event `" + outcome.event + "`";
  if (outcome.ending == Ending::events_accumulate) text += ", limit t = " + number(outcome.limit_time);
  if (!succeeded(outcome.ending) && outcome.h != 0) text += ", h = " + number(outcome.h);
  if (!succeeded(outcome.ending) && outcome.error != 0) text += ", error " + number(outcome.error) + " tolerances";
  if (!outcome.component.empty()) text += ", worst in " + outcome.component;
  if (!outcome.hint.empty()) text += "; " + outcome.hint;
  return text;
}

}  // namespace continuo
