// Sweeps over blocks in a wavefront change each block as consecutive sweeps do.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/time_stepping/wavefront.hpp>

namespace continuo::wavefront_test {
namespace {

/// Of each block two halves, of which an act across the end of a block touches the second and the first of the next.
/// Each act mixes its name into both halves that it touches, and each half into the other: any other order of two acts
/// on a half gives another number.
struct Trace {
  std::vector<std::uint64_t> halves;

  explicit Trace(std::size_t blocks) : halves(2 * blocks, 1) {}
  void mix(std::size_t a, std::size_t b, std::uint64_t name) {
    const std::uint64_t both = 0x100000001b3 * (halves[a] + 3 * halves[b] + name);
    halves[a] ^= both;
    halves[b] += both;
  }
  void within(std::size_t block, std::uint64_t name) { mix(2 * block, 2 * block + 1, name); }
  void across(std::size_t block, std::uint64_t name) {
    if (2 * block + 2 < halves.size()) mix(2 * block + 1, 2 * block + 2, name);
  }
};

std::vector<Sweep> sweeps_of(Trace& trace, std::size_t count, bool has_rest) {
  std::vector<Sweep> sweeps;
  for (std::size_t i = 0; i < count; ++i) {
    Sweep& sweep = sweeps.emplace_back();
    sweep.within = [&trace, i](std::size_t block) { trace.within(block, 2 * i + 1); };
    if (i + 1 < count) sweep.across = [&trace, i](std::size_t block) { trace.across(block, 2 * i + 2); };
    if (has_rest && i == 1) sweep.rest = [&trace] { trace.mix(0, trace.halves.size() - 1, 99); };
  }
  return sweeps;
}
Trace one_after_another(std::size_t blocks, std::size_t count, bool has_rest) {
  Trace trace(blocks);
  for (const Sweep& sweep : sweeps_of(trace, count, has_rest)) {
    for (std::size_t block = 0; block < blocks; ++block) sweep.within(block);
    for (std::size_t block = 0; block < blocks && sweep.across; ++block) sweep.across(block);
    if (sweep.rest) sweep.rest();
  }
  return trace;
}

TEST(Wavefront, ActsOnEachBlockAsSweepsOneAfterAnother) {
  for (const int threads : {1, 2, 3, 7})
    for (const std::size_t blocks : {1u, 2u, 3u, 5u, 12u, 40u})
      for (const std::size_t count : {1u, 2u, 4u, 6u})
        for (const bool has_rest : {false, true}) {
          Trace trace(blocks);
          const std::vector<Sweep> sweeps = sweeps_of(trace, count, has_rest);
          ThreadTeam team(threads);
          team.run([&] { run_sweeps(team, blocks, sweeps); });
          EXPECT_EQ(trace.halves, one_after_another(blocks, count, has_rest).halves)
              << threads << " threads, " << blocks << " blocks, " << count << " sweeps";
        }
}

// Skewing is for the cache: between two acts of one thread on a block come acts on no more blocks than there are
// sweeps.
TEST(Wavefront, StaysWithinAsManyBlocksAsThereAreSweeps) {
  const std::size_t blocks = 50, count = 4;
  std::vector<std::size_t> acts;
  std::vector<Sweep> sweeps(count);
  for (Sweep& sweep : sweeps) sweep.within = sweep.across = [&](std::size_t block) { acts.push_back(block); };
  ThreadTeam team(1);
  run_sweeps(team, blocks, sweeps);
  ASSERT_EQ(acts.size(), 2 * blocks * count);
  std::size_t newest = 0;
  for (const std::size_t block : acts) {
    newest = std::max(newest, block);
    EXPECT_LE(newest - block, count);
  }
}

}  // namespace
}  // namespace continuo::wavefront_test
