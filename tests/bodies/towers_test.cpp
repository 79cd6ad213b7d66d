// Towers and deep heaps of balls come to rest at the default options. A perfectly vertical tower is an unstable
// equilibrium, but nothing pushes it sideways: its balls stay above each other to the last bit.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <continuo/bodies/fast_motion.hpp>

namespace continuo::towers_test {
namespace {

template <class Real, int Dim>
struct Tower {
  using V = Vector<Real, Dim>;
  World<Real, Dim> world;

  /// Balls of radius 1/2 and mass 1, with the gaps `gap`; the top one has the mass `top`.
  explicit Tower(int count, Real gap = 0, Real top = 1) {
    V up{};
    up[Dim - 1] = 1;
    world.gravity = up * Real(-9.81);
    EXPECT_TRUE(world.add_wall({.normal = up}));
    for (int i = 0; i < count; ++i)
      EXPECT_TRUE(world.add(
          {.position = up * (Real(i) + Real(0.5) + gap * Real(i + 1)), .mass = i + 1 == count ? top : Real(1)}));
  }
};
template <class Real, int Dim>
[[nodiscard]] Real fastest(const World<Real, Dim>& world) {
  Real most(0);
  for (const auto& v : world.velocity) most = std::max(most, length(v));
  return most;
}

/// The height of the top ball, by the static balance: a contact of angular frequency w is a spring of the stiffness m
/// w^2, where m is the mass between the two, 1 / (1/m_a + 1/m_b), and bears the weight of all balls above it.
[[nodiscard]] double height_at_rest(int count, double top) {
  const double w = 2 * std::numbers::pi * 80, g = 9.81;  // a third of 240 substeps in a second
  double height = count - 0.5, weight = top * g, above = 1 / top;
  for (int k = count - 1; k >= 0; --k) {
    const double inverse_mass = k == 0 ? above : above + 1;
    height -= weight * inverse_mass / (w * w);
    weight += g, above = 1;
  }
  return height;
}

template <class Real, int Dim>
void expect_rest(int count, Real gap, Real top) {
  Tower<Real, Dim> tower(count, gap, top);
  FastMotion<Real, Dim> motion(tower.world);
  ASSERT_TRUE(motion.advance_to(Real(count > 40 ? 45 : 25)));
  // A position is a multiple of its rounding, and may change by some of these in a substep.
  const Real rounding = 2 * std::numeric_limits<Real>::epsilon() * static_cast<Real>(count);
  const Real height = tower.world.position.back()[Dim - 1];
  EXPECT_LE(fastest(tower.world), 240 * rounding + Real(1e-8)) << count << ' ' << gap << ' ' << top;
  EXPECT_NEAR(height, height_at_rest(count, static_cast<double>(top)), 20 * rounding + Real(1e-8))
      << count << ' ' << gap << ' ' << top;
}
template <class Real, int Dim>
void expect_all_rest() {
  for (const int count : {1, 5, 10, 20, 40, 80})
    for (const Real gap : {Real(0), Real(0.05)}) expect_rest<Real, Dim>(count, gap, 1);
  for (const Real top : {Real(0.1), Real(10), Real(100)}) expect_rest<Real, Dim>(20, 0, top);
}
TEST(Towers, ComeToRestInThePlane) {
  expect_all_rest<double, 2>();
  expect_all_rest<float, 2>();
}
TEST(Towers, ComeToRestInSpace) {
  expect_all_rest<double, 3>();
  expect_all_rest<float, 3>();
}

// Nothing but the contacts along their normals takes energy here.
TEST(Towers, DeepHeapsWithoutFrictionComeToRest) {
  for (const double width : {1.3, 1.9, 3.05}) {
    World<double, 2> world;
    const Material<double> smooth{.restitution = 0, .friction = 0};
    world.gravity = {{0, -9.81}};
    ASSERT_TRUE(world.add_container({{0, 0}}, {{width, 1000}}, smooth));
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> uniform(-0.001, 0.001);
    const int row = static_cast<int>(width);
    for (int i = 0; i < 40 * row; ++i)
      ASSERT_TRUE(world.add(
          {.position = {{(i % row + 0.5) * width / row + uniform(engine), i / row + 0.51}}, .material = smooth}));
    FastMotion<double, 2> motion(world);
    ASSERT_TRUE(motion.advance_to(40));
    EXPECT_LE(fastest(world), 1e-7) << width;
  }
}

// Overlaps are undone at `fastest_push` at most, though a sweep corrects contacts by 1.4 times what each needs. Two
// balls that begin deep in each other, alone, part at least at 1 / 1.4 of it, but for the softness of the contact, some
// 1/50.
TEST(Towers, DeepBallsPartAtTheFastestPushAtMost) {
  World<double, 3> world;
  for (const double x : {0.0, 0.4}) ASSERT_TRUE(world.add({.position = {{x, 0, 0}}}));
  FastMotion<double, 3> motion(world);
  for (int step = 1; step <= 4; ++step) {
    ASSERT_TRUE(motion.advance());
    const double apart = world.position[1][0] - world.position[0][0];
    EXPECT_LE(apart, 0.4 + 4 * step / 60.0 + 1e-12);
    EXPECT_GE(apart, 0.4 + 0.97 / 1.4 * 4 * step / 60.0);
  }
  EXPECT_LE(fastest(world), 1e-12);
}

}  // namespace
}  // namespace continuo::towers_test
