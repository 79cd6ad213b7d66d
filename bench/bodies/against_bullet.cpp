// Spheres, ours and Bullet's, in turn in one process: an elastic gas (exact motion) and a heap that falls into a box
// (fast motion). What is compared is the time; what each makes of the physics stands beside it.
//   against_bullet [REPEATS]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <bench/bodies/scenes.hpp>
#include <bench/processor_time.hpp>
#include <btBulletDynamicsCommon.h>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::bench {
namespace {

struct Result {
  double seconds = std::numeric_limits<double>::infinity();
  double energy = 0;   // kinetic, at the end over that at the beginning; or itself where that is 0
  double overlap = 0;  // the deepest at the end
  double deepest = 0;  // of all steps; of the exact motion as at the end
};

double deepest_overlap(const std::vector<Vector<double, 3>>& x) {
  double deepest = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double square = squared(x[i] - x[j]);
      if (square < 1) deepest = std::max(deepest, 1 - std::sqrt(square));
    }
  return deepest;
}

template <class Real>
Result judged(const World<Real, 3>& before, const World<Real, 3>& after, double seconds) {
  std::vector<Vector<double, 3>> x;
  for (const auto& at : after.position) x.push_back({{at[0], at[1], at[2]}});
  const double start = kinetic_energy(before), end = kinetic_energy(after);
  const double overlap = deepest_overlap(x);
  return {seconds, start > 0 ? end / start : end, overlap, overlap};
}

Result by_exact_motion(const Scene& scene) {
  const World<double, 3> before = world_of<double>(scene);
  World<double, 3> world = before;
  const double begin = processor_seconds();
  ExactMotion<double, 3> motion(world);
  require(motion.advance_to(scene.duration));
  return judged(before, world, processor_seconds() - begin);
}

template <class Real>
Result by_fast_motion(const Scene& scene) {
  const World<Real, 3> before = world_of<Real>(scene);
  World<Real, 3> world = before;
  double begin = processor_seconds(), deepest = 0;
  FastMotion<Real, 3> motion(world);
  double seconds = processor_seconds() - begin;
  for (int i = 0; i < std::lround(scene.duration / scene.step); ++i) {
    begin = processor_seconds();
    require(motion.advance());
    seconds += processor_seconds() - begin;
    deepest = std::max(deepest, static_cast<double>(motion.deepest_overlap()));
  }
  Result result = judged(before, world, seconds);
  result.deepest = std::max(result.deepest, deepest);
  return result;
}

/// Ten iterations, steps of 1/60, sleeping off; planes for the box.
Result by_bullet(const Scene& scene) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broad_phase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broad_phase, &solver, &configuration);
  world.getSolverInfo().m_numIterations = 10;
  const auto as = [](const Vector<double, 3>& v) {
    return btVector3(static_cast<btScalar>(v[0]), static_cast<btScalar>(v[1]), static_cast<btScalar>(v[2]));
  };
  world.setGravity(as(scene.gravity));
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btMotionState>> states;
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  const auto add = [&](btCollisionShape* shape, double mass, const btVector3& at, const btVector3& velocity) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
    states.push_back(std::make_unique<btDefaultMotionState>(btTransform(btQuaternion::getIdentity(), at)));
    btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), states.back().get(), shape, inertia);
    info.m_restitution = static_cast<btScalar>(scene.material.restitution);
    info.m_friction = static_cast<btScalar>(scene.material.friction);
    bodies.push_back(std::make_unique<btRigidBody>(info));
    bodies.back()->setLinearVelocity(velocity);
    bodies.back()->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(bodies.back().get());
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {1, -1}) {
      btVector3 normal(0, 0, 0);
      normal[axis] = static_cast<btScalar>(side);
      shapes.push_back(std::make_unique<btStaticPlaneShape>(
          normal, side > 0 ? btScalar(0) : static_cast<btScalar>(-scene.upper[static_cast<std::size_t>(axis)])));
      add(shapes.back().get(), 0, btVector3(0, 0, 0), btVector3(0, 0, 0));
    }
  shapes.push_back(std::make_unique<btSphereShape>(btScalar(0.5)));
  const double mass = volume<double, 3>(Sphere<double>{0.5});
  for (std::size_t i = 0; i < scene.position.size(); ++i)
    add(shapes.back().get(), mass, as(scene.position[i]), as(scene.velocity[i]));
  const auto energy = [&] {
    double sum = 0;
    for (const auto& body : bodies)
      if (body->getInvMass() > 0)
        sum += mass / 2 * body->getLinearVelocity().length2() + 0.1 * mass / 2 * body->getAngularVelocity().length2();
    return sum;
  };
  const double start = energy();
  double seconds = 0, deepest = 0;
  for (int i = 0; i < std::lround(scene.duration / scene.step); ++i) {
    const double begin = processor_seconds();
    world.stepSimulation(static_cast<btScalar>(scene.step), 0, static_cast<btScalar>(scene.step));
    seconds += processor_seconds() - begin;
    for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
      const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
      for (int p = 0; p < manifold.getNumContacts(); ++p)
        deepest = std::max(deepest, -static_cast<double>(manifold.getContactPoint(p).getDistance()));
    }
  }
  const double end = energy();
  std::vector<Vector<double, 3>> x;
  for (const auto& body : bodies) {
    const btVector3 at = body->getWorldTransform().getOrigin();
    if (body->getInvMass() > 0) x.push_back({{at.x(), at.y(), at.z()}});
  }
  for (const auto& body : bodies) world.removeRigidBody(body.get());
  const double overlap = deepest_overlap(x);
  return {seconds, start > 0 ? end / start : end, overlap, std::max(overlap, deepest)};
}

constexpr const char* bullet = sizeof(btScalar) == sizeof(float) ? "bullet, float" : "bullet, double";

void print(const char* scene, const char* solver, const Result& result, const Result& peer) {
  std::printf("| %s | %s | %.3g s | **%.3f** (1/%.1f) | %.6g | %.4f | %.4f |\n", scene, solver, result.seconds,
              result.seconds / peer.seconds, peer.seconds / result.seconds, result.energy, result.overlap,
              result.deepest);
  std::fflush(stdout);
}

template <class Run>
void take_less(Result& least, Run&& run) {
  const Result result = run();
  if (result.seconds < least.seconds) least = result;
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  using namespace continuo::bench;
  const int repeats = count > 1 ? std::max(1, std::atoi(arguments[1])) : 2;
  std::puts(
      "| Scene | Solver | Time | Part of Bullet's | Kinetic energy | Deepest overlap | Of all steps "
      "|\n|---|---|---|---|---|---|---|");
  {
    const Scene scene = gas(1000, 20, 60);
    Result ours, theirs;
    for (int i = 0; i < repeats; ++i) {
      take_less(ours, [&] { return by_exact_motion(scene); });
      take_less(theirs, [&] { return by_bullet(scene); });
    }
    print("gas of 1,000, 60 s", "exact", ours, theirs);
    print("gas of 1,000, 60 s", bullet, theirs, theirs);
  }
  {
    const Scene scene = heap(10000);
    Result single, full, theirs;
    for (int i = 0; i < repeats; ++i) {
      take_less(single, [&] { return by_fast_motion<float>(scene); });
      take_less(full, [&] { return by_fast_motion<double>(scene); });
      take_less(theirs, [&] { return by_bullet(scene); });
    }
    print("heap of 10,000, 600 steps", "fast, float", single, theirs);
    print("heap of 10,000, 600 steps", "fast, double", full, theirs);
    print("heap of 10,000, 600 steps", bullet, theirs, theirs);
  }
}
