// The line of progress and its timing.
#include <cstdio>

#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/results/summary.hpp>

namespace continuo::app {
namespace {
using namespace std::chrono_literals;
constexpr auto patience = 500ms;  // what is shorter shows nothing
constexpr auto pause = 100ms;
}  // namespace

Progress::Progress() : begin_(Clock::now()), next_(begin_ + patience) {}

Progress::~Progress() {
  if (shown_) fmt::print(stderr, "\r\033[K");
}

std::function<void(double)> Progress::parts(double begin, double share) {
  if (!watched()) return {};
  return [this, begin, share](double part) { show("", begin + share * part); };
}
std::function<void(double)> Progress::over(double from, double to) {
  if (!watched()) return {};
  return [this, from, to](double t) { show(fmt::format("t = {:.6g}", t), (t - from) / (to - from)); };
}
std::function<void(double)> Progress::number(std::string_view of) {
  if (!watched()) return {};
  return [this, of](double value) { show(fmt::format("{} = {:.6g}", of, value), std::nullopt); };
}

void Progress::show(const std::string& text, std::optional<double> part) {
  const auto now = Clock::now();
  if (part && *part < part_) begin_ = now;  // it began anew, with a second run
  if (part) part_ = *part;
  if (now < next_) return;
  next_ = now + pause;
  std::string line = text;
  if (part && *part > 0 && *part <= 1) {
    const double spent = std::chrono::duration<double>(now - begin_).count();
    line += fmt::format("{}{:.0f} %, {} left", text.empty() ? "" : ", ", 100 * *part,
                        results::duration(spent * (1 - *part) / *part));
  }
  if (line.empty()) return;
  shown_ = true;
  fmt::print(stderr, "\r\033[K{}", line);
  std::fflush(stderr);
}

}  // namespace continuo::app
