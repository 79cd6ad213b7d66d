// The outcome of a run in words.
#include <charconv>
#include <chrono>
#include <cmath>

#include <continuo/solve/outcome.hpp>

namespace continuo {

namespace {
std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 10).ptr};
}
}  // namespace

double detail::seconds_of_steady_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

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

Status status(const Outcome<double>& outcome) {
  if (succeeded(outcome.ending)) return {.ending = outcome.ending};
  return {.ending = outcome.ending, .message = describe(outcome), .place = "t = " + number(outcome.t)};
}

}  // namespace continuo
