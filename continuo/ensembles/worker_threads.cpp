// The threads of an ensemble: an arena of oneTBB.
#include <algorithm>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <continuo/ensembles/worker_threads.hpp>

namespace continuo::detail {

void on_threads(int threads, std::size_t most, const std::function<void()>& work) {
  using oneapi::tbb::global_control;
  const std::size_t machine = global_control::active_value(global_control::max_allowed_parallelism);
  const std::size_t wanted = threads > 0 ? static_cast<std::size_t>(threads) : machine;
  const int count = static_cast<int>(std::min({wanted, machine, std::max<std::size_t>(most, 1)}));
  if (count == 1) return work();
  oneapi::tbb::task_arena arena(count);
  arena.execute([&] { oneapi::tbb::parallel_for(0, count, [&](int) { work(); }, oneapi::tbb::simple_partitioner()); });
}

}  // namespace continuo::detail
