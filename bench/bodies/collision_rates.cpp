// How many collisions a second the exact motion makes of elastic gases of many sizes, packing 0.3, on one core. A run
// warms up until every ball has collided several times, then is measured; the best of the repeats counts.
//   collision_rates [REPEATS]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>

#include <bench/processor_time.hpp>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::bench {
namespace {

/// Balls of radius 1/2 on a grid in a box that they fill to `packing`, at speed 5 in random directions.
template <int Dim>
World<double, Dim> gas(int count, double packing) {
  World<double, Dim> world;
  const double edge = std::pow(count * volume<double, Dim>(Sphere<double>{0.5}) / packing, 1.0 / Dim);
  Vector<double, Dim> upper;
  for (std::size_t axis = 0; axis < upper.size(); ++axis) upper[axis] = edge;
  const Material<double> elastic{.restitution = 1, .friction = 0};
  require(world.add_container({}, upper, elastic));
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  const int side = static_cast<int>(std::ceil(std::pow(count, 1.0 / Dim) - 1e-9));
  for (int i = 0; i < count; ++i) {
    BodyDefinition<double, Dim> ball{.material = elastic};
    for (std::size_t axis = 0, rest = static_cast<std::size_t>(i); axis < upper.size();
         ++axis, rest /= static_cast<std::size_t>(side)) {
      ball.position[axis] = (static_cast<double>(rest % static_cast<std::size_t>(side)) + 0.5) * edge / side;
      ball.velocity[axis] = normal(engine);
    }
    ball.velocity *= 5 / length(ball.velocity);
    require(world.add(ball));
  }
  return world;
}

template <int Dim>
void measure(int count, int repeats) {
  double best = 0, drift = 0;
  for (int i = 0; i < repeats; ++i) {
    World<double, Dim> world = gas<Dim>(count, 0.3);
    const double energy = kinetic_energy(world);
    ExactMotion motion(world);
    const auto collisions = [&] { return motion.statistics().collisions + motion.statistics().wall_collisions; };
    const auto run = [&](std::size_t at_least, double interval) {
      const std::size_t until = collisions() + at_least;
      while (collisions() < until)
        if (const Status status = motion.advance_to(world.time + interval); !status)
          return void(std::puts(status.message.c_str()));
    };
    const auto n = static_cast<std::size_t>(count);
    run(5 * n, 0.05);
    const std::size_t before = collisions();
    const double begin = processor_seconds();
    run(std::max<std::size_t>(10 * n, 1'000'000), count < 10000 ? 10 : 0.5);
    best = std::max(best, static_cast<double>(collisions() - before) / (processor_seconds() - begin));
    drift = std::max(drift, std::abs(kinetic_energy(world) / energy - 1));
  }
  std::printf("| %d | %d | %.3g | %.1g |\n", Dim, count, best, drift);
  std::fflush(stdout);
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  const int repeats = count > 1 ? std::max(1, std::atoi(arguments[1])) : 3;
  std::puts("| Dimensions | Bodies | Collisions per second | Drift of the energy |\n|---|---|---|---|");
  for (const int bodies : {1000, 10000, 100000}) {
    continuo::bench::measure<3>(bodies, repeats);
    continuo::bench::measure<2>(bodies, repeats);
  }
}
