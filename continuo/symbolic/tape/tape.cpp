// continuo/symbolic/tape/tape.cpp
// The evaluation for the usual numbers, compiled once. The compiler of tapes is in tape_compile.cpp.
#include <utility>

#include <continuo/symbolic/tape/tape_run.hpp>

namespace continuo::model {

template void Tape::prepare(std::span<float>) const;
template void Tape::prepare(std::span<double>) const;
template void Tape::prepare(std::span<long double>) const;
template void Tape::evaluate(std::span<double>, std::span<const double>, std::span<double>) const;
template void Tape::evaluate(std::span<double>, std::span<const double>, std::span<double>, const tape::Copies&) const;
template void Tape::evaluate(std::span<float>, std::span<float>) const;
template void Tape::evaluate(std::span<double>, std::span<double>) const;
template void Tape::evaluate(std::span<long double>, std::span<long double>) const;

void Tape::use_native(NativeEvaluation function, std::shared_ptr<const void> code) const {
  const std::lock_guard lock(native_->mutex);
  if (native_->code) return;
  native_->code = std::move(code);
  native_->function.store(function, std::memory_order_release);
}

void Tape::notify_of_use(std::uint64_t operations, std::function<std::uint64_t(std::uint64_t)> notify) const {
  native_->notify = std::move(notify);
  native_->wanted.store(operations, std::memory_order_release);
}

bool Tape::count_use(std::uint64_t operations) const {
  Native& native = *native_;
  std::uint64_t wanted = native.wanted.load(std::memory_order_acquire);
  if (wanted == 0) return false;
  const std::uint64_t done = native.operations.fetch_add(operations, std::memory_order_relaxed) + operations;
  // Of threads that come here at once, one notifies.
  if (done < wanted || !native.wanted.compare_exchange_strong(wanted, 0)) return true;
  wanted = native.notify(done);
  native.wanted.store(wanted, std::memory_order_release);
  return wanted != 0;
}

Tape::Size Tape::size() const {
  const auto count = [](const Program& program) {
    return program.instructions.empty() ? 0 : program.instructions.size() - 1;
  };
  Size size{.prepared = count(preparation_), .single = count(body_) - body_.batches.size()};
  size.batches = body_.batches.size();
  for (const tape::Batch& batch : body_.batches) size.batched += batch.count;
  size.gathered = body_.gathered.size();
  return size;
}

}  // namespace continuo::model
