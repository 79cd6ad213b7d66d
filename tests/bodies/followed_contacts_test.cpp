// Contacts that are carried along with their bodies: they are those that would be found anew, up to the square of how
// far the bodies have moved, and walls of boxes that they hold do not lean.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "rigid_worlds.hpp"
#include <continuo/bodies/manifold_kernels/solver_states.hpp>
#include <continuo/bodies/rigid_stepping/rigid_contact.hpp>
#include <continuo/shapes/box_manifold.hpp>

namespace continuo::followed_contacts_test {
namespace {

using test::advance;
using test::upright_vector;

template <int Dim>
Vector<double, Dim> random_vector(std::mt19937& engine) {
  std::normal_distribution<double> normal;
  Vector<double, Dim> v;
  for (double& component : v.components) component = normal(engine);
  return v;
}
template <int Dim>
RigidBody<double, Dim> body_at(const Vector<double, Dim>& x, const Orientation<double, Dim>& orientation) {
  RigidBody<double, Dim> body;
  body.x = body.x_before = x;
  body.orientation = body.orientation_before = orientation;
  body.inverse_mass = 1;
  body.update_axes();
  return body;
}
Orientation<double, 2> turned(const Orientation<double, 2>& orientation, const Vector<double, 2>& turn) {
  return {{orientation[0] + turn[0]}};
}
Orientation<double, 3> turned(const Orientation<double, 3>& orientation, const Vector<double, 3>& turn) {
  const Orientation<double, 3> by{{std::sqrt(1 - squared(turn) / 4), turn[0] / 2, turn[1] / 2, turn[2] / 2}};
  return product(by, orientation);
}

/// Two boxes of random sizes near each other, where b then moves against a, and both together.
template <int Dim>
struct MovedBoxes {
  Convex<double, Dim> a, b;
  RigidBody<double, Dim> at_a, at_b, then_a, then_b;

