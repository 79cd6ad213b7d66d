// continuo/status/status.hpp
// How an operation ended. Every public function of the library that can fail returns a Status, or a Result (result.hpp)
// where it also returns a value:
//
//   if (const continuo::Status status = motion.advance_to(10); !status) std::cerr << describe(status) << '\n';
#pragma once
#include <string>
#include <string_view>
#include <utility>

namespace continuo {

/// How a run or any other operation ended.
enum class Ending {        // recordings hold the number: new ones come last
  reached_end,             ///< All that was asked for was done.
  stopped_by_event,        ///< An event ended the run as the model says; a success.
  step_too_small,          ///< The step that the tolerance needs is below what rounding can resolve.
  too_many_steps,          ///< The limit of steps was reached.
  too_many_rejects,        ///< Too many steps in a row were rejected.
  not_finite,              ///< A value became infinite or NaN.
  nonlinear_solve_failed,  ///< The equations of a step, or of a solution, could not be solved.
  events_accumulate,       ///< The times of events tend to a limit that is not passed.
  interrupted,             ///< Somebody asked for the end; what was computed so far is kept.
  invalid_input,           ///< What was given cannot be meant; nothing was done.
  cannot_continue,         ///< Nothing further can be computed from here; the message names the reason.
  unreadable,              ///< A file could not be read, or its content is corrupt.
  unwritable,              ///< A file could not be written; an older one stays.
  stopped_by_callback,     ///< A function that watches the run asked for its end; a success.
};
inline constexpr Ending last_ending = Ending::stopped_by_callback;

/// "reached end", "step too small", ...
[[nodiscard]] std::string_view to_string(Ending ending);

/// Whether the operation gave what was asked: it reached the end, or an event or a callback stopped it.
[[nodiscard]] constexpr bool succeeded(Ending ending) {
  return ending == Ending::reached_end || ending == Ending::stopped_by_event || ending == Ending::stopped_by_callback;
}

/// How an operation ended, in words.
struct [[nodiscard]] Status {
  Ending ending = Ending::reached_end;  ///< Why it ended.
  std::string message{};                ///< One sentence: what is wrong and how to mend it; empty after a success.
  std::string place{};  ///< What the message is about: a file, a body, a time; empty where the message names it.

  /// Whether it succeeded.
  explicit operator bool() const { return succeeded(ending); }

  friend bool operator==(const Status&, const Status&) = default;
};

/// What was given cannot be meant. An empty message is a success: functions that look for faults return the first.
[[nodiscard]] inline Status invalid_input(std::string message, std::string place = {}) {
  if (message.empty()) return {};
  return {Ending::invalid_input, std::move(message), std::move(place)};
}

/// The first of two that failed; a success where both succeeded.
[[nodiscard]] inline Status first_failure(Status first, Status second) {
  return first ? std::move(second) : std::move(first);
}

/// "PLACE: MESSAGE"; the ending's name where there is no message.
[[nodiscard]] std::string describe(const Status& status);

}  // namespace continuo
