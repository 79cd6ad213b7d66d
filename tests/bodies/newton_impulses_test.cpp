// The impulses of contacts with friction by Newton's method, for balls whose masses differ by up to six powers of ten:
// random clusters against the laws of contact, which the test works out itself in long double.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/contacts/newton_impulses.hpp>
#include <continuo/bodies/contacts/touching.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo::newton_impulses_test {
namespace {

using Wide = long double;

/// Balls that are dropped onto each other along random ways until they touch something, with random velocities. Then
/// they are pressed downwards, as by an impact.
template <int Dim>
World<double, Dim> cluster(std::mt19937& random, double powers, const Material<double>& material) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  World<double, Dim> world;
  Vector<double, Dim> room;
  for (std::size_t axis = 0; axis < Dim; ++axis) room[axis] = axis + 1 < Dim ? 1.8 : 60;
  EXPECT_TRUE(world.add_container({}, room, material));
  const int count = std::uniform_int_distribution(2, 8)(random);
  double top = 0;
  for (int k = 0; k < count; ++k) {
    const double radius = uniform(0.2, 0.5);
    Vector<double, Dim> at, velocity;
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      at[axis] = uniform(radius, room[0] - radius);
      velocity[axis] = uniform(-1, 1);
    }
    velocity[Dim - 1] -= 2;
    // From above, down to where it first touches.
    const auto is_free = [&](double height) {
      at[Dim - 1] = height;
      for (std::size_t i = 0; i < world.size(); ++i)
        if (length(at - world.position[i]) < radius + world.radius[i]) return false;
      return height >= radius;
    };
    double low = 0, high = top + 2;
    for (double height = high; height > 0 && is_free(height); height -= 0.02) high = height, low = height - 0.02;
    for (int halving = 0; halving < 60; ++halving) (is_free((low + high) / 2) ? high : low) = (low + high) / 2;
    at[Dim - 1] = high;
    top = std::max(top, high);
    EXPECT_TRUE(world.add({.shape = Sphere<double>{radius},
                           .position = at,
                           .velocity = velocity,
                           .mass = std::pow(10, uniform(0, powers)),
                           .material = material}));
  }
  return world;
}
template <int Dim>
ProjectedGaussSeidel<double, Dim> rows_of(const World<double, Dim>& world, bool rolls) {
  ProjectedGaussSeidel<double, Dim> sweeps;
  for (std::size_t i = 0; i < world.size(); ++i) sweeps.add(world, i);
  for (const Touching& pair : pairs_within(world, 0.05)) {  // some are near only: they must have no impulse
    PersistentContact<double, Dim> contact(world, pair);
    if (!rolls) contact.roll.most = 0;
    contact.place(world, world.position, world.velocity, world.spin);
    sweeps.add(contact, pair.a + 1, pair.with_wall() ? 0 : pair.b + 1).least = -10 * std::max(0.0, contact.gap - 1e-9);
  }
  return sweeps;
}

template <int Dim>
Vector<Wide, Dim> wide(const Vector<double, Dim>& from) {
  Vector<Wide, Dim> to;
  for (std::size_t axis = 0; axis < Dim; ++axis) to[axis] = Wide(from[axis]);
  return to;
}

/// What the impulses do to the velocities, and by how much of the fastest speed a law is violated.
template <int Dim>
class Referee {
 public:
  using V = Vector<Wide, Dim>;
  using S = Spin<Wide, Dim>;
  using Sweeps = ProjectedGaussSeidel<double, Dim>;

  Referee(const Sweeps& sweeps, std::span<const ContactImpulse<double, Dim>> impulses)
      : bodies_(sweeps.movers()), v_(bodies_.size()), spin_(bodies_.size()) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      v_[i] = wide(bodies_[i].v);
      for (std::size_t axis = 0; axis < S::size(); ++axis) spin_[i][axis] = Wide(bodies_[i].spin[axis]);
      fastest = std::max(fastest, length(v_[i]));
    }
    for (std::size_t k = 0; k < impulses.size(); ++k) push(sweeps.rows()[k], impulses[k]);
    for (std::size_t k = 0; k < impulses.size(); ++k) judge(sweeps.rows()[k], impulses[k]);
  }
  Wide fastest = 1;
  Wide violation = 0;  // of a speed: of separation, of slip against the direction of friction
  bool is_possible = true;

 private:
  static Wide inertia_inverse(const typename Sweeps::Moving& body) { return Wide(body.turn) / Wide(body.radius); }
  void push(const auto& row, const ContactImpulse<double, Dim>& by) {
    const V normal = wide(row.normal), impulse = normal * Wide(by.press) + wide(by.rub);
    for (const auto& [place, sign] : {std::pair{row.a, Wide(-1)}, std::pair{row.b, Wide(1)}}) {
      if (place == 0) continue;
      const auto& body = bodies_[place];
      v_[place] += impulse * (sign * Wide(body.inverse_mass));
      // The arm of the force on b is -radius * normal, on a it is +radius * normal: the moments are the same.
      spin_[place] -= moment(V(normal * Wide(body.radius)), wide(by.rub)) * inertia_inverse(body);
      S couple;
      for (std::size_t axis = 0; axis < S::size(); ++axis) couple[axis] = Wide(by.roll[axis]) * Wide(row.arm);
      spin_[place] += couple * (sign * inertia_inverse(body));
    }
  }
  void judge(const auto& row, const ContactImpulse<double, Dim>& by) {
    const V normal = wide(row.normal);
    const auto surface = [&](std::uint32_t place, Wide side) {
      return place == 0 ? V{} : V(v_[place] + turning(spin_[place], V(normal * (side * Wide(bodies_[place].radius)))));
    };
    const V rate = surface(row.b, -1) - surface(row.a, 1);
    const Wide more = dot(rate, normal) - Wide(row.least), press = Wide(by.press);
    violation = std::max(violation, -more);
    if (press > 0) violation = std::max(violation, std::min(more, press * Wide(row.of_normal)));
    is_possible = is_possible && press >= 0 && std::abs(dot(wide(by.rub), normal)) <= 1e-12L * press;
    if (!(row.friction > 0) || !(press > 0)) return;
    const V slip = rate - normal * dot(rate, normal);
    const Wide most = Wide(row.friction) * press, rub = length(wide(by.rub));
    is_possible = is_possible && rub <= most * (1 + 1e-9L);
    // Either nothing slips, or friction has its limit and acts against the slip.
    const Wide against = (most * length(slip) + dot(wide(by.rub), slip)) / most;
    violation = std::max(violation, std::min(against, most * Wide(row.of_slip)));
    const Wide most_roll = Wide(row.resistance) * press;
    if (!(most_roll > 0)) return;
    S rolling = (spin_[row.b] - spin_[row.a]) * Wide(row.arm), couple;
    for (std::size_t axis = 0; axis < S::size(); ++axis) couple[axis] = Wide(by.roll[axis]);
    if constexpr (Dim == 3) rolling -= normal * dot(rolling, normal);
    is_possible = is_possible && length(couple) <= most_roll * (1 + 1e-9L);
    const Wide back = (most_roll * length(rolling) + dot(couple, rolling)) / most_roll;
    violation = std::max(violation, std::min(back, most_roll * Wide(row.of_roll)));
  }

  std::vector<typename Sweeps::Moving> bodies_;
  std::vector<V> v_;
  std::vector<S> spin_;
};

