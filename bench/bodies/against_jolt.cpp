// Balls and boxes of space against Jolt: the same scenes, steps of 1/60 s, both in turn, so that the ratio holds where
// the speed of the machine drifts. Each system has its defaults: ours four substeps, Jolt ten sweeps of velocities and
// two of positions.
//   against_jolt [THREADS]
#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <vector>

// Each header of Jolt needs this one before it.
#include <Jolt/Jolt.h>
// The others.
#include <Jolt/Core/Factory.h>
#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/JobSystemThreadPool.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Body/BodyFilter.h>
#include <Jolt/Physics/Collision/BroadPhase/BroadPhaseLayerInterfaceTable.h>
#include <Jolt/Physics/Collision/BroadPhase/ObjectVsBroadPhaseLayerFilterTable.h>
#include <Jolt/Physics/Collision/CollideShape.h>
#include <Jolt/Physics/Collision/CollisionCollectorImpl.h>
#include <Jolt/Physics/Collision/NarrowPhaseQuery.h>
#include <Jolt/Physics/Collision/ObjectLayerPairFilterTable.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/PlaneShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/RegisterTypes.h>
#include <bench/bodies/rigid_ratios.hpp>
#include <bench/bodies/rigid_scenes.hpp>
#include <bench/bodies/scenes.hpp>

namespace continuo::bench {
namespace {

/// The layers of Jolt: what is fixed meets what moves, what moves meets all.
struct JoltLayers {
  static constexpr JPH::ObjectLayer fixed{0}, moving{1};
  JPH::BroadPhaseLayerInterfaceTable of_broad_phase{2, 2};
  JPH::ObjectLayerPairFilterTable pairs{2};
  std::unique_ptr<JPH::ObjectVsBroadPhaseLayerFilterTable> with_broad_phase;

  JoltLayers() {
    of_broad_phase.MapObjectToBroadPhaseLayer(fixed, JPH::BroadPhaseLayer(0));
    of_broad_phase.MapObjectToBroadPhaseLayer(moving, JPH::BroadPhaseLayer(1));
    pairs.EnableCollision(fixed, moving), pairs.EnableCollision(moving, moving);
    with_broad_phase = std::make_unique<JPH::ObjectVsBroadPhaseLayerFilterTable>(of_broad_phase, 2, pairs, 2);
  }
};

class JoltWorld {
 public:
  explicit JoltWorld(int threads) : memory_(256 << 20) {
    if (threads == 1)
      jobs_ = std::make_unique<JPH::JobSystemSingleThreaded>(JPH::cMaxPhysicsJobs);
    else
      jobs_ = std::make_unique<JPH::JobSystemThreadPool>(JPH::cMaxPhysicsJobs, JPH::cMaxPhysicsBarriers, threads - 1);
    system_.Init(1 << 15, 0, 1 << 18, 1 << 17, layers_.of_broad_phase, *layers_.with_broad_phase, layers_.pairs);
    system_.SetGravity(JPH::Vec3(0, 0, -9.81f));
  }
  void add_plane(const JPH::Vec3& normal, float offset) {
    add(new JPH::PlaneShape(JPH::Plane(normal, -offset)), {0, 0, 0}, true);
  }
  void add_ball(const JPH::Vec3& at, float radius) { add(new JPH::SphereShape(radius), at); }
  void add_box(const JPH::Vec3& at) { add(new JPH::BoxShape(JPH::Vec3::sReplicate(0.5f)), at); }
  void set_friction(float friction) { friction_ = friction; }
  void add_pyramid(int base, float x, float depth) {
    for (int i = 0; i < base; ++i)
      for (int j = i; j < base; ++j)
        add_box(
            {x + 0.5f * static_cast<float>(i + 1) + static_cast<float>(j - i), depth, static_cast<float>(i) + 0.5f});
  }
  void advance() {
    if (!is_ready_) system_.OptimizeBroadPhase(), is_ready_ = true;
    system_.Update(1.0f / 60, 1, &memory_, jobs_.get());
  }
  [[nodiscard]] double overlap() const {
    double deepest = 0;
    for (const JPH::BodyID body : bodies_) {
      const JPH::RefConst<JPH::Shape> shape = system_.GetBodyInterfaceNoLock().GetShape(body);
      JPH::AllHitCollisionCollector<JPH::CollideShapeCollector> found;
      system_.GetNarrowPhaseQueryNoLock().CollideShape(
          shape, JPH::Vec3::sReplicate(1), system_.GetBodyInterfaceNoLock().GetCenterOfMassTransform(body), {},
          JPH::RVec3::sZero(), found, {}, {}, JPH::IgnoreSingleBodyFilter(body));
      for (const JPH::CollideShapeResult& hit : found.mHits)
        deepest = std::max(deepest, static_cast<double>(hit.mPenetrationDepth));
    }
    return deepest;
  }
  [[nodiscard]] double mean_square_speed() const {
    double sum = 0;
    for (const JPH::BodyID body : bodies_)
      sum += static_cast<double>(system_.GetBodyInterfaceNoLock().GetLinearVelocity(body).LengthSq());
    return sum / static_cast<double>(bodies_.size());
  }

