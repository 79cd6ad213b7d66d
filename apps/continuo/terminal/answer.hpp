// The answer of a verb to --json: one object on standard output, whatever happens (docs/scripting.md).
//
//   if (options.json) answer("continuo.orbit/1", {{"period", found.period}});
#pragma once
#include <string_view>

#include <apps/continuo/terminal/exit_codes.hpp>
#include <nlohmann/json_fwd.hpp>

namespace continuo::app {

/// The layout of an answer without a result: why there is none is in its messages.
inline constexpr std::string_view failure_layout = "continuo.failure/1";

/// Whether the words of a command line ask for JSON, even where they are wrong otherwise.
bool wants_json(int argc, char** argv);

/// Keeps what was said on standard error for the answer: an object with at least `severity` and `message`.
void record_message(nlohmann::ordered_json message);

/// The result of the verb, which is printed when the verb ends. `layout` names the schema of its fields. Numbers that
/// are not finite become null, bytes that are not UTF-8 the replacement character.
void answer(std::string_view layout, nlohmann::ordered_json fields);

/// Where a signal ends the process in the middle of its work, this verb has an answer all the same.
void answer_even_if_interrupted(std::string_view verb);

/// Prints the answer, with the exit code and all messages up to now. Without a result it is one of `failure_layout`.
void print_answer(std::string_view verb, int exit);

/// The same while the verb goes on: its exit code is null, and nothing more is printed at its end.
void print_answer_now();

}  // namespace continuo::app
