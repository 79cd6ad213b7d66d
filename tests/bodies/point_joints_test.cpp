// Point joints in lanes: their widths against each other, what they leave of the velocity, and nets of bodies, which
// are too thick to be solved directly.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "rigid_worlds.hpp"
#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/rigid_stepping/manifold_solver.hpp>
#include <continuo/bodies/rigid_stepping/point_joint_solver.hpp>
#include <continuo/bodies/snapshot.hpp>

namespace continuo::point_joints_test {

using namespace test;  // rigid_worlds.hpp

namespace {

template <class Real, int Dim>
struct Scene {
  std::vector<RigidBody<Real, Dim>> bodies;
  std::vector<PointJoint<Real, Dim>> joints;
};

/// Moving bodies, of which one in eight is fixed, with random joints between them.
template <class Real, int Dim>
Scene<Real, Dim> random_scene(unsigned seed, std::size_t bodies, std::size_t joints) {
  std::mt19937 engine(seed);
  const auto between = [&](double low, double high) {
    return static_cast<Real>(low + (high - low) * (static_cast<double>(engine()) / 4294967296.0));
  };
  const auto fill = [&](auto& vector) {
    for (Real& part : vector.components) part = between(-1, 1);
  };
  Scene<Real, Dim> scene;
  for (std::size_t i = 0; i < bodies; ++i) {
    RigidBody<Real, Dim>& body = scene.bodies.emplace_back();
    if (i % 8 == 7) continue;
    fill(body.x), fill(body.v), fill(body.spin);
    body.inverse_mass = between(0.5, 2);
    for (std::size_t k = 0; k < body.inverse_inertia_now.columns.size(); ++k)
      body.inverse_inertia_now[k][k] = between(0.5, 2);
  }
  while (scene.joints.size() < joints) {
    PointJoint<Real, Dim> joint{.a = static_cast<std::uint32_t>(engine() % bodies),
                                .b = static_cast<std::uint32_t>(engine() % bodies)};
    if (joint.a == joint.b || (scene.bodies[joint.a].is_fixed() && scene.bodies[joint.b].is_fixed())) continue;
    fill(joint.arm_a), fill(joint.arm_b), fill(joint.impulse);
    scene.joints.push_back(joint);
  }
  return scene;
}

/// A solver of joints with the states of their bodies.
template <class Real, int Dim>
class Solved {
 public:
  static constexpr Real h = Real(1) / 240;

  Solved(Scene<Real, Dim>& scene, const ManifoldKernels<Real, Dim>& kernels)
      : scene_(scene), states_(team_, kernels), joints_(team_, kernels) {
    states_.begin(scene.bodies, {});
    joints_.begin(scene.bodies, states_.states(), scene.joints);
    joints_.set_hardness(h, softness(Real(60), Real(2), h), Real(4));
  }
  void apply(ManifoldPass pass) {
    joints_.sweep(pass);
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i)
      if (pass == ManifoldPass::push && !scene_.bodies[i].is_fixed()) move_body(i);
  }
  [[nodiscard]] SolverState<Real, Dim>& state(std::size_t i) { return states_.state(i); }
  [[nodiscard]] std::vector<Real> numbers() {
    std::vector<Real> all;
    const auto note = [&](const auto& vector) {
      all.insert(all.end(), vector.components.begin(), vector.components.end());
    };
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) note(state(i).v()), note(state(i).spin());
    for (std::size_t k = 0; k < scene_.joints.size(); ++k) note(joints_.impulse(k));
    return all;
  }

 private:
  void move_body(std::size_t i) {
    if constexpr (Dim == 2) {
      move(state(i), state(i).spin(), h, states_.angle(i));
    } else {
      move(state(i), state(i).spin(), h);
    }
  }
  Scene<Real, Dim>& scene_;
  ThreadTeam team_{1};
  ManifoldSolver<Real, Dim> states_;
  PointJointSolver<Real, Dim> joints_;
};

template <class Real, int Dim>
void expect_the_same_bits_of_all_widths() {
  const auto kernels = manifold_kernels<Real, Dim>();
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Scene<Real, Dim> scene = random_scene<Real, Dim>(seed, 60, seed == 1 ? 7 : 200);
    std::vector<Real> expected;
    for (const auto& of_width : kernels) {
      Solved<Real, Dim> solved(scene, of_width);
      for (const ManifoldPass pass : {ManifoldPass::begin, ManifoldPass::push, ManifoldPass::relax, ManifoldPass::begin,
                                      ManifoldPass::push, ManifoldPass::rebound})
        solved.apply(pass);
      if (expected.empty()) expected = solved.numbers();
      EXPECT_EQ(solved.numbers(), expected) << of_width.lanes;
    }
  }
}
TEST(PointJoints, GiveTheSameBitsOfAllWidths) {
  expect_the_same_bits_of_all_widths<double, 2>();
  expect_the_same_bits_of_all_widths<double, 3>();
  expect_the_same_bits_of_all_widths<float, 2>();
  expect_the_same_bits_of_all_widths<float, 3>();
}

