// Heaps by the exact motion: balls dropped into a narrow box, and discs into a funnel, until they lie. What it costs,
// and what is left wrong: overlaps, and energy from nowhere.
//   exact_heaps [SECONDS]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include <bench/bodies/overlap.hpp>
#include <bench/bodies/scenes.hpp>
#include <bench/processor_time.hpp>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::bench {
namespace {

World<double, 3> boxful(int count, double edge, const Material<double>& material) {
  return world_of<double>(dropped(count, edge, static_cast<int>(edge / 1.1), 0.04, material));
}

/// Rows of a dozen discs above two slopes of 45 degrees.
World<double, 2> funnelful(int count, const Material<double>& material) {
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  for (const double side : {1.0, -1.0}) require(world.add_wall({.normal = {{side, 1}}, .material = material}));
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> jitter(-0.01, 0.01);
  for (int i = 0; i < count; ++i)
    require(world.add({.shape = Sphere<double>{0.2},
                       .position = {{-2.75 + 0.5 * (i % 12) + jitter(engine), 4 + 0.5 * (i / 12)}},
                       .material = material}));
  return world;
}

template <int Dim>
void measure(const char* scene, World<double, Dim> world, const Material<double>& material, double until) {
  ExactMotion motion(world);
  const auto energy = [&] { return kinetic_energy(world) + potential_energy(world); };
  double deepest = 0, rise = 0, seconds = 0, last = energy();
  constexpr int looks = 30;
  for (int k = 1; k <= looks; ++k) {
    const double begin = processor_seconds();
    if (const Status status = motion.advance_to(until * k / looks); !status)
      return void(std::puts(status.message.c_str()));
    seconds += processor_seconds() - begin;
    deepest = std::max(deepest, deepest_overlap(world));
    rise = std::max(rise, energy() / last - 1);
    last = energy();
  }
  std::printf("| %s | %zu | %g | %g | %.2f s | %.1e | %.1e | %.1e J |\n", scene, world.size(), material.restitution,
              material.friction, seconds, deepest, rise, kinetic_energy(world));
  std::fflush(stdout);
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  using namespace continuo::bench;
  const double until = count > 1 ? std::max(0.1, std::atof(arguments[1])) : 3;
  std::puts(
      "| Scene | Bodies | Restitution | Friction | Time | Deepest overlap | Greatest rise of the energy | Kinetic at "
      "last |");
  std::puts("|---|---|---|---|---|---|---|---|");
  for (const double friction : {0.0, 0.5})
    for (const double restitution : {0.0, 0.5}) {
      const continuo::Material<double> material{.restitution = restitution, .friction = friction};
      measure("box", boxful(20, 3, material), material, until);
      measure("box", boxful(200, 6, material), material, until);
      measure("funnel", funnelful(96, material), material, until);
    }
}
