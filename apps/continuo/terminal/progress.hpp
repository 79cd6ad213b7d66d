// How far a long run or study is, and the time that is left: one line on a terminal only, gone when it ends.
//
//   Progress progress;
//   experiment.progress = progress.over(0, 20);   // t = 3.1, 16 %, 4 s left
#pragma once
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace continuo::app {

class Progress {
 public:
  Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  // What runs and studies call; each is empty where nobody watches.

  /// With the part that is done, 0 to 1; of the whole that is `share`, after `begin`.
  std::function<void(double part)> parts(double begin = 0, double share = 1);
  /// With a time on the way from one to another.
  std::function<void(double t)> over(double from, double to);
  /// With a number that says nothing of the end.
  std::function<void(double number)> number(std::string_view of);

 private:
  using Clock = std::chrono::steady_clock;
  void show(const std::string& text, std::optional<double> part);

  Clock::time_point begin_, next_;
  double part_ = 0;
  bool shown_ = false;
};

}  // namespace continuo::app
