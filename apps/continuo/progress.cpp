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

std::function<void(double)> Progress::watcher() {
  if (!watched()) return {};
  return [this](double t) { show(t); };
}

void Progress::show(double t) {
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + pause;
  shown_ = true;
  fmt::print(stderr, "\r\033[Kt = {:.6g}", t);
  std::fflush(stderr);
}

}  // namespace continuo::app
