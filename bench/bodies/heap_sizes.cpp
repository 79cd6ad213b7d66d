// What a step of the fast motion costs where balls are of two sizes: heaps that fall into a box, by the processor's
// time.
//   heap_sizes [BALLS] [STEPS]
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include <bench/bodies/scenes.hpp>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::bench {
namespace {

template <class Real>
void print(const char* scalar, int balls, int steps, double part, int times) {
  World<Real, 3> world = world_of<Real>(heap_of_two_sizes(balls, part, times));
  FastMotion<Real, 3> motion(world);
  std::size_t contacts = 0;
  const std::clock_t begin = std::clock();
  for (int i = 0; i < steps; ++i) {
    require(motion.advance());
    contacts += motion.statistics().contacts;
  }
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  std::printf("| %g %% | %d | %s | %.2f ms | %.0f ns | %.2f | %.2f |\n", 100 * part, times, scalar,
              1e3 * seconds / steps, 1e9 * seconds / static_cast<double>(std::max<std::size_t>(contacts, 1)),
              static_cast<double>(contacts) / steps / balls, static_cast<double>(motion.statistics().lists) / steps);
  std::fflush(stdout);
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  struct Case {
    double part;
    int times;
  };
  const int balls = count > 1 ? std::max(100, std::atoi(arguments[1])) : 10000;
  const int steps = count > 2 ? std::max(1, std::atoi(arguments[2])) : 600;
  std::puts(
      "| Large | Times as large | Scalar | A step | A contact | Contacts of a ball | Lists of pairs a step "
      "|\n|---|---|---|---|---|---|---|");
  for (const auto& [part, times] :
       {Case{0, 1}, Case{0.01, 5}, Case{0.01, 15}, Case{0.1, 5}, Case{0.1, 15}, Case{0.45, 5}, Case{0.45, 15}}) {
    continuo::bench::print<float>("float", balls, steps, part, times);
    continuo::bench::print<double>("double", balls, steps, part, times);
  }
}
