#include <csignal>

#include <apps/continuo/interrupt.hpp>

namespace continuo::app {
namespace {

// A signal handler reaches nothing but what lives outside of functions.
std::atomic<bool> interrupted_once{false};
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

const std::atomic<bool>& interrupt_flag() {
  struct sigaction action{};
  action.sa_handler = [](int) { interrupted_once.store(true); };
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);  // the next one has its ordinary effect
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  return interrupted_once;
}

}  // namespace continuo::app
