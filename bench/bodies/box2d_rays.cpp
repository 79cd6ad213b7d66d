// Rays among static bodies of Box2D.
#include <algorithm>
#include <variant>

#include <bench/bodies/ray_scenes.hpp>
#include <bench/bodies/rigid_ratios.hpp>
#include <box2d/box2d.h>

namespace continuo::bench {
namespace {

b2Vec2 of(const Vector<float, 2>& v) {
  return {v[0], v[1]};
}
void add(b2BodyId body, const b2ShapeDef& definition, const Sphere<float>& ball) {
  const b2Circle circle{{0, 0}, ball.radius};
  b2CreateCircleShape(body, &definition, &circle);
}
void add(b2BodyId body, const b2ShapeDef& definition, const Capsule<float>& rod) {
  const b2Capsule capsule{{0, -rod.length / 2}, {0, rod.length / 2}, rod.radius};
  b2CreateCapsuleShape(body, &definition, &capsule);
}
void add(b2BodyId body, const b2ShapeDef& definition, const Box<float, 2>& box) {
  const b2Polygon polygon = b2MakeBox(box.size[0] / 2, box.size[1] / 2);
  b2CreatePolygonShape(body, &definition, &polygon);
}
void add(b2BodyId body, const b2ShapeDef& definition, const Hull<float, 2>& hull) {
  std::vector<b2Vec2> points;
  for (const Vector<float, 2>& point : hull.points) points.push_back(of(point));
  const b2Hull found = b2ComputeHull(points.data(), static_cast<int>(points.size()));
  const b2Polygon polygon = b2MakePolygon(&found, 0);
  b2CreatePolygonShape(body, &definition, &polygon);
}
void add(b2BodyId, const b2ShapeDef&, const Compound<float, 2>&) {}  // the scenes have none

}  // namespace

std::optional<RayTimes> rays_of_peer(const RayScene<float, 2>& scene, std::span<const Ray<float, 2>> rays, int times) {
  const b2WorldDef world_definition = b2DefaultWorldDef();
  const b2WorldId world = b2CreateWorld(&world_definition);
  const b2ShapeDef shape_definition = b2DefaultShapeDef();
  for (const auto& at : scene.bodies) {
    b2BodyDef definition = b2DefaultBodyDef();
    definition.position = of(at.position);
    definition.rotation = b2MakeRot(at.orientation[0]);
    const b2BodyId body = b2CreateBody(world, &definition);
    std::visit([&](const auto& shape) { add(body, shape_definition, shape); }, at.shape);
  }
  b2World_RebuildStaticTree(world);
  const RayTimes found = least_time(times, processor_seconds, [&] {
    RayTimes sums;
    for (const Ray<float, 2>& ray : rays) {
      const b2RayResult hit =
          b2World_CastRayClosest(world, of(ray.origin), of(ray.direction * ray.reach), b2DefaultQueryFilter());
      if (hit.hit) ++sums.hits, sums.distance += static_cast<double>(hit.fraction * ray.reach);
    }
    return sums;
  });
  b2DestroyWorld(world);
  return found;
}

}  // namespace continuo::bench
