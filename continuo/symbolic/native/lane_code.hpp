// The machine code of a tape for several runs at once: not there at first, and perhaps never. Shared by the threads
// that make runs; see NativeCompiler::lane_code.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>

#include <continuo/symbolic/tape/tape.hpp>

namespace continuo::model {

class LaneCode {
 public:
  /// What Tape::evaluate does, for TapeLanes; null as long as there is none. States and outputs need not be aligned.
  [[nodiscard]] NativeEvaluation function() const { return function_.load(std::memory_order_acquire); }
  /// Who evaluates the tape says so, now and then: so many operations, each on all lanes.
  void count_use(std::uint64_t operations);

 private:
  friend class NativeCompiler;
  void use(NativeEvaluation evaluation, std::shared_ptr<const void> code);

  std::atomic<NativeEvaluation> function_ = nullptr;
  std::shared_ptr<const void> code_;
  std::atomic<std::uint64_t> operations_ = 0, wanted_ = 0;  // done so far; when to notify, 0 never
  std::function<std::uint64_t(std::uint64_t)> notify_;
  std::mutex mutex_;
};

}  // namespace continuo::model
