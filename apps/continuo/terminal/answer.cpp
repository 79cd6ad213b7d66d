// Collects the result and the messages of a verb, and prints them as one JSON object.
#include <algorithm>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <apps/continuo/terminal/answer.hpp>
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

void print_with(Answer& answer, std::string_view layout, const Json& head) {
  Json document{{"layout", layout}};
  document.update(head);
  document["messages"] = answer.messages;
  document.update(answer.fields);
  answer.printed = true;
  print(document.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
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

void print_answer(std::string_view verb, int exit) {
  Answer& answer = the_answer();
  const std::scoped_lock lock(answer.mutex);
  if (answer.printed) return;
  if (answer.layout) return print_with(answer, *answer.layout, {{"exit", exit}});
  print_with(answer, failure_layout, {{"verb", verb.empty() ? Json() : Json(verb)}, {"exit", exit}});
}

void print_answer_now() {
  Answer& answer = the_answer();
  const std::scoped_lock lock(answer.mutex);
  print_with(answer, answer.layout.value_or(std::string(failure_layout)), {{"exit", nullptr}});
}

}  // namespace continuo::app
