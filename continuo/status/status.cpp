// The words for endings, and a status as one line of text.
#include <continuo/status/status.hpp>

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
    case Ending::cannot_continue:
      return "cannot continue";
    case Ending::interrupted:
      return "interrupted";
    case Ending::invalid_input:
      return "invalid input";
    case Ending::unreadable:
      return "unreadable";
    case Ending::unwritable:
      return "unwritable";
    case Ending::stopped_by_callback:
      return "stopped by callback";
  }
  return "unknown";
}

std::string describe(const Status& status) {
  const std::string words = status.message.empty() ? std::string(to_string(status.ending)) : status.message;
  return status.place.empty() ? words : status.place + ": " + words;
}

}  // namespace continuo
