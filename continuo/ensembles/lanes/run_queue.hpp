// The list of runs that the threads of an ensemble work off, and the delivery of their results.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <continuo/ensembles/ensemble_options.hpp>

namespace continuo::detail {

/// Gives out the numbers of the runs, and takes their results. Every function may be called by several threads at once.
template <State X, State P>
class RunQueue {
 public:
  using Result = RunResult<X, P>;

  /// The results go to options.finished, or where there is none to `kept`.
  RunQueue(std::size_t count, const EnsembleOptions<X, P>& options, std::vector<Result>& kept)
      : count_(count), options_(options), kept_(kept) {
    if (options.finished) {
      waiting_.resize(std::min(count, window));
    } else {
      kept_.resize(count);
    }
  }

  /// The number of the next run; none where all have been given out, or the ensemble is to end.
  [[nodiscard]] std::optional<std::size_t> take() {
    if (stopped()) return std::nullopt;
    const std::size_t run = next_.fetch_add(1, std::memory_order_relaxed);
    return run < count_ ? std::optional<std::size_t>(run) : std::nullopt;
  }

  /// Whether run number `run` may begin. Results are delivered in order; one long run must not let the results of all
  /// others pile up behind it.
  [[nodiscard]] bool has_room_for(std::size_t run) const {
    return !options_.finished || run < delivered_.load(std::memory_order_acquire) + window;
  }
  /// Waits until it may, or the ensemble is to end.
  void wait_for_room(std::size_t run) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return stopped() || has_room_for(run); });
  }

  /// Takes a result.
  void put(Result&& result) {
    const std::size_t run = result.run;
    if (!options_.finished) {
      kept_[run] = std::move(result);
      return;
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    std::size_t next = delivered_.load(std::memory_order_relaxed);
    if (run == next) {
      deliver(result);
      ++next;
    } else {
      waiting_[run % waiting_.size()] = std::move(result);
    }
    for (; next < count_ && waiting_[next % waiting_.size()]; ++next) {
      deliver(*waiting_[next % waiting_.size()]);
      waiting_[next % waiting_.size()].reset();
    }
    delivered_.store(next, std::memory_order_release);
    changed_.notify_all();
  }

  /// No further run begins: a function of the user has thrown.
  void stop() {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }
  [[nodiscard]] bool interrupted() const {
    return options_.interrupt && options_.interrupt->load(std::memory_order_relaxed);
  }
  [[nodiscard]] bool stopped() const { return stopped_.load(std::memory_order_relaxed) || interrupted(); }
  /// The runs from here on have never begun.
  [[nodiscard]] std::size_t begun() const { return std::min(count_, next_.load()); }
  [[nodiscard]] bool complete() const { return !stopped_ && next_.load() >= count_; }

 private:
  void deliver(const Result& result) {
    if (!stopped_ && !options_.finished(result)) stopped_ = true;
  }

  static constexpr std::size_t window = 4096;  // runs

  std::size_t count_;
  const EnsembleOptions<X, P>& options_;
  std::vector<Result>& kept_;
  std::vector<std::optional<Result>> waiting_;  // for the results of runs with lower numbers
  std::atomic<std::size_t> next_ = 0, delivered_ = 0;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
};

}  // namespace continuo::detail
