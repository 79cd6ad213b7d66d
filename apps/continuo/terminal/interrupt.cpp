// The handler of SIGINT and SIGTERM.
#include <csignal>
#include <cstdint>
#include <ctime>

#include <apps/continuo/terminal/exit_codes.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <unistd.h>

namespace continuo::app {
namespace {

// A signal handler reaches nothing but what lives outside of functions.
std::atomic<bool> interrupted_once{false};
std::atomic<const std::string*> last_words{nullptr};
std::atomic<std::int64_t> first_signal{0};  // when, in milliseconds
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

std::int64_t milliseconds_now() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000 + 1;  // never 0
}

/// Ends the process, by what a signal handler may call.
void end_by(int number) {
  if (const std::string* text = last_words.exchange(nullptr)) {
    for (std::size_t at = 0; at < text->size();) {
      const ssize_t written = ::write(STDOUT_FILENO, text->data() + at, text->size() - at);
      if (written <= 0) break;
      at += static_cast<std::size_t>(written);
    }
    ::_exit(interrupted);
  }
  std::signal(number, SIG_DFL);
  std::raise(number);
}

/// A second signal ends the process at once. But `timeout`, and shells, send one to the process and another to its
/// group: what follows within half a second is the same wish.
void note(int number) {
  constexpr std::int64_t same_wish = 500;
  const std::int64_t now = milliseconds_now();
  std::int64_t first = 0;
  if (first_signal.compare_exchange_strong(first, now) || now - first < same_wish) {
    interrupted_once.store(true);
    return;
  }
  end_by(number);
}

void handle_by(void (*handler)(int)) {
  struct sigaction action{};
  action.sa_handler = handler;
  action.sa_flags = static_cast<int>(SA_RESTART);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

void answer_interrupt_with(const std::string& text) {
  last_words.store(nullptr);
  if (text.empty()) return;
  static const std::string kept = text;  // until the end, for the handler
  last_words.store(&kept);
  handle_by(end_by);
}

const std::atomic<bool>& interrupt_flag() {
  handle_by(note);
  return interrupted_once;
}

}  // namespace continuo::app