/// Of 400 random clusters: how many are solved, from what some sweeps leave. With friction the laws are those of no
/// least energy, and Newton's method may go in circles: then what it leaves tells. Impulses are rounded to double: a
/// light body between heavy ones feels 1e-16 of what they push, times the ratio of the masses.
template <int Dim>
int count_solved(double powers, const Material<double>& material, bool rolls) {
  const Wide rounding = 1e-13L * std::pow(10.0L, static_cast<Wide>(powers));
  int solved = 0;
  std::mt19937 random(11);
  for (int round = 0; round < 400; ++round) {
    const World<double, Dim> world = cluster<Dim>(random, powers, material);
    auto sweeps = rows_of(world, rolls);
    if (sweeps.rows().empty()) {
      ++solved;
      continue;
    }
    const auto free = sweeps.movers();
    sweeps.sweep(1e-9, 200);
    const auto found = NewtonImpulses<double, Dim>(sweeps, free).find();
    sweeps.restore(free);
    const Referee<Dim> referee(sweeps, found);
    EXPECT_TRUE(referee.is_possible) << "round " << round;
    const bool is_right = referee.violation <= rounding * referee.fastest;
    solved += is_right;
    // The bound by which time steps judge impulses agrees about it.
    sweeps.apply(free, found);
    double energy = 0;
    for (const auto& one : free)
      if (one.inverse_mass > 0) energy += squared(one.v) / one.inverse_mass;
    const bool is_said = sweeps.greatest_error_energy() <= 1e-6 * energy;
    EXPECT_TRUE(is_said || !is_right) << "round " << round;
  }
  return solved;
}

TEST(NewtonImpulses, MeetTheLawsOfContactInThePlane) {
  EXPECT_EQ(count_solved<2>(0, {.friction = 0}, false), 400);
  EXPECT_EQ(count_solved<2>(6, {.friction = 0}, false), 400);
  EXPECT_GE(count_solved<2>(0, {.friction = 0.3}, false), 396);
  EXPECT_GE(count_solved<2>(6, {.friction = 0.3}, false), 388);
  EXPECT_GE(count_solved<2>(3, {.friction = 0.8, .rolling_resistance = 0.1}, true), 372);
}
TEST(NewtonImpulses, MeetTheLawsOfContactInSpace) {
  EXPECT_EQ(count_solved<3>(0, {.friction = 0}, false), 400);
  EXPECT_EQ(count_solved<3>(6, {.friction = 0}, false), 400);
  EXPECT_GE(count_solved<3>(0, {.friction = 0.3}, false), 396);
  EXPECT_GE(count_solved<3>(6, {.friction = 0.3}, false), 388);
  EXPECT_GE(count_solved<3>(3, {.friction = 0.8, .rolling_resistance = 0.1}, true), 372);
}

// Where a heavy ball falls on a light one that lies on a floor, both stop, whatever their masses: m v is passed on. The
// sweeps would need as many rounds as the ratio of the masses.
TEST(NewtonImpulses, AHeavyBallStopsOnALightOne) {
  for (const double ratio : {1.0, 1e3, 1e6, 1e9}) {
    World<double, 2> world;
    ASSERT_TRUE(world.add_wall({}));
    ASSERT_TRUE(world.add({.position = {{0, 0.5}}, .mass = 1, .material = {.friction = 0.5}}));
    ASSERT_TRUE(
        world.add({.position = {{0, 1.5}}, .velocity = {{0, -1}}, .mass = ratio, .material = {.friction = 0.5}}));
    auto sweeps = rows_of(world, false);
    const auto found = NewtonImpulses<double, 2>(sweeps, sweeps.movers()).find();
    ASSERT_EQ(found.size(), 2u);
    // A rounding of the light ball's speed is so much more of what the heavy one is pushed.
    for (const auto& impulse : found) EXPECT_NEAR(impulse.press / ratio, 1, 1e-15 + 4e-18 * ratio);
  }
}

}  // namespace
}  // namespace continuo::newton_impulses_test
