// Random worlds with absurd numbers: refused with a reason, or moved to finite states, or stopped with a reason.
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/forces.hpp>
#include <continuo/bodies/queries.hpp>

namespace continuo::random_worlds_test {
namespace {

/// Numbers of all magnitudes, and sometimes NaN or infinity.
template <class Real>
class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}

  bool one_in(unsigned count) { return engine_() % count == 0; }
  std::size_t below(std::size_t count) { return engine_() % count; }
  Real any() {
    constexpr std::array<Real, 10> strange{Real(0),
                                           Real(-0.0),
                                           std::numeric_limits<Real>::quiet_NaN(),
                                           std::numeric_limits<Real>::infinity(),
                                           -std::numeric_limits<Real>::infinity(),
                                           std::numeric_limits<Real>::max(),
                                           std::numeric_limits<Real>::lowest(),
                                           std::numeric_limits<Real>::min(),
                                           std::numeric_limits<Real>::denorm_min(),
                                           Real(1e20)};
    return one_in(60) ? strange[below(strange.size())] : usual();
  }
  Real usual() { return Real(static_cast<int>(below(17)) - 8) / 2; }  // places on a grid: many coincide
  Real positive() { return one_in(8) ? Real(std::exp2(static_cast<double>(below(80)) - 40)) : Real(1 + below(4)) / 4; }

  template <int Size>
  Vector<Real, Size> vector() {
    Vector<Real, Size> v;
    for (std::size_t axis = 0; axis < v.size(); ++axis) v[axis] = any();
    return v;
  }

 private:
  std::mt19937 engine_;
};

template <class Real, int Dim>
World<Real, Dim> random_world(Numbers<Real>& numbers, std::size_t& refused) {
  World<Real, Dim> world;
  if (numbers.one_in(2)) world.gravity = numbers.template vector<Dim>();
  if (!is_finite(world.gravity)) world.gravity = {};
  for (std::size_t w = numbers.below(4); w > 0; --w)
    (void)world.add_wall({.normal = numbers.template vector<Dim>(),
                          .offset = numbers.any() - 4,
                          .material = {.restitution = Real(numbers.below(3)) / 2}});
  if (numbers.one_in(3))
    (void)world.add_container(numbers.template vector<Dim>() - Vector<Real, Dim>{{4, 4}},
                              numbers.template vector<Dim>());
  for (std::size_t n = numbers.below(10); n > 0; --n) {
    BodyDefinition<Real, Dim> body{.shape = Sphere<Real>{numbers.one_in(20) ? numbers.any() : numbers.positive()},
                                   .position = numbers.template vector<Dim>(),
                                   .velocity = numbers.template vector<Dim>()};
    if (numbers.one_in(2)) body.mass = numbers.positive();
    if (numbers.one_in(5)) body.spin = numbers.template vector<Spin<Real, Dim>::size()>();
    body.fixed = numbers.one_in(6);
    body.material = {.restitution = Real(numbers.below(5)) / 4, .friction = Real(numbers.below(3)) / 2};
    body.group = static_cast<std::uint32_t>(numbers.below(3));
    refused += world.add(body) ? 0 : 1;
  }
  if (numbers.one_in(3)) {
    EXPECT_TRUE(world.ignore(0, 1));
  }
  if (numbers.one_in(8)) world.drag.linear = numbers.positive();
  if (numbers.one_in(8)) world.attraction.constant = numbers.positive();
  if (numbers.one_in(8) && world.size() > 1)
    world.springs.push_back({.a = world.handle(0), .b = world.handle(1), .stiffness = numbers.positive()});
  return world;
}

template <class Real, int Dim>
bool all_finite(const World<Real, Dim>& world) {
  for (std::size_t i = 0; i < world.size(); ++i)
    if (!is_finite(world.position[i]) || !is_finite(world.velocity[i]) || !is_finite(world.spin[i])) return false;
  return true;
}

