// Output to the terminal: messages, failures, colours.
#include <cstdio>
#include <cstdlib>

#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace continuo::app {

void say(std::string_view message) {
  fmt::print(stderr, "continuo: {}\n", message);
  record_message({{"severity", "error"}, {"message", message}});
}

void mention(std::string_view message) {
  fmt::print(stderr, "continuo: {}\n", message);
  record_message({{"severity", "note"}, {"message", message}});
}

bool written(const Status& status) {
  if (!status) say(status.message);
  return static_cast<bool>(status);
}

void print(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);  // in order with the messages
}

bool all_printed() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return true;
  say("standard output could not be written completely");
  return false;
}

bool colors_wanted() {
  const char* no_color = std::getenv("NO_COLOR");
  return watched() && (no_color == nullptr || *no_color == '\0');
}

bool watched() {
  return isatty(STDERR_FILENO) == 1;
}

}  // namespace continuo::app
