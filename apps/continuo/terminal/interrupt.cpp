// The handler of SIGINT and SIGTERM.
#include <csignal>
#include <cstdint>
#include <ctime>

#include <apps/continuo/terminal/interrupt.hpp>

namespace continuo::app {
namespace {

// A signal handler reaches nothing but what lives outside of functions.
std::atomic<bool> interrupted_once{false};
std::atomic<std::int64_t> first_signal{0};  // when, in milliseconds
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

std::int64_t milliseconds_now() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000 + 1;  // never 0
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
  std::signal(number, SIG_DFL);
  std::raise(number);
}

}  // namespace

const std::atomic<bool>& interrupt_flag() {
  struct sigaction action{};
  action.sa_handler = note;
  action.sa_flags = static_cast<int>(SA_RESTART);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  return interrupted_once;
}

}  // namespace continuo::app