struct Tally {
  std::size_t refused = 0, moved = 0, stopped = 0;
};

template <class Real, int Dim>
void try_one(unsigned seed, Tally& tally) {
  Numbers<Real> numbers(seed);
  World<Real, Dim> world = random_world<Real, Dim>(numbers, tally.refused);
  World<Real, Dim> fast = world;
  ASSERT_TRUE(all_finite(world));
  ExactMotion<Real, Dim> motion(world, {.most_events = only_gravity(world) ? 150u : 4u});
  const Status moved = motion.advance_to(Real(0.25));
  ++(moved ? tally.moved : tally.stopped);
  if (moved) {
    EXPECT_TRUE(all_finite(world)) << seed;
  }

  FastMotion<Real, Dim> steps(fast);
  for (int k = 0; k < 2; ++k) {
    const Status stepped = steps.advance();
    if (stepped) {
      EXPECT_TRUE(all_finite(fast)) << seed;
    }
    if (!stepped) break;
  }
  const Queries<Real, Dim> queries(world);
  (void)queries.first_hit({numbers.template vector<Dim>(), numbers.template vector<Dim>(), numbers.any()});
  (void)queries.nearest(numbers.template vector<Dim>(), 3);
}

void try_many(unsigned first, unsigned end) {
  Tally tally;
  for (unsigned seed = first; seed < end; seed += 4) {
    try_one<double, 3>(seed, tally);
    try_one<double, 2>(seed + 1, tally);
    try_one<float, 3>(seed + 2, tally);
    try_one<float, 2>(seed + 3, tally);
  }
  // Each kind of ending occurs, or the test would prove nothing.
  EXPECT_GT(tally.refused, (end - first) / 10);
  EXPECT_GT(tally.moved, (end - first) / 2);
  EXPECT_GT(tally.stopped, (end - first) / 100);
}

TEST(RandomWorlds, MoveOrSayWhyNot) {
  try_many(0, 200);
}

TEST(RandomWorlds, MoreMoveOrSayWhyNot) {
  try_many(200, 1000);
}

TEST(RandomWorlds, RefuseWhatNoBodyCanBe) {
  World<double, 3> world;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double radius : {0.0, -1.0, nan, inf, 1e-200, 1e200})
    EXPECT_FALSE(world.add({.shape = Sphere<double>{radius}})) << radius;
  EXPECT_FALSE(world.add({.position = {{nan, 0, 0}}}));
  EXPECT_FALSE(world.add({.velocity = {{0, inf, 0}}}));
  EXPECT_FALSE(world.add({.mass = 0}));
  EXPECT_FALSE(world.add({.mass = -1}));
  EXPECT_FALSE(world.add({.mass = nan}));
  EXPECT_FALSE(world.add({.material = {.restitution = 1.5}}));
  EXPECT_FALSE(world.add({.group = 32}));
  EXPECT_EQ(world.size(), 0u);
}

// A million spheres, some at one place, added and moved at once.
TEST(RandomWorlds, HugeCrowd) {
  World<float, 3> world;
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> uniform(-80, 80);
  for (int i = 0; i < 1'000'000; ++i) {
    BodyDefinition<float, 3> ball{.position = {{uniform(engine), uniform(engine), uniform(engine)}},
                                  .velocity = {{uniform(engine) / 80, uniform(engine) / 80, uniform(engine) / 80}}};
    if (i % 100000 == 7) ball.position = {};
    ASSERT_TRUE(world.add(ball));
  }
  World<float, 3> fast = world;
  ExactMotion<float, 3> motion(world, {.most_events = 2'000'000});
  (void)motion.advance_to(0.01f);
  EXPECT_TRUE(all_finite(world));
  FastMotion<float, 3> steps(fast);
  EXPECT_TRUE(steps.advance());
  EXPECT_TRUE(all_finite(fast));
}

}  // namespace
}  // namespace continuo::random_worlds_test
