#include <cstdio>

#include <apps/continuo/study_progress.hpp>
#include <apps/continuo/terminal.hpp>
#include <fmt/format.h>

#include <continuo/results/summary.hpp>

namespace continuo::app {
namespace {
using namespace std::chrono_literals;
constexpr auto patience = 500ms;  // shorter studies show nothing
constexpr auto pause = 100ms;
}  // namespace

StudyProgress::StudyProgress() : begin_(Clock::now()), next_(begin_ + patience) {}

StudyProgress::~StudyProgress() {
  if (shown_) fmt::print(stderr, "\r\033[K");
}

std::function<void(double)> StudyProgress::watcher() {
  if (!watched()) return {};
  return [this](double part) { show(part); };
}

void StudyProgress::show(double part) {
  const auto now = Clock::now();
  if (now < next_ || !(part > 0)) return;
  next_ = now + pause;
  shown_ = true;
  const double spent = std::chrono::duration<double>(now - begin_).count();
  fmt::print(stderr, "\r\033[K{:.0f} %, {} left", 100 * part, results::duration(spent * (1 - part) / part));
  std::fflush(stderr);
}

}  // namespace continuo::app
