// A function that becomes machine code once that pays, for those who compute the same otherwise until then.
//
//   const auto function = native.function(key, [] { return text; });   // see NativeCompiler
//   if (void* const code = function->code()) ... else { ...; function->count(operations); }
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

namespace continuo::model {

class NativeFunction {
 public:
  /// Called by who counts, when that many operations are done, and again after as many as it returns; 0: not again.
  using Notify = std::function<std::uint64_t(std::uint64_t operations)>;

  /// The function, to be cast to its type; null as long as there is none.
  [[nodiscard]] void* code() const { return function_.load(std::memory_order_acquire); }
  /// Only the first one counts. `code` keeps it loaded.
  void use(void* function, std::shared_ptr<const void> code) {
    const std::lock_guard lock(mutex_);
    if (code_) return;
    code_ = std::move(code);
    function_.store(function, std::memory_order_release);
  }
  /// To be set before threads share it: `notify` is called first after so many operations.
  void notify_of_use(std::uint64_t operations, Notify notify) {
    notify_ = std::move(notify);
    wanted_.store(operations, std::memory_order_release);
  }
  /// Who computes the same otherwise says how much.
  void count(std::uint64_t operations) {
    std::uint64_t wanted = wanted_.load(std::memory_order_acquire);
    if (wanted == 0) return;
    const std::uint64_t done = operations_.fetch_add(operations, std::memory_order_relaxed) + operations;
    // Of threads that come here at once, one notifies.
    if (done >= wanted && wanted_.compare_exchange_strong(wanted, 0))
      wanted_.store(notify_(done), std::memory_order_release);
  }

 private:
  std::atomic<void*> function_ = nullptr;
  std::shared_ptr<const void> code_;
  std::atomic<std::uint64_t> operations_ = 0, wanted_ = 0;  // done so far; when to notify, 0 never
  Notify notify_;
  std::mutex mutex_;
};

}  // namespace continuo::model
