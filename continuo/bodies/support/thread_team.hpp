// Parallel loops. No iteration reads or writes data that another iteration writes, so that the results are the same to
// the last bit for any number of threads.
//
// A step has hundreds of loops of some microseconds, too short to begin and end a parallel loop of the library for
// each. So the threads join once per step and take blocks of loop after loop from tickets, as in Box2D v3 (E. Catto,
// "Simulation Islands", 2023). Each thread has a ticket of its own, for the same part of every loop, so that data
// written in one loop is in its cache in the next. A thread that has done its part takes blocks from the tickets of
// others. So the caller can do every block alone, and no loop waits for a thread that never joins.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <thread>
#include <type_traits>
#include <utility>

#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

namespace continuo {

class ThreadTeam {
 public:
  /// At most so many threads, the caller's among them.
  explicit ThreadTeam(int threads)
      : threads_(static_cast<std::size_t>(std::max(threads, 1))), tickets_(std::make_unique<Ticket[]>(threads_)) {
    if (threads > 1) arena_ = std::make_unique<oneapi::tbb::task_arena>(threads);
  }
  [[nodiscard]] bool is_alone() const { return !arena_; }
  [[nodiscard]] std::size_t threads() const { return threads_; }

  /// Runs `act`, and distributes the loops within it among the threads.
  template <class Act>
  void run(Act&& act) {
    if (is_alone()) return act();
    arena_->execute([&] {
      oneapi::tbb::task_group helpers;
      is_open_.store(true, std::memory_order_release);
      for (std::size_t i = 1; i < threads_; ++i) helpers.run(Helper(*this, i));
      std::exception_ptr error;
      try {
        act();
      } catch (...) {
        error = std::current_exception();
      }
      is_open_.store(false, std::memory_order_release);
      helpers.wait();
      if (error) std::rethrow_exception(error);
    });
  }

  /// act(from, to) for parts of first ... last - 1 that are no shorter than `shortest`, which should be some
  /// microseconds of work.
  template <class Act>
  void for_each(std::size_t first, std::size_t last, std::size_t shortest, Act&& act) {
    if (first >= last) return;
    const std::size_t blocks =
        std::min((last - first) / std::max(shortest, std::size_t{1}), std::min<std::size_t>(4 * threads_, 0xffff));
    if (blocks < 2 || !is_open_.load(std::memory_order_relaxed)) return act(first, last);
    share(blocks, [&](std::size_t block) {
      act(first + (last - first) * block / blocks, first + (last - first) * (block + 1) / blocks);
    });
  }

  /// act(block) for 0 ... blocks - 1, at most 65535.
  template <class Act>
  void share(std::size_t blocks, Act&& act) {
    if (blocks < 2 || !is_open_.load(std::memory_order_relaxed)) {
      for (std::size_t block = 0; block < blocks; ++block) act(block);
      return;
    }
    using Plain = std::remove_reference_t<Act>;
    loop_ = {[](const void* context, std::size_t block) {
               (*const_cast<Plain*>(static_cast<const Plain*>(context)))(block);
             },
             std::addressof(act), blocks};
    done_.store(0, std::memory_order_relaxed);
    ++number_of_loop_;
    for (std::size_t i = 0; i < threads_; ++i)
      tickets_[i].store(number_of_loop_ << 32 | (loop_.blocks * (i + 1) / threads_) << 16 | loop_.blocks * i / threads_,
                        std::memory_order_release);
    do_blocks(0);
    for (int idle = 0; done_.load(std::memory_order_acquire) != loop_.blocks; ++idle) wait(idle);
    if (has_failed_.exchange(false)) std::rethrow_exception(std::exchange(error_, nullptr));
  }

 private:
  /// A thread's part of a loop, in one word: the number of the loop, the end of the blocks, and the next block.
  struct alignas(64) Ticket : std::atomic<std::uint64_t> {};
  struct Loop {
    void (*act)(const void* context, std::size_t block) = nullptr;
    const void* context = nullptr;
    std::size_t blocks = 0;
  };

  /// A task that is passed to another thread in a way that is visible to the thread sanitizer, which does not see the
  /// synchronization within the library.
  class Helper {
   public:
    Helper(ThreadTeam& team, std::size_t number) : number_(number) { team_.store(&team, std::memory_order_release); }
    Helper(const Helper& other) : Helper(*other.team_.load(std::memory_order_relaxed), other.number_) {}
    void operator()() const { team_.load(std::memory_order_acquire)->help(number_); }

   private:
    std::size_t number_;
    std::atomic<ThreadTeam*> team_;
  };

  /// Waits for loops by reading its own ticket alone: others would have to share theirs while they take blocks.
  void help(std::size_t number) {
    std::uint64_t last_loop = 0;
    for (int idle = 0; is_open_.load(std::memory_order_acquire); ++idle) {
      const std::uint64_t loop = tickets_[number].load(std::memory_order_acquire) >> 32;
      if (loop == last_loop) {
        wait(idle);
        continue;
      }
      last_loop = loop, idle = 0;
      do_blocks(number);
    }
  }
  /// Does the blocks of the present loop that are left, from the thread's own part and then those of others. A loop
  /// cannot end before a thread has counted the blocks that it has taken, so that all are of the same loop; they are
  /// counted together, as the counter is shared.
  void do_blocks(std::size_t thread) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < threads_; ++i)
      while (do_block_of(tickets_[(thread + i) % threads_])) ++count;
    if (count > 0) done_.fetch_add(count, std::memory_order_release);
  }
  /// Does the next block of a part; false where none is left. The ticket contains the number of its loop, so that an
  /// old ticket is invalid.
  [[nodiscard]] bool do_block_of(Ticket& of_part) {
    std::uint64_t ticket = of_part.load(std::memory_order_acquire);
    std::uint64_t next;
    do {
      next = ticket & 0xffff;
      if (next >= (ticket >> 16 & 0xffff)) return false;
    } while (!of_part.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel, std::memory_order_acquire));
    try {
      loop_.act(loop_.context, next);
    } catch (...) {
      if (!has_failed_.exchange(true)) error_ = std::current_exception();
    }
    return true;
  }
  /// A loop ends within microseconds; where there are more threads than processors, another needs this one.
  static void wait(int idle) {
    if (idle > 200) std::this_thread::yield();
  }

  std::size_t threads_;
  std::unique_ptr<oneapi::tbb::task_arena> arena_;
  Loop loop_;
  std::uint64_t number_of_loop_ = 0;
  std::unique_ptr<Ticket[]> tickets_;
  alignas(64) std::atomic<std::size_t> done_ = 0;
  std::atomic<bool> is_open_ = false, has_failed_ = false;
  std::exception_ptr error_;
};

}  // namespace continuo