/// The velocity at the end of an arm that was `arm` before the body turned by the rotation of its state.
template <int Dim>
Vector<double, Dim> turned(const SolverState<double, Dim>& state, const Vector<double, Dim>& arm) {
  if constexpr (Dim == 2) {
    const double sine = state.quad[1][2], cosine = 1 - state.quad[1][3];
    return {{cosine * arm[0] - sine * arm[1], sine * arm[0] + cosine * arm[1]}};
  } else {
    return rotation(Orientation<double, 3>(state.turn())) * arm;
  }
}

// A joint alone leaves nothing of the velocity of b's point against the frame of a, and changes neither momentum.
template <int Dim>
void expect_that_one_holds() {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    Scene<double, Dim> scene = random_scene<double, Dim>(seed, 2, 1);
    for (auto& body : scene.bodies)
      for (std::size_t k = 0; k < body.inverse_inertia_now.columns.size(); ++k) body.inverse_inertia_now[k][k] = 0.5;
    const auto& joint = scene.joints[0];
    Solved<double, Dim> solved(scene, manifold_kernels<double, Dim>().back());
    const auto momenta = [&] {
      Vector<double, Dim> linear{};
      Spin<double, Dim> angular{};
      for (std::size_t i = 0; i < 2; ++i) {
        const Vector<double, Dim> p = solved.state(i).v() * (1 / scene.bodies[i].inverse_mass);
        linear += p;
        angular +=
            moment(Vector<double, Dim>(scene.bodies[i].x + solved.state(i).moved()), p) + solved.state(i).spin() * 2.0;
      }
      return std::pair(linear, angular);
    };
    const auto before = momenta();
    for (const ManifoldPass pass : {ManifoldPass::begin, ManifoldPass::push, ManifoldPass::relax}) solved.apply(pass);
    const auto &a = solved.state(joint.a), &b = solved.state(joint.b);
    const Vector<double, Dim> arm_b = turned<Dim>(b, joint.arm_b);
    const Vector<double, Dim> arm_a =
        (scene.bodies[joint.b].x + b.moved() + arm_b) - (scene.bodies[joint.a].x + a.moved());
    // Numbers near 1 with a few hundred roundings.
    EXPECT_LE(length(Vector<double, Dim>((b.v() + turning(b.spin(), arm_b)) - (a.v() + turning(a.spin(), arm_a)))),
              1e-13);
    EXPECT_LE(length(Vector<double, Dim>(momenta().first - before.first)), 1e-13) << seed;
    EXPECT_LE(length(Spin<double, Dim>(momenta().second - before.second)), 1e-13) << seed;
  }
}
TEST(PointJoints, HoldPointsTogether) {
  expect_that_one_holds<2>();
  expect_that_one_holds<3>();
}

/// Balls of mass 0.5 in a square grid of distance 1, each joined to its neighbours half way; those of the highest row
/// may be fixed.
template <int Dim>
World<double, Dim> net(int side, bool hangs, const BodyTraits<double>& traits = {}) {
  World<double, Dim> world;
  std::vector<BodyHandle> bodies;
  if (hangs) world.gravity = upright_vector<Dim>(0, -9.81);
  for (int k = 0; k < side * side; ++k) {
    const int column = k % side, row = k / side;
    const auto body = world.add({.shape = Sphere<double>{0.4},
                                 .position = upright_vector<Dim>(column, -row),
                                 .mass = 0.5,
                                 .fixed = hangs && row == 0,
                                 .traits = traits});
    EXPECT_TRUE(body) << describe(body.status());
    const auto join = [&](int other, double x, double height) {
      EXPECT_TRUE(world.add_joint({.kind = JointKind::ball,
                                   .a = bodies[static_cast<std::size_t>(other)],
                                   .b = *body,
                                   .anchor = upright_vector<Dim>(x, height)}));
    };
    if (row > 0) join(k - side, column, -row + 0.5);
    if (column > 0 && !(hangs && row == 0)) join(k - 1, column - 0.5, -row);
    bodies.push_back(*body);
  }
  return world;
}
template <int Dim>
double greatest_error(const World<double, Dim>& world) {
  double greatest = 0;
  for (const JointHandle handle : world.joints()) {
    const Joint<double, Dim>& joint = *world.find(handle);
    const auto end = [&](BodyHandle body, const Vector<double, Dim>& anchor) {
      const std::size_t i = world.index(body);
      return Vector<double, Dim>(world.position[i] + rotation(world.orientation[i]) * anchor);
    };
    greatest =
        std::max(greatest, length(Vector<double, Dim>(end(joint.b, joint.anchor_b) - end(joint.a, joint.anchor_a))));
  }
  return greatest;
}

