// Chains whose links turn far within a substep: energy and momenta stay what they are, in space as in the plane, and
// the motion converges to that of the exact motion.
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>
#include <continuo/shapes/turned_inertia.hpp>

namespace continuo::turning_chains_test {
namespace {

template <int Dim>
struct Invariants {
  double energy = 0, kinetic_energy = 0, greatest_momentum = 0;
  Vector<double, Dim> momentum{};
  Spin<double, Dim> angular{};
};
template <int Dim>
[[nodiscard]] Invariants<Dim> invariants(const World<double, Dim>& world) {
  Invariants<Dim> of;
  for (std::size_t i = 0; i < world.size(); ++i) {
    const double mass = world.mass[i];
    const Vector<double, Dim> way = world.velocity[i] * mass;
    const Spin<double, Dim> own = turned_inertia(rotation(world.orientation[i]), world.inertia(i)) * world.spin[i];
    of.kinetic_energy += (dot(way, world.velocity[i]) + dot(own, world.spin[i])) / 2;
    of.energy -= mass * dot(world.gravity, world.position[i]);
    of.momentum += way, of.angular += moment(world.position[i], way) + own;
    of.greatest_momentum += length(way) + length(moment(world.position[i], way)) + length(own);
  }
  of.energy += of.kinetic_energy;
  return of;
}

struct Chain {
  int links = 2;
  double rate = 10;  // at which each link turns
  bool hangs = false;
  bool is_slender = false;
  unsigned seed = 1;
};
/// Links of random directions that turn about random axes, whose ends move together. One that hangs has weight.
template <int Dim>
[[nodiscard]] World<double, Dim> chain(const Chain& of) {
  std::mt19937 engine(of.seed);
  std::normal_distribution<double> normal;
  const auto direction = [&](auto vector) {
    for (double& component : vector.components) component = normal(engine);
    return vector * (1 / length(vector));
  };
  World<double, Dim> world;
  if (of.hangs) world.gravity[Dim - 1] = -9.81;
  EXPECT_TRUE(world.ignore(1, 1));
  Box<double, Dim> box;
  box.size[0] = 0.9, box.size[1] = 0.3;
  if constexpr (Dim == 3) box.size[2] = 0.15;
  const Shape<double, Dim> shape = of.is_slender ? Shape<double, Dim>(Capsule<double>{0.9, 0.05}) : box;
  Vector<double, Dim> end{}, speed{};
  BodyHandle last{};
  for (int k = 0; k < of.links; ++k) {
    const Vector<double, Dim> arm = direction(Vector<double, Dim>{}) * 0.5;
    const Spin<double, Dim> spin = direction(Spin<double, Dim>{}) * of.rate;
    const auto link = world.add({.shape = shape,
                                 .position = end + arm,
                                 .velocity = speed + turning(spin, arm),
                                 .spin = spin,
                                 .mass = 1,
                                 .group = 1});
    EXPECT_TRUE(link);
    if (k > 0 || of.hangs) {
      EXPECT_TRUE(world.add_joint(
          {.kind = Dim == 2 ? JointKind::hinge : JointKind::ball, .a = last, .b = *link, .anchor = end}));
    }
    last = *link, end += arm * 2, speed += turning(spin, arm) * 2;
  }
  return world;
}

/// The energy of each substep is set to what it was and what gravity has given; the sum of a step has rounding errors
/// of some 1e-16 of the kinetic energy and of the weights' work, 240 times in a second. Momenta are sums of impulses on
/// two bodies.
template <int Dim>
void expect_invariants(const Chain& of) {
  SCOPED_TRACE(testing::Message() << Dim << " dimensions, " << of.links << " links at " << of.rate << " rad/s, seed "
                                  << of.seed << (of.hangs ? ", hangs" : ""));
  World<double, Dim> world = chain<Dim>(of);
  const Invariants<Dim> before = invariants(world);
  FastMotion<double, Dim> motion(world);
  for (int k = 0; k < 60; ++k) {
    ASSERT_TRUE(motion.advance());
    const Invariants<Dim> now = invariants(world);
    const double scale = before.kinetic_energy + (of.hangs ? 9.81 * of.links * of.links : 0.0);
    ASSERT_NEAR(now.energy, before.energy, 1e-11 * scale) << "in step " << k;
    if (of.hangs) continue;
    ASSERT_LT(length(Vector<double, Dim>(now.momentum - before.momentum)), 1e-11 * before.greatest_momentum);
    ASSERT_LT(length(Spin<double, Dim>(now.angular - before.angular)), 1e-10 * before.greatest_momentum);
  }
}
TEST(TurningChains, KeepEnergyAndMomenta) {
  for (const int links : {2, 5, 20})
    for (const double rate : {3.0, 10.0, 30.0, 100.0})
      for (const bool hangs : {false, true}) {
        if (links == 20 && rate > 30) continue;
        const unsigned seed = static_cast<unsigned>(links);
        expect_invariants<2>({.links = links, .rate = rate, .hangs = hangs, .seed = seed});
        expect_invariants<3>({.links = links, .rate = rate, .hangs = hangs, .seed = seed});
      }
}
TEST(TurningChains, OfSlenderLinksNeverGainEnergy) {
  for (unsigned seed = 1; seed <= 10; ++seed)
    for (const double rate : {30.0, 300.0}) {
      World<double, 3> world =
          chain<3>({.links = 3, .rate = rate, .hangs = seed % 2 == 0, .is_slender = true, .seed = seed});
      const Invariants<3> before = invariants(world);
      FastMotion<double, 3> motion(world);
      for (int k = 0; k < 60; ++k) {
        ASSERT_TRUE(motion.advance());
        ASSERT_LT(invariants(world).energy, before.energy + 1e-10 * (before.kinetic_energy + 100))
            << "seed " << seed << " at " << rate << " rad/s, in step " << k;
      }
    }
}

template <int Dim>
[[nodiscard]] double error_of_fast(const Chain& of, int substeps, double duration) {
  World<double, Dim> exact = chain<Dim>(of), fast = exact;
  ExactMotion<double, Dim> referee(exact, {.tolerance = 1e-10});
  EXPECT_TRUE(referee.advance_to(duration));
  FastMotion<double, Dim> motion(fast, {.step = duration / 15, .substeps = substeps});
  for (int k = 0; k < 15; ++k) EXPECT_TRUE(motion.advance());
  double greatest = 0;
  for (std::size_t i = 0; i < fast.size(); ++i)
    greatest = std::max(greatest, length(Vector<double, Dim>(fast.position[i] - exact.position[i])));
  return greatest;
}
/// Of second order: half the substep leaves a quarter of the error.
template <int Dim>
void expect_convergence(bool hangs) {
  const Chain of{.links = 2, .rate = 5, .hangs = hangs, .seed = 2};
  const double coarse = error_of_fast<Dim>(of, 4, 0.25), fine = error_of_fast<Dim>(of, 16, 0.25);
  EXPECT_LT(coarse, 1e-3) << Dim;
  EXPECT_LT(fine, coarse / 8) << Dim;
}
TEST(TurningChains, ConvergeToTheExactMotion) {
  expect_convergence<2>(false), expect_convergence<2>(true);
  expect_convergence<3>(false), expect_convergence<3>(true);
}
/// A single rod that hangs from its end in space: 7 times a second about itself, and slowly about the vertical.
TEST(TurningChains, AFastPendulumOfSpaceFollowsTheExactMotion) {
  const double error = error_of_fast<3>({.links = 1, .rate = 30, .hangs = true, .seed = 1}, 4, 0.25);
  EXPECT_LT(error, 0.02);
}

}  // namespace
}  // namespace continuo::turning_chains_test
