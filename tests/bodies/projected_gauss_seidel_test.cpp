// The impulses of coupled contacts: closed forms, and the laws of contact and friction in a random heap.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/contacts/projected_gauss_seidel.hpp>
#include <continuo/bodies/contacts/touching.hpp>

namespace continuo::projected_gauss_seidel_test {
namespace {

template <int Dim>
ProjectedGaussSeidel<double, Dim> all_that_touch(const World<double, Dim>& world, double reach) {
  ProjectedGaussSeidel<double, Dim> sweeps;
  for (std::size_t i = 0; i < world.size(); ++i) sweeps.add(world, i);
  for (const Touching& pair : pairs_within(world, reach)) {
    PersistentContact<double, Dim> contact(world, pair);
    contact.place(world, world.position, world.velocity, world.spin);
    sweeps.add(contact, pair.a + 1, pair.with_wall() ? 0 : pair.b + 1);
  }
  return sweeps;
}

// A hundred balls fall on a floor together. The k-th contact from above stops the k masses above it. With balls
// numbered at random, a sweep passes an impulse on by a few balls, and sweeps alone would reduce the error by some
// (pi/200)^2 each: after 4000 a tenth of it would be left.
TEST(ProjectedGaussSeidel, StopATowerByGoingOnInTheirDirection) {
  constexpr std::size_t n = 100;
  std::vector<std::size_t> floor_of(n);
  std::iota(floor_of.begin(), floor_of.end(), std::size_t{0});
  std::shuffle(floor_of.begin(), floor_of.end(), std::mt19937(7));
  World<double, 2> world;
  EXPECT_TRUE(world.add_wall({}));
  for (const std::size_t floor : floor_of) {
    const double height = 0.5 + static_cast<double>(floor);
    EXPECT_TRUE(
        world.add({.position = {{0, height}}, .velocity = {{0, -2}}, .mass = 3.0, .material = {.friction = 0}}));
  }
  auto sweeps = all_that_touch(world, 1e-9);
  ASSERT_EQ(sweeps.rows().size(), n);
  sweeps.sweep(1e-12, 4000);
  for (const auto& row : sweeps.rows()) {
    const std::size_t below = row.b == 0 ? 0 : std::max(floor_of[row.a - 1], floor_of[row.b - 1]);
    EXPECT_NEAR(row.impulse.press, 6.0 * static_cast<double>(n - below), 1e-7);
  }
}

// The result satisfies the laws of contact for balls of many masses, packed and thrown at a floor, or pressed into a
// box. The error of a velocity is at most its change in the last sweep, times the number of further sweeps to
// convergence, some hundreds.
template <int Dim>
void expect_laws(unsigned seed, bool in_box, const Material<double>& material) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-1, 1);
  World<double, Dim> world;
  constexpr int side = Dim == 2 ? 8 : 4;
  if (in_box) {
    Vector<double, Dim> upper;
    for (std::size_t axis = 0; axis < upper.size(); ++axis) upper[axis] = 0.98 * side + 0.02;
    EXPECT_TRUE(world.add_container({}, upper, material));
  } else {
    EXPECT_TRUE(world.add_wall({.material = material}));
  }
  for (int k = 0; k < (Dim == 2 ? side * side : side * side * side); ++k) {
    Vector<double, Dim> x, v;
    Spin<double, Dim> spin;
    for (int axis = 0, rest = k; axis < Dim; ++axis, rest /= side) {
      const auto at = static_cast<std::size_t>(axis);
      x[at] = 0.5 + 0.98 * (rest % side) + 0.01 * part(random), v[at] = part(random);
    }
    for (std::size_t axis = 0; axis < spin.size(); ++axis) spin[axis] = part(random);
    v[Dim - 1] -= 1;
    EXPECT_TRUE(
        world.add({.position = x, .velocity = v, .spin = spin, .mass = std::exp(part(random)), .material = material}));
  }
  auto sweeps = all_that_touch(world, 0.01);
  const double before = sweeps.energy();
  constexpr double least = 1e-10, wrong = 300 * least;
  sweeps.sweep(least, 20000);
  EXPECT_LT(sweeps.energy(), before);
  int slip = 0, hold = 0, part_ways = 0;
  for (const auto& row : sweeps.rows()) {
    const auto &a = sweeps.mover(row.a), &b = sweeps.mover(row.b);
    Vector<double, Dim> rate = b.v - a.v;
    const double parting = dot(rate, row.normal), press = row.impulse.press;
    EXPECT_GE(press, 0);
    EXPECT_GE(parting, -wrong);
    EXPECT_LE(std::min(press, parting), wrong);  // one of the two is zero
    if (press == 0) ++part_ways;
    rate -= row.normal * parting + turning(a.spin, Vector<double, Dim>(row.normal * a.radius)) +
            turning(b.spin, Vector<double, Dim>(row.normal * b.radius));
    const double rub = length(row.impulse.rub), most = material.friction * press, speed = length(rate);
    EXPECT_LE(rub, most * (1 + 1e-12));
    if (rub < most * (1 - 1e-9)) {
      EXPECT_LE(speed, wrong) << "it slips though friction could hold it";
      ++hold;
    } else if (speed > 1e-3) {  // the direction of the slip is known
      EXPECT_NEAR(dot(rate, row.impulse.rub), -speed * rub, wrong * rub);
      if (press > 0) ++slip;
    }
  }
  EXPECT_GT(hold, 0);
  if (in_box) return;  // no body can leave the box
  EXPECT_GT(slip, 0);
  EXPECT_GT(part_ways, 0);
}
TEST(ProjectedGaussSeidel, ObeyTheLawsOfContactAndFriction) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    expect_laws<2>(seed, false, {.friction = 0.2});
    expect_laws<3>(seed, false, {.friction = 0.2});
    expect_laws<2>(seed, true, {.friction = 0.5, .rolling_resistance = 0.1});
    expect_laws<3>(seed, true, {.friction = 0.5, .rolling_resistance = 0.1});
  }
}

}  // namespace
}  // namespace continuo::projected_gauss_seidel_test
