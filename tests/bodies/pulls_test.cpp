// Pulls that are bounded: with any other loads they bear no more than their greatest force, and follow their law.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "random_rigid_worlds.hpp"
#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>

namespace continuo::pulls_test {

using namespace test;  // random_rigid_worlds.hpp

namespace {

/// A body in gravity of any direction, drawn to one to three points by springs of which most are bounded.
template <class Real, int Dim>
struct Drawn {
  using V = Vector<Real, Dim>;

  Drawn(unsigned seed, bool at_centre) : numbers(seed) {
    world.gravity = numbers.template vector<Dim>(Real(10));
    BodyDefinition<Real, Dim> body{.shape = Box<Real, Dim>{}, .mass = numbers.between(Real(0.2), Real(5))};
    body.position = numbers.template vector<Dim>(Real(1)), body.velocity = numbers.template vector<Dim>(Real(2));
    if (!at_centre) body.spin = numbers.template vector<Spin<Real, Dim>::size()>(Real(2));
    const auto added = world.add(body);
    EXPECT_TRUE(added);
    for (std::size_t k = 1 + numbers.below(3); k > 0; --k) add_pull(*added, at_centre);
  }
  void add_pull(BodyHandle body, bool at_centre) {
    JointDefinition<Real, Dim> pull{.kind = JointKind::pull, .b = body, .anchor = world.position_of(body)};
    if (!at_centre) pull.anchor += numbers.template vector<Dim>(Real(0.5));
    pull.spring = JointSpring<Real>{.hertz = numbers.between(Real(0.5), Real(8)), .damping = numbers.between(0, 1)};
    if (!numbers.one_in(6)) pull.breaks_at = numbers.between(Real(0.1), Real(40));
    const auto added = world.add_joint(pull);
    EXPECT_TRUE(added);
    pulls.push_back(*added);
    world.find(*added)->target = pull.anchor + numbers.template vector<Dim>(numbers.one_in(2) ? Real(0.2) : Real(3));
  }

  RandomNumbers<Real> numbers;
  World<Real, Dim> world;
  std::vector<JointHandle> pulls;
};

/// Of forces up to some hundred: Newton's method stops at 1e-8 of the greatest velocity, and the step divides by h.
template <class Real>
constexpr Real rounded = sizeof(Real) == 4 ? Real(2e-2) : Real(1e-6);

/// What a spring wants by its law, cut to the greatest force: -m (w^2 (x - target) + 2 d w v), by implicit Euler from
/// the place where a substep of h ends, as the velocities of its relaxing pass are.
template <class Real, int Dim>
Vector<Real, Dim> law_of(const Joint<Real, Dim>& pull, const World<Real, Dim>& world, Real h) {
  const Real w = 2 * std::numbers::pi_v<Real> * pull.spring->hertz;
  const auto apart = world.position[0] + world.velocity[0] * h - pull.target;
  const auto wish = (apart * (w * w) + world.velocity[0] * (2 * pull.spring->damping * w)) * -world.mass[0];
  return wish * std::min(Real(1), pull.breaks_at / length(wish));
}
/// At the centre of a body, pulls follow their law with implicit Euler.
template <class Real, int Dim>
void expect_the_law(unsigned seed, std::size_t& bounded) {
  Drawn<Real, Dim> drawn(seed, true);
  World<Real, Dim>& world = drawn.world;
  const Real h = Real(1) / 240;
  FastMotion<Real, Dim> motion(world, {.step = h, .substeps = 1});
  for (int k = 0; k < 200; ++k) {
    ASSERT_TRUE(motion.advance());
    for (const JointHandle handle : drawn.pulls) {
      const Joint<Real, Dim>& pull = *world.find(handle);
      const auto expected = law_of(pull, world, h);
      ASSERT_LE(length(Vector<Real, Dim>(pull.force - expected)), rounded<Real> * (1 + length(expected)))
          << "seed " << seed << ", step " << k;
      bounded += length(expected) >= pull.breaks_at * Real(0.999) ? 1 : 0;
    }
  }
}
TEST(Pulls, FollowTheirLawUpToTheirGreatestForce) {
  std::size_t bounded = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    expect_the_law<double, 2>(seed, bounded), expect_the_law<double, 3>(seed, bounded);
    expect_the_law<float, 2>(seed, bounded), expect_the_law<float, 3>(seed, bounded);
  }
  EXPECT_GT(bounded, 5'000u);
}

/// Anywhere on a body they are bounded, and all that changes its momentum beside gravity.
template <class Real, int Dim>
void expect_bounds_and_momentum(unsigned seed) {
  Drawn<Real, Dim> drawn(seed, false);
  World<Real, Dim>& world = drawn.world;
  const Real h = Real(1) / 240;
  FastMotion<Real, Dim> motion(world, {.step = h, .substeps = 1});
  for (int k = 0; k < 200; ++k) {
    const auto before = world.velocity[0];
    ASSERT_TRUE(motion.advance());
    auto force = world.gravity * world.mass[0];
    for (const JointHandle handle : drawn.pulls) {
      const Joint<Real, Dim>& pull = *world.find(handle);
      ASSERT_LE(length(pull.force), pull.breaks_at * (1 + 16 * std::numeric_limits<Real>::epsilon()))
          << "seed " << seed << ", step " << k;
      force += pull.force;
    }
    const auto change = (world.velocity[0] - before) * (world.mass[0] / h);
    ASSERT_LE(length(Vector<Real, Dim>(change - force)), 2 * rounded<Real> * (1 + length(force)))
        << "seed " << seed << ", step " << k;
  }
}
TEST(Pulls, BearNoMoreThanTheirGreatestForce) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    expect_bounds_and_momentum<double, 2>(seed), expect_bounds_and_momentum<double, 3>(seed);
    expect_bounds_and_momentum<float, 2>(seed), expect_bounds_and_momentum<float, 3>(seed);
  }
}

