// Boxes and joints of space against Box3D: the same scenes, steps of 1/60 s with four substeps, both in turn, so that
// the ratio holds where the speed of the machine drifts.
//   against_box3d [THREADS]
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include <bench/bodies/rigid_ratios.hpp>
#include <bench/bodies/rigid_scenes.hpp>
#include <box3d/box3d.h>

namespace continuo::bench {
namespace {

class Box3dWorld {
 public:
  explicit Box3dWorld(int threads) {
    b3WorldDef definition = b3DefaultWorldDef();
    definition.workerCount = static_cast<std::uint32_t>(threads);
    definition.enableSleep = false;
    definition.gravity = {0, -9.81f, 0};
    world_ = b3CreateWorld(&definition);
  }
  Box3dWorld(const Box3dWorld&) = delete;
  Box3dWorld& operator=(const Box3dWorld&) = delete;
  ~Box3dWorld() { b3DestroyWorld(world_); }

  b3BodyId add(float x, float height, float depth, bool is_fixed = false) {
    b3BodyDef definition = b3DefaultBodyDef();
    definition.type = is_fixed ? b3_staticBody : b3_dynamicBody;
    definition.position = {x, height, depth};
    bodies_.push_back(b3CreateBody(world_, &definition));
    return bodies_.back();
  }
  void add_box(b3BodyId body, float width, float height, float depth) {
    const b3BoxHull box = b3MakeBoxHull(width / 2, height / 2, depth / 2);
    const b3ShapeDef definition = shape();
    b3CreateHullShape(body, &definition, &box.base);
  }
  void add_pyramid(int base, float x, float depth) {
    for (int i = 0; i < base; ++i)
      for (int j = i; j < base; ++j)
        add_box(
            add(x + 0.5f * static_cast<float>(i + 1) + static_cast<float>(j - i), static_cast<float>(i) + 0.5f, depth),
            1, 1, 1);
  }
  void add_ball(b3BodyId body, float radius) {
    b3ShapeDef definition = shape();
    definition.filter.categoryBits = 2;
    definition.filter.maskBits = ~std::uint64_t{2};
    const b3Sphere sphere{{0, 0, 0}, radius};
    b3CreateSphereShape(body, &definition, &sphere);
  }
  void add_joint(b3BodyId a, b3BodyId b, b3Vec3 at_a, b3Vec3 at_b) {
    b3SphericalJointDef definition = b3DefaultSphericalJointDef();
    definition.base.bodyIdA = a, definition.base.bodyIdB = b;
    definition.base.localFrameA.p = at_a, definition.base.localFrameB.p = at_b;
    b3CreateSphericalJoint(world_, &definition);
  }
  void advance() { b3World_Step(world_, 1.0f / 60, 4); }
  [[nodiscard]] double overlap() const {
    double deepest = 0;
    std::vector<b3ContactData> contacts(256);
    for (const b3BodyId body : bodies_) {
      const int count = b3Body_GetContactData(body, contacts.data(), static_cast<int>(contacts.size()));
      for (const b3ContactData& contact : std::span(contacts).first(static_cast<std::size_t>(count)))
        for (int m = 0; m < contact.manifoldCount; ++m)
          for (int p = 0; p < contact.manifolds[m].pointCount; ++p)
            deepest = std::max(deepest, -static_cast<double>(contact.manifolds[m].points[p].separation));
    }
    return deepest;
  }
  [[nodiscard]] double mean_square_speed() const {
    double sum = 0;
    std::size_t count = 0;
    for (const b3BodyId body : bodies_) {
      if (b3Body_GetType(body) == b3_staticBody) continue;
      const b3Vec3 v = b3Body_GetLinearVelocity(body);
      sum += static_cast<double>(v.x * v.x + v.y * v.y + v.z * v.z), ++count;
    }
    return sum / static_cast<double>(count);
  }

 private:
  [[nodiscard]] static b3ShapeDef shape() {
    b3ShapeDef definition = b3DefaultShapeDef();
    definition.density = 1;
    definition.baseMaterial.friction = friction;
    return definition;
  }

  b3WorldId world_;
  std::vector<b3BodyId> bodies_;
};

void make_large_pyramid(Box3dWorld& world) {
  world.add_box(world.add(0, -1, 0, true), 800, 2, 800);
  world.add_pyramid(100, -50, 0);
}
void make_many_pyramids(Box3dWorld& world) {
  const float width = 14 * 11;
  world.add_box(world.add(0, -1, 0, true), 800, 2, 800);
  for (int row = 0; row < 14; ++row)
    for (int column = 0; column < 14; ++column)
      world.add_pyramid(10, -0.5f * width + 11.0f * static_cast<float>(column) + 0.5f, 11.0f * static_cast<float>(row));
}
void make_joint_grid(Box3dWorld& world) {
  constexpr int side = 100;
  std::vector<b3BodyId> bodies;
  for (int k = 0; k < side; ++k)
    for (int i = 0; i < side; ++i) {
      const b3BodyId body = world.add(static_cast<float>(k), static_cast<float>(-i), 0, i == 0);
      world.add_ball(body, 0.4f);
      if (i > 0) world.add_joint(bodies.back(), body, {0, -0.5f, 0}, {0, 0.5f, 0});
      if (k > 0 && i > 0) world.add_joint(bodies[bodies.size() - side], body, {0.5f, 0, 0}, {-0.5f, 0, 0});
      bodies.push_back(body);
    }
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  using namespace continuo::bench;
  const int threads = count > 1 ? std::max(1, std::atoi(arguments[1])) : 1;
  print_head("Box3D", threads);
  compare<3, Box3dWorld>("large_pyramid", large_pyramid<3>(100), make_large_pyramid, 200, {.threads = threads});
  compare<3, Box3dWorld>("many_pyramids", many_pyramids<3>(14, 14), make_many_pyramids, 100, {.threads = threads});
  compare<3, Box3dWorld>("joint_grid", joint_grid<3>(100), make_joint_grid, 100, {.threads = threads});
}
