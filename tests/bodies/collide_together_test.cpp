// Collisions of one instant obey the laws that define them, whatever the masses: no two bodies part more slowly than
// their restitution asks for, and those that bear an impulse part with just that. With the impulses as the only change
// of the velocities, these laws have one solution. Where it is not found, the motion says so.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/bodies/contacts/collide_together.hpp>
#include <continuo/bodies/exact_motion.hpp>

namespace continuo::collide_together_test {
namespace {

/// Balls of radius 0.5 that touch, and run towards one of them.
template <int Dim>
struct Cluster {
  using V = Vector<double, Dim>;
  std::vector<V> x, v;
  std::vector<Spin<double, Dim>> spin;
  std::vector<double> mass;
  std::vector<Collision<double, Dim>> contacts;

  void add(const V& place, const V& velocity, double its_mass) {
    x.push_back(place), v.push_back(velocity), spin.emplace_back(), mass.push_back(its_mass);
  }
  void touch(const Material<double>& material) {
    for (std::uint32_t a = 0; a < x.size(); ++a)
      for (std::uint32_t b = a + 1; b < x.size(); ++b) {
        const V apart = x[b] - x[a];
        const double distance = length(apart);
        if (distance > 1 + 1e-9) continue;
        const V normal = apart * (1 / distance);
        contacts.push_back(
            {.a = a, .b = b, .normal = normal, .material = material, .acts = dot(V(v[b] - v[a]), normal) < 0});
      }
  }
  [[nodiscard]] bool collide(int most_sweeps = 1000) {
    CollisionRound<double, Dim> round;
    return round.collide(
        std::span(contacts),
        [this](std::uint32_t k) { return Mover<double, Dim>{v[k], spin[k], 0.5, 1 / mass[k], 10 / mass[k]}; },
        most_sweeps);
  }
  [[nodiscard]] double parting(const Collision<double, Dim>& one) const {
    return dot(V(v[one.b] - v[one.a]), one.normal);
  }
};

/// In close packing, with masses that differ by up to exp(2 spread).
template <int Dim>
Cluster<Dim> packed(int side, double spread, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> part(-1, 1);
  Cluster<Dim> cluster;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int k = 0; k < (Dim == 3 ? side : 1); ++k) {
        Vector<double, Dim> x{}, v{};
        x[0] = i + 0.5 * (j + k), x[1] = j * std::sqrt(0.75) + k * std::sqrt(1.0 / 12);
        if constexpr (Dim == 3) x[2] = k * std::sqrt(2.0 / 3);
        for (std::size_t axis = 0; axis < Dim; ++axis) v[axis] = part(engine) - x[axis] / 2;
        cluster.add(x, v, std::exp(spread * part(engine)));
      }
  return cluster;
}

/// Impulses of m v change the speed of a body of the least mass by up to the ratio of the masses times v, with their
/// rounding, and do so in each of up to 1000 sweeps.
template <int Dim>
void expect_laws(Cluster<Dim> cluster, double e) {
  cluster.touch({.restitution = e, .friction = 0});
  const auto before = cluster.v;
  std::vector<double> least;
  double fastest = 0;
  for (const auto& one : cluster.contacts) least.push_back(-e * cluster.parting(one));
  for (const auto& v : before) fastest = std::max(fastest, length(v));
  ASSERT_TRUE(cluster.collide());
  const auto [light, heavy] = std::ranges::minmax(cluster.mass);
  const double rounding = 2.3e-16, wrong = 1e-12 * fastest;
  auto expected = before;
  for (std::size_t k = 0; k < cluster.contacts.size(); ++k) {
    const auto& one = cluster.contacts[k];
    EXPECT_GE(one.impulse, 0);
    expected[one.a] -= one.normal * (one.impulse / cluster.mass[one.a]);
    expected[one.b] += one.normal * (one.impulse / cluster.mass[one.b]);
    if (!one.acts) continue;
    EXPECT_GE(cluster.parting(one), least[k] - wrong);
    if (one.impulse > 0) {
      EXPECT_LE(cluster.parting(one), least[k] + std::max(wrong, 12 * rounding * one.impulse / light));
    }
  }
  for (std::size_t k = 0; k < before.size(); ++k)
    EXPECT_LE(length(Vector<double, Dim>(expected[k] - cluster.v[k])), 1000 * rounding * fastest * heavy / light);
}
TEST(CollideTogether, ObeyTheLawsOfImpactWhateverTheMasses) {
  for (unsigned seed = 1; seed <= 5; ++seed)
    for (const double spread : {0.0, 1.0, 3.0, 7.0})
      for (const double e : {0.0, 0.5, 1.0}) {
        expect_laws(packed<2>(3, spread, seed), e);
        expect_laws(packed<2>(6, spread, seed), e);
        expect_laws(packed<3>(3, spread, seed), e);
      }
}

/// Balls in a row, all of which approach each other.
template <int Dim>
Cluster<Dim> row_that_shrinks(int count, double heavy) {
  Cluster<Dim> cluster;
  for (int k = 0; k < count; ++k) {
    Vector<double, Dim> x{}, v{};
    x[0] = k, v[0] = -k / double(count);
    cluster.add(x, v, k % 2 == 0 ? 1.0 : heavy);
  }
  return cluster;
}
// More contacts than are solved directly, and too few sweeps for them: an impulse travels by one ball in each.
TEST(CollideTogether, TellWhereTheImpulsesWereNotFound) {
  const auto is_found = [](int count, double friction, int most_sweeps) {
    auto cluster = row_that_shrinks<2>(count, 1);
    cluster.touch({.restitution = 0.5, .friction = friction});
    for (std::size_t k = 0; k < cluster.spin.size(); ++k) cluster.spin[k][0] = k % 3 == 0 ? 1 : -1;
    return cluster.collide(most_sweeps);
  };
  EXPECT_TRUE(is_found(20, 0, 2));  // directly
  EXPECT_TRUE(is_found(20, 0.5, 1000));
  EXPECT_TRUE(is_found(400, 0, 1000));
  EXPECT_FALSE(is_found(400, 0, 10));
}

// What is no number is not smaller than an error that would be too large.
TEST(CollideTogether, TellWhereSpeedsAreNoNumbers) {
  for (const double friction : {0.0, 0.5}) {
    auto cluster = row_that_shrinks<2>(5, 1);
    cluster.touch({.restitution = 0.5, .friction = friction});
    cluster.v[2][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(cluster.collide()) << friction;
  }
}

TEST(CollideTogether, EndTheExactMotionWhereTheImpulsesWereNotFound) {
  World<double, 2> world;
  const auto cluster = row_that_shrinks<2>(400, 1e8);
  for (std::size_t k = 0; k < cluster.x.size(); ++k)
    ASSERT_TRUE(world.add({.position = cluster.x[k],
                           .velocity = cluster.v[k],
                           .mass = cluster.mass[k],
                           .material = {.restitution = 0.5, .friction = 0}}));
  ExactMotion motion(world);
  const Status status = motion.advance_to(1);
  EXPECT_EQ(status.ending, Ending::cannot_continue);
  EXPECT_THAT(status.message,
              testing::HasSubstr("the impulses of the collision at t = 0.000000 of bodies 0, 1, 2, 3, 4, 5, 6, 7 and "
                                 "392 more were not found: masses that differ less"));
  EXPECT_EQ(motion.advance_to(2).message, status.message);
}

// Bodies of any shape, in a packing with more contacts than are needed to part them, whose restitutions ask for speeds
// that do not fit each other: some of them give way.
TEST(CollideTogether, RedundantContactsOfBodiesOfAnyShape) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const auto cluster = packed<2>(5, 0, seed);
    World<double, 2> world;
    ASSERT_TRUE(world.add({.shape = Box<double, 2>{{{1, 1}}}, .position = {{100, 100}}}));
    Vector<double, 2> momentum{};
    for (std::size_t k = 0; k < cluster.x.size(); ++k) {
      ASSERT_TRUE(world.add({.position = cluster.x[k],
                             .velocity = cluster.v[k],
                             .mass = cluster.mass[k],
                             .material = {.restitution = 0.5, .friction = 0}}));
      momentum += cluster.v[k] * cluster.mass[k];
    }
    const double before = kinetic_energy(world);
    ExactMotion motion(world);
    const Status status = motion.advance_to(0.01);
    ASSERT_TRUE(status) << status.message << ", seed " << seed;
    for (std::size_t k = 0; k < world.size(); ++k) momentum -= world.velocity[k] * world.mass[k];
    EXPECT_LE(length(momentum), 1e-11);
    EXPECT_LE(kinetic_energy(world), before * (1 + 1e-12));
  }
}

}  // namespace
}  // namespace continuo::collide_together_test