// At rest the joints of the highest row carry the weight of all others. What a joint with this softness gives way under
// a force F is F h^2 times a few inverse masses, which along a column of 15 add up with the weight below.
template <int Dim>
void expect_that_a_net_carries_its_weight() {
  constexpr int side = 16;
  World<double, Dim> world = net<Dim>(side, true, {.damping = 4, .spin_damping = 4});
  FastMotion<double, Dim> motion(world, {});
  advance(motion, 600);
  double carried = 0;
  for (const JointHandle handle : world.joints()) {
    const Joint<double, Dim>& joint = *world.find(handle);
    if (world.is_fixed(world.index(joint.a))) carried += joint.force[Dim - 1];
  }
  const double h = 1.0 / 240;
  const double weight = side * (side - 1) * 0.5 * 9.81 / (1 + 4 * h);  // damping takes its part of g h as well
  EXPECT_NEAR(carried, weight, 1e-6 * weight);
  const double force = (side - 1) * 0.5 * 9.81;
  EXPECT_LE(greatest_error(world), 20 * force * h * h / 0.5);
}
TEST(PointJoints, ANetCarriesItsWeight) {
  expect_that_a_net_carries_its_weight<2>();
  expect_that_a_net_carries_its_weight<3>();
}

/// Free nets that turn: no force acts, so that momentum stays, and joints give no energy.
template <int Dim>
void expect_that_a_free_net_keeps_its_momentum() {
  World<double, Dim> world = net<Dim>(12, false);
  for (std::size_t i = 0; i < world.size(); ++i) {
    world.velocity[i][0] = 1 - 0.5 * (world.position[i][Dim - 1] + 5.5);
    world.velocity[i][Dim - 1] = 0.5 * (world.position[i][0] - 5.5);
  }
  const auto energy = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < world.size(); ++i)
      sum += 0.25 * squared(world.velocity[i]) + 0.5 * dot(world.spin[i], world.inertia(i) * world.spin[i]);
    return sum;
  };
  const auto momentum = [&] {
    Vector<double, Dim> sum{};
    for (const auto& v : world.velocity) sum += v * 0.5;
    return sum;
  };
  const double before = energy();
  FastMotion<double, Dim> motion(world, {});
  for (int k = 0; k < 240; ++k) {
    advance(motion, 1);
    ASSERT_LE(energy(), before * (1 + 1e-9)) << k;
  }
  EXPECT_NEAR(momentum()[0], 72, 1e-9);
  EXPECT_NEAR(momentum()[Dim - 1], 0, 1e-9);
  EXPECT_LE(greatest_error(world), 1e-2);
}
TEST(PointJoints, AFreeNetKeepsItsMomentum) {
  expect_that_a_free_net_keeps_its_momentum<2>();
  expect_that_a_free_net_keeps_its_momentum<3>();
}

// The same bits for any number of threads, and where the motion goes on from a snapshot in the middle.
template <int Dim>
void expect_the_same_bits() {
  std::vector<World<double, Dim>> worlds(3, net<Dim>(20, true));
  FastMotion<double, Dim> alone(worlds[0], {}), together(worlds[1], {.threads = 3}), before(worlds[2], {});
  advance(before, 20);
  const Bytes bytes = snapshot(worlds[2], before);
  World<double, Dim> again;
  FastMotion<double, Dim> after(again, {});
  const Status status = restore(bytes, again, after);
  ASSERT_TRUE(status) << describe(status);
  advance(alone, 50), advance(together, 50), advance(after, 30);
  for (const World<double, Dim>* const other : {&worlds[1], &again})
    for (std::size_t i = 0; i < worlds[0].size(); ++i) {
      ASSERT_EQ(worlds[0].position[i], other->position[i]) << i;
      ASSERT_EQ(worlds[0].velocity[i], other->velocity[i]) << i;
      ASSERT_EQ(worlds[0].orientation[i], other->orientation[i]) << i;
    }
}
TEST(PointJoints, GiveTheSameBitsWithThreadsAndSnapshots) {
  expect_the_same_bits<2>();
  expect_the_same_bits<3>();
}

}  // namespace
}  // namespace continuo::point_joints_test
