// Times of the same scene in two systems, in turn.
#pragma once
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <ctime>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::bench {

/// Seconds that the work of all threads takes, of a process that does nothing else.
[[nodiscard]] inline double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}
/// Seconds that pass.
[[nodiscard]] inline double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

inline void print_head(const char* peer, int threads) {
  std::printf(
      "%d threads; ms a step: of %s where one thread moves it, that of the processor, else what passes; in steps of "
      "1/60 s\n| Scene | Continuo | %s | Ratio | Overlap | of %s | Speed at the end | of %s "
      "|\n|---|---|---|---|---|---|---|---|\n",
      threads, "both", peer, peer, peer);
}

/// The mean of all squares.
template <int Dim>
[[nodiscard]] double mean_square_speed(const World<float, Dim>& world) {
  double sum = 0;
  for (const Vector<float, Dim>& v : world.velocity) sum += static_cast<double>(squared(v));
  return sum / static_cast<double>(world.size());
}

/// Moves a world and what `make` makes of the peer's for so many steps, in turn, and prints their times, the deepest
/// overlap at the end of each fiftieth part, and the root of the mean square of speeds at the end.
template <int Dim, class Peer, class Make>
void compare(const char* name, World<float, Dim> world, Make&& make, int steps, FastOptions<float> options) {
  const int threads = options.threads;
  FastMotion<float, Dim> motion(world, options);
  Peer peer(threads);
  make(peer);
  const auto now = [&] { return threads == 1 ? processor_seconds() : wall_seconds(); };
  require(motion.advance());  // the first step builds lists
  peer.advance();
  double ours = 0, theirs = 0, overlap = 0, peers_overlap = 0;
  const int turn = std::max(1, steps / 50);
  for (int k = 1; k < steps; k += turn) {
    const int count = std::min(turn, steps - k);
    const double begin = now();
    for (int i = 0; i < count; ++i) require(motion.advance());
    const double middle = now();
    for (int i = 0; i < count; ++i) peer.advance();
    theirs += now() - middle, ours += middle - begin;
    overlap = std::max(overlap, static_cast<double>(motion.deepest_overlap()));
    peers_overlap = std::max(peers_overlap, peer.overlap());
  }
  std::printf("| %s | %.3f | %.3f | %.3f | %.4f | %.4f | %.4f | %.4f |\n", name, 1e3 * ours / (steps - 1),
              1e3 * theirs / (steps - 1), ours / theirs, overlap, peers_overlap, std::sqrt(mean_square_speed(world)),
              std::sqrt(peer.mean_square_speed()));
  std::fflush(stdout);
}

}  // namespace continuo::bench
