// A scene moved exactly and by the fast motion in steps of 1/60 s: how far the fast one is off, and what both cost.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>

#include <bench/processor_time.hpp>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::bench {

[[nodiscard]] inline double processor_milliseconds() {
  return 1e3 * processor_seconds();
}

inline void print_head_of_comparison() {
  std::puts("| Scene | Energy | Momentum | Mean position | Time, exact | Time, fast |\n|---|---|---|---|---|---|");
}

/// Sizes that differences are parts of: mechanical energy above the floor z = 0 and the sum of |m v|, both at most; at
/// rest, the momentum of 1e-6 lengths per time.
template <int Dim>
struct Sizes {
  double energy = 0, momentum = 0;
  void see(const World<double, Dim>& world) {
    double sum = 0;
    for (std::size_t i = 0; i < world.size(); ++i)
      if (!world.is_fixed(i)) sum += world.mass[i] * std::max(length(world.velocity[i]), 1e-6);
    energy = std::max(energy, std::abs(kinetic_energy(world)) + std::abs(potential_energy(world)));
    momentum = std::max(momentum, sum);
  }
};

template <int Dim>
[[nodiscard]] Vector<double, Dim> mean_position(const World<double, Dim>& world) {
  Vector<double, Dim> sum;
  double moving = 0;
  for (std::size_t i = 0; i < world.size(); ++i)
    if (!world.is_fixed(i)) sum += world.position[i], ++moving;
  return sum * (1 / moving);
}

/// Prints a row: differences of energy and momentum as parts of the greatest in the scene, that of the mean position,
/// and the processor's time.
template <int Dim>
void compare(const char* name, const World<double, Dim>& start, double duration) {
  World<double, Dim> exact = start, fast = start;
  Sizes<Dim> sizes;
  sizes.see(start);
  double begin = processor_milliseconds();
  ExactMotion<double, Dim> exact_motion(exact, {.most_events = 2'000'000});
  const Status status = exact_motion.advance_to(duration);
  const double exact_time = processor_milliseconds() - begin;
  if (!status) {
    std::printf("| %s | the exact motion: %s |\n", name, status.message.c_str());
    return;
  }
  begin = processor_milliseconds();
  double seen = 0;  // what looking costs
  FastMotion<double, Dim> motion(fast);
  for (int i = 0; i < std::lround(duration * 60); ++i) {
    if (const Status step = motion.advance(); !step) std::printf("%s: %s\n", name, step.message.c_str());
    const double before = processor_milliseconds();
    sizes.see(fast);
    seen += processor_milliseconds() - before;
  }
  const double fast_time = processor_milliseconds() - begin - seen;
  const auto energy = [](const auto& world) { return kinetic_energy(world) + potential_energy(world); };
  std::printf("| %s | %.1e | %.1e | %.1e | %.2f ms | %.2f ms |\n", name, (energy(fast) - energy(exact)) / sizes.energy,
              length(momentum(fast) - momentum(exact)) / sizes.momentum,
              length(mean_position(fast) - mean_position(exact)), exact_time, fast_time);
  std::fflush(stdout);
}

}  // namespace continuo::bench
