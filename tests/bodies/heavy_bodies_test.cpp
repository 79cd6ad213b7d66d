// A heavy body that many light ones touch: each of these acts on a copy of it, which is not seen in their motion, and
// momentum is the same.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "rigid_worlds.hpp"

namespace continuo::heavy_bodies_test {
namespace {

using test::advance;
using test::upright_vector;

template <int Dim>
Box<double, Dim> plate(double width, double height) {
  Vector<double, Dim> size;
  for (double& side : size.components) side = 4;
  size[0] = width, size[Dim - 1] = height;
  return {size};
}

/// Double columns of seven rows of boxes that fall on a plate of this mass, on which nothing else acts: their contacts
/// are so many that they are swept.
template <int Dim>
World<double, Dim> columns_on_plate(std::size_t columns, double mass) {
  World<double, Dim> world;
  world.gravity = upright_vector<Dim>(0, -9.81);
  for (std::size_t n = 0; n < columns; ++n)
    for (std::size_t k = 0; k < 14; ++k)
      test::add_box<Dim>(world, upright_vector<Dim>(3.0 * static_cast<double>(n) + (k % 2 == 0 ? 0 : 1.001),
                                                    0.52 + 1.01 * static_cast<double>(k / 2)));
  const auto made = world.add({.shape = plate<Dim>(400, 1), .position = upright_vector<Dim>(100, -0.5), .mass = mass});
  EXPECT_TRUE(made);
  BodyTraits<double> traits;
  traits.gravity_scale = 0;
  EXPECT_TRUE(world.set_traits(*made, traits));
  return world;
}

// A plate of 1e9 moves by less than 60 * 14 * 9.81 / 1e9 t^2 / 2 = 4e-6 in a second, whatever its contacts miss of each
// other. The columns do not touch each other. They rest on overlaps of 0.005, of which a tenth depends on the order in
// which contacts are swept.
template <int Dim>
void expect_columns_to_rest_as_few_do() {
  World<double, Dim> few = columns_on_plate<Dim>(15, 1e9), many = columns_on_plate<Dim>(60, 1e9);
  FastMotion<double, Dim> of_few(few), of_many(many);
  advance<Dim>(of_few, 300), advance<Dim>(of_many, 300);
  EXPECT_LT(of_many.statistics().colours, 12u);  // for 120 contacts with the plate
  for (std::size_t i = 0; i < 15 * 14; ++i) {
    ASSERT_LT(length(many.velocity[i]), 1e-3) << i << ' ' << length(few.velocity[i]);
    ASSERT_NEAR(few.position[i][Dim - 1], many.position[i][Dim - 1], 1e-3 * static_cast<double>(i % 14 / 2 + 1)) << i;
  }
}
TEST(HeavyBodies, BearColumnsAsWhereTheyAreFew) {
  expect_columns_to_rest_as_few_do<2>();
  expect_columns_to_rest_as_few_do<3>();
}

// The forces between bodies have no sum. What the others have got from gravity is known: of the momentum, a rounding of
// 1e-16 for each of some thousand impulses of up to 100.
TEST(HeavyBodies, KeepMomentum) {
  for (const double mass : {3e3, 3e4, 1e6}) {
    World<double, 2> world = columns_on_plate<2>(20, mass);
    for (std::size_t i = 0; i + 1 < world.size(); ++i) world.velocity[i] = {{0.3, -1}};
    FastMotion<double, 2> motion(world);
    const double light = 20 * 14;
    for (int k = 1; k <= 60; ++k) {
      advance<2>(motion, 1);
      Vector<double, 2> momentum;
      for (std::size_t i = 0; i < world.size(); ++i) momentum += world.velocity[i] * world.mass[i];
      EXPECT_NEAR(momentum[0], 0.3 * light, 1e-9) << mass << ' ' << k;
      EXPECT_NEAR(momentum[1], -light * (1 + 9.81 * k / 60), 1e-9) << mass << ' ' << k;
    }
  }
}

// What hits a plate from both sides without gravity only loses energy: squares of four boxes that hardly touch each
// other at first, on a plate that is as light as a heavy body may be, and lighter.
TEST(HeavyBodies, TakeEnergy) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> uniform;
    World<double, 2> world;
    world.gravity = {};
    for (int n = 0; n < 80; ++n) {
      const double side = n % 2 == 0 ? 1 : -1, height = 1.01 + 0.3 * uniform(engine);
      for (int k = 0; k < 4; ++k)
        ASSERT_TRUE(world.add({.shape = Box<double, 2>{},
                               .position = {{4.0 * n / 2 + 1.001 * (k % 2), side * (height + 1.001 * (k / 2))}},
                               .velocity = {{uniform(engine) - 0.5, -side * (1 + 2 * uniform(engine))}},
                               .spin = {{2 * uniform(engine) - 1}},
                               .mass = 1,
                               .material = {.friction = 0.5}}));
    }
    ASSERT_TRUE(world.add({.shape = plate<2>(400, 1), .position = {{100, 0}}, .mass = std::pow(10, 3 + seed * 0.1)}));
    FastMotion<double, 2> motion(world);
    const auto energy = [&] {
      double sum = 0;
      for (std::size_t i = 0; i < world.size(); ++i)
        sum += world.mass[i] * squared(world.velocity[i]) + world.inertia(i)[0][0] * squared(world.spin[i]);
      return sum / 2;
    };
    double before = energy();
    for (int k = 0; k < 60; ++k) {
      advance<2>(motion, 1);
      EXPECT_LT(energy(), before * (1 + 1e-9)) << seed << " step " << k;
      before = energy();
    }
  }
}

}  // namespace
}  // namespace continuo::heavy_bodies_test
