// Boxes and joints of the plane against Box2D: the same scenes, steps of 1/60 s with four substeps, both in turn, so
// that the ratio holds where the speed of the machine drifts.
//   against_box2d [THREADS]
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <vector>

#include <bench/bodies/rigid_ratios.hpp>
#include <bench/bodies/rigid_scenes.hpp>
#include <box2d/box2d.h>

namespace continuo::bench {
namespace {

class Box2dWorld {
 public:
  explicit Box2dWorld(int threads) {
    b2WorldDef definition = b2DefaultWorldDef();
    definition.workerCount = threads;
    definition.enableSleep = false;
    world_ = b2CreateWorld(&definition);
  }
  Box2dWorld(const Box2dWorld&) = delete;
  Box2dWorld& operator=(const Box2dWorld&) = delete;
  ~Box2dWorld() { b2DestroyWorld(world_); }

  b2BodyId add(float x, float y, bool is_fixed = false) {
    b2BodyDef definition = b2DefaultBodyDef();
    definition.type = is_fixed ? b2_staticBody : b2_dynamicBody;
    definition.position = {x, y};
    bodies_.push_back(b2CreateBody(world_, &definition));
    return bodies_.back();
  }
  void add_box(b2BodyId body, float width, float height, float density = 1, b2Vec2 centre = {0, 0}) {
    const b2Polygon box = b2MakeOffsetBox(width / 2, height / 2, centre, b2Rot_identity);
    const b2ShapeDef definition = shape(density);
    b2CreatePolygonShape(body, &definition, &box);
  }
  void add_pyramid(int base, float x, float height) {
    for (int i = 0; i < base; ++i)
      for (int j = i; j < base; ++j)
        add_box(add(x + 0.5f * static_cast<float>(i + 1) + static_cast<float>(j - i),
                    height + static_cast<float>(i) + 0.5f),
                1, 1);
  }
  void add_ball(b2BodyId body, float radius, bool collides_with_balls = false) {
    b2ShapeDef definition = shape(1);
    definition.filter.categoryBits = 2;
    if (!collides_with_balls) definition.filter.maskBits = ~std::uint64_t{2};
    const b2Circle circle{{0, 0}, radius};
    b2CreateCircleShape(body, &definition, &circle);
  }
  void add_hinge(b2BodyId a, b2BodyId b, b2Vec2 at_a, b2Vec2 at_b, float speed = 0, float torque = 0) {
    b2RevoluteJointDef definition = b2DefaultRevoluteJointDef();
    definition.base.bodyIdA = a, definition.base.bodyIdB = b;
    definition.base.localFrameA.p = at_a, definition.base.localFrameB.p = at_b;
    definition.enableMotor = torque > 0;
    definition.motorSpeed = speed, definition.maxMotorTorque = torque;
    b2CreateRevoluteJoint(world_, &definition);
  }
  void advance() { b2World_Step(world_, 1.0f / 60, 4); }
  [[nodiscard]] double overlap() const {
    double deepest = 0;
    std::vector<b2ContactData> contacts(64);
    for (const b2BodyId body : bodies_) {
      const int count = b2Body_GetContactData(body, contacts.data(), static_cast<int>(contacts.size()));
      for (int k = 0; k < count; ++k)
        for (int p = 0; p < contacts[static_cast<std::size_t>(k)].manifold.pointCount; ++p)
          deepest = std::max(deepest,
                             -static_cast<double>(contacts[static_cast<std::size_t>(k)].manifold.points[p].separation));
    }
    return deepest;
  }
  [[nodiscard]] double mean_square_speed() const {
    double sum = 0;
    std::size_t count = 0;
    for (const b2BodyId body : bodies_) {
      if (b2Body_GetType(body) == b2_staticBody) continue;
      const b2Vec2 v = b2Body_GetLinearVelocity(body);
      sum += static_cast<double>(v.x * v.x + v.y * v.y), ++count;
    }
    return sum / static_cast<double>(count);
  }