  explicit MovedBoxes(std::mt19937& engine) {
    std::uniform_real_distribution<double> uniform;
    const auto random_box = [&] {
      Vector<double, Dim> size;
      for (double& side : size.components) side = std::exp(4 * uniform(engine) - 2);
      const auto made = convex_body<double, Dim>(*continuo::box<Dim>(size), 0);
      EXPECT_TRUE(made);
      return *made;
    };
    a = random_box(), b = random_box();
    const auto direction = random_vector<Dim>(engine);
    at_a = body_at<Dim>({}, turned(Orientation<double, Dim>{identity_orientation()}, random_vector<Dim>(engine) * 0.3));
    const auto way = direction * (1 / length(direction));
    at_b = body_at<Dim>(way * (a.reach + b.reach), turned(at_a.orientation, random_vector<Dim>(engine) * 0.2));
    const double apart = closest_points(a.core, b.core, relative(at_a.pose(), at_b.pose())).distance;
    at_b.x -= way * apart;  // now they are as near as the direction allows
    const double small = std::min(a.reach, b.reach);
    then_b = body_at<Dim>(at_b.x + random_vector<Dim>(engine) * (0.008 * uniform(engine) * small),
                          turned(at_b.orientation, random_vector<Dim>(engine) * (0.008 * uniform(engine))));
    then_a = at_a;
  }
  [[nodiscard]] static Orientation<double, Dim> identity_orientation() {
    Orientation<double, Dim> same;
    if constexpr (Dim == 3) same[0] = 1;
    return same;
  }
  [[nodiscard]] Manifold<double, Dim> manifold_at(const RigidBody<double, Dim>& of_a,
                                                  const RigidBody<double, Dim>& of_b, double margin) const {
    return manifold_of_boxes(
        a, b, {half_sides(a), half_sides(b), relative(of_a.pose(), of_b.pose()), std::min(a.reach, b.reach)}, margin);
  }
};
template <int Dim>
double least_separation(const Manifold<double, Dim>& of) {
  double least = 1e300;
  for (const auto& point : of.all()) least = std::min(least, point.separation);
  return least;
}

// Nothing is deeper than the contact says: a point that was outside the margin is not near yet, and along its normal
// the bodies are as far apart as it says but for the product of a turn (0.01) and a way (0.02 of the size).
template <int Dim>
void expect_followed_contacts_to_be_those_of_now() {
  std::mt19937 engine(11);
  int followed = 0, refused = 0;
  for (int k = 0; k < 10000; ++k) {
    const MovedBoxes<Dim> boxes(engine);
    const double size = std::min(boxes.a.reach, boxes.b.reach), margin = (boxes.a.reach + boxes.b.reach) / 100;
    const auto found = boxes.manifold_at(boxes.at_a, boxes.at_b, margin);
    if (found.size == 0) continue;
    RigidContact<double, Dim> contact;
    renew(contact, found, boxes.at_a.pose(), margin, boxes.at_a, boxes.at_b);
    if (!follow(contact, margin, size, boxes.a.reach < boxes.b.reach, boxes.then_a, boxes.then_b)) {
      ++refused;
      continue;
    }
    ++followed;
    const auto anew = boxes.manifold_at(boxes.then_a, boxes.then_b, 2 * margin);
    double least = 1e300;
    for (const auto& point : contact.all()) least = std::min(least, point.separation);
    ASSERT_GT(anew.size, 0u);
    // The manifold of now is along the axis of greatest separation, up to its bias of 1e-3.
    EXPECT_GE(least_separation(anew), std::min(least, 0.0) - (1e-3 + 4e-4) * size) << k;
    for (const auto& point : contact.all()) {
      // Where each acts on the other is one point.
      const auto on_a = boxes.then_a.x + point.arm_a, on_b = boxes.then_b.x + point.arm_b;
      EXPECT_LT(length(on_a - on_b), 1e-12);
      EXPECT_NEAR(separation(contact, point, boxes.then_a, boxes.then_b), point.separation, 1e-12);
    }
  }
  EXPECT_GT(followed, 500);
  EXPECT_GT(refused, 500);
}
TEST(FollowedContacts, AreThoseOfNow) {
  expect_followed_contacts_to_be_those_of_now<2>();
  expect_followed_contacts_to_be_those_of_now<3>();
}

// What turns along with the other body, as on a table that turns, has the contact of the beginning, turned.
TEST(FollowedContacts, TurnWithBothBodies) {
  std::mt19937 engine(5);
  for (int k = 0; k < 2000; ++k) {
    const MovedBoxes<3> boxes(engine);
    const double size = std::min(boxes.a.reach, boxes.b.reach), margin = (boxes.a.reach + boxes.b.reach) / 100;
    const auto found = boxes.manifold_at(boxes.at_a, boxes.at_b, margin);
    if (found.size == 0) continue;
    RigidContact<double, 3> contact;
    renew(contact, found, boxes.at_a.pose(), margin, boxes.at_a, boxes.at_b);
    contact.points[0].friction = {{0.6, -0.8}};
    const RigidContact<double, 3> before = contact;
    const Pose<double, 3> turn{{{1, 2, 3}}, rotation(Orientation<double, 3>{{std::cos(0.002), std::sin(0.002), 0, 0}})};
    auto a = boxes.at_a, b = boxes.at_b;
    for (RigidBody<double, 3>* body : {&a, &b}) {
      body->x = turn.place(body->x);
      for (std::size_t axis = 0; axis < 3; ++axis) body->axes[axis] = turn.axes * body->axes[axis];
    }
    ASSERT_TRUE(follow(contact, margin, size, boxes.a.reach < boxes.b.reach, a, b));
    EXPECT_LT(length(contact.normal - turn.axes * before.normal), 1e-12);
    for (std::size_t i = 0; i < contact.size; ++i) {
      EXPECT_NEAR(contact.points[i].separation, before.points[i].separation, 1e-12 * size);
      EXPECT_LT(length(contact.points[i].arm_a - turn.axes * before.points[i].arm_a), 1e-12 * (a.x[0] + size + 10));
    }
    // By 0.004 radians the frame in which sweeps hold it has not turned far; twice that it has to follow.
    EXPECT_FALSE(has_turned_far(contact, a));
    EXPECT_LT(length(HeldFrame(contact).normal - before.normal), 1e-12);
    for (RigidBody<double, 3>* body : {&a, &b}) {
      body->x = turn.place(body->x);
      for (std::size_t axis = 0; axis < 3; ++axis) body->axes[axis] = turn.axes * body->axes[axis];
    }
    ASSERT_TRUE(has_turned_far(contact, a));
    const Vector<double, 3> friction = in_world(contact.points[0].friction, HeldFrame(contact).normal);
    turn_held_frame(contact, a);
    ASSERT_TRUE(follow(contact, margin, size, boxes.a.reach < boxes.b.reach, a, b));
    EXPECT_LT(length(HeldFrame(contact).normal - contact.normal), 1e-12);
    // The impulses of friction, of length 1, are what they were in the world, but for what is along the new normal.
    EXPECT_LT(length(in_world(contact.points[0].friction, contact.normal) - friction), 0.0081);
  }
}

// Two rows of bricks, an island that is swept, on a plate that a motor tilts by 0.02 radians a second. They slip where
// the tangent of its angle is the friction. The normal may lag by HeldFrame::most_turn, and to slide by 1 mm takes
// t = cbrt(6 mm / (g w / cos(angle))), in which the plate turns by 0.006.
TEST(FollowedContacts, SlipOnAPlateThatTilts) {
  constexpr double friction = 0.5, w = 0.02;
  World<double, 2> world;
  world.gravity = {{0, -9.81}};
  ASSERT_TRUE(world.add({.shape = Box<double, 2>{{{90, 1}}},
                         .spin = {{w}},
                         .fixed = true,
                         .material = {.friction = friction},
                         .traits = {.is_driven = true}}));
  const double begin = std::atan(friction) - 0.1;
  const Pose<double, 2> tilted{{}, rotation(Orientation<double, 2>{{begin}})};
  world.orientation[0] = {{begin}};
  const auto add = [&](double x, double height) {
    ASSERT_TRUE(world.add({.shape = Box<double, 2>{{{1, 1}}},
                           .position = tilted.place({{x, height}}),
                           .orientation = {{begin}},
                           .material = {.friction = friction}}));
  };
  for (int i = 0; i < 60; ++i) add(i - 30, 1);
  for (int i = 0; i < 59; ++i) add(i - 29.5, 2);
  FastMotion<double, 2> motion(world);
  const auto along_plate = [&](std::size_t i) {
    const Pose<double, 2> at{{}, rotation(world.orientation[0])};
    return at.local(world.position[i])[0];
  };
  const double start = along_plate(30);
  for (int k = 0; k < 600 && std::abs(along_plate(30) - start) < 1e-3; ++k) advance<2>(motion, 1);
  EXPECT_GT(motion.statistics().colours, 2u);  // it was swept
  EXPECT_GT(world.orientation[0][0], std::atan(friction) * 0.99);
  const double lag = HeldFrame<double, 2>::most_turn;
  EXPECT_LT(world.orientation[0][0], std::atan(friction) + lag + 0.006);
}

// A wall one box thick, in rows of 50, 49, ..., 1. Rigid boxes stay where they are; soft contacts at 30 Hz let the wall
// sink by g / w^2 times the number of boxes on one at most, and it leans by less than that at its top. It leant by
// twice the side of a box after ten seconds where the frames of contacts followed every turn.
TEST(FollowedContacts, HoldAWallUpright) {
  World<double, 3> world = test::world_on_slope<3>(0, 0.6);
  constexpr int base = 50;
  for (int i = 0; i < base; ++i)
    for (int j = i; j < base; ++j) test::add_box<3>(world, upright_vector<3>(0.5 * i + (j - i), i + 0.5));
  FastMotion<double, 3> motion(world);
  advance<3>(motion, 600);
  const double sag = 9.81 / std::pow(2 * 3.14159 * 30, 2) * base;
  for (std::size_t i = 0; i < world.size(); ++i) {
    EXPECT_LT(std::abs(world.position[i][1]), 3 * sag) << i;
    EXPECT_LT(length(world.velocity[i]), 0.01) << i;
  }
}

}  // namespace
}  // namespace continuo::followed_contacts_test
