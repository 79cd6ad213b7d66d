// How far a long study is, and the time that is left: one line on a terminal only, gone when the study ends.
#pragma once
#include <chrono>
#include <functional>

namespace continuo::app {

class StudyProgress {
 public:
  StudyProgress();
  StudyProgress(const StudyProgress&) = delete;
  StudyProgress& operator=(const StudyProgress&) = delete;
  ~StudyProgress();

  /// What a study calls with the part that is done, 0 to 1; empty where nobody watches.
  std::function<void(double)> watcher();

 private:
  using Clock = std::chrono::steady_clock;
  void show(double part);

  Clock::time_point begin_, next_;
  bool shown_ = false;
};

}  // namespace continuo::app
