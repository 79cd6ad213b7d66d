// apps/continuo/progress.hpp
// How far a long run is, on a terminal only: one line that is gone when the run ends.
#pragma once
#include <chrono>
#include <functional>
#include <string_view>

namespace continuo::app {

class Progress {
 public:
  Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// What a run calls with its time (or what `of` names); empty where nobody watches.
  std::function<void(double)> watcher(std::string_view of = "t");

 private:
  using Clock = std::chrono::steady_clock;
  void show(std::string_view of, double t);

  Clock::time_point next_;
  bool shown_ = false;
};

}  // namespace continuo::app
