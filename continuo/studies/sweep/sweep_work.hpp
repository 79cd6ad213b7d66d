// The runs of a sweep made chunk by chunk on several threads. Which thread makes a chunk, and when, changes nothing.
//
//   SweepWork work{.chunks = folder.missing(), .threads = 8};
//   work.on_chunk = [&](std::uint64_t chunk, std::vector<SweepOutcome> made) { return folder.write(chunk, made); };
//   const Status status = run_chunks(sweep, folder.identity(), work);
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <continuo/studies/sweep/sweep_chunks.hpp>
#include <continuo/studies/sweep/sweep_run.hpp>

namespace continuo::studies {

/// What is to be done, and who gets it.
struct SweepWork {
  std::vector<std::uint64_t> chunks;  // in rising order
  std::size_t threads = 1;
  bool in_order = false;  // on_chunk is called in the order of `chunks`; else as they come
  bool at_once = false;   // on_chunk may be called by several threads at the same time; not with `in_order`
  const std::atomic<bool>* interrupt = nullptr;
  /// Gets every chunk, one after the other where not `at_once`. After a failure no more are begun.
  std::function<Status(std::uint64_t chunk, std::vector<SweepOutcome> outcomes)> on_chunk{};
  /// The next place in `chunks` that nobody has taken, or one behind the last, where other processes take from the same
  /// list; without it all are made here. Not with `in_order`.
  std::function<std::uint64_t()> take{};
  std::function<void(std::uint64_t runs)> progress{};  // how many runs have ended; one call at a time
};

/// Makes the chunks. The failure of `on_chunk`; Ending::interrupted where not all that were to be taken were made.
Status run_chunks(const PreparedSweep& sweep, const SweepIdentity& identity, const SweepWork& work);

/// The chunks of part `part` of `parts`, counted from 1: consecutive ones, as equal in number as can be.
[[nodiscard]] std::vector<std::uint64_t> chunks_of_part(const SweepIdentity& identity, std::uint64_t part,
                                                        std::uint64_t parts);

}  // namespace continuo::studies
