// What a step of the fast motion costs with more balls and with more threads: the heap of against_bullet, by the clock
// on the wall.
//   heap_scaling [STEPS] [REPEATS]
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <string>
#include <thread>

#include <bench/bodies/scenes.hpp>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::bench {
namespace {

struct Cost {
  double wall = std::numeric_limits<double>::infinity(), processor = 0;  // milliseconds a step
};

template <class Real>
Cost cost_of(const Scene& scene, int steps, int threads) {
  World<Real, 3> world = world_of<Real>(scene);
  FastMotion<Real, 3> motion(world, {.threads = threads});
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t processor = std::clock();  // of all threads
  for (int i = 0; i < steps; ++i) require(motion.advance());
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  return {1e3 * wall.count() / steps, 1e3 * static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC / steps};
}

template <class Real>
void print(const char* scalar, int steps, int repeats) {
  const int most = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  double alone_ten = 0;
  for (const int count : {10000, 100000}) {
    const Scene scene = heap(count);
    double alone = 0;
    for (int threads = 1; threads <= most; threads *= 2) {
      Cost least;
      for (int i = 0; i < repeats; ++i) {
        const Cost cost = cost_of<Real>(scene, steps, threads);
        if (cost.wall < least.wall) least = cost;
      }
      if (threads == 1) alone = least.wall;
      if (threads == 1 && count == 10000) alone_ten = least.wall;
      std::printf("| %d | %s | %d | %.2f ms | %.2f ms | %.2f | %.1f |\n", count, scalar, threads, least.wall,
                  least.processor, alone / least.wall, least.wall / alone_ten);
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  const int steps = count > 1 ? std::max(1, std::atoi(arguments[1])) : 600;
  const int repeats = count > 2 ? std::max(1, std::atoi(arguments[2])) : 1;
  std::puts(
      "| Balls | Scalar | Threads | A step | Processor time | Times as fast as one thread | Times 10,000 by one "
      "|\n|---|---|---|---|---|---|---|");
  continuo::bench::print<float>("float", steps, repeats);
  continuo::bench::print<double>("double", steps, repeats);
}