 private:
  [[nodiscard]] static b2ShapeDef shape(float density) {
    b2ShapeDef definition = b2DefaultShapeDef();
    definition.density = density;
    definition.material.friction = friction;
    return definition;
  }

  b2WorldId world_;
  std::vector<b2BodyId> bodies_;
};

void make_large_pyramid(Box2dWorld& world) {
  world.add_box(world.add(0, -1, true), 200, 2);
  world.add_pyramid(100, -50, 0);
}
void make_many_pyramids(Box2dWorld& world) {
  const float width = 20 * 11;
  for (int row = 0; row < 20; ++row) {
    const float shift = 11.0f * static_cast<float>(row);
    world.add_box(world.add(0, shift - 0.05f, true), width + 2, 0.1f);
    for (int column = 0; column < 20; ++column)
      world.add_pyramid(10, -0.5f * width + 11.0f * static_cast<float>(column) + 0.5f, shift);
  }
}
void make_tumbler(Box2dWorld& world) {
  const b2BodyId ground = world.add(0, 0, true), drum = world.add(0, 10);
  world.add_box(drum, 1, 20, 50, {10, 0}), world.add_box(drum, 1, 20, 50, {-10, 0});
  world.add_box(drum, 20, 1, 50, {0, 10}), world.add_box(drum, 20, 1, 50, {0, -10});
  world.add_hinge(ground, drum, {0, 10}, {0, 0}, 25 * std::numbers::pi_v<float> / 180, 1e8f);
  for (int i = 0; i < 45; ++i)
    for (int j = 0; j < 45; ++j)
      world.add_box(world.add(-9 + 0.4f * static_cast<float>(j), 1 + 0.4f * static_cast<float>(i)), 0.25f, 0.25f);
}
void make_joint_grid(Box2dWorld& world) {
  constexpr int side = 100;
  std::vector<b2BodyId> bodies;
  for (int k = 0; k < side; ++k)
    for (int i = 0; i < side; ++i) {
      const b2BodyId body =
          world.add(static_cast<float>(k), static_cast<float>(-i), i == 0 && k >= side / 2 - 3 && k <= side / 2 + 3);
      world.add_ball(body, 0.4f);
      if (i > 0) world.add_hinge(bodies.back(), body, {0, -0.5f}, {0, 0.5f});
      if (k > 0) world.add_hinge(bodies[bodies.size() - side], body, {0.5f, 0}, {-0.5f, 0});
      bodies.push_back(body);
    }
}
void make_heap_of_discs(Box2dWorld& world) {
  world.add_box(world.add(50, -1, true), 104, 2);
  for (const float x : {-1.0f, 101.0f}) world.add_box(world.add(x, 100, true), 2, 200);
  for_each_place_of_discs([&](float x, float y) { world.add_ball(world.add(x, y), 0.5f, true); });
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  using namespace continuo::bench;
  const int threads = count > 1 ? std::max(1, std::atoi(arguments[1])) : 1;
  print_head("Box2D", threads);
  compare<2, Box2dWorld>("large_pyramid", large_pyramid<2>(100), make_large_pyramid, 500, {.threads = threads});
  compare<2, Box2dWorld>("many_pyramids", many_pyramids<2>(20, 20), make_many_pyramids, 200, {.threads = threads});
  compare<2, Box2dWorld>("tumbler", tumbler(45), make_tumbler, 750, {.threads = threads});
  compare<2, Box2dWorld>("joint_grid", joint_grid<2>(100), make_joint_grid, 500, {.threads = threads});
  compare<2, Box2dWorld>("heap of 10,000 discs", heap_of_discs(), make_heap_of_discs, 600, {.threads = threads});
  // Contacts of the same frequency are as deep and as quiet.
  compare<2, Box2dWorld>("discs, both at 30 Hz", heap_of_discs(), make_heap_of_discs, 600,
                         {.hertz = 30, .threads = threads});
}