 private:
  void add(const JPH::Shape* shape, const JPH::Vec3& at, bool is_fixed = false) {
    JPH::BodyCreationSettings body(shape, JPH::RVec3(at), JPH::Quat::sIdentity(),
                                   is_fixed ? JPH::EMotionType::Static : JPH::EMotionType::Dynamic,
                                   is_fixed ? JoltLayers::fixed : JoltLayers::moving);
    body.mFriction = friction_;
    body.mAllowSleeping = false;
    body.mLinearDamping = body.mAngularDamping = 0;
    const JPH::BodyID made = system_.GetBodyInterface().CreateAndAddBody(body, JPH::EActivation::Activate);
    if (!is_fixed) bodies_.push_back(made);
  }

  JoltLayers layers_;
  JPH::TempAllocatorImpl memory_;
  std::unique_ptr<JPH::JobSystem> jobs_;
  JPH::PhysicsSystem system_;
  std::vector<JPH::BodyID> bodies_;
  float friction_ = friction;
  bool is_ready_ = false;
};

[[nodiscard]] JPH::Vec3 of_jolt(const Vector<double, 3>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}
/// Balls that fall into an open box.
void make_balls(JoltWorld& world, const Scene& scene) {
  world.set_friction(static_cast<float>(scene.material.friction));
  world.add_plane({0, 0, 1}, 0);
  for (const std::size_t axis : {0u, 1u}) {
    JPH::Vec3 normal = JPH::Vec3::sZero();
    normal.SetComponent(static_cast<unsigned>(axis), 1);
    world.add_plane(normal, 0), world.add_plane(-normal, -static_cast<float>(scene.upper[axis]));
  }
  for (std::size_t i = 0; i < scene.position.size(); ++i)
    world.add_ball(of_jolt(scene.position[i]), scene.radius.empty() ? 0.5f : static_cast<float>(scene.radius[i]));
}
void make_large_pyramid(JoltWorld& world) {
  world.add_plane({0, 0, 1}, 0);
  world.add_pyramid(100, -50, 0);
}
void make_many_pyramids(JoltWorld& world) {
  const float width = 14 * 11;
  world.add_plane({0, 0, 1}, 0);
  for (int row = 0; row < 14; ++row)
    for (int column = 0; column < 14; ++column)
      world.add_pyramid(10, -0.5f * width + 11.0f * static_cast<float>(column) + 0.5f, 11.0f * static_cast<float>(row));
}
void compare_balls(const char* name, const Scene& scene, int threads) {
  compare<3, JoltWorld>(name, world_of<float>(scene), [&](JoltWorld& world) { make_balls(world, scene); }, 600,
                        {.threads = threads});
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  using namespace continuo::bench;
  const int threads = count > 1 ? std::max(1, std::atoi(arguments[1])) : 1;
  JPH::RegisterDefaultAllocator();
  JPH::Factory::sInstance = new JPH::Factory;
  JPH::RegisterTypes();
  print_head("Jolt", threads);
  compare_balls("heap of 10,000 balls", heap(10000), threads);
  compare_balls("10 % of the balls 15 times as large", heap_of_two_sizes(10000, 0.1, 15), threads);
  compare<3, JoltWorld>("large_pyramid", large_pyramid<3>(100), make_large_pyramid, 200, {.threads = threads});
  compare<3, JoltWorld>("many_pyramids", many_pyramids<3>(14, 14), make_many_pyramids, 100, {.threads = threads});
}
