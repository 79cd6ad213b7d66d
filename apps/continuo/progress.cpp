#include <cstdio>

#include <apps/continuo/progress.hpp>
#include <apps/continuo/terminal.hpp>
#include <fmt/format.h>

namespace continuo::app {
namespace {
using namespace std::chrono_literals;
constexpr auto patience = 500ms;  // shorter runs show nothing
constexpr auto pause = 100ms;
}  // namespace

Progress::Progress() : next_(Clock::now() + patience) {}

Progress::~Progress() {
  if (shown_) fmt::print(stderr, "\r\033[K");
}

std::function<void(double)> Progress::watcher(std::string_view of) {
  if (!watched()) return {};
  return [this, of](double t) { show(of, t); };
}

void Progress::show(std::string_view of, double t) {
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + pause;
  shown_ = true;
  fmt::print(stderr, "\r\033[K{} = {:.6g}", of, t);
  std::fflush(stderr);
}

}  // namespace continuo::app
