// Counts what a tape does for several runs at once, and holds its machine code.
#include <utility>

#include <continuo/symbolic/native/lane_code.hpp>

namespace continuo::model {

void LaneCode::count_use(std::uint64_t operations) {
  std::uint64_t wanted = wanted_.load(std::memory_order_acquire);
  if (wanted == 0) return;
  const std::uint64_t done = operations_.fetch_add(operations, std::memory_order_relaxed) + operations;
  // Of threads that come here at once, one notifies.
  if (done < wanted || !wanted_.compare_exchange_strong(wanted, 0)) return;
  wanted_.store(notify_(done), std::memory_order_release);
}

void LaneCode::use(NativeEvaluation evaluation, std::shared_ptr<const void> code) {
  const std::lock_guard lock(mutex_);
  if (code_) return;
  code_ = std::move(code);
  function_.store(evaluation, std::memory_order_release);
}

}  // namespace continuo::model
