// The threads of an ensemble.
#pragma once
#include <cstddef>
#include <functional>

namespace continuo::detail {

/// Calls `work` on as many threads at once, at most `most` and no more than the machine (or oneTBB's global_control)
/// runs at once, which is what 0 threads stand for. Returns when all calls have; an exception of one is passed on.
void on_threads(int threads, std::size_t most, const std::function<void()>& work);

}  // namespace continuo::detail
