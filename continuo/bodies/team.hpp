// Loops whose turns may run at once. What a turn writes no other turn reads or writes, so the results are the same to
// the last bit for any number of threads.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

namespace continuo {

class Team {
 public:
  /// At most so many threads, the caller's among them.
  explicit Team(int threads) {
    if (threads > 1) arena_ = std::make_unique<oneapi::tbb::task_arena>(threads);
  }
  bool is_alone() const { return !arena_; }

  /// Loops within `act` are shared out.
  template <class Act>
  void run(Act&& act) {
    if (is_alone()) {
      act();
    } else {
      arena_->execute([&] { act(); });
    }
  }

  /// act(from, to) for parts of first ... last - 1 that are no shorter than `shortest`, which should be some
  /// microseconds of work. Each thread has the same part every time: what it needs is in its cache.
  template <class Act>
  void for_each(std::size_t first, std::size_t last, std::size_t shortest, Act&& act) {
    if (is_alone() || last - first < 2 * shortest) {
      if (first < last) act(first, last);
      return;
    }
    // The library orders these accesses too, but not where a sanitizer sees it.
    turns_.fetch_add(1, std::memory_order_release);
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<std::size_t>(first, last, shortest),
        [&](const oneapi::tbb::blocked_range<std::size_t>& part) {
          (void)turns_.load(std::memory_order_acquire);
          act(part.begin(), part.end());
          turns_.fetch_add(1, std::memory_order_release);
        },
        oneapi::tbb::static_partitioner{});
    (void)turns_.load(std::memory_order_acquire);
  }

 private:
  std::unique_ptr<oneapi::tbb::task_arena> arena_;
  std::atomic<std::size_t> turns_ = 0;
};

}  // namespace continuo