/// The exact motion of the same world. Implicit Euler is off by a part of h, which two steps h extrapolate to 0. Later
/// than this some of the motions are chaotic.
template <int Dim>
void expect_the_exact_motion(unsigned seed) {
  const Drawn<double, Dim> drawn(seed, false);
  World<double, Dim> exact = drawn.world;
  ExactMotion<double, Dim> of_exact(exact);
  ASSERT_TRUE(of_exact.advance_to(0.1));
  const auto place_with = [&](double h) {
    World<double, Dim> world = drawn.world;
    FastMotion<double, Dim> motion(world, {.step = h, .substeps = 1});
    EXPECT_TRUE(motion.advance_to(0.1));
    return world.position[0];
  };
  const auto place = place_with(1.0 / 4000) * 2 - place_with(1.0 / 2000);
  const double way = length(Vector<double, Dim>(exact.position[0] - drawn.world.position[0]));
  EXPECT_LE(length(Vector<double, Dim>(place - exact.position[0])), 0.005 * (0.1 + way)) << "seed " << seed;
}
TEST(Pulls, MoveBodiesAsTheExactMotionDoes) {
  for (unsigned seed = 0; seed < 30; ++seed) expect_the_exact_motion<2>(seed), expect_the_exact_motion<3>(seed);
}

/// In heaps, whether these are solved together or by sweeps, with impacts.
template <class Real, int Dim>
void expect_bounds_in_a_heap(unsigned seed, std::size_t bodies) {
  RandomRigidWorld<Real, Dim> made(seed);
  World<Real, Dim>& world = made.world;
  Material<Real> bouncy{.restitution = made.numbers.one_in(2) ? Real(0.5) : Real(0), .friction = Real(0.5)};
  while (world.size() < bodies) made.add_body(Real(1.5), bouncy);
  std::vector<JointHandle> pulls;
  for (std::size_t k = 0; k < 8; ++k) {
    const BodyHandle body = world.handle(made.numbers.below(world.size()));
    JointDefinition<Real, Dim> pull{.kind = JointKind::pull, .b = body, .anchor = world.position_of(body)};
    pull.anchor += made.numbers.template vector<Dim>(Real(0.3)), pull.breaks_at = made.numbers.between(1, 20);
    const auto added = world.add_joint(pull);
    if (!added) continue;
    world.find(*added)->target = pull.anchor + made.numbers.template vector<Dim>(Real(0.3));
    pulls.push_back(*added);
  }
  FastMotion<Real, Dim> motion(world, {});
  for (int k = 0; k < 60 && motion.advance(); ++k)
    for (const JointHandle pull : pulls)
      ASSERT_LE(length(world.find(pull)->force),
                world.find(pull)->breaks_at * (1 + 16 * std::numeric_limits<Real>::epsilon()))
          << "seed " << seed << ", step " << k;
}
TEST(Pulls, AreBoundedInHeaps) {
  for (unsigned seed = 0; seed < 3; ++seed)
    for (const std::size_t bodies : {10u, 90u}) {
      expect_bounds_in_a_heap<double, 2>(seed, bodies), expect_bounds_in_a_heap<double, 3>(seed, bodies);
      expect_bounds_in_a_heap<float, 2>(seed, bodies), expect_bounds_in_a_heap<float, 3>(seed, bodies);
    }
}

/// A pull that cannot hold a body against a load along the diagonal, though each component of the load is less than its
/// greatest force: the body is drawn away by what is left.
TEST(Pulls, AreNoStrongerAlongADiagonal) {
  World<double, 2> world;
  world.gravity = {{-9.81, -9.81}};
  const auto box = world.add({.shape = Box<double, 2>{}, .mass = 1});
  ASSERT_TRUE(box);
  const auto pull = world.add_joint({.kind = JointKind::pull, .b = *box, .breaks_at = 10});
  ASSERT_TRUE(pull);
  FastMotion<double, 2> motion(world, {});
  ASSERT_TRUE(motion.advance_to(1));
  const double speed = length(world.velocity[0]);
  ASSERT_TRUE(motion.advance_to(2));
  EXPECT_NEAR(length(world.velocity[0]) - speed, 9.81 * std::numbers::sqrt2 - 10, 1e-9);
  EXPECT_NEAR(length(world.find(*pull)->force), 10, 1e-9);
}

}  // namespace
}  // namespace continuo::pulls_test
