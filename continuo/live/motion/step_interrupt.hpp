// continuo/live/motion/step_interrupt.hpp
// A step that takes long, and who does not want to wait for it. A long step is computed by a thread of its own; once
// the interrupt is requested, nobody waits for it any more. It is told to end, which it does at its next attempt, and
// goes on until then without being in the way.
//
//   StepInterrupt interrupt;
//   auto track = make_track(program, plan, &interrupt);
//   track->advance(1);                              // in one thread
//   interrupt.request();                            // in another: advance returns false, was_interrupted() is true
#pragma once
#include <atomic>
#include <chrono>
#include <future>
#include <utility>
#include <vector>

namespace continuo::live {

class StepInterrupt {
 public:
  /// From any thread: what advances gives up, until `forget`.
  void request() { requested_.store(true); }
  void forget() { requested_.store(false); }
  [[nodiscard]] bool is_requested() const { return requested_.load(std::memory_order_relaxed); }

  /// Waits for a step. False: it was interrupted, and the step is still being computed.
  [[nodiscard]] bool wait_for(const std::future<bool>& step) const {
    constexpr auto moment = std::chrono::milliseconds(5);
    while (step.wait_for(moment) != std::future_status::ready)
      if (is_requested()) return false;
    return true;
  }

  /// Keeps a step that nobody needs any more until it has ended; at its own end it waits for all of them.
  void leave(std::future<bool> step) {
    std::erase_if(left_, [](const std::future<bool>& each) {
      return each.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    left_.push_back(std::move(step));
  }

 private:
  std::atomic<bool> requested_{false};
  std::vector<std::future<bool>> left_;  // of std::async, whose destructor waits
};

}  // namespace continuo::live
