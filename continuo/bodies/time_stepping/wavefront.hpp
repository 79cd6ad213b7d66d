// Several sweeps over a row of blocks, each of which interacts only with its neighbours. A block goes through as many
// sweeps as possible while it is in the cache, like stencil computations with skewed time (M. Wolfe, "Loop skewing: the
// wavefront method revisited", 1986).
//
// A sweep acts within each block, and then across the end of each block, on this block and the next one. Within block
// b, the next sweep has to wait only for the actions across both ends of b. So at turn t one thread executes sweep i
// within block t - i and across the end of block t - i - 1, for rising i. Several threads do the same, each with a
// chunk of the blocks. The range that a thread can do alone ends one block farther from the other chunks with every
// sweep; the blocks that this leaves over follow at the end, sweep by sweep. The actions on a block have the same order
// for any number of threads.
#pragma once
#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <continuo/bodies/support/thread_team.hpp>

namespace continuo {

struct Sweep {
  std::function<void(std::size_t)> within{};  // a block
  std::function<void(std::size_t)> across{};  // the end of a block; none where nothing is to be done there
  std::function<void()> rest{};               // actions on blocks farther apart, after all others; usually none
};

namespace detail {

struct BlockRange {
  std::size_t first = 0, last = 0;  // last is excluded

  [[nodiscard]] bool has(std::size_t block) const { return first <= block && block < last; }
};

/// The blocks of a chunk that a sweep can do without the other chunks, within blocks or across their ends.
[[nodiscard]] inline BlockRange alone(const BlockRange& chunk, std::size_t blocks, std::size_t sweep, bool is_across) {
  const std::size_t first = chunk.first == 0 ? 0 : chunk.first + sweep;
  const std::size_t less = chunk.last == blocks ? 0 : sweep + (is_across ? 1 : 0);
  return {first, chunk.last > less ? chunk.last - less : 0};
}

inline void run_chunk(const BlockRange& chunk, std::size_t blocks, std::span<const Sweep> sweeps) {
  const auto act = [&](const auto& function, std::size_t i, bool is_across, std::size_t turn) {
    const std::size_t behind = i + (is_across ? 1 : 0);
    if (turn < behind || !function) return;
    if (alone(chunk, blocks, i, is_across).has(turn - behind)) function(turn - behind);
  };
  for (std::size_t turn = chunk.first; turn < chunk.last + sweeps.size(); ++turn)
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
      act(sweeps[i].within, i, false, turn);
      act(sweeps[i].across, i, true, turn);
    }
}

}  // namespace detail

/// Runs the sweeps, with the result as if each went over all blocks before the next begins.
inline void run_sweeps(ThreadTeam& team, std::size_t blocks, std::span<const Sweep> sweeps) {
  if (sweeps.size() > 1 && std::ranges::any_of(sweeps, [](const Sweep& sweep) { return bool(sweep.rest); })) {
    for (const Sweep& sweep : sweeps) {
      run_sweeps(team, blocks, {&sweep, 1});
      if (sweep.rest) sweep.rest();
    }
    return;
  }
  const std::size_t chunks = std::min(team.threads(), blocks);
  const auto chunk = [&](std::size_t i) { return detail::BlockRange{blocks * i / chunks, blocks * (i + 1) / chunks}; };
  team.share(chunks, [&](std::size_t i) { detail::run_chunk(chunk(i), blocks, sweeps); });
  if (chunks == 1) return;
  std::vector<std::size_t> left;
  const auto act_on_left = [&](const auto& function, std::size_t sweep, bool is_across) {
    if (!function) return;
    left.clear();
    for (std::size_t i = 0; i < chunks; ++i)
      for (std::size_t block = chunk(i).first; block < chunk(i).last; ++block)
        if (!detail::alone(chunk(i), blocks, sweep, is_across).has(block)) left.push_back(block);
    team.share(left.size(), [&](std::size_t i) { function(left[i]); });
  };
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    act_on_left(sweeps[i].within, i, false);
    act_on_left(sweeps[i].across, i, true);
  }
}

}  // namespace continuo
