// Collects the result and the messages of a verb, and prints them as one JSON object.
#include <algorithm>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <nlohmann/json.hpp>

namespace continuo::app {
namespace {

using Json = nlohmann::ordered_json;

/// As standard output and standard error, there is one answer in a process. A server speaks from threads of its own.
struct Answer {
  std::mutex mutex;
  std::optional<std::string> layout;  // of the result, where there is one
  Json fields = Json::object(), messages = Json::array();
  bool printed = false;
};

Answer& the_answer() {
  static Answer answer;
  return answer;
}

std::string text_of(std::string_view layout, const Json& head, const Json& messages, const Json& fields) {
  Json document{{"layout", layout}};
  document.update(head);
  document["messages"] = messages;
  document.update(fields);
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

void print_with(Answer& answer, std::string_view layout, const Json& head) {
  answer_interrupt_with("");  // it would be a second one
  answer.printed = true;
  print(text_of(layout, head, answer.messages, answer.fields));
}

Json head_of_failure(std::string_view verb, int exit) {
  return {{"verb", verb.empty() ? Json() : Json(verb)}, {"exit", exit}};
}

}  // namespace

bool wants_json(int argc, char** argv) {
  const auto words = std::span(argv, static_cast<std::size_t>(argc));
  return std::ranges::any_of(words, [](const char* word) { return std::string_view(word) == "--json"; });
}

void record_message(Json message) {
  Answer& answer = the_answer();
  const std::scoped_lock lock(answer.mutex);
  answer.messages.push_back(std::move(message));
}

void answer(std::string_view layout, Json fields) {
  Answer& answer = the_answer();
  const std::scoped_lock lock(answer.mutex);
  answer.layout = layout;
  answer.fields = std::move(fields);
}

void answer_even_if_interrupted(std::string_view verb) {
  const Json message{{"severity", "error"}, {"message", "interrupted before there was a result"}};
  answer_interrupt_with(
      text_of(failure_layout, head_of_failure(verb, interrupted), Json::array({message}), Json::object()));
}

void print_answer(std::string_view verb, int exit) {
  Answer& answer = the_answer();
  const std::scoped_lock lock(answer.mutex);
  if (answer.printed) return;
  if (answer.layout) return print_with(answer, *answer.layout, {{"exit", exit}});
  print_with(answer, failure_layout, head_of_failure(verb, exit));
}

void print_answer_now() {
  Answer& answer = the_answer();
  const std::scoped_lock lock(answer.mutex);
  print_with(answer, answer.layout.value_or(std::string(failure_layout)), {{"exit", nullptr}});
}

}  // namespace continuo::app
